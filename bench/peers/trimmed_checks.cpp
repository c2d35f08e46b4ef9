#include "peers/trimmed_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/trim_region.h"

namespace tessera::bench {

AreaCheck check_areas(const TrimmedCase& one, std::span<const SurfaceTriangle> mesh, double bound) {
  std::vector<double> areas(one.faces.size(), 0);
  for (const SurfaceTriangle& t : mesh)
    areas[t.face] += 0.5 * length(cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]));
  AreaCheck check;
  for (std::size_t k = 0; k < areas.size(); ++k) {
    const TrueFace& face = *one.faces[k];
    const double off = std::abs(areas[k] - face.area());
    const double share = off / face.area(), expected = off / (bound * face.perimeter() + 1e-3 * face.area());
    if (share > check.worst) check.worst = share, check.face = k;
    if (expected > check.expected) check.expected = expected, check.expected_face = k;
  }
  return check;
}

SideCheck check_sides(const TrimmedCase& one, std::size_t points_per_face) {
  SideCheck all;
  std::mt19937 random(2);
  for (std::size_t k = 0; k < one.faces.size(); ++k) {
    const TrueFace& face = *one.faces[k];
    const ModelSurface& surface = one.model.surfaces[k];
    const TrimRegion region = test::value_of(TrimRegion::make(*surface.trims, test::value_of(to_bezier(surface))));
    std::size_t apart = 0, kept = 0;
    double farthest = 0;
    Parameters where{};
    for (std::size_t point = 0; point < points_per_face; ++point) {
      const Parameters at = face.random(random), ours = face.ours(at);
      const TrimSide side = region.locate(ours[0], ours[1]);
      const bool theirs = face.contains(at);
      ++all.points;
      all.borders += side == TrimSide::border;
      if (side == TrimSide::border || (side == TrimSide::inside) == theirs) continue;
      const double share = face.border_share(at);
      if (!(share > 1e-6)) {
        ++all.near;
        continue;
      }
      ++apart;
      kept += side == TrimSide::inside;
      if (share > farthest) farthest = share, where = at;
    }
    all.apart += apart;
    all.farthest = std::max(all.farthest, farthest);
    if (apart > 0)
      std::printf(
          "  sides: face %zu, %zu loops: %zu of %zu points differ, %zu of them kept here; farthest %.1e of the "
          "box from the border, at (%.9g, %.9g)\n",
          k, surface.trims->size(), apart, points_per_face, kept, farthest, where[0], where[1]);
  }
  return all;
}

}  // namespace tessera::bench
