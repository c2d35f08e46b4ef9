// Hits of the user's Embree scenes, completed in double.

#include <algorithm>
#include <iterator>
#include <string>

#include "base/impl_access.h"
#include "parallel/least_index.h"
#include "parallel/parallel_for.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/guard.h"
#include "tessera/ray_embree.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t hits_per_task = 256;

/// Returns the instance that holds the geometry: the last one of the stack.
std::uint32_t innermost_instance(const RTCHit& hit) {
  const auto begin = std::begin(hit.instID), end = std::end(hit.instID);
  const auto behind = std::find(begin, end, RTC_INVALID_GEOMETRY_ID);
  return behind == begin ? Hit::no_instance : *std::prev(behind);
}

Result<Hit> resolve_one(const RayScene::Impl& scene, unsigned geometry, const RTCRayHit& from) {
  if (from.hit.geomID == RTC_INVALID_GEOMETRY_ID || from.hit.geomID != geometry) return Hit{};
  Result<Hit> hit = scene.resolve(from.hit.primID, double{from.hit.u}, double{from.hit.v});
  if (!hit) return hit.status();
  hit->t = double{from.ray.tfar};
  hit->instance = innermost_instance(from.hit);
  return hit;
}

Status check(const RayScene::Impl& scene, std::size_t from, std::size_t hits) {
  if (hits < from)
    return Status(StatusCode::buffer_too_small, "there is room for " + std::to_string(hits) + " hits, not for " +
                                                    std::to_string(from) + " of Embree");
  if (!scene.fresh())
    return Status(StatusCode::stale, "the patch set was edited after this ray scene was made: call refit");
  return {};
}

}  // namespace

Status resolve(const RayScene& scene, unsigned geometry, std::span<const RTCRayHit> from, std::span<Hit> hits,
               const Execution& execution) {
  return guarded([&]() -> Status {
    const RayScene::Impl& impl = impl_of(scene);
    if (Status status = check(impl, from.size(), hits.size()); !status.ok()) return status;
    LeastIndex bad;
    Status status = parallel_for(from.size(), hits_per_task, execution, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const Result<Hit> hit = resolve_one(impl, geometry, from[k]);
        hits[k] = hit ? *hit : Hit{};
        if (!hit) bad.add(k);
      }
    });
    if (!status.ok() || !bad.found()) return status;
    const Status fault = resolve_one(impl, geometry, from[bad.index()]).status();
    return Status(fault.code(), fault.message(), static_cast<std::ptrdiff_t>(bad.index()));
  });
}

}}  // namespace tessera::abi_0_1
