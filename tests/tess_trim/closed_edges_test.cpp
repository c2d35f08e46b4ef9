// The vertices that faces share along edges, as the planner asks for them.

#include "tess/closing/closed_edges.h"

#include <atomic>

#include "base/impl_access.h"
#include "tess_trim/closed_shape.h"

namespace tessera::test {
namespace {

TEST(ClosedEdges, AreNotMadeOnceTheCallIsCancelled) {
  const PatchSet set = value_of(make_patch_set(joined(cube(), 1e-6)));
  const PatchSet::Impl& impl = impl_of(set);
  const EdgeRuns runs(impl);
  std::vector<Division> divisions;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const Segments rate(2 + static_cast<int>(k));
    divisions.push_back(Division::of(PatchShape::of(set.patch(k)), {rate, rate}, {rate, rate, rate, rate}));
  }
  const std::vector<std::uint8_t> is_joined(4 * divisions.size(), 0);
  const auto close = [&](const std::atomic<bool>* cancel) {
    return close_edges(
        impl, runs, divisions, {}, nullptr, 1, 1e-9, is_joined, [](std::uint32_t) { return ChordBound(); }, cancel);
  };
  std::atomic<bool> cancel = false;
  for (const Result<ClosedEdges>& made : {close(nullptr), close(&cancel)}) {
    ASSERT_TRUE(made.ok());
    EXPECT_GT(made->edits.size(), 2u);
    EXPECT_LT(made->gap, 1e-15);
  }
  cancel = true;
  EXPECT_EQ(close(&cancel).status().code(), StatusCode::cancelled);
}

}  // namespace
}  // namespace tessera::test
