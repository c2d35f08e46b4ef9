#include "query/winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "block/patch_trims.h"
#include "measure/gauss_rule.h"
#include "parallel/parallel_for.h"
#include "query/facing.h"
#include "ray/line/first_order.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Integrals over what is kept of a patch, about a point: of the normal, of the area, and of normal times position.
struct PatchFlux {
  Vec3 normal, moment;
  double area = 0, flux = 0;
  void add(const PatchFlux& other, double sign) {
    normal += sign * other.normal, moment += other.moment;
    area += other.area, flux += sign * other.flux;
  }
};

PatchFlux flux_of(const LeafTracer& tracer, std::uint32_t patch, const Vec3& about) {
  const PatchTrims* const trims = tracer.set->impl().trims.get();
  const bool is_cut = trims != nullptr && trims->is_cut[patch] != 0;
  const GaussRule& rule = gauss_rule(is_cut ? 6 : 2);
  PatchFlux sum;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rule.count); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(rule.count); ++j) {
      const double u = rule.nodes[i], v = rule.nodes[j], weight = rule.weights[i] * rule.weights[j];
      if (is_cut && tracer.trims != nullptr && !tracer.trims->keeps_point(patch, u, v)) continue;
      const FirstOrder at = first_order(tracer.set->patch(patch), u, v, about);
      const Vec3 normal = weight * cross(at.du, at.dv);
      sum.normal += normal, sum.flux += dot(at.position, normal);
      sum.area += length(normal), sum.moment += length(normal) * at.position;
    }
  return sum;
}

/// A part faces outwards if it faces away from the centroid of its area on the whole. A part that does neither, such as
/// a plane one, stays as it is.
bool faces_inwards(const LeafTracer& tracer, std::span<const std::uint32_t> patches,
                   std::span<const std::int8_t> signs) {
  const Vec3 about = tracer.set->patch(patches.front()).point(0, 0);
  PatchFlux sum;
  for (const std::uint32_t patch : patches) sum.add(flux_of(tracer, patch, about), signs[patch]);
  if (!(sum.area > 0)) return false;
  const Vec3 centre = (1 / sum.area) * sum.moment;
  constexpr double least_share = 1e-9;
  const double flux = sum.flux - dot(centre, sum.normal);
  return flux < -least_share * sum.area * std::sqrt(sum.area);
}

}  // namespace

Result<WindingNumbers> WindingNumbers::make(const RayScene::Impl& scene, const Execution& execution) {
  WindingNumbers made(scene);
  const SetView& set = *made.tracer().set;
  Result<SetOrientation> orientation = orient(set, made.tracer().borders->of(set), execution);
  if (!orientation) return orientation.status();
  made.orientation_ = *std::move(orientation);
  if (Status status = made.face_outwards(execution); !status.ok()) return status;
  return made;
}

/// Turns closed parts by the parity of the hits of all closed parts, so that the normals of cavities point into them.
Status WindingNumbers::face_outwards(const Execution& execution) {
  std::vector<std::int8_t>& signs = orientation_.signs;
  std::vector<std::uint8_t> is_open(signs.size(), 0), is_counted(signs.size(), 0);
  for (const BorderArc& arc : orientation_.arcs) is_open[orientation_.parts[arc.patch]] = 1;
  for (std::size_t k = 0; k < signs.size(); ++k) is_counted[k] = is_open[orientation_.parts[k]] == 0;
  std::vector<std::uint32_t> order(signs.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::ranges::stable_sort(order, {}, [&](std::uint32_t patch) { return orientation_.parts[patch]; });
  std::vector<std::size_t> first;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (orientation_.parts[order[k]] == order[k]) first.push_back(k);
  first.push_back(order.size());
  std::vector<std::uint8_t> is_turned(first.size() - 1, 0);
  const HitParity parity(*scene_, is_counted);
  const auto face = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto patches = std::span(order).subspan(first[k], first[k + 1] - first[k]);
      const Facing facing = is_counted[patches.front()] != 0 ? parity.facing_of(patches, signs) : unsure;
      is_turned[k] = facing == inwards || (facing == unsure && faces_inwards(tracer(), patches, signs));
    }
  };
  const Execution quiet{.cancel = execution.cancel};
  if (Status status = parallel_for(is_turned.size(), 4, quiet, face); !status.ok()) return status;
  std::vector<std::uint8_t> turned_parts(signs.size(), 0);
  for (std::size_t k = 0; k < is_turned.size(); ++k) turned_parts[order[first[k]]] = is_turned[k];
  const auto turn = [&](std::uint32_t patch, std::int8_t& sign) {
    if (turned_parts[orientation_.parts[patch]] != 0) sign = static_cast<std::int8_t>(-sign);
  };
  for (std::uint32_t patch = 0; patch < signs.size(); ++patch) turn(patch, signs[patch]);
  for (BorderArc& arc : orientation_.arcs) turn(arc.patch, arc.sign);
  return {};
}

AngleShare WindingNumbers::number_by(const Ray& ray, std::span<const Hit> hits) const {
  const Vec3 direction = normalized(ray.direction);
  AngleShare number;
  for (const Hit& hit : hits) {
    const double sine = dot(hit.normal, direction);
    number.value += orientation_.signs[hit.patch] * (sine > 0 ? 1 : sine < 0 ? -1 : 0);
    number.is_sure = number.is_sure && is_clear(hit.flags) && std::abs(sine) > least_sine;
  }
  constexpr double of_arcs = 4;  // hits and arcs are on one side of a border from this share of the arcs' error on
  const HalfLine line{ray.origin, direction, of_arcs * orientation_.near};
  for (const BorderArc& arc : orientation_.arcs) add_share(arc, line, number);
  return number;
}

Status WindingNumbers::number_along(const Vec3& point, const Vec3& direction, AngleShare& number) const {
  const Ray ray{.origin = point, .direction = direction};
  HitLists lists;
  if (Status status = scene_->all({&ray, 1}, lists, {}); !status.ok()) return status;
  number = number_by(ray, lists.hits);
  return {};
}

/// Finds a number by rays in several directions: the first that is sure, else the middle one of all.
Status WindingNumbers::settle(const Vec3& point, double& number) const {
  std::array<double, ray_directions.size()> found{};
  for (std::size_t k = 0; k < found.size(); ++k) {
    AngleShare one;
    if (Status status = number_along(point, ray_directions[k], one); !status.ok()) return status;
    found[k] = number = one.value;
    if (one.is_sure) return {};
  }
  std::ranges::nth_element(found, found.begin() + found.size() / 2);
  number = found[found.size() / 2];
  return {};
}

Status WindingNumbers::find(std::span<const Vec3> points, std::span<double> numbers) const {
  std::vector<Ray> rays(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) rays[k] = {.origin = points[k], .direction = ray_directions[0]};
  HitLists lists;
  if (Status status = scene_->all(rays, lists, {}); !status.ok()) return status;
  for (std::size_t k = 0; k < points.size(); ++k) {
    numbers[k] = std::numeric_limits<double>::quiet_NaN();
    if (!is_valid(rays[k])) continue;
    const auto hits = std::span(lists.hits).subspan(lists.first[k], lists.first[k + 1] - lists.first[k]);
    const AngleShare number = number_by(rays[k], hits);
    numbers[k] = number.value;
    if (number.is_sure) continue;
    if (Status status = settle(points[k], numbers[k]); !status.ok()) return status;
  }
  return {};
}

}}  // namespace tessera::abi_0_1
