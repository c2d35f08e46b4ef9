#include "sets.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera::bench {

namespace {

/// Control points unchanged, weights from 1 to 2. Opposite borders have equal weights, so that neighbours still share
/// their borders.
std::vector<BezierPatch> with_weights(const std::vector<BezierPatch>& patches) {
  std::vector<BezierPatch> out;
  for (const BezierPatch& patch : patches) {
    std::vector<double> weights;
    for (int i = 0; i <= patch.degree_u(); ++i)
      for (int j = 0; j <= patch.degree_v(); ++j)
        weights.push_back(1 + (i % patch.degree_u() == 0 ? 0 : 0.25) + (j % patch.degree_v() == 0 ? 0 : 0.75));
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
  static std::map<std::string, PatchSet, std::less<>> fields;
  const auto known = fields.find(name);
  if (known != fields.end()) return known->second;
  const bool rational = name.starts_with("rational");
  const int patches = std::stoi(std::string(name.substr(name.find_first_of("0123456789"))));
  const int columns = patches < 20000 ? 25 : 100;
  PatchSetOptions options;
  options.blocks.double_bernstein = !rational && (patches == 20000 || patches == 100000);
  const std::vector<BezierPatch> field = test::wavy_field(patches / columns, columns);
  return fields.emplace(name, test::value_of(PatchSet::make(rational ? with_weights(field) : field, options)))
      .first->second;
}

}  // namespace tessera::bench
