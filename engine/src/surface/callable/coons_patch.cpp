#include "tessera/coons_patch.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/safe_length.h"
#include "base/text.h"
#include "surface/callable/border_curve.h"
#include "surface/net/checks.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::array<const BorderCurve*, 4> all_of(const CoonsBorders& b) { return {&b.c1, &b.c2, &b.d1, &b.d2}; }

/// The ends of the four curves: [border][end].
using Ends = std::array<std::array<Vec3, 2>, 4>;

Result<Ends> ends_of(const CoonsBorders& borders) {
  Ends ends;
  for (std::size_t k = 0; k < 4; ++k) {
    const BorderCurve& border = *all_of(borders)[k];
    const Interval& interval = domain(border);
    for (std::size_t end = 0; end < 2; ++end) {
      const auto point = position(border, end == 0 ? interval.from : interval.to, coons_border_names[k]);
      if (!point) return point.status();
      ends[k][end] = *point;
    }
  }
  return ends;
}

/// Checks that C_b and D_a meet at the corner r(u_a, v_b).
Status check_closed(const Ends& ends, double share) {
  if (!(share >= 0 && std::isfinite(share)))
    return {StatusCode::invalid_argument,
            "the closing tolerance is " + text(share) + ", it must be finite and not negative"};
  Box3 box;
  for (const auto& border : ends)
    for (const Vec3& end : border) box.extend(end);
  const double diagonal = safe_length(box.upper - box.lower);
  if (!std::isfinite(diagonal)) return {StatusCode::non_finite, "the borders' ends are too far apart"};
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const Vec3 &c = ends[b][a], &d = ends[2 + a][b];
      const double gap = safe_length(c - d);
      if (gap <= share * diagonal) continue;
      const auto verb = [](std::size_t end) { return end == 0 ? " begins at " : " ends at "; };
      return {StatusCode::invalid_argument,
              "the borders do not close at the corner r(u" + std::to_string(a) + ", v" + std::to_string(b) +
                  "): " + coons_border_names[b] + verb(a) + text(c) + ", " + coons_border_names[2 + a] + verb(b) +
                  text(d) + ", a gap of " + text(gap) + "; the tolerance is " + text(share * diagonal),
              static_cast<std::ptrdiff_t>(2 * a + b)};
    }
  return {};
}

/// Turns derivatives by the local parameter into those by the surface's: the chain rule over an interval of this
/// length.
Blend::Jet over(Blend::Jet blend, double length) {
  for (std::size_t a = 0; a < 2; ++a) {
    blend[1][a] /= length;
    blend[2][a] = blend[2][a] / length / length;
  }
  return blend;
}

/// Position, first and second derivative.
using Jet = std::array<Vec3, 3>;

/// Returns D_a - r_a0 g1 - r_a1 g2, which f_a adds to the surface between C1 and C2.
Jet correction(const Jet& d, const Vec3& r_a0, const Vec3& r_a1, const Blend::Jet& g) {
  Jet result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = d[k] - (g[k][0] * r_a0 + g[k][1] * r_a1);
  return result;
}

}  // namespace

CoonsPatch::CoonsPatch(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

Result<CoonsPatch> CoonsPatch::make(const CoonsBorders& borders, const CoonsOptions& options) {
  return guarded([&]() -> Result<CoonsPatch> {
    for (std::size_t k : {std::size_t{0}, std::size_t{2}}) {
      const auto border = all_of(borders);
      if (Status status =
              check_same_interval(*border[k], coons_border_names[k], *border[k + 1], coons_border_names[k + 1]);
          !status.ok())
        return status;
    }
    const auto ends = ends_of(borders);
    if (!ends) return ends.status();
    if (Status status = check_closed(*ends, options.closing_tolerance); !status.ok()) return status;
    return CoonsPatch({borders, options.f, options.g, {(*ends)[0][0], (*ends)[1][0], (*ends)[0][1], (*ends)[1][1]}});
  });
}

Domain CoonsPatch::domain() const {
  const Interval &u = tessera::domain(borders().c1), &v = tessera::domain(borders().d1);
  return {u.from, u.to, v.from, v.to};
}

bool CoonsPatch::is_exact() const {
  const auto all = all_of(borders());
  return std::all_of(all.begin(), all.end(), [](const BorderCurve* b) { return tessera::is_exact(*b); }) &&
         f().is_polynomial() && g().is_polynomial();
}

Result<SurfaceJet> evaluate_jet(const CoonsPatch& patch, double u, double v) {
  return guarded([&]() -> Result<SurfaceJet> {
    const auto borders = all_of(patch.borders());
    std::array<Jet, 4> curves;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto jet = evaluate_jet(*borders[k], k < 2 ? u : v, coons_border_names[k]);
      if (!jet) return jet.status();
      curves[k] = {jet->position, jet->first, jet->second};
    }
    const Domain d = patch.domain();
    const auto f_local = patch.f().at(d.local_u(u)), g_local = patch.g().at(d.local_v(v));
    if (!f_local) return f_local.status();
    if (!g_local) return g_local.status();
    const Blend::Jet f = over(*f_local, d.u1 - d.u0), g = over(*g_local, d.v1 - d.v0);
    const Jet corrections[] = {correction(curves[2], patch.corner(0, 0), patch.corner(0, 1), g),
                               correction(curves[3], patch.corner(1, 0), patch.corner(1, 1), g)};
    const auto derivative = [&](std::size_t k, std::size_t l) {
      Vec3 sum;
      for (std::size_t a = 0; a < 2; ++a) sum += g[l][a] * curves[a][k] + f[k][a] * corrections[a][l];
      return sum;
    };
    const SurfaceJet jet{derivative(0, 0), derivative(1, 0), derivative(0, 1),
                         derivative(2, 0), derivative(1, 1), derivative(0, 2)};
    if (Status status = check_finite(jet, u, v); !status.ok()) return status;
    return jet;
  });
}

Result<Vec3> position(const CoonsPatch& patch, double u, double v) {
  return guarded([&]() -> Result<Vec3> {
    const auto borders = all_of(patch.borders());
    std::array<Vec3, 4> curves;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto point = position(*borders[k], k < 2 ? u : v, coons_border_names[k]);
      if (!point) return point.status();
      curves[k] = *point;
    }
    const Domain d = patch.domain();
    const auto f = patch.f().values_at(d.local_u(u)), g = patch.g().values_at(d.local_v(v));
    if (!f) return f.status();
    if (!g) return g.status();
    Vec3 sum;
    for (std::size_t a = 0; a < 2; ++a) {
      const int corner = static_cast<int>(a);
      const Vec3 chord = (*g)[0] * patch.corner(corner, 0) + (*g)[1] * patch.corner(corner, 1);
      sum += (*g)[a] * curves[a] + (*f)[a] * (curves[2 + a] - chord);
    }
    if (Status status = check_finite(sum, u, v); !status.ok()) return status;
    return sum;
  });
}

}}  // namespace tessera::abi_0_1
