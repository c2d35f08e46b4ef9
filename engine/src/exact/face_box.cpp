#include "exact/face_box.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The nearest knot if it is within `tolerance` of `end`: otherwise a patch as narrow as that would lie between the
/// two.
double settled_on_knot(const FreeRange& range, double end, double tolerance) {
  double nearest = end, distance = tolerance;
  for (const double knot : range.knots) {
    const double turns = range.period > 0 ? std::round((end - knot) / range.period) : 0;
    const double there = knot + turns * range.period;
    if (std::abs(end - there) > distance) continue;
    nearest = there;
    distance = std::abs(end - there);
  }
  return nearest;
}

/// Whether all control points of the curve are on one side of the box.
bool is_on_a_side(const Curve& curve, const FaceBox& box) {
  const auto all = [&](auto&& fits) { return std::all_of(curve.points().begin(), curve.points().end(), fits); };
  const Domain& d = box.domain;
  return all([&](const Vec3& p) { return std::abs(p.x - d.u0) <= box.tolerance_u; }) ||
         all([&](const Vec3& p) { return std::abs(p.x - d.u1) <= box.tolerance_u; }) ||
         all([&](const Vec3& p) { return std::abs(p.y - d.v0) <= box.tolerance_v; }) ||
         all([&](const Vec3& p) { return std::abs(p.y - d.v1) <= box.tolerance_v; });
}

/// The area of the polygon through the curves' ends.
double enclosed_area(const std::vector<Curve>& curves) {
  double twice = 0;
  const Vec3 corner = curves.front().points().front();
  for (const Curve& curve : curves) twice += cross(curve.points().front() - corner, curve.points().back() - corner).z;
  return 0.5 * twice;
}

}  // namespace

double FreeRange::tolerance() const { return std::clamp(length_tolerance, 1e-9 * (to - from), 1e-4 * (to - from)); }

void FreeRange::settle() {
  const double tol = tolerance();
  for (double* const end : {&from, &to}) {
    *end = settled_on_knot(*this, *end, tol);
    if (std::abs(*end - first) <= tol) *end = first;
    if (std::abs(*end - last) <= tol) *end = last;
  }
  if (period > 0) {
    if (to - from > period - tol) to = from == first ? last : from + period;
  } else {
    from = std::max(from, first);
    to = std::min(to, last);
  }
}

bool is_whole_box(const std::vector<TrimLoop>& loops, const FaceBox& box) {
  if (loops.size() != 1 || loops[0].curves.empty()) return false;
  const std::vector<Curve>& curves = loops[0].curves;
  if (!std::all_of(curves.begin(), curves.end(), [&](const Curve& c) { return is_on_a_side(c, box); })) return false;
  const Domain& d = box.domain;
  const double width = d.u1 - d.u0, height = d.v1 - d.v0;
  const double slack = 2 * (box.tolerance_u * height + box.tolerance_v * width);
  return std::abs(std::abs(enclosed_area(curves)) - width * height) <= slack;
}

}}  // namespace tessera::abi_0_1
