// Points of scenes of patches, for both modes.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/text.h"
#include "ray/line/first_order.h"
#include "ray/scene/ray_scene_impl.h"
#include "ray/scene/surface_hit.h"

namespace tessera { inline namespace abi_0_1 {

/// Positions are convex combinations relative to the box's centre (first_order.h), or absolute: at most 4 (m + n) + 8
/// roundings of the largest coordinate (Farouki and Rajan, CAGD 4, 1987, sec. 5).
double PatchScene::spawn_offset() const {
  const Box3 around = box();
  const double largest = std::max(max_abs(around.lower), max_abs(around.upper));
  return std::numeric_limits<double>::epsilon() * (2 * largest + (4 * 2 * max_degree + 8) * size());
}

Status PatchScene::check_point(std::uint32_t patch, double u, double v) const {
  if (patch >= set_.patch_count())
    return Status(StatusCode::invalid_argument,
                  "there is no patch " + std::to_string(patch) + " in a set of " + std::to_string(set_.patch_count()));
  // Written so that NaN fails.
  if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1))
    return Status(std::isfinite(u) && std::isfinite(v) ? StatusCode::invalid_argument : StatusCode::non_finite,
                  "u and v of a point of a patch are " + text(u) + " and " + text(v) + ", they must be from 0 to 1");
  return {};
}

Result<LocalGeometry> PatchScene::local_geometry(const Hit& hit) const {
  if (Status status = check_point(hit.patch, hit.patch_u, hit.patch_v); !status.ok()) return status;
  return tessera::local_geometry(set_.patch(hit.patch), hit.patch_u, hit.patch_v);
}

Result<Hit> PatchScene::resolve(std::uint32_t patch, double u, double v) const {
  if (Status status = check_point(patch, u, v); !status.ok()) return status;
  Hit hit;
  hit.t = 0;
  set_surface_point(set_, size(), 1, patch, u, v, first_order(set_.patch(patch), u, v), hit);
  return hit;
}

}}  // namespace tessera::abi_0_1
