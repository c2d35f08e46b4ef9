#include "tessera/ray_scene.h"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

#include "base/text.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/guard.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t rays_per_task = 512;
constexpr double progress_ends[] = {0.2, 0.4};  // after the cuts, after the pieces; the tree is the rest

Status stale() {
  return Status(StatusCode::stale, "the patch set was edited after this ray scene was made: call refit");
}

Status short_output(std::size_t rays, std::size_t room) {
  return Status(StatusCode::buffer_too_small, counted(rays, "ray") + ", but room for " + counted(room, "result"));
}

/// Gathers the hits of tasks that end in any order. The first task that has not ended writes to the list itself, so a
/// single thread needs no memory beside the list.
class HitsInOrder {
 public:
  HitsInOrder(std::size_t tasks, std::vector<Hit>& list) : list_(list), found_(tasks), ended_(tasks) {}

  /// Returns where the hits of a task are appended.
  std::vector<Hit>& begin(std::size_t task) {
    const std::lock_guard lock(mutex_);
    return task == next_ ? list_ : found_[task];
  }
  /// Appends the hits of all tasks up to the first that has not ended.
  void end(std::size_t task) {
    const std::lock_guard lock(mutex_);
    ended_[task] = true;
    for (; next_ < ended_.size() && ended_[next_]; ++next_) {
      const std::vector<Hit> found = std::exchange(found_[next_], {});
      list_.insert(list_.end(), found.begin(), found.end());
    }
  }

 private:
  std::mutex mutex_;
  std::vector<Hit>& list_;
  std::vector<std::vector<Hit>> found_;  ///< of tasks that began before it was their turn
  std::vector<bool> ended_;
  std::size_t next_ = 0;  ///< the first task that has not ended
};

}  // namespace

Status RayScene::Impl::done(Status status) {
  ready_ = status.ok();
  if (ready_) revision_ = source_revision();
  return status;
}

Status RayScene::Impl::rebuild(const Execution& execution) {
  ready_ = false;  // whatever build() throws
  CallProgress progress(execution, progress_ends);
  return progress.finish(done(build(progress.loops())));
}

Status RayScene::Impl::refit(const Execution& execution) {
  CallProgress progress(execution, progress_ends);
  if (fresh()) return progress.finish({});
  if (!std::exchange(ready_, false)) return progress.finish(done(build(progress.loops())));
  return progress.finish(done(update(revision_, progress.loops())));
}

Result<Hit> RayScene::Impl::resolve(std::uint32_t, double, double) const {
  return Status(StatusCode::unsupported,
                "a scene of instances cannot resolve a point of a patch: call resolve() of the instance's own scene");
}

Result<Hit> RayScene::Impl::resolve(const Ray&, std::uint32_t, double, double) const {
  return Status(StatusCode::unsupported,
                "this scene is not one of patches in exact mode, which alone finds the root next to a point");
}

Status RayScene::Impl::check(const RayBatch& batch) const {
  if (!fresh()) return stale();
  if (batch.filter != nullptr && !can_filter())
    return Status(StatusCode::unsupported, "filters need a ray scene in exact mode");
  return {};
}

Status RayScene::Impl::closest(const RayBatch& batch, const HitWriter& hits, std::size_t count,
                               const Execution& execution) const {
  if (Status status = check(batch); !status.ok()) return status;
  Status status = parallel_for(count, rays_per_task, execution,
                               [&](std::size_t begin, std::size_t end) { closest_piece(batch, hits, begin, end); });
  return batch.stopped() ? batch.filter->status() : status;
}

Status RayScene::Impl::occluded(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t count,
                                const Execution& execution) const {
  if (Status status = check(batch); !status.ok()) return status;
  Status status = parallel_for(count, rays_per_task, execution, [&](std::size_t begin, std::size_t end) {
    occluded_piece(batch, occluded, begin, end);
  });
  return batch.stopped() ? batch.filter->status() : status;
}

Status RayScene::Impl::all(std::span<const Ray> rays, HitLists& lists, const Execution& execution) const {
  lists.hits.clear();
  lists.first.assign(rays.size() + 1, 0);
  if (!fresh()) return stale();
  prepare_borders();
  const std::size_t tasks = (rays.size() + rays_per_task - 1) / rays_per_task;
  HitsInOrder in_order(tasks, lists.hits);
  std::vector<Status> faults(tasks);
  Status status = parallel_for(tasks, 1, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t task = begin; task < end; ++task) {
      std::vector<Hit>& hits = in_order.begin(task);
      const std::size_t last = std::min(rays.size(), (task + 1) * rays_per_task);
      for (std::size_t k = task * rays_per_task; k < last && faults[task].ok(); ++k) {
        const std::size_t before = hits.size();
        faults[task] = all_of(rays[k], hits);
        lists.first[k + 1] = hits.size() - before;
      }
      in_order.end(task);
    }
  });
  if (!status.ok()) return status;
  for (const Status& fault : faults) {
    if (!fault.ok()) return fault;
  }
  std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
  return {};
}

RayScene::RayScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

Result<RayScene> RayScene::make(const PatchSet& set, const RaySceneOptions& options, const Execution& execution) {
  return guarded([&]() -> Result<RayScene> {
    if (options.mode != RayMode::grid && options.mode != RayMode::exact)
      return Status(StatusCode::invalid_argument, "no such ray mode");
    Result<std::unique_ptr<Impl>> impl =
        options.mode == RayMode::exact ? make_exact_scene(set, options) : make_grid_scene(set, options);
    if (!impl) return impl.status();
    if (Status status = (*impl)->rebuild(execution); !status.ok()) return status;
    return RayScene(*std::move(impl));
  });
}

Result<RayScene> RayScene::make(PatchSet&& set, const RaySceneOptions& options, const Execution& execution) {
  return guarded([&]() -> Result<RayScene> {
    Result<RayScene> made = make(std::as_const(set), options, execution);
    if (made) made->impl_->keep(std::move(set));
    return made;
  });
}

Result<RayScene> RayScene::make(const Model& model, const RaySceneOptions& options, const Execution& execution) {
  Result<PatchSet> set = make_patch_set(model);
  if (!set) return set.status();
  if (const std::span<const Status> faults = set->trim_faults(); !faults.empty()) return faults.front();
  return make(*std::move(set), options, execution);
}

Result<RayScene> RayScene::make(const PatchSet& set, const Mesh& mesh, const RaySceneOptions& options,
                                const Execution& execution) {
  return guarded([&]() -> Result<RayScene> {
    Result<std::unique_ptr<Impl>> impl = make_mesh_scene(set, mesh, options);
    if (!impl) return impl.status();
    if (Status status = (*impl)->rebuild(execution); !status.ok()) return status;
    return RayScene(*std::move(impl));
  });
}

Result<RayScene> RayScene::make(std::span<const RayInstance> instances, const Execution& execution) {
  return guarded([&]() -> Result<RayScene> {
    Result<std::unique_ptr<Impl>> impl = make_instance_scene(instances);
    if (!impl) return impl.status();
    if (Status status = (*impl)->rebuild(execution); !status.ok()) return status;
    return RayScene(*std::move(impl));
  });
}

Status RayScene::closest(std::span<const Ray> rays, std::span<Hit> hits, const Execution& execution) const {
  return guarded([&] {
    if (hits.size() < rays.size()) return short_output(rays.size(), hits.size());
    return impl_->closest({RaySpan(rays)}, HitSpan(hits), rays.size(), execution);
  });
}

Status RayScene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                          const Execution& execution) const {
  return guarded([&] {
    if (occluded.size() < rays.size()) return short_output(rays.size(), occluded.size());
    return impl_->occluded({RaySpan(rays)}, View1<std::uint8_t>::soa({occluded}), rays.size(), execution);
  });
}

Status RayScene::all(std::span<const Ray> rays, HitLists& lists, const Execution& execution) const {
  Status status = guarded([&] { return impl_->all(rays, lists, execution); });
  if (!status.ok()) {
    lists.hits.clear();
    lists.first.clear();
  }
  return status;
}

Hit RayScene::closest(const Ray& ray) const {
  Hit hit;
  if (!closest({&ray, 1}, {&hit, 1}).ok()) hit.kind = HitKind::invalid_ray;
  return hit;
}

HitKind RayScene::occluded(const Ray& ray) const {
  std::uint8_t result = 0;
  if (!is_valid(ray) || !occluded({&ray, 1}, {&result, 1}).ok()) return HitKind::invalid_ray;
  return result != 0 ? HitKind::hit : HitKind::miss;
}

Status RayScene::refit(const Execution& execution) {
  return guarded([&] { return impl_->refit(execution); });
}

Status RayScene::rebuild(const Execution& execution) {
  return guarded([&] { return impl_->rebuild(execution); });
}

double RayScene::spawn_offset() const { return impl_->fresh() ? impl_->spawn_offset() : 0; }

Result<LocalGeometry> RayScene::local_geometry(const Hit& hit) const {
  return guarded([&]() -> Result<LocalGeometry> {
    if (!impl_->fresh()) return stale();
    if (hit.kind != HitKind::hit)
      return Status(StatusCode::invalid_argument, "only a hit has a curvature: this is a miss or an invalid ray");
    return impl_->local_geometry(hit);
  });
}

Result<Hit> RayScene::resolve(std::uint32_t patch, double u, double v) const {
  return guarded([&]() -> Result<Hit> {
    if (!impl_->fresh()) return stale();
    return impl_->resolve(patch, u, v);
  });
}

Result<Hit> RayScene::resolve(const Ray& ray, std::uint32_t patch, double u, double v) const {
  return guarded([&]() -> Result<Hit> {
    if (!impl_->fresh()) return stale();
    return impl_->resolve(ray, patch, u, v);
  });
}

std::uint64_t RayScene::revision() const { return impl_->revision(); }
Result<std::vector<double>> RayScene::edge_gaps() const {
  return guarded([&]() -> Result<std::vector<double>> {
    if (!impl_->fresh()) return stale();
    return impl_->edge_gaps();
  });
}

Box3 RayScene::box() const { return impl_->box(); }
std::size_t RayScene::memory_bytes() const { return impl_->memory_bytes(); }

}}  // namespace tessera::abi_0_1
