#include "ray/embree_boxes.h"

#include <algorithm>
#include <utility>

#include "ray/embree_device.h"
#include "ray/embree_ray.h"

namespace tessera {
namespace {

/// What a call of Embree's carries to the callback: first what Embree knows, so that one points to the other.
struct Call {
  EmbreeContext context;
  EmbreeBoxes::Visit visit;
  float enter;  ///< s where Embree's ray begins
};

}  // namespace

struct EmbreeBoxes::State {
  EmbreeMonitor monitor;  // outlives the device, which calls it
  std::vector<Box3> boxes;
  Owned<RTCDevice, DeviceRelease> device;
  Owned<RTCScene, SceneRelease> scene;

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const State& state = *static_cast<const State*>(arguments->geometryUserPtr);
    *arguments->bounds_o = padded(state.boxes[arguments->primID]);
  }

  static void intersect(const RTCIntersectFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;  // rays come one by one
    Call& call = *reinterpret_cast<Call*>(arguments->context);
    float& far = RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, arguments->N), arguments->N, 0);
    far = std::min(far, static_cast<float>(call.visit(arguments->primID)) - call.enter + box_pad);
  }
};

EmbreeBoxes::EmbreeBoxes(std::unique_ptr<State> state) : state_(std::move(state)) {}
EmbreeBoxes::EmbreeBoxes(EmbreeBoxes&&) noexcept = default;
EmbreeBoxes& EmbreeBoxes::operator=(EmbreeBoxes&&) noexcept = default;
EmbreeBoxes::~EmbreeBoxes() = default;

Result<EmbreeBoxes> EmbreeBoxes::make() {
  auto state = std::make_unique<State>();
  Result<Owned<RTCDevice, DeviceRelease>> device = make_device(state->monitor);
  if (!device) return device.status();
  state->device = *std::move(device);
  return EmbreeBoxes(std::move(state));
}

Status EmbreeBoxes::build(std::vector<Box3> boxes, const Execution& execution) {
  State& state = *state_;
  state.scene.reset();
  state.boxes = std::move(boxes);
  const Owned<RTCGeometry, GeometryRelease> geometry(rtcNewGeometry(state.device.get(), RTC_GEOMETRY_TYPE_USER));
  Owned<RTCScene, SceneRelease> scene(rtcNewScene(state.device.get()));
  if (!geometry || !scene) return state.monitor.take();
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(state.boxes.size()));
  rtcSetGeometryUserData(geometry.get(), &state);
  rtcSetGeometryBoundsFunction(geometry.get(), &State::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), &State::intersect);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (Status status = commit(scene.get(), state.monitor, execution); !status.ok()) return status;
  state.scene = std::move(scene);
  return {};
}

void EmbreeBoxes::visit(const RayLine& line, Visit visit) const {
  Call call{embree_context(), visit, static_cast<float>(line.enter)};
  RTCRayHit ray{};
  ray.ray = embree_ray(line);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersect(state_->scene.get(), call.context, Coherence::incoherent, ray);
}

std::size_t EmbreeBoxes::memory_bytes() const {
  return state_->monitor.bytes() + state_->boxes.capacity() * sizeof(Box3);
}

}  // namespace tessera
