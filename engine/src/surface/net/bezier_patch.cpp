#include "tessera/bezier_patch.h"

#include <algorithm>
#include <string>

#include "surface/net/collapsed_sides.h"
#include "surface/net/patch_pieces.h"
#include "surface/net/validate.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::string size_text(int degree_u, int degree_v) {
  return "a patch of degree (" + std::to_string(degree_u) + ", " + std::to_string(degree_v) + ") has " +
         std::to_string(degree_u + 1) + " x " + std::to_string(degree_v + 1);
}

Status check_count(int degree_u, int degree_v, std::size_t count, const char* what) {
  if (count == static_cast<std::size_t>(degree_u + 1) * static_cast<std::size_t>(degree_v + 1)) return {};
  return {StatusCode::count_mismatch, size_text(degree_u, degree_v) + " " + what + ", found " + std::to_string(count)};
}

/// Checks the requirements of BezierPatch::polynomial.
Status check_net(int degree_u, int degree_v, std::span<const Vec3> points) {
  if (Status status = check_degree(degree_u, "degree u"); !status.ok()) return status;
  if (Status status = check_degree(degree_v, "degree v"); !status.ok()) return status;
  if (Status status = check_count(degree_u, degree_v, points.size(), "control points"); !status.ok()) return status;
  return check_points(points, [&](std::size_t k) { return place_in_rows(k, static_cast<std::size_t>(degree_v) + 1); });
}

}  // namespace

Result<BezierPatch> BezierPatch::polynomial(int degree_u, int degree_v, std::span<const Vec3> points) {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_net(degree_u, degree_v, points); !status.ok()) return status;
    return PatchPieces::single(degree_u, degree_v, points, {});
  });
}

Result<BezierPatch> BezierPatch::rational(int degree_u, int degree_v, std::span<const Vec3> points,
                                          std::span<const double> weights) {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_net(degree_u, degree_v, points); !status.ok()) return status;
    if (Status status = check_count(degree_u, degree_v, weights.size(), "weights"); !status.ok()) return status;
    const auto place = [&](std::size_t k) { return place_in_rows(k, static_cast<std::size_t>(degree_v) + 1); };
    if (Status status = check_weights(weights, place); !status.ok()) return status;
    return PatchPieces::single(degree_u, degree_v, points, all_equal(weights) ? std::span<const double>{} : weights);
  });
}

Result<BezierPatch> BezierPatch::with_points(std::span<const Vec3> points) const {
  return guarded([&]() -> Result<BezierPatch> {
    if (Status status = check_net(degree_u_, degree_v_, points); !status.ok()) return status;
    return PatchPieces::single(degree_u_, degree_v_, points, weights());
  });
}

Box3 BezierPatch::hull_box() const {
  Box3 box;
  for (const Vec3& p : points()) box.extend(p);
  return box;
}

SideMask BezierPatch::collapsed_sides() const { return tessera::collapsed_sides(degree_u_, degree_v_, points()); }

}}  // namespace tessera::abi_0_1
