#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/text.h"
#include "surface/quadric/quadric_profile.h"
#include "tessera/guard.h"
#include "tessera/quadric.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double angle_margin = 1e-15;
constexpr double border_margin = 1e-12;

Status bad_range(const char* direction, double from, double to, const std::string& wanted) {
  return {StatusCode::invalid_argument,
          std::string("the range of ") + direction + " from " + text(from) + " to " + text(to) + " " + wanted};
}

Status check_range(const char* direction, Profile profile, bool latitude, double from, double to) {
  if (!std::isfinite(from) || !std::isfinite(to))
    return {StatusCode::non_finite, std::string("the range of ") + direction + " is not finite"};
  if (!(from < to)) return bad_range(direction, from, to, "is empty or reversed");
  const double far = std::max(std::abs(from), std::abs(to));
  if (profile == Profile::hyperbola && far > 300) return bad_range(direction, from, to, "leaves [-300, 300]");
  if (profile != Profile::circle) return {};
  if (latitude && far > pi / 2 + angle_margin)
    return bad_range(direction, from, to, "leaves the latitudes [-pi/2, pi/2]");
  if (!latitude && to - from > 2 * pi + 4 * angle_margin)
    return bad_range(direction, from, to, "is more than a full turn");
  if (far > 100) return bad_range(direction, from, to, "leaves [-100, 100] radians");
  return {};
}

double sign_of(const QuadricPiece& piece) { return piece.sheet() == 0 ? 1 : -1; }

/// Returns t moved by whole turns to the turn that begins at `from`.
double turned(double t, double from, double margin) { return t + 2 * pi * std::ceil((from - margin - t) / (2 * pi)); }

/// Returns the parameters of a canonical point, up to full turns of u.
QuadricParameters raw_parameters(const Quadric& quadric, const Vec3& p, int sheet) {
  const double x = p.x / quadric.size().x, y = p.y / quadric.size().y, z = p.z / quadric.size().z;
  const double radius = std::hypot(x, y), angle = std::atan2(y, x);
  switch (quadric.kind()) {
    case QuadricKind::ellipsoid:
      return {angle, std::atan2(z, radius), 0};
    case QuadricKind::hyperboloid_one_sheet:
      return {angle, std::asinh(z), 0};
    case QuadricKind::hyperboloid_two_sheets:
      return {angle, std::asinh(radius), z < 0 ? 1 : 0};
    case QuadricKind::elliptic_cone:
      return {z < 0 ? std::atan2(-y, -x) : angle, z, 0};
    case QuadricKind::elliptic_paraboloid:
      return {angle, radius, 0};
    case QuadricKind::hyperbolic_paraboloid:
      return {x, y, 0};
    case QuadricKind::elliptic_cylinder:
      return {angle, z, 0};
    case QuadricKind::hyperbolic_cylinder:
      return {std::asinh(y), z, x < 0 ? 1 : 0};
    case QuadricKind::parabolic_cylinder:
      return {x, y, 0};
    case QuadricKind::intersecting_planes: {
      // Near the common line a point lies in both planes.
      const double a = quadric.size().x, b = quadric.size().y, margin = border_margin * std::hypot(p.x, p.y);
      const double off = std::abs(b * p.x - a * p.y) - std::abs(b * p.x + a * p.y);
      const int nearer = off > margin ? 1 : off < -margin ? 0 : sheet;
      return {a * p.x + (nearer == 0 ? b : -b) * p.y, z, nearer};
    }
    case QuadricKind::parallel_planes:
      return {p.y, p.z, x < 0 ? 1 : 0};
    default:
      return {p.y, p.z, 0};
  }
}

}  // namespace

QuadricPiece::QuadricPiece(const Data& data) : data_(std::make_shared<const Data>(data)) {}

Result<QuadricPiece> QuadricPiece::make(const Quadric& quadric, const Domain& range, int sheet) {
  return guarded([&]() -> Result<QuadricPiece> {
    const QuadricKind kind = quadric.kind();
    if (!is_surface(kind))
      return Status(StatusCode::unsupported, "a quadric of the kind '" + std::string(name(kind)) + "' has no surface");
    if (sheet < 0 || sheet >= sheet_count(kind))
      return Status(StatusCode::invalid_argument, "there is no sheet " + std::to_string(sheet) +
                                                      ": a quadric of the kind '" + std::string(name(kind)) + "' has " +
                                                      counted(static_cast<std::size_t>(sheet_count(kind)), "sheet") +
                                                      ", counted from 0");
    const Profiles profile = profiles(kind);
    if (Status status = check_range("u", profile.u, false, range.u0, range.u1); !status.ok()) return status;
    if (Status status = check_range("v", profile.v, true, range.v0, range.v1); !status.ok()) return status;
    const QuadricPiece piece({quadric, range, sheet});
    for (const double u : {range.u0, range.u1})
      for (const double v : {range.v0, range.v1})
        if (!is_finite(evaluate_jet(piece, u, v).position))
          return Status(StatusCode::non_finite, "a corner of the piece is out of the range of doubles");
    return piece;
  });
}

std::optional<QuadricParameters> QuadricPiece::locate(const Vec3& point) const {
  const Quadric& quadric = data_->quadric;
  const Domain& range = data_->range;
  const Profiles profile = profiles(quadric.kind());
  const Vec3 p = quadric.frame().local(point);
  QuadricParameters at = raw_parameters(quadric, p, sheet());
  const double margin_u = border_margin * (range.u1 - range.u0), margin_v = border_margin * (range.v1 - range.v0);
  const auto inside = [&](QuadricParameters& q) {
    if (q.sheet != sheet() || !(q.v >= range.v0 - margin_v && q.v <= range.v1 + margin_v)) return false;
    if (profile.u == Profile::circle) {
      const double radius = std::hypot(p.x / quadric.size().x, p.y / quadric.size().y);
      q.u = radius <= border_margin ? range.u0 : turned(q.u, range.u0, margin_u);  // a pole lies on every meridian
    }
    return q.u >= range.u0 - margin_u && q.u <= range.u1 + margin_u;
  };
  QuadricParameters opposite{at.u + pi, -at.v, at.sheet};
  const bool both =
      quadric.kind() == QuadricKind::hyperboloid_two_sheets || quadric.kind() == QuadricKind::elliptic_paraboloid;
  if (!inside(at)) {
    if (!both || !inside(opposite)) return std::nullopt;
    at = opposite;
  }
  return QuadricParameters{std::clamp(at.u, range.u0, range.u1), std::clamp(at.v, range.v0, range.v1), at.sheet};
}

SurfaceJet evaluate_jet(const QuadricPiece& piece, double u, double v) {
  const Quadric& quadric = piece.quadric();
  const Profiles profile = profiles(quadric.kind());
  std::array<ProfileValue, 3> a, b;
  for (int order = 0; order < 3; ++order) {
    a[static_cast<std::size_t>(order)] = profile_value(profile.u, u, order);
    b[static_cast<std::size_t>(order)] = profile_value(profile.v, v, order);
  }
  const auto vector = [&](std::size_t i, std::size_t j) {
    return quadric.frame().vector(canonical_point(quadric, sign_of(piece), a[i], b[j]));
  };
  return {quadric.frame().origin + vector(0, 0), vector(1, 0), vector(0, 1), vector(2, 0), vector(1, 1), vector(0, 2)};
}

QuadricParameters canonical_parameters(const QuadricPiece& piece, double u, double v) {
  const Profiles profile = profiles(piece.quadric().kind());
  const Domain& r = piece.range();
  return {canonical_parameter(profile.u, r.u0, r.u1, u), canonical_parameter(profile.v, r.v0, r.v1, v), piece.sheet()};
}

QuadricParameters grid_parameters(const QuadricPiece& piece, double u, double v) {
  const Profiles profile = profiles(piece.quadric().kind());
  const Domain& r = piece.range();
  return {grid_parameter(profile.u, r.u0, r.u1, u).value, grid_parameter(profile.v, r.v0, r.v1, v).value,
          piece.sheet()};
}

}}  // namespace tessera::abi_0_1
