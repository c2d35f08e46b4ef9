// .bpt as parse_bpt reads it: the number of patches, then the degrees and the control points of each.

#include <algorithm>
#include <string>

#include "io/spline/model_formats.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Whether all weights are equal, so that they change nothing.
bool is_polynomial(const BezierPatch& patch) {
  const auto weights = patch.weights();
  return std::all_of(weights.begin(), weights.end(), [&](double w) { return w == weights.front(); });
}

void write_patch(const BezierPatch& patch, OutputFile& out) {
  out.write_number(patch.degree_u());
  out.write(' ');
  out.write_number(patch.degree_v());
  out.write('\n');
  for (const Vec3& p : patch.points()) {
    out.write_number(p.x);
    out.write(' ');
    out.write_number(p.y);
    out.write(' ');
    out.write_number(p.z);
    out.write('\n');
  }
}

}  // namespace

Status write_bpt(std::span<const WrittenSurface> surfaces, OutputFile& out, std::vector<std::string>& warnings) {
  std::size_t patches = 0;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const WrittenSurface& surface = surfaces[k];
    const auto rational = std::find_if_not(surface.patches.begin(), surface.patches.end(), is_polynomial);
    if (rational != surface.patches.end())
      return {StatusCode::unsupported,
              (surface.patches.size() == 1 ? std::string("it")
                                           : "its patch " + std::to_string(rational - surface.patches.begin())) +
                  " is rational, but .bpt has no weights: write .obj",
              static_cast<std::ptrdiff_t>(k)};
    if (!surface.trims.empty()) warnings.push_back(trims_left_out(k, surface, ".bpt has none"));
    patches += surface.patches.size();
  }
  out.write_number(patches);
  out.write('\n');
  for (const WrittenSurface& surface : surfaces)
    for (const BezierPatch& patch : surface.patches) {
      if (out.failed()) return {};
      write_patch(patch, out);
    }
  return {};
}

}}  // namespace tessera::abi_0_1
