#include <string>
#include <utility>

#include "base/text.h"
#include "query/point_scene_impl.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/surface_hit.h"
#include "tessera/guard.h"
#include "tessera/model.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Checks the arguments of a batch with `count` results for each point. Errors: those of PointScene::nearest_patches().
Status check_batch(std::size_t points, std::size_t count, std::size_t results, double max_distance) {
  constexpr std::size_t max_count = std::size_t{1} << 20;
  if (!(count >= 1 && count <= max_count))
    return {StatusCode::invalid_argument,
            "the patches for a point must be from 1 to 2^20, found " + std::to_string(count)};
  if (results / count < points)
    return {StatusCode::buffer_too_small,
            counted(points, "point") + (count == 1 ? "" : " with " + counted(count, "patch", "patches") + " each") +
                ", but room for " + counted(results, "result")};
  if (max_distance >= 0) return {};
  return {StatusCode::invalid_argument, "the largest distance must be at least 0, found " + text(max_distance)};
}

}  // namespace

Status PointScene::Impl::done(Status status) {
  ready_ = status.ok();
  if (ready_) revision_ = set_.revision();
  return status;
}

Status PointScene::Impl::check_fresh() const {
  if (fresh()) return {};
  return {StatusCode::stale, "the patch set was edited after this point scene was made: call refit"};
}

Status PointScene::Impl::build(const Execution& execution) {
  ready_ = false;
  const Box3 box = set_.box();
  size_ = box.diagonal();
  if (!(size_ >= smallest_exact && size_ <= largest_exact))
    return Status(StatusCode::unsupported,
                  "a point scene holds models of a size from 1e-140 to 1e140: scale the model");
  return done(pieces_.build(set_, SceneFrame::around(box), execution));
}

Status PointScene::Impl::refit(const Execution& execution) {
  if (fresh()) return {};
  const Box3 box = set_.box();
  if (!std::exchange(ready_, false) || !pieces_.frame().holds(box)) return build(execution);
  size_ = box.diagonal();
  const std::vector<std::uint32_t> edited = set_.edited_since(revision_);
  return done(pieces_.update(set_, edited, execution));
}

bool PointScene::Impl::is_valid(const Vec3& point) const {
  constexpr double max_coordinate = 1e140;  // in the scene's coordinates: squares are finite
  return is_finite(point) && max_abs(pieces_.frame().to_scene(point)) <= max_coordinate;
}

/// Completes a candidate.
NearestPoint PointScene::Impl::point_of(const NearCandidate& candidate, const NearestSearch::Outcome& found) const {
  const SceneFrame& frame = pieces_.frame();
  FirstOrder at = first_order(set_.patch(candidate.patch), frame.centre, pieces_.kernels(), candidate.u, candidate.v);
  at.position = frame.centre + at.position;
  Hit hit;
  set_surface_point(set_, size_, 1, candidate.patch, candidate.u, candidate.v, at, hit, {.derivatives = false});
  NearestPoint out;
  out.kind = NearestKind::found;
  out.surface = hit.surface, out.patch = hit.patch;
  out.u = hit.u, out.v = hit.v, out.patch_u = candidate.u, out.patch_v = candidate.v;
  out.position = hit.position, out.normal = hit.normal;
  out.distance = candidate.distance, out.rounding = found.slack;
  out.flags = {.certified = found.complete, .ambiguous = found.ambiguous, .border = candidate.on_border};
  out.flags.degenerate_normal = hit.flags.degenerate_normal;
  return out;
}

NearestPoint PointScene::Impl::nearest(const Vec3& point, double max_distance, NearestSearch& search,
                                       QueryTree::Path& path) const {
  NearestPoint out;
  if (!is_valid(point) || !(max_distance >= 0)) {
    out.kind = NearestKind::invalid_point;
    return out;
  }
  const NearestSearch::Outcome found = search.run(path, point, max_distance);
  if (found.best.patch != no_id) return point_of(found.best, found);
  out.flags.certified = found.complete;
  out.rounding = found.slack;
  return out;
}

void PointScene::Impl::nearest_patches(const Vec3& point, double max_distance, NearestSearch& search,
                                       QueryTree::Path& path, std::span<NearestPoint> nearest) const {
  NearestPoint none;
  if (!is_valid(point) || !(max_distance >= 0)) {
    none.kind = NearestKind::invalid_point;
    return std::ranges::fill(nearest, none), void();
  }
  const NearestSearch::Outcome found = search.run_patches(path, point, max_distance, nearest.size());
  none.flags.certified = found.complete, none.rounding = found.slack;
  for (std::size_t k = 0; k < nearest.size(); ++k)
    nearest[k] = k < search.places().size() ? point_of(search.places()[k], found) : none;
}

void PointScene::Impl::find_places(const Vec3& point, double distance, NearestSearch& search, QueryTree::Path& path,
                                   Places& places) const {
  if (!is_valid(point)) return;
  const NearestSearch::Outcome outcome = search.run_all(path, point, distance);
  for (const NearCandidate& one : search.places()) {
    const NearestPoint made = point_of(one, outcome);
    if (std::exchange(places.has_first, true))
      places.others.push_back(made);
    else
      places.first = made;
  }
}

PointScene::PointScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PointScene::PointScene(PointScene&&) noexcept = default;
PointScene& PointScene::operator=(PointScene&&) noexcept = default;
PointScene::~PointScene() = default;

Result<PointScene> PointScene::make(const PatchSet& set, const Execution& execution) {
  return guarded([&]() -> Result<PointScene> {
    auto impl = std::make_unique<Impl>(set);
    if (Status status = impl->build(execution); !status.ok()) return status;
    return PointScene(std::move(impl));
  });
}

Result<PointScene> PointScene::make(PatchSet&& set, const Execution& execution) {
  return guarded([&]() -> Result<PointScene> {
    Result<PointScene> made = make(std::as_const(set), execution);
    if (made) made->impl_->keep(std::move(set));
    return made;
  });
}

Result<PointScene> PointScene::make(const Model& model, const Execution& execution) {
  Result<PatchSet> set = make_patch_set(model);
  if (!set) return set.status();
  if (const std::span<const Status> faults = set->trim_faults(); !faults.empty()) return faults.front();
  return make(*std::move(set), execution);
}

Status PointScene::nearest(std::span<const Vec3> points, std::span<NearestPoint> nearest, double max_distance,
                           const Execution& execution) const {
  return guarded([&]() -> Status {
    if (Status status = check_batch(points.size(), 1, nearest.size(), max_distance); !status.ok()) return status;
    if (Status status = impl_->check_fresh(); !status.ok()) return status;
    const auto at = [&](std::size_t k) { return points[k]; };
    return impl_->for_points(points.size(), execution, at,
                             [&](std::size_t k, NearestSearch& search, QueryTree::Path& path) {
                               nearest[k] = impl_->nearest(points[k], max_distance, search, path);
                             });
  });
}

Status PointScene::nearest_patches(std::span<const Vec3> points, std::size_t count, std::span<NearestPoint> nearest,
                                   double max_distance, const Execution& execution) const {
  return guarded([&]() -> Status {
    if (Status status = check_batch(points.size(), count, nearest.size(), max_distance); !status.ok()) return status;
    if (Status status = impl_->check_fresh(); !status.ok()) return status;
    const auto at = [&](std::size_t k) { return points[k]; };
    return impl_->for_points(
        points.size(), execution, at, [&](std::size_t k, NearestSearch& search, QueryTree::Path& path) {
          impl_->nearest_patches(points[k], max_distance, search, path, nearest.subspan(k * count, count));
        });
  });
}

NearestPoint PointScene::nearest(const Vec3& point, double max_distance) const {
  NearestPoint out;
  if (!nearest({&point, 1}, {&out, 1}, max_distance).ok()) out.kind = NearestKind::invalid_point;
  return out;
}

Status PointScene::places(std::span<const Vec3> points, double distance, SurfacePlaces& places,
                          const Execution& execution) const {
  constexpr double max_share = 1e-3;
  places.places.clear(), places.first.clear();
  return guarded([&]() -> Status {
    if (Status status = impl_->check_fresh(); !status.ok()) return status;
    if (!(distance > 0 && distance <= max_share * impl_->size()))
      return {StatusCode::invalid_argument, "the distance of places must be above 0 and at most 1e-3 of the size, " +
                                                text(max_share * impl_->size()) + ", found " + text(distance)};
    std::vector<Impl::Places> found(points.size());
    const auto at = [&](std::size_t k) { return points[k]; };
    const Status status = impl_->for_points(points.size(), execution, at,
                                            [&](std::size_t k, NearestSearch& search, QueryTree::Path& path) {
                                              impl_->find_places(points[k], distance, search, path, found[k]);
                                            });
    if (!status.ok()) return status;
    places.first.push_back(0);
    for (const Impl::Places& one : found) {
      if (one.has_first) places.places.push_back(one.first);
      places.places.insert(places.places.end(), one.others.begin(), one.others.end());
      places.first.push_back(places.places.size());
    }
    return {};
  });
}

Status PointScene::refit(const Execution& execution) {
  return guarded([&] { return impl_->refit(execution); });
}

std::uint64_t PointScene::revision() const { return impl_->revision(); }
std::size_t PointScene::memory_bytes() const { return impl_->memory_bytes(); }

}}  // namespace tessera::abi_0_1
