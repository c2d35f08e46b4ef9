#include <string>
#include <utility>

#include "base/text.h"
#include "query/point_scene_impl.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/surface_hit.h"
#include "tessera/guard.h"
#include "tessera/model.h"

namespace tessera { inline namespace abi_0_1 {

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

NearestPoint PointScene::Impl::nearest(const Vec3& point, double max_distance, NearestSearch& search) const {
  NearestPoint out;
  constexpr double max_coordinate = 1e140;  // in the scene's coordinates: squares are finite
  if (!is_finite(point) || !(max_abs(pieces_.frame().to_scene(point)) <= max_coordinate) || !(max_distance >= 0)) {
    out.kind = NearestKind::invalid_point;
    return out;
  }
  const NearestSearch::Outcome found = search.run(point, max_distance);
  out.flags.certified = found.complete;
  out.rounding = found.slack;
  if (found.best.patch == no_id) return out;
  const NearCandidate& best = found.best;
  const SceneFrame& frame = pieces_.frame();
  FirstOrder at = first_order(set_.patch(best.patch), best.u, best.v, frame.centre);
  at.position = frame.centre + at.position;
  Hit hit;
  set_surface_point(set_, size_, 1, best.patch, best.u, best.v, at, hit, {.derivatives = false});
  out.kind = NearestKind::found;
  out.surface = hit.surface, out.patch = hit.patch;
  out.u = hit.u, out.v = hit.v, out.patch_u = best.u, out.patch_v = best.v;
  out.position = hit.position, out.normal = hit.normal;
  out.distance = best.distance;
  out.flags.ambiguous = found.ambiguous, out.flags.border = best.on_border;
  out.flags.degenerate_normal = hit.flags.degenerate_normal;
  return out;
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
    if (nearest.size() < points.size())
      return {StatusCode::buffer_too_small,
              counted(points.size(), "point") + ", but room for " + counted(nearest.size(), "result")};
    if (!(max_distance >= 0))
      return {StatusCode::invalid_argument, "the largest distance must be at least 0, found " + text(max_distance)};
    if (Status status = impl_->check_fresh(); !status.ok()) return status;
    const auto at = [&](std::size_t k) { return points[k]; };
    return impl_->for_points(points.size(), execution, at, [&](std::size_t k, NearestSearch& search) {
      nearest[k] = impl_->nearest(points[k], max_distance, search);
    });
  });
}

NearestPoint PointScene::nearest(const Vec3& point, double max_distance) const {
  NearestPoint out;
  if (!nearest({&point, 1}, {&out, 1}, max_distance).ok()) out.kind = NearestKind::invalid_point;
  return out;
}

Status PointScene::refit(const Execution& execution) {
  return guarded([&] { return impl_->refit(execution); });
}

std::uint64_t PointScene::revision() const { return impl_->revision(); }
std::size_t PointScene::memory_bytes() const { return impl_->memory_bytes(); }

}}  // namespace tessera::abi_0_1
