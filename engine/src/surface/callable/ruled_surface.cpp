#include "tessera/coons_patch.h"

#include "surface/callable/border_curve.h"
#include "surface/net/checks.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A point's parameter along the curves, and the weights of the two curves.
struct RuledPoint {
  RuledPoint(const RuledSurface& surface, double u, double v) {
    const bool along_u = surface.straight() == Direction::v;
    const Domain d = surface.domain();
    const double across = along_u ? v : u, from = along_u ? d.v0 : d.u0, to = along_u ? d.v1 : d.u1;
    along = along_u ? u : v;
    length = to - from;
    first = (to - across) / length;
    second = (across - from) / length;
  }
  /// Interpolates, exactly at the ends.
  Vec3 between(const Vec3& a, const Vec3& b) const { return first * a + second * b; }

  double along, length, first, second;
};

}  // namespace

RuledSurface::RuledSurface(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

Result<RuledSurface> RuledSurface::make(const BorderCurve& first, const BorderCurve& second, const Interval& across,
                                        Direction straight) {
  return guarded([&]() -> Result<RuledSurface> {
    if (straight != Direction::u && straight != Direction::v)
      return Status(StatusCode::invalid_argument, "the direction of the straight lines must be u or v");
    if (Status status = check_same_interval(first, ruled_curve_names[0], second, ruled_curve_names[1]); !status.ok())
      return status;
    const RuledSurface surface({first, second, across, straight});
    if (Status status = check_domain(surface.domain()); !status.ok()) return status;
    return surface;
  });
}

Domain RuledSurface::domain() const {
  const Interval &along = tessera::domain(first()), &across = data_->across;
  if (straight() == Direction::v) return {along.from, along.to, across.from, across.to};
  return {across.from, across.to, along.from, along.to};
}

bool RuledSurface::is_exact() const { return tessera::is_exact(first()) && tessera::is_exact(second()); }

Result<SurfaceJet> evaluate_jet(const RuledSurface& surface, double u, double v) {
  return guarded([&]() -> Result<SurfaceJet> {
    const RuledPoint place(surface, u, v);
    const auto first = evaluate_jet(surface.first(), place.along, ruled_curve_names[0]);
    if (!first) return first.status();
    const auto second = evaluate_jet(surface.second(), place.along, ruled_curve_names[1]);
    if (!second) return second.status();
    SurfaceJet jet;
    jet.position = place.between(first->position, second->position);
    jet.du = place.between(first->first, second->first);
    jet.dv = (1 / place.length) * (second->position - first->position);
    jet.duu = place.between(first->second, second->second);
    jet.duv = (1 / place.length) * (second->first - first->first);
    if (surface.straight() == Direction::u) jet = {jet.position, jet.dv, jet.du, jet.dvv, jet.duv, jet.duu};
    if (Status status = check_finite(jet, u, v); !status.ok()) return status;
    return jet;
  });
}

Result<Vec3> position(const RuledSurface& surface, double u, double v) {
  return guarded([&]() -> Result<Vec3> {
    const RuledPoint place(surface, u, v);
    const auto first = position(surface.first(), place.along, ruled_curve_names[0]);
    if (!first) return first.status();
    const auto second = position(surface.second(), place.along, ruled_curve_names[1]);
    if (!second) return second.status();
    const Vec3 point = place.between(*first, *second);
    if (Status status = check_finite(point, u, v); !status.ok()) return status;
    return point;
  });
}

}}  // namespace tessera::abi_0_1
