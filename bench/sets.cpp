#include "sets.h"

#include <filesystem>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera::bench {

namespace {

/// The same control points with weights from 1 to 2.
std::vector<BezierPatch> with_weights(const std::vector<BezierPatch>& patches) {
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    std::vector<double> weights;
    for (std::size_t k = 0; k < patch.points().size(); ++k) weights.push_back(1 + static_cast<double>(k % 5) / 4);
    const std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    out.push_back(test::value_of(BezierPatch::rational(patch.degree_u(), patch.degree_v(), points, weights)));
  }
  return out;
}

}  // namespace

const PatchSet& set_named(std::string_view name) {
  if (name == "teapot") {
    static const PatchSet teapot = test::value_of(make_patch_set(
        test::value_of(read_model(std::filesystem::path(TESSERA_SOURCE_DIR) / "tools" / "models" / "teapot.bpt"))));
    return teapot;
  }
  if (name == "bicubic1000") {
    static const PatchSet small = test::value_of(PatchSet::from(test::wavy_field(40, 25)));
    return small;
  }
  if (name == "rational20000") {
    static const PatchSet rational = test::value_of(PatchSet::from(with_weights(test::wavy_field(200, 100))));
    return rational;
  }
  static const PatchSet field = [] {
    PatchSetOptions options;
    options.blocks.double_bernstein = true;
    return test::value_of(PatchSet::from(test::wavy_field(200, 100), options));
  }();
  return field;
}

}  // namespace tessera::bench
