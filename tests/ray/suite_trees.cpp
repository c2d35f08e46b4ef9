// Chooses the trees of the scenes of all tests in this program: TESSERA_TEST_RAY_TREES=own for the library's own, which
// the test ray.own_trees sets. Otherwise scenes have those that the build prefers.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string_view>

#include "ray/tree/ray_trees.h"

namespace tessera::test { namespace {

class SuiteTrees final : public testing::Environment {
  void SetUp() override {
    const char* const wanted = std::getenv("TESSERA_TEST_RAY_TREES");
    if (wanted == nullptr) return;
    ASSERT_STREQ(wanted, "own");
    use_ray_trees(&own_ray_trees());
  }
};

[[maybe_unused]] const testing::Environment* const suite_trees = testing::AddGlobalTestEnvironment(new SuiteTrees);

}}  // namespace tessera::test
