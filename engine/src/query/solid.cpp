#include "tessera/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/impl_access.h"
#include "base/infinity.h"
#include "base/text.h"
#include "block/patch_edges.h"
#include "parallel/parallel_for.h"
#include "query/set_shells.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/curve.h"
#include "tessera/guard.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Directions without any regularity, so that few rays run along edges or lie in planes of a model.
constexpr std::array<Vec3, 7> directions{{{0.36172, 0.51394, 0.77787},
                                          {-0.62719, 0.70301, 0.33513},
                                          {0.83192, -0.27103, 0.48417},
                                          {-0.29981, -0.81377, 0.49793},
                                          {0.54713, 0.62291, -0.55939},
                                          {-0.70199, 0.17993, -0.68907},
                                          {0.11939, -0.66109, -0.74073}}};
/// How far a direction is from a tangent plane at least for its side to count, as a sine.
constexpr double least_sine = 1e-6;
constexpr std::size_t points_per_task = 256, surfaces_per_task = 16;

bool is_clear(const HitFlags& flags) {
  return !flags.uncertified && !flags.incomplete && !flags.edge && !flags.degenerate_normal && !flags.unrefined;
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

 private:
  enum Facing : std::int8_t { outwards = 1, inwards = -1, unsure = 0 };

  const SetView& set() const { return *source_->tracer().set; }
  Facing facing_at(std::uint32_t patch, double u, double v) const;
  Facing facing_of(std::span<const std::uint32_t> patches) const;
  Facing facing_beside(const PatchEdges::Face& face, const TrimLoop& loop) const;
  void check_islands(const PatchEdges::Face& face);
  bool side_of(const Hit& hit, const Ray& ray, PointSide& side) const;
  Status count(const Ray& ray, bool& is_odd, bool& is_sure) const;
  Status settle(const Vec3& point, Containment& out) const;

  const RayScene::Impl* scene_;
  const ExactSource* source_;
  std::uint64_t revision_ = 0;
  std::size_t open_borders_ = 0;
  bool faces_tell_ = false;          ///< whether the first hit's face tells the side
  std::vector<std::int8_t> facing_;  ///< `[surface]`: Facing
};

/// Counts all hits of a ray.
Status Solid::Impl::count(const Ray& ray, bool& is_odd, bool& is_sure) const {
  HitLists lists;
  if (Status status = scene_->all({&ray, 1}, lists, {}); !status.ok()) return status;
  is_odd = lists.hits.size() % 2 != 0;
  is_sure = std::ranges::all_of(lists.hits, [](const Hit& hit) { return is_clear(hit.flags); });
  return {};
}

/// Tells which way the normal at a point of a patch points. The rays along it and against it, which leave out the point
/// itself, meet a closed surface an odd number of times together.
Solid::Impl::Facing Solid::Impl::facing_at(std::uint32_t patch, double u, double v) const {
  const Result<Hit> at = scene_->resolve(patch, u, v);
  if (!at || at->flags.degenerate_normal) return unsure;
  Ray along{.origin = at->position, .direction = at->normal};
  along.spawn_offset = 2 * scene_->spawn_offset();
  bool is_odd_along = false, is_odd_against = false, is_sure = false, is_sure_against = false;
  if (!count(along, is_odd_along, is_sure).ok()) return unsure;
  along.direction = -along.direction;
  if (!count(along, is_odd_against, is_sure_against).ok()) return unsure;
  if (!is_sure || !is_sure_against || is_odd_along == is_odd_against) return unsure;
  return is_odd_along ? inwards : outwards;
}

/// Tells which way the normals of a surface point, if three of its points agree.
Solid::Impl::Facing Solid::Impl::facing_of(std::span<const std::uint32_t> patches) const {
  constexpr std::array<ParameterPoint, 5> places{
      {{0.47, 0.53}, {0.21, 0.29}, {0.77, 0.23}, {0.31, 0.83}, {0.87, 0.67}}};
  constexpr std::size_t max_tries = 24;
  const LeafTrims* const trims = source_->tracer().trims;
  int votes = 0, count = 0;
  for (std::size_t k = 0; k < max_tries && count < 3; ++k) {
    const std::size_t round = k / places.size();
    const std::uint32_t patch = patches[(k * patches.size() / max_tries + round) % patches.size()];
    ParameterPoint at = places[k % places.size()];
    const double shift = 0.01 * static_cast<double>(k);
    at = {std::fmod(at.u + shift, 1.0), std::fmod(at.v + 0.7 * shift, 1.0)};
    if (trims != nullptr && !trims->keeps_point(patch, at.u, at.v)) continue;
    const Facing facing = facing_at(patch, at.u, at.v);
    votes += facing, count += facing != unsure;
  }
  return count > 0 && std::abs(votes) == count ? static_cast<Facing>(votes / count) : unsure;
}

/// Tells which way the normal points on the kept side of a loop.
Solid::Impl::Facing Solid::Impl::facing_beside(const PatchEdges::Face& face, const TrimLoop& loop) const {
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
      if (const Facing facing = facing_at(patch, at.u, at.v); facing != unsure) return facing;
    }
  }
  return unsure;
}

/// A face that loops cut into several parts may face outwards to another side in each. Each part has a loop, so that the
/// kept sides of all loops show them all.
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
  std::vector<std::vector<std::uint32_t>> patches(set().impl().surface_count);
  for (std::uint32_t k = 0; k < set().patch_count(); ++k) patches[set().source(k).surface].push_back(k);
  facing_.assign(patches.size(), unsure);
  // Where shells touch, the first hit may be that of either, so that all hits have to be counted.
  faces_tell_ = shells.open_borders == 0 && shells.count == 1;
  if (!faces_tell_) return {};
  const auto face_all = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (!patches[k].empty()) facing_[k] = facing_of(patches[k]);
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
  for (const Vec3& direction : directions) {
    bool is_odd = false, is_sure = false;
    if (Status status = count({.origin = point, .direction = direction}, is_odd, is_sure); !status.ok()) return status;
    if (is_sure && open_borders_ == 0) {
      out = {is_odd ? PointSide::inside : PointSide::outside, true};
      return {};
    }
    ++(is_odd ? inside : outside);
  }
  const bool is_split = open_borders_ > 0 && inside > 0 && outside > 0;
  out = {is_split ? PointSide::unknown : inside > outside ? PointSide::inside : PointSide::outside, false};
  return {};
}

Status Solid::Impl::contains(std::span<const Vec3> points, std::span<Containment> sides) const {
  std::vector<Ray> rays(points.size());
  std::vector<Hit> hits(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) rays[k] = {.origin = points[k], .direction = directions[0]};
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
    if (sides.size() < points.size())
      return {StatusCode::buffer_too_small,
              counted(points.size(), "point") + ", but room for " + counted(sides.size(), "side")};
    if (Status status = impl_->check_fresh(); !status.ok()) return status;
    std::vector<Status> faults((points.size() + points_per_task - 1) / points_per_task);
    Status status = parallel_for(points.size(), points_per_task, execution, [&](std::size_t begin, std::size_t end) {
      faults[begin / points_per_task] =
          impl_->contains(points.subspan(begin, end - begin), sides.subspan(begin, end - begin));
    });
    if (!status.ok()) return status;
    const auto fault = std::ranges::find_if(faults, [](const Status& one) { return !one.ok(); });
    return fault != faults.end() ? *fault : Status();
  });
}

Containment Solid::contains(const Vec3& point) const {
  Containment out;
  if (!contains({&point, 1}, {&out, 1}).ok()) out = {PointSide::invalid_point, false};
  return out;
}

Status signed_distances(const Solid& solid, const PointScene& scene, std::span<const Vec3> points,
                        std::span<double> distances, const Execution& execution) {
  return guarded([&]() -> Status {
    if (distances.size() < points.size())
      return {StatusCode::buffer_too_small,
              counted(points.size(), "point") + ", but room for " + counted(distances.size(), "distance")};
    std::vector<Containment> sides(points.size());
    if (Status status = solid.contains(points, sides, {.cancel = execution.cancel}); !status.ok()) return status;
    std::vector<NearestPoint> nearest(points.size());
    if (Status status = scene.nearest(points, nearest, infinity, execution); !status.ok()) return status;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const PointSide side = sides[k].side;
      const bool is_known = side == PointSide::inside || side == PointSide::outside;
      distances[k] = !is_known                   ? std::numeric_limits<double>::quiet_NaN()
                     : side == PointSide::inside ? -nearest[k].distance
                                                 : nearest[k].distance;
    }
    return {};
  });
}

}}  // namespace tessera::abi_0_1
