// The boxes of instances as primitives of a user geometry.

#include <algorithm>
#include <utility>

#include "ray/embree/embree_device.h"
#include "ray/embree/embree_ray.h"
#include "ray/embree/embree_trees.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The data that a call of Embree carries to the callback. Embree's context comes first, so that a pointer to it is one
/// to this.
struct BoxCall {
  EmbreeContext context;
  InstanceTree::Visit visit;
  std::size_t count;                              ///< number of lines
  std::array<float, InstanceTree::packet> enter;  ///< s where Embree's rays begin, by their ids
};

struct InstanceState {
  EmbreeMonitor monitor;  // outlives the device, which calls it
  std::vector<Box3> boxes;
  Owned<RTCDevice, DeviceRelease> device;
  Owned<RTCScene, SceneRelease> scene;

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const InstanceState& state = *static_cast<const InstanceState*>(arguments->geometryUserPtr);
    *arguments->bounds_o = padded(state.boxes[arguments->primID]);
  }

  /// Embree 3 passes lanes that it calls valid but that have no ray of this call: see embree_leaves.cpp.
  static void intersect(const RTCIntersectFunctionNArguments* arguments) {
    BoxCall& call = *reinterpret_cast<BoxCall*>(arguments->context);
    const unsigned count = arguments->N;
    RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, count);
    unsigned lanes = 0;
    for (unsigned k = 0; k < count; ++k) {
      const unsigned ray = RTCRayN_id(rays, count, k);
      if (arguments->valid[k] != 0 && ray < call.count) lanes |= 1u << ray;
    }
    if (lanes == 0) return;
    std::array<double, InstanceTree::packet> ends;
    call.visit(arguments->primID, lanes, ends);
    for (unsigned k = 0; k < count; ++k) {
      const unsigned ray = RTCRayN_id(rays, count, k);
      if (ray >= call.count || (lanes >> ray & 1u) == 0) continue;
      float& far = RTCRayN_tfar(rays, count, k);
      far = std::min(far, static_cast<float>(ends[ray]) - call.enter[ray] + box_pad);
    }
  }
};

/// Owns device, scene and geometry.
class EmbreeInstances final : public InstanceTree {
 public:
  Status start();
  Status build(std::vector<Box3> boxes, const Execution& execution) override;
  void visit(std::span<const RayLine* const> lines, Visit visit) const override;
  /// Returns the bytes that Embree has allocated, and those of the boxes.
  std::size_t memory_bytes() const override { return state_.monitor.bytes() + state_.boxes.capacity() * sizeof(Box3); }

 private:
  InstanceState state_;
};

Status EmbreeInstances::start() { return make_device(state_.monitor, state_.device); }

Status EmbreeInstances::build(std::vector<Box3> boxes, const Execution& execution) {
  InstanceState& state = state_;
  state.scene.reset();
  state.boxes = std::move(boxes);
  const Owned<RTCGeometry, GeometryRelease> geometry(rtcNewGeometry(state.device.get(), RTC_GEOMETRY_TYPE_USER));
  Owned<RTCScene, SceneRelease> scene(rtcNewScene(state.device.get()));
  if (!geometry || !scene) return state.monitor.take();
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(state.boxes.size()));
  rtcSetGeometryUserData(geometry.get(), &state);
  rtcSetGeometryBoundsFunction(geometry.get(), &InstanceState::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), &InstanceState::intersect);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (Status status = commit(scene.get(), state.monitor, execution); !status.ok()) return status;
  state.scene = std::move(scene);
  return {};
}

void EmbreeInstances::visit(std::span<const RayLine* const> lines, Visit visit) const {
  BoxCall call{embree_context(), visit, lines.size(), {}};
  for (std::size_t k = 0; k < lines.size(); ++k) call.enter[k] = static_cast<float>(lines[k]->enter);
  if (lines.size() == 1) {
    RTCRayHit ray{};
    ray.ray = embree_ray(*lines[0]);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(state_.scene.get(), call.context, Coherence::incoherent, ray);
    return;
  }
  RTCRayHit16 rays;
  alignas(64) int valid[packet];
  set_packet(
      lines.size(), [&](std::size_t k) -> const RayLine& { return *lines[k]; }, rays, valid);
  intersect(state_.scene.get(), call.context, Coherence::coherent, valid, rays);
}

}  // namespace

Result<std::unique_ptr<InstanceTree>> make_embree_instances(const kernel::RayKernels&) {
  auto tree = std::make_unique<EmbreeInstances>();
  if (Status status = tree->start(); !status.ok()) return status;
  return std::unique_ptr<InstanceTree>(std::move(tree));
}

}}  // namespace tessera::abi_0_1
