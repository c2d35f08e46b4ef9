#include "ray/embree_leaves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "kernel/kernel_table.h"
#include "ray/embree_device.h"
#include "ray/leaf_tracer.h"

namespace tessera {
namespace {

// Rays in float: start and direction round by 2^-24 of at most 3.5 and over at most 4, a component by 5e-7. Boxes are
// larger by four times that on each side; Embree's own arithmetic is conservative in robust scenes.
constexpr float box_pad = 2e-6f;

/// What a call of Embree's carries to the callbacks: first what Embree knows, so that one points to the other. Of a
/// packet's rays, by their ids.
struct Call {
  EmbreeContext context;
  SearchSpace* space;
  std::array<RayQuery*, EmbreeLeaves::packet> queries;  ///< null of idle lanes
  std::array<float, EmbreeLeaves::packet> enter;  ///< s where Embree's ray begins
  std::array<kernel::RayProbe, EmbreeLeaves::packet> probes;
};

/// Embree 3 takes 16 rays by eights or fours where the machine has no wider vectors, and a part without a ray of ours comes
/// to the callbacks with lanes that it calls valid.
bool is_idle(const Call& call, unsigned ray) { return call.queries[ray] == nullptr; }

void enter(Call& call, unsigned ray, RayQuery& query) {
  call.queries[ray] = &query;
  call.enter[ray] = static_cast<float>(query.line.enter);
  call.probes[ray] = probe_of(query);
}

/// Start, direction and reach, within the scene's box.
std::array<float, 7> embree_ray(const RayLine& line) {
  const Vec3 start = line.start + line.enter * line.direction, &d = line.direction;
  const auto narrow = [](double x) { return static_cast<float>(x); };
  return {narrow(start.x),
          narrow(start.y),
          narrow(start.z),
          narrow(d.x),
          narrow(d.y),
          narrow(d.z),
          narrow(line.leave - line.enter) + box_pad};
}

}  // namespace

struct EmbreeLeaves::State {
  EmbreeMonitor monitor;  // outlives the device, which calls it
  LeafTracer tracer;
  Owned<RTCDevice, DeviceRelease> device;
  Owned<RTCGeometry, GeometryRelease> geometry;
  Owned<RTCScene, SceneRelease> scene;

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const State& state = *static_cast<const State*>(arguments->geometryUserPtr);
    const Box3& box = state.tracer.nets->boxes()[arguments->primID];
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = static_cast<float>(box.lower.x) - box_pad, out.upper_x = static_cast<float>(box.upper.x) + box_pad;
    out.lower_y = static_cast<float>(box.lower.y) - box_pad, out.upper_y = static_cast<float>(box.upper.y) + box_pad;
    out.lower_z = static_cast<float>(box.lower.z) - box_pad, out.upper_z = static_cast<float>(box.upper.z) + box_pad;
  }

  const RayQuery& search(unsigned leaf, Call& call, unsigned ray) const {
    tracer.search(leaf, call.probes[ray], *call.queries[ray], *call.space);
    return *call.queries[ray];
  }

  /// The end of Embree's ray follows the closest root, rounded up by what boxes are padded with. One ray or a packet.
  static void intersect(const RTCIntersectFunctionNArguments* arguments) {
    const State& state = *static_cast<const State*>(arguments->geometryUserPtr);
    Call& call = *reinterpret_cast<Call*>(arguments->context);
    const unsigned count = arguments->N;
    RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, count);
    for (unsigned k = 0; k < count; ++k) {
      if (arguments->valid[k] == 0) continue;
      const unsigned ray = RTCRayN_id(rays, count, k);
      if (is_idle(call, ray)) continue;
      const RayQuery& query = state.search(arguments->primID, call, ray);
      float& far = RTCRayN_tfar(rays, count, k);
      far = std::min(far, static_cast<float>(query.far) - call.enter[ray] + box_pad);
    }
  }

  static void occluded(const RTCOccludedFunctionNArguments* arguments) {
    const State& state = *static_cast<const State*>(arguments->geometryUserPtr);
    Call& call = *reinterpret_cast<Call*>(arguments->context);
    const unsigned count = arguments->N;
    for (unsigned k = 0; k < count; ++k) {
      if (arguments->valid[k] == 0) continue;
      const unsigned ray = RTCRayN_id(arguments->ray, count, k);
      if (is_idle(call, ray)) continue;
      const RayQuery& query = state.search(arguments->primID, call, ray);
      if (query.done()) RTCRayN_tfar(arguments->ray, count, k) = -std::numeric_limits<float>::infinity();
    }
  }
};

EmbreeLeaves::EmbreeLeaves(std::unique_ptr<State> state) : state_(std::move(state)) {}
EmbreeLeaves::EmbreeLeaves(EmbreeLeaves&&) noexcept = default;
EmbreeLeaves& EmbreeLeaves::operator=(EmbreeLeaves&&) noexcept = default;
EmbreeLeaves::~EmbreeLeaves() = default;

Result<EmbreeLeaves> EmbreeLeaves::make(Isa isa) {
  auto state = std::make_unique<State>();
  Result<Owned<RTCDevice, DeviceRelease>> device = make_device(state->monitor, isa);
  if (!device) return device.status();
  state->device = *std::move(device);
  state->tracer.kernels = &ray_kernels(isa);
  return EmbreeLeaves(std::move(state));
}

Status EmbreeLeaves::build(const SetView& set, const LeafNets& nets, double tolerance, bool follows,
                           const Execution& execution) {
  State& state = *state_;
  state.scene.reset();
  state.tracer.set = &set, state.tracer.nets = &nets;
  state.tracer.tolerance = tolerance;
  RTCDevice device = state.device.get();
  state.geometry.reset(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  Owned<RTCScene, SceneRelease> scene(rtcNewScene(device));
  RTCGeometry geometry = state.geometry.get();
  if (!geometry || !scene) return state.monitor.take();
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(nets.leaves().size()));
  rtcSetGeometryUserData(geometry, &state);
  rtcSetGeometryBoundsFunction(geometry, &State::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, &State::intersect);
  rtcSetGeometryOccludedFunction(geometry, &State::occluded);
  // Embree refits in dynamic scenes of low quality alone, which hold a tree for each geometry: this one's is built as
  // well as any, and later refitted, where it says so from the start.
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
  State& state = *state_;
  state.tracer.tolerance = tolerance;
  rtcCommitGeometry(state.geometry.get());
  Status status = commit(state.scene.get(), state.monitor, execution);
  if (!status.ok()) state.scene.reset();
  return status;
}

void EmbreeLeaves::trace(RayQuery& query, SearchSpace& space) const {
  Call call;
  call.context = embree_context();
  call.space = &space;
  RTCRayHit hit{};
  enter(call, 0, query);
  const std::array<float, 7> ray = embree_ray(query.line);
  hit.ray.org_x = ray[0], hit.ray.org_y = ray[1], hit.ray.org_z = ray[2];
  hit.ray.dir_x = ray[3], hit.ray.dir_y = ray[4], hit.ray.dir_z = ray[5];
  hit.ray.tfar = ray[6];
  hit.ray.mask = ~0u;
  if (query.wanted == RootsWanted::any) {
    occluded(state_->scene.get(), call.context, Coherence::incoherent, hit.ray);
    return;
  }
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersect(state_->scene.get(), call.context, Coherence::incoherent, hit);
}

void EmbreeLeaves::trace(std::span<RayQuery* const> queries, SearchSpace& space) const {
  Call call;
  call.context = embree_context();
  call.space = &space;
  RTCRayHit16 hit;
  alignas(64) std::array<int, packet> valid{};
  for (unsigned k = 0; k < packet; ++k) {
    const std::size_t which = k < queries.size() ? k : 0;  // idle lanes repeat the first
    valid[k] = k < queries.size() ? -1 : 0;
    if (k < queries.size())
      enter(call, k, *queries[k]);
    else
      call.queries[k] = nullptr;
    const std::array<float, 7> ray = embree_ray(queries[which]->line);
    hit.ray.org_x[k] = ray[0], hit.ray.org_y[k] = ray[1], hit.ray.org_z[k] = ray[2];
    hit.ray.dir_x[k] = ray[3], hit.ray.dir_y[k] = ray[4], hit.ray.dir_z[k] = ray[5];
    hit.ray.tnear[k] = 0, hit.ray.tfar[k] = ray[6];
    hit.ray.time[k] = 0, hit.ray.mask[k] = ~0u, hit.ray.id[k] = k, hit.ray.flags[k] = 0;
    hit.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID, hit.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  if (queries[0]->wanted == RootsWanted::any) {
    occluded(state_->scene.get(), call.context, Coherence::coherent, valid.data(), hit.ray);
  } else {
    intersect(state_->scene.get(), call.context, Coherence::coherent, valid.data(), hit);
  }
}

const LeafTracer& EmbreeLeaves::tracer() const { return state_->tracer; }

std::size_t EmbreeLeaves::memory_bytes() const { return state_->monitor.bytes(); }

}  // namespace tessera
