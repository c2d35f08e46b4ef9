#include "surface/net/checks.h"

#include <cmath>
#include <utility>

#include "base/text.h"
#include "surface/net/validate.h"

namespace tessera { inline namespace abi_0_1 {

Status check_interval(double from, double to, const std::string& name) {
  const std::string interval = name + ", [" + text(from) + ", " + text(to) + "], ";
  if (!std::isfinite(from) || !std::isfinite(to)) return {StatusCode::non_finite, interval + "must be finite"};
  if (!(from < to)) return {StatusCode::invalid_argument, interval + "must have its start below its end"};
  if (!std::isfinite(to - from) || !std::isfinite(1 / (to - from)))
    return {StatusCode::invalid_argument, interval + "is too long or too short"};
  return {};
}

Status check_vectors(std::span<const Vec3> vectors, std::size_t columns, const std::string& what) {
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    const Vec3& p = vectors[k];
    if (is_finite(p)) continue;
    return {StatusCode::non_finite,
            what + " " + place_in_rows(k, columns) + " is (" + text(p.x) + ", " + text(p.y) + ", " + text(p.z) +
                "), its coordinates must be finite",
            static_cast<std::ptrdiff_t>(k)};
  }
  return {};
}

Status check_increasing(std::span<const double> values, const std::string& what, const std::string& direction) {
  if (values.size() < 2)
    return {StatusCode::invalid_argument,
            "at least two " + what + "s are needed along " + direction + ", found " + std::to_string(values.size())};
  const auto bad = [&](StatusCode code, std::size_t k, const char* why) {
    return Status(code, what + " " + direction + "[" + std::to_string(k) + "] = " + text(values[k]) + why,
                  static_cast<std::ptrdiff_t>(k));
  };
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) return bad(StatusCode::non_finite, k, " is not finite");
    if (k > 0 && !(values[k] > values[k - 1]))
      return bad(StatusCode::invalid_argument, k, " is not above the one before it");
    if (k > 0 && !std::isfinite(values[k] - values[k - 1]))
      return bad(StatusCode::non_finite, k, " is too far from the one before it");
  }
  return {};
}

Status check_domain(const Domain& domain) {
  if (Status status = check_interval(domain.u0, domain.u1, "the domain along u"); !status.ok()) return status;
  return check_interval(domain.v0, domain.v1, "the domain along v");
}

std::string text_at(double u, double v) { return " at (u, v) = (" + text(u) + ", " + text(v) + ")"; }

Status check_finite(const Vec3& position, double u, double v) {
  return check_finite(SurfaceJet{position, {}, {}, {}, {}, {}}, u, v);
}

Status check_finite(const SurfaceJet& jet, double u, double v) {
  const std::pair<const Vec3*, const char*> vectors[] = {{&jet.position, "the surface"},
                                                         {&jet.du, "the surface's derivative by u"},
                                                         {&jet.dv, "the surface's derivative by v"},
                                                         {&jet.duu, "the surface's second derivative by u"},
                                                         {&jet.duv, "the surface's mixed derivative"},
                                                         {&jet.dvv, "the surface's second derivative by v"}};
  for (const auto& [p, what] : vectors)
    if (!is_finite(*p))
      return {StatusCode::non_finite, what + text_at(u, v) + " is (" + text(p->x) + ", " + text(p->y) + ", " +
                                          text(p->z) + "), it must be finite"};
  return {};
}

}}  // namespace tessera::abi_0_1
