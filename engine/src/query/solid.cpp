#include "tessera/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/function_ref.h"
#include "base/impl_access.h"
#include "base/infinity.h"
#include "base/shared_slot.h"
#include "base/text.h"
#include "block/patch_edges.h"
#include "parallel/parallel_for.h"
#include "query/facing.h"
#include "query/set_shells.h"
#include "query/winding.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/curve.h"
#include "tessera/guard.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t points_per_task = 256, open_points_per_task = 16, surfaces_per_task = 16;

Status check_room(std::size_t points, std::size_t room, const char* what) {
  if (room >= points) return {};
  return {StatusCode::buffer_too_small, counted(points, "point") + ", but room for " + counted(room, what)};
}

/// Runs tasks over points. Errors: cancelled, the first of a task's.
Status for_points(std::size_t count, std::size_t per_task, const Execution& execution,
                  FunctionRef<Status(std::size_t, std::size_t)> task) {
  std::vector<Status> faults((count + per_task - 1) / per_task);
  Status status = parallel_for(count, per_task, execution, [&](std::size_t begin, std::size_t end) {
    faults[begin / per_task] = task(begin, end);
  });
  if (!status.ok()) return status;
  const auto fault = std::ranges::find_if(faults, [](const Status& one) { return !one.ok(); });
  return fault != faults.end() ? *fault : Status();
}

}  // namespace

class Solid::Impl {
 public:
  explicit Impl(const RayScene& scene) : scene_(&impl_of(scene)), source_(scene_->exact_source()) {}

  Status make(const Execution& execution);
  std::size_t open_borders() const { return open_borders_; }
  Status check_fresh() const {
    if (source_->fresh() && scene_->revision() == revision_) return {};
    return {StatusCode::stale, "the patch set was edited after this solid was made: make it anew"};
  }
  /// Tells the sides of a task's points.
  Status contains(std::span<const Vec3> points, std::span<Containment> sides) const;
  /// Returns the winding numbers, which the first call makes. Errors: those of WindingNumbers::make().
  Result<std::shared_ptr<const WindingNumbers>> winding(const Execution& execution) const;

 private:
  const SetView& set() const { return *source_->tracer().set; }
  Facing facing_beside(const PatchEdges::Face& face, const TrimLoop& loop) const;
  void check_islands(const PatchEdges::Face& face);
  bool side_of(const Hit& hit, const Ray& ray, PointSide& side) const;
  Status settle(const Vec3& point, Containment& out) const;
  Status contains_by_number(std::span<const Vec3> points, std::span<Containment> sides) const;

  const RayScene::Impl* scene_;
  const ExactSource* source_;
  std::uint64_t revision_ = 0;
  std::size_t open_borders_ = 0;
  bool faces_tell_ = false;          ///< whether the first hit's face tells the side
  std::vector<std::int8_t> facing_;  ///< `[surface]`: Facing
  mutable SharedSlot<WindingNumbers> winding_;
};

/// Tells which way the normal points on the kept side of a loop.
Facing Solid::Impl::facing_beside(const PatchEdges::Face& face, const TrimLoop& loop) const {
  constexpr std::size_t max_curves = 8;
  const CutLines& lines = impl_of(face.region).lines;
  for (std::size_t k = 0; k < std::min(loop.curves.size(), max_curves); ++k) {
    const Curve& curve = loop.curves[k];
    const Interval range = curve.domain();
    const Vec3 middle = position(curve, 0.5 * (range.from + range.to));
    const Vec3 chord = position(curve, 0.55 * range.from + 0.45 * range.to) - middle;
    for (const double aside : {0.1, -0.1, 0.001, -0.001}) {
      const double u = middle.x - aside * chord.y, v = middle.y + aside * chord.x;
      if (!impl_of(face.region).domain.contains(u, v)) continue;
      const std::uint32_t patch =
          face.patches[interval_of(lines.u.lines, u) * (lines.v.lines.size() - 1) + interval_of(lines.v.lines, v)];
      if (patch == no_id) continue;
      const Domain& domain = set().source(patch).domain;
      const ParameterPoint at{domain.local_u(u), domain.local_v(v)};
      if (!source_->tracer().trims->keeps_point(patch, at.u, at.v)) continue;
      if (const Facing facing = HitParity(*scene_).facing_at(patch, at.u, at.v); facing != unsure) return facing;
    }
  }
  return unsure;
}

/// A face that loops cut into several parts may face outwards to another side in each. Each part has a loop, so that
/// the kept sides of all loops show them all.
void Solid::Impl::check_islands(const PatchEdges::Face& face) {
  const auto patch = std::ranges::find_if(face.patches, [](std::uint32_t k) { return k != no_id; });
  if (patch == face.patches.end() || face.loops->size() < 2 || source_->tracer().trims == nullptr) return;
  std::int8_t& facing = facing_[set().source(*patch).surface];
  for (const TrimLoop& loop : *face.loops)
    if (facing != unsure && facing_beside(face, loop) != facing) facing = unsure;
}

Status Solid::Impl::make(const Execution& execution) {
  if (source_ == nullptr || source_->tracer().patches != set().patch_count())
    return {StatusCode::unsupported, "a solid needs a ray scene of all patches of a set, in exact mode"};
  if (!source_->fresh())
    return {StatusCode::stale, "the patch set was edited after the ray scene was made: call refit"};
  revision_ = scene_->revision();
  scene_->prepare_borders();
  const SetShells shells = find_shells(set(), source_->tracer().borders->of(set()));
  open_borders_ = shells.open_borders;
  if (open_borders_ > 0) return winding(execution).status();
  std::vector<std::vector<std::uint32_t>> patches(set().impl().surface_count);
  for (std::uint32_t k = 0; k < set().patch_count(); ++k) patches[set().source(k).surface].push_back(k);
  facing_.assign(patches.size(), unsure);
  // Where shells touch, the first hit may be that of either, so that all hits have to be counted.
  faces_tell_ = shells.count == 1;
  if (!faces_tell_) return {};
  const auto face_all = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (!patches[k].empty()) facing_[k] = HitParity(*scene_).facing_of(patches[k]);
  };
  Status status = parallel_for(patches.size(), surfaces_per_task, execution, face_all);
  const PatchEdges* const edges = set().impl().edges.get();
  if (!status.ok() || edges == nullptr) return status;
  const Execution quiet{.cancel = execution.cancel};
  return parallel_for(edges->faces.size(), surfaces_per_task, quiet, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) check_islands(edges->faces[k]);
  });
}

/// Whether a ray's first hit tells the side of its origin.
bool Solid::Impl::side_of(const Hit& hit, const Ray& ray, PointSide& side) const {
  if (hit.kind == HitKind::miss && !hit.flags.incomplete) {
    side = PointSide::outside;
    return true;
  }
  if (hit.kind != HitKind::hit || !is_clear(hit.flags)) return false;
  const double sine = dot(hit.normal, ray.direction) * facing_[hit.surface];
  if (!(std::abs(sine) > least_sine)) return false;
  side = sine > 0 ? PointSide::inside : PointSide::outside;
  return true;
}

/// Tells the side of a point by all hits of rays in several directions: the first that is sure, else most of them.
Status Solid::Impl::settle(const Vec3& point, Containment& out) const {
  int inside = 0, outside = 0;
  for (const Vec3& direction : ray_directions) {
    bool is_odd = false, is_sure = false;
    const Ray ray{.origin = point, .direction = direction};
    if (Status status = HitParity(*scene_).count(ray, is_odd, is_sure); !status.ok()) return status;
    out = {is_odd ? PointSide::inside : PointSide::outside, is_sure};
    if (is_sure) return {};
    ++(is_odd ? inside : outside);
  }
  out.side = inside > outside ? PointSide::inside : PointSide::outside;
  return {};
}

Result<std::shared_ptr<const WindingNumbers>> Solid::Impl::winding(const Execution& execution) const {
  if (std::shared_ptr<const WindingNumbers> made = winding_.load()) return made;
  Result<WindingNumbers> made = WindingNumbers::make(*scene_, {.cancel = execution.cancel});
  if (!made) return made.status();
  auto shared = std::make_shared<const WindingNumbers>(*std::move(made));
  winding_.store(shared);
  return shared;
}

/// Tells the sides of an open surface, none of which is certified.
Status Solid::Impl::contains_by_number(std::span<const Vec3> points, std::span<Containment> sides) const {
  std::vector<double> numbers(points.size());
  const std::shared_ptr<const WindingNumbers> winding = winding_.load();
  if (Status status = winding->find(points, numbers); !status.ok()) return status;
  for (std::size_t k = 0; k < points.size(); ++k) {
    constexpr double error = 1e-6;
    const double above = std::abs(numbers[k]) - 0.5;
    sides[k] = {std::isnan(above)          ? PointSide::invalid_point
                : std::abs(above) <= error ? PointSide::unknown
                : above > 0                ? PointSide::inside
                                           : PointSide::outside,
                false};
  }
  return {};
}

Status Solid::Impl::contains(std::span<const Vec3> points, std::span<Containment> sides) const {
  if (open_borders_ > 0) return contains_by_number(points, sides);
  std::vector<Ray> rays(points.size());
  std::vector<Hit> hits(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) rays[k] = {.origin = points[k], .direction = ray_directions[0]};
  if (faces_tell_)
    if (Status status = scene_->closest({RaySpan(rays)}, HitSpan(hits), rays.size(), {}); !status.ok()) return status;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!is_valid(rays[k])) {
      sides[k] = {PointSide::invalid_point, false};
    } else if (PointSide side{}; faces_tell_ && side_of(hits[k], rays[k], side)) {
      sides[k] = {side, true};
    } else if (Status status = settle(points[k], sides[k]); !status.ok()) {
      return status;
    }
  }
  return {};
}

Solid::Solid(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Solid::Solid(Solid&&) noexcept = default;
Solid& Solid::operator=(Solid&&) noexcept = default;
Solid::~Solid() = default;

Result<Solid> Solid::make(const RayScene& scene, const Execution& execution) {
  return guarded([&]() -> Result<Solid> {
    auto impl = std::make_unique<Impl>(scene);
    if (Status status = impl->make(execution); !status.ok()) return status;
    return Solid(std::move(impl));
  });
}

bool Solid::is_closed() const { return impl_->open_borders() == 0; }
std::size_t Solid::open_borders() const { return impl_->open_borders(); }

Status Solid::contains(std::span<const Vec3> points, std::span<Containment> sides, const Execution& execution) const {
  return guarded([&]() -> Status {
    if (Status status = check_room(points.size(), sides.size(), "side"); !status.ok()) return status;
    if (Status status = impl_->check_fresh(); !status.ok()) return status;
    const std::size_t per_task = is_closed() ? points_per_task : open_points_per_task;
    return for_points(points.size(), per_task, execution, [&](std::size_t begin, std::size_t end) {
      return impl_->contains(points.subspan(begin, end - begin), sides.subspan(begin, end - begin));
    });
  });
}

Containment Solid::contains(const Vec3& point) const {
  Containment out;
  if (!contains({&point, 1}, {&out, 1}).ok()) out = {PointSide::invalid_point, false};
  return out;
}

Status Solid::winding_numbers(std::span<const Vec3> points, std::span<double> numbers,
                              const Execution& execution) const {
  return guarded([&]() -> Status {
    if (Status status = check_room(points.size(), numbers.size(), "number"); !status.ok()) return status;
    if (Status status = impl_->check_fresh(); !status.ok()) return status;
    const Result<std::shared_ptr<const WindingNumbers>> winding = impl_->winding(execution);
    if (!winding) return winding.status();
    return for_points(points.size(), open_points_per_task, execution, [&](std::size_t begin, std::size_t end) {
      return (*winding)->find(points.subspan(begin, end - begin), numbers.subspan(begin, end - begin));
    });
  });
}

Status signed_distances(const Solid& solid, const PointScene& scene, std::span<const Vec3> points,
                        std::span<SignedDistance> distances, const Execution& execution) {
  return guarded([&]() -> Status {
    if (Status status = check_room(points.size(), distances.size(), "distance"); !status.ok()) return status;
    std::vector<Containment> sides(points.size());
    if (Status status = solid.contains(points, sides, {.cancel = execution.cancel}); !status.ok()) return status;
    std::vector<NearestPoint> nearest(points.size());
    if (Status status = scene.nearest(points, nearest, infinity, execution); !status.ok()) return status;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto& [side, is_certified] = sides[k];
      const bool is_known = side == PointSide::inside || side == PointSide::outside;
      distances[k] = {.distance = std::numeric_limits<double>::quiet_NaN(), .side = side};
      if (!is_known) continue;
      distances[k].distance = side == PointSide::inside ? -nearest[k].distance : nearest[k].distance;
      distances[k].is_side_certified = is_certified;
      distances[k].is_nearest_certified = nearest[k].flags.certified;
    }
    return {};
  });
}

Status signed_distances(const Solid& solid, const PointScene& scene, std::span<const Vec3> points,
                        std::span<double> distances, const Execution& execution) {
  return guarded([&]() -> Status {
    if (Status status = check_room(points.size(), distances.size(), "distance"); !status.ok()) return status;
    std::vector<SignedDistance> found(points.size());
    if (Status status = signed_distances(solid, scene, points, found, execution); !status.ok()) return status;
    std::ranges::transform(found, distances.begin(), &SignedDistance::distance);
    return {};
  });
}

}}  // namespace tessera::abi_0_1
