#include <cmath>
#include <numbers>

#include "base/text.h"
#include "tessera/guard.h"
#include "tessera/parametric_surface.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

/// Returns cos and sin; a full turn gives the same as 0.
std::array<double, 2> direction(double theta) {
  if (theta == full_turn) theta = 0;
  return {std::cos(theta), std::sin(theta)};
}

}  // namespace

// The points stay within the disc. With e = 2^-53 the relative errors of a point's distance from the centre are:
// 1. cos and sin: 1.1 e.
// 2. Two products: e each.
// 3. Sum with the centre: e (|x0| + R), in both coordinates together 1.4 e of R.
// 4. The caller's x - x0: e again.
// 5. The squares, sums and differences of R R - dx dx - dy dy: 3 e of R R together, which counts half for the radius.
//
// The distance is therefore at most
//   R s (1 + e (1.1 + 2 + 1.4 + 1 + 1.5)) + e (|x0| + |y0|) = R s (1 + 7 e) + e (|x0| + |y0|).
Result<PolarMap> PolarMap::make(const Disc& disc) {
  return guarded([&]() -> Result<PolarMap> {
    const double size = std::abs(disc.x) + std::abs(disc.y) + disc.radius;
    if (!std::isfinite(size))
      return Status(StatusCode::non_finite, "the disc of radius " + text(disc.radius) + " about (" + text(disc.x) +
                                                ", " + text(disc.y) + ") must be finite");
    if (!(disc.radius > 0) || !std::isfinite(1 / disc.radius))
      return Status(StatusCode::invalid_argument,
                    "the disc's radius is " + text(disc.radius) + ", it must be positive");
    PolarMap map;
    map.disc_ = disc;
    map.scale_ = 1 - 0x1p-50 - 0x1p-52 * ((std::abs(disc.x) + std::abs(disc.y)) / disc.radius);
    if (!(map.scale_ > 0.5))
      return Status(StatusCode::invalid_argument,
                    "the disc's radius " + text(disc.radius) + " is below the rounding of its centre");
    return map;
  });
}

Domain PolarMap::domain() const { return {0, disc_.radius, 0, full_turn}; }

std::array<double, 2> PolarMap::operator()(double rho, double theta) const {
  const auto [c, s] = direction(theta);
  const double r = scale_ * rho;
  return {disc_.x + r * c, disc_.y + r * s};
}

SurfaceJet PolarMap::chain_rule(const SurfaceJet& p, double rho, double theta) const {
  const auto [cosine, sine] = direction(theta);
  const double c = scale_ * cosine, s = scale_ * sine;
  SurfaceJet jet;
  jet.position = p.position;
  jet.du = c * p.du + s * p.dv;
  jet.dv = rho * (c * p.dv - s * p.du);
  jet.duu = c * c * p.duu + 2 * c * s * p.duv + s * s * p.dvv;
  jet.duv = (c * p.dv - s * p.du) + rho * (c * s * (p.dvv - p.duu) + (c * c - s * s) * p.duv);
  jet.dvv = rho * rho * (s * s * p.duu - 2 * c * s * p.duv + c * c * p.dvv) - rho * jet.du;
  return jet;
}

}}  // namespace tessera::abi_0_1
