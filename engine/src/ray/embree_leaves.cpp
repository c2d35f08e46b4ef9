#include "ray/embree_leaves.h"

#include <cmath>
#include <limits>
#include <utility>

#include "kernel/kernel_table.h"
#include "ray/embree_device.h"
#include "ray/polished_root.h"

namespace tessera {
namespace {

// Rays in float: start and direction round by 2^-24 of at most 3.5 and over at most 4, a component by 5e-7. Boxes are
// larger by four times that on each side; Embree's own arithmetic is conservative in robust scenes.
constexpr float box_pad = 2e-6f;
constexpr double probe_pad = 4e-6;  // of s in a kernel, by as much again

/// What a call of Embree's carries to the callbacks: first what Embree knows, so that one points to the other.
struct Call {
  RTCIntersectContext context;
  RayQuery* query;
  SearchSpace* space;
  float enter_in_float;  ///< s where Embree's ray begins
  kernel::RayProbe probe;
};

kernel::RayProbe probe_of(const RayQuery& query) {
  const auto narrow = [](double x) { return static_cast<float>(x); };
  const Vec3 &o = query.line.start, &d = query.line.direction;
  return {{narrow(o.x), narrow(o.y), narrow(o.z), 0},
          {narrow(d.x), narrow(d.y), narrow(d.z), 0},
          narrow(std::max(query.near, -8.0) - probe_pad),
          8,
          false};
}

}  // namespace

struct EmbreeLeaves::State {
  EmbreeMonitor monitor;  // outlives the device, which calls it
  const SetView* set = nullptr;
  const LeafNets* nets = nullptr;
  const kernel::RayKernels* kernels = nullptr;
  double tolerance = 0;
  Owned<RTCDevice, DeviceRelease> device;
  Owned<RTCScene, SceneRelease> scene;

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const State& state = *static_cast<const State*>(arguments->geometryUserPtr);
    const Box3& box = state.nets->boxes()[arguments->primID];
    RTCBounds& out = *arguments->bounds_o;
    out.lower_x = static_cast<float>(box.lower.x) - box_pad, out.upper_x = static_cast<float>(box.upper.x) + box_pad;
    out.lower_y = static_cast<float>(box.lower.y) - box_pad, out.upper_y = static_cast<float>(box.upper.y) + box_pad;
    out.lower_z = static_cast<float>(box.lower.z) - box_pad, out.upper_z = static_cast<float>(box.upper.z) + box_pad;
  }

  static const RayQuery& search(const void* user, unsigned leaf_index, RTCIntersectContext* context) {
    const State& state = *static_cast<const State*>(user);
    Call& call = *reinterpret_cast<Call*>(context);
    const Leaf& leaf = state.nets->leaves()[leaf_index];
    call.probe.far = static_cast<float>(std::min(call.query->far, 8.0) + probe_pad);
    if (!state.decide(leaf, leaf_index, call)) {
      state.nets->write_net(*state.set, leaf, call.space->leaf_net(), call.space->spare_net());
      search_leaf(leaf, call.space->leaf_net(), state.tolerance, *call.space, *call.query);
    }
    return *call.query;
  }

  /// In float, where that proves what there is; then in double what was found.
  bool decide(const Leaf& leaf, unsigned leaf_index, Call& call) const {
    const auto trace = leaf.rational ? kernels->trace_rational_leaf : kernels->trace_polynomial_leaf;
    const kernel::RayLeaf& local = nets->local(leaf_index);
    RayQuery& query = *call.query;
    kernel::RayRoots roots;
    call.probe.any = query.wanted == RootsWanted::any;
    if (!trace(local, call.probe, roots)) return false;
    if (roots.count == 0) return true;
    if (call.probe.any) {
      query.found = lies_between(roots.root[0], query.line);
      if (query.found) return true;
      call.probe.any = false;  // that one is next to an end: all must be looked at
      if (!trace(local, call.probe, roots)) return false;
    }
    LeafRoot polished[kernel::RayRoots::most];
    for (int k = 0; k < roots.count; ++k) {
      if (!polish(set->patch(leaf.patch), nets->frame(), leaf, *kernels, query.line, roots.root[k], polished[k]))
        return false;
    }
    for (int k = 0; k < roots.count; ++k) query.take(polished[k]);
    return true;
  }

  /// Whether tnear and tfar are no question.
  static bool lies_between(const kernel::RayRoot& root, const RayLine& line) {
    const double s = root.s, off = static_cast<double>(root.s_error) + line.slack;
    return s - off > line.near && s + off < line.far;
  }

  /// Rays come one by one. The end of Embree's ray follows the closest root, rounded up by what boxes are padded with.
  static void intersect(const RTCIntersectFunctionNArguments* arguments) {
    if (arguments->N != 1 || arguments->valid[0] == 0) return;
    const RayQuery& query = search(arguments->geometryUserPtr, arguments->primID, arguments->context);
    RTCRay& ray = *reinterpret_cast<RTCRay*>(RTCRayHitN_RayN(arguments->rayhit, 1));
    const Call& call = *reinterpret_cast<const Call*>(arguments->context);
    ray.tfar = std::min(ray.tfar, static_cast<float>(query.far) - call.enter_in_float + box_pad);
  }

  static void occluded(const RTCOccludedFunctionNArguments* arguments) {
    if (arguments->N != 1 || arguments->valid[0] == 0) return;
    const RayQuery& query = search(arguments->geometryUserPtr, arguments->primID, arguments->context);
    RTCRay& ray = *reinterpret_cast<RTCRay*>(arguments->ray);
    if (query.done()) ray.tfar = -std::numeric_limits<float>::infinity();
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
  state->kernels = &kernel::kernels(isa);
  return EmbreeLeaves(std::move(state));
}

Status EmbreeLeaves::build(const SetView& set, const LeafNets& nets, double tolerance, const Execution& execution) {
  State& state = *state_;
  state.scene.reset();
  state.set = &set;
  state.nets = &nets;
  state.tolerance = tolerance;
  RTCDevice device = state.device.get();
  const Owned<RTCGeometry, GeometryRelease> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  Owned<RTCScene, SceneRelease> scene(rtcNewScene(device));
  if (!geometry || !scene) return state.monitor.take();
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(nets.leaves().size()));
  rtcSetGeometryUserData(geometry.get(), &state);
  rtcSetGeometryBoundsFunction(geometry.get(), &State::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), &State::intersect);
  rtcSetGeometryOccludedFunction(geometry.get(), &State::occluded);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (Status status = commit(scene.get(), state.monitor, execution); !status.ok()) return status;
  state.scene = std::move(scene);
  return {};
}

void EmbreeLeaves::trace(RayQuery& query, SearchSpace& space) const {
  const RayLine& line = query.line;
  const Vec3 start = line.start + line.enter * line.direction;
  Call call{context_for(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT), &query, &space, static_cast<float>(line.enter),
            probe_of(query)};
  RTCRay ray{};
  ray.org_x = static_cast<float>(start.x), ray.org_y = static_cast<float>(start.y);
  ray.org_z = static_cast<float>(start.z);
  ray.dir_x = static_cast<float>(line.direction.x), ray.dir_y = static_cast<float>(line.direction.y);
  ray.dir_z = static_cast<float>(line.direction.z);
  ray.tfar = static_cast<float>(line.leave - line.enter) + box_pad;
  ray.mask = ~0u;
  if (query.wanted == RootsWanted::any) {
    rtcOccluded1(state_->scene.get(), &call.context, &ray);
    return;
  }
  RTCRayHit hit{};
  hit.ray = ray;
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene.get(), &call.context, &hit);
}

std::size_t EmbreeLeaves::memory_bytes() const { return state_->monitor.bytes(); }

}  // namespace tessera
