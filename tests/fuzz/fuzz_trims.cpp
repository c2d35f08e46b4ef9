// libFuzzer: trimming loops of .json models, good or bad, must become regions or errors, in time and memory that the
// length of the input bounds. Neither the order of the loops nor their direction may matter.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "tessera/io.h"
#include "tessera/trim_region.h"

namespace {

using namespace tessera;

void require(bool holds) {
  if (!holds) std::abort();
}

/// Whether there is a region; an error must have a message. Loops that repair leaves open are `internal`: those with
/// coordinates or weights so far apart that rounding moves an end across the domain.
bool sound(const Result<TrimRegion>& region) {
  if (region.ok()) return true;
  const Status& status = region.status();
  require(!status.message().empty() && status.code() != StatusCode::out_of_memory);
  return false;
}

void check_remarks(const TrimRegion& region, std::size_t loops) {
  for (const LoopRemark& remark : region.remarks())
    require(remark.loop < loops && !remark.text.empty() && std::isfinite(remark.size) && remark.size >= 0);
  require(region.band().u >= 0 && region.band().v >= 0);
}

Result<Curve> reversed(const Curve& curve) {
  std::vector<Vec3> points(curve.points().rbegin(), curve.points().rend());
  std::vector<double> weights(curve.weights().rbegin(), curve.weights().rend()), knots;
  for (std::size_t k = curve.knots().size(); k-- > 0;) knots.push_back(-curve.knots()[k]);
  const Interval domain{-curve.domain().to, -curve.domain().from};
  return curve.is_rational() ? Curve::nurbs(curve.degree(), points, weights, knots, domain)
                             : Curve::b_spline(curve.degree(), points, knots, domain);
}

/// The loops from the last to the first, each run the other way; none if a curve cannot be reversed.
std::vector<TrimLoop> turned(const std::vector<TrimLoop>& loops) {
  std::vector<TrimLoop> result(loops.rbegin(), loops.rend());
  for (TrimLoop& loop : result) {
    std::reverse(loop.curves.begin(), loop.curves.end());
    for (Curve& curve : loop.curves) {
      Result<Curve> other = reversed(curve);
      if (!other) return {};
      curve = *std::move(other);
    }
  }
  return result;
}

/// Compares the sides of points; those near a border may differ, because a reversed curve has other roundings.
void compare(const TrimRegion& a, const TrimRegion& b, const Domain& d) {
  const double du = 1e-9 * (d.u1 - d.u0), dv = 1e-9 * (d.v1 - d.v0);
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 8; ++k) {
      const double u = d.u_at((i + 0.37) / 8), v = d.v_at((k + 0.61) / 8);
      const TrimSide side = a.locate(u, v);
      bool near = false;
      for (const auto& [x, y] : {std::pair{u - du, v}, {u + du, v}, {u, v - dv}, {u, v + dv}})
        near = near || a.locate(x, y) != side || b.locate(x, y) != b.locate(u, v);
      if (!near && side != TrimSide::border && b.locate(u, v) != TrimSide::border) require(b.locate(u, v) == side);
    }
}

void use(const ModelSurface& surface) {
  const Result<Shared<std::vector<TrimLoop>>> trims = grid_trims(surface);
  if (!trims) return require(!trims.status().message().empty());
  const std::vector<TrimLoop>& loops = **trims;
  const Domain d = domain(surface.surface);
  const std::array breaks_u{d.u0, d.u_at(0.25), d.u1}, breaks_v{d.v0, d.v_at(0.5), d.v1};
  for (int periodic = 0; periodic < 4; ++periodic) {
    const TrimOptions options{.periodic_u = periodic % 2 == 1, .periodic_v = periodic / 2 == 1};
    const Result<TrimRegion> region = TrimRegion::make(loops, breaks_u, breaks_v, options);
    if (!sound(region)) continue;
    check_remarks(*region, loops.size());
    const Result<TrimRegion> other = TrimRegion::make(turned(loops), breaks_u, breaks_v, options);
    const bool is_repaired = !region->remarks().empty();  // the kept side of open loops depends on their direction
    if (sound(other) && !is_repaired && other->remarks().empty()) compare(*region, *other, d);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const Result<Model> model = parse_json_model({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!model) return 0;  // the target of the reader checks the errors
  for (const ModelSurface& surface : model->surfaces) use(surface);
  return 0;
}
