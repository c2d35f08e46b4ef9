// The pieces of patches as primitives of a user geometry.

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "kernel/table/kernel_table.h"
#include "ray/embree/embree_device.h"
#include "ray/embree/embree_ray.h"
#include "ray/embree/embree_trees.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The data that a call of Embree carries to the callbacks. Embree's context comes first, so that a pointer to it is
/// one to this. Arrays are indexed by the ids of the packet's rays.
struct LeafCall {
  EmbreeContext context;
  SearchSpace* space;
  std::array<float, LeafTree::packet> enter;  ///< s where Embree's ray begins
  unsigned used;                              ///< bits of the lanes that have a ray
  QueryPacket packet;                         ///< a single ray is in the first lane
};

struct LeafState {
  EmbreeMonitor monitor;  // outlives the device, which calls it
  LeafTracer tracer;
  Owned<RTCDevice, DeviceRelease> device;
  Owned<RTCGeometry, GeometryRelease> geometry;
  Owned<RTCScene, SceneRelease> scene;

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const LeafState& state = *static_cast<const LeafState*>(arguments->geometryUserPtr);
    const LeafTracer& tracer = state.tracer;
    const unsigned k = arguments->primID;
    if (k >= tracer.first_tube) {
      *arguments->bounds_o = padded(tracer.tubes->box(k - tracer.first_tube));
    } else {
      *arguments->bounds_o = padded(tracer.use_of(k) == PatchUse::out ? Box3() : tracer.nets->boxes()[k]);
    }
  }

  /// Searches a leaf for the valid rays of a call, then calls `then(k, ray, query)` for each. On machines without wider
  /// vectors Embree 3 splits 16 rays into eights or fours; a part without a ray of ours has lanes that it calls valid.
  template <class IdOf, class Then>
  void search(unsigned leaf, LeafCall& call, unsigned count, const int* valid, const IdOf& id_of,
              const Then& then) const {
    unsigned lanes = 0, places = 0;
    for (unsigned k = 0; k < count; ++k) {
      const unsigned ray = id_of(k), is_ours = static_cast<unsigned>(valid[k]) & call.used >> ray & 1u;
      lanes |= is_ours << ray, places |= is_ours << k;
    }
    if (lanes == 0) return;
    if ((lanes & (lanes - 1)) == 0) {
      const auto ray = static_cast<std::size_t>(std::countr_zero(lanes));
      tracer.search(leaf, call.packet.probes[ray], *call.packet.queries[ray], *call.space);
    } else {
      tracer.search(leaf, call.packet, lanes, *call.space);
    }
    for (; places != 0; places &= places - 1) {
      const auto k = static_cast<unsigned>(std::countr_zero(places));
      const unsigned ray = id_of(k);
      then(k, ray, *call.packet.queries[ray]);
    }
  }

  /// Moves the end of Embree's ray to the closest root, rounded up by the padding of boxes. For one ray or a packet.
  static void intersect(const RTCIntersectFunctionNArguments* arguments) {
    const LeafState& state = *static_cast<const LeafState*>(arguments->geometryUserPtr);
    LeafCall& call = *reinterpret_cast<LeafCall*>(arguments->context);
    const unsigned count = arguments->N;
    RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, count);
    state.search(
        arguments->primID, call, count, arguments->valid, [&](unsigned k) { return RTCRayN_id(rays, count, k); },
        [&](unsigned k, unsigned ray, const RayQuery& query) {
          float& far = RTCRayN_tfar(rays, count, k);
          far = std::min(far, static_cast<float>(query.far) - call.enter[ray] + box_pad);
        });
  }

  static void occluded(const RTCOccludedFunctionNArguments* arguments) {
    const LeafState& state = *static_cast<const LeafState*>(arguments->geometryUserPtr);
    LeafCall& call = *reinterpret_cast<LeafCall*>(arguments->context);
    const unsigned count = arguments->N;
    state.search(
        arguments->primID, call, count, arguments->valid,
        [&](unsigned k) { return RTCRayN_id(arguments->ray, count, k); },
        [&](unsigned k, unsigned, const RayQuery& query) {
          if (query.done()) RTCRayN_tfar(arguments->ray, count, k) = -std::numeric_limits<float>::infinity();
        });
  }
};

/// Owns device, scene and geometry.
class EmbreeLeaves final : public LeafTree {
 public:
  Status start(Isa isa);
  Status build(const TracedLeaves& leaves, bool follows, const Execution& execution) override;
  Status refit(double tolerance, const Execution& execution) override;
  void trace(RayQuery& query, SearchSpace& space) const override;
  void trace(std::span<RayQuery* const> queries, SearchSpace& space) const override;
  const LeafTracer& tracer() const override { return state_.tracer; }
  /// Returns the bytes that Embree has allocated.
  std::size_t memory_bytes() const override { return state_.monitor.bytes(); }

 private:
  LeafState state_;
};

/// Makes the device; `isa` is for Embree as well.
Status EmbreeLeaves::start(Isa isa) {
  state_.tracer.kernels = &ray_kernels(isa);
  return make_device(state_.monitor, state_.device, isa);
}

Status EmbreeLeaves::build(const TracedLeaves& leaves, bool follows, const Execution& execution) {
  LeafState& state = state_;
  state.scene.reset();
  static_cast<TracedLeaves&>(state.tracer) = leaves;
  RTCDevice device = state.device.get();
  state.geometry.reset(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  Owned<RTCScene, SceneRelease> scene(rtcNewScene(device));
  RTCGeometry geometry = state.geometry.get();
  if (!geometry || !scene) return state.monitor.take();
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(leaves.primitives()));
  rtcSetGeometryUserData(geometry, &state);
  rtcSetGeometryBoundsFunction(geometry, &LeafState::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, &LeafState::intersect);
  rtcSetGeometryOccludedFunction(geometry, &LeafState::occluded);
  // Embree refits only in dynamic scenes of low quality, which hold one tree per geometry. If the geometry asks for
  // refitting from the start, its tree is built as well as any, and later refitted.
  if (follows) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene.get(), geometry);
  rtcSetSceneFlags(scene.get(), follows ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_ROBUST);
  if (Status status = commit(scene.get(), state.monitor, execution); !status.ok()) return status;
  state.scene = std::move(scene);
  return {};
}

Status EmbreeLeaves::refit(double tolerance, const Execution& execution) {
  LeafState& state = state_;
  state.tracer.tolerance = tolerance;
  rtcCommitGeometry(state.geometry.get());
  Status status = commit(state.scene.get(), state.monitor, execution);
  if (!status.ok()) state.scene.reset();
  return status;
}

void EmbreeLeaves::trace(RayQuery& query, SearchSpace& space) const {
  LeafCall call;
  call.context = embree_context();
  call.space = &space;
  RTCRayHit hit{};
  call.enter[0] = static_cast<float>(query.line.enter);
  call.used = 1;
  call.packet.queries[0] = &query;
  call.packet.probes[0] = probe_of(query);
  hit.ray = embree_ray(query.line);
  if (query.wanted == RootsWanted::any) {
    occluded(state_.scene.get(), call.context, Coherence::incoherent, hit.ray);
    return;
  }
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersect(state_.scene.get(), call.context, Coherence::incoherent, hit);
}

void EmbreeLeaves::trace(std::span<RayQuery* const> queries, SearchSpace& space) const {
  LeafCall call;
  call.context = embree_context();
  call.space = &space;
  RTCRayHit16 hit;
  alignas(64) int valid[packet];
  set_packet(
      queries.size(), [&](std::size_t k) -> const RayLine& { return queries[k]->line; }, hit, valid);
  call.used = (1u << queries.size()) - 1;
  for (unsigned k = 0; k < packet; ++k) {
    if (k < queries.size()) {
      call.enter[k] = static_cast<float>(queries[k]->line.enter);
      call.packet.set(k, *queries[k]);
    } else {
      call.packet.set_idle(k);
    }
  }
  if (queries[0]->wanted == RootsWanted::any) {
    occluded(state_.scene.get(), call.context, Coherence::coherent, valid, hit.ray);
  } else {
    intersect(state_.scene.get(), call.context, Coherence::coherent, valid, hit);
  }
}

}  // namespace

Result<std::unique_ptr<LeafTree>> make_embree_leaves(Isa isa) {
  auto tree = std::make_unique<EmbreeLeaves>();
  if (Status status = tree->start(isa); !status.ok()) return status;
  return std::unique_ptr<LeafTree>(std::move(tree));
}

}}  // namespace tessera::abi_0_1
