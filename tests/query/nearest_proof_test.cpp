// Compares nearest points with a search that shares no code, in classes of difficult surfaces and places. A longer
// run: tessera_nearest_report.

#include <gtest/gtest.h>

#include "support/nearest_proof.h"

namespace tessera::test { namespace {

TEST(NearestProof, NothingIsNearer) {
  for (const RayClass& of : ray_classes()) {
    SCOPED_TRACE(of.name);
    const NearestTally tally = nearest_tally(of, 150, 3);
    EXPECT_EQ(tally.missed, 0u);
    EXPECT_EQ(tally.wrong, 0u) << tally.worst;
    EXPECT_EQ(tally.off, 0u);
    EXPECT_EQ(tally.far_from_best, 0u);
    EXPECT_GE(double(tally.certified), 0.99 * double(tally.points));
  }
}

}}  // namespace tessera::test
