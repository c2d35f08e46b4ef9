#include "tessera/ray_embree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/impl_access.h"
#include "base/text.h"
#include "ray/embree/embree_api.h"
#include "ray/embree/embree_device.h"
#include "ray/line/ray_segment.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr double smallest_size = 1e-15;
constexpr float infinity = std::numeric_limits<float>::infinity();

const ExactSource& source_of(void* user_data) { return *static_cast<const ExactSource*>(user_data); }

/// Returns the box of a leaf or a tube in the model's coordinates, with all points that count as hit and every rounding.
void bounds(const RTCBoundsFunctionArguments* arguments) {
  const LeafTracer& tracer = source_of(arguments->geometryUserPtr).tracer();
  const unsigned k = arguments->primID;
  const bool is_tube = k >= tracer.first_tube;
  if (!is_tube && tracer.use_of(k) == PatchUse::out) {
    *arguments->bounds_o = {infinity, infinity, infinity, 0, -infinity, -infinity, -infinity, 0};
    return;
  }
  const SceneFrame& frame = tracer.nets->frame();
  Vec3 low{-1, -1, -1}, high{1, 1, 1};  // holds every leaf
  try {
    const Box3 box = is_tube ? tracer.tubes->box(k - tracer.first_tube) : tracer.nets->box(*tracer.set, k);
    low = box.lower, high = box.upper;
  } catch (...) {  // no memory; Embree cannot handle exceptions
  }
  const double pad = (is_tube ? 0 : tracer.tolerance_of(tracer.nets->leaves()[k])) + 1e-12;
  low = frame.to_model(low - Vec3{pad, pad, pad}), high = frame.to_model(high + Vec3{pad, pad, pad});
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::max(max_abs(low), max_abs(high));
  const auto below = [&](double x) { return std::nextafter(static_cast<float>(x - rounding), -infinity); };
  const auto above = [&](double x) { return std::nextafter(static_cast<float>(x + rounding), infinity); };
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = below(low.x), out.lower_y = below(low.y), out.lower_z = below(low.z);
  out.upper_x = above(high.x), out.upper_y = above(high.y), out.upper_z = above(high.z);
}

Ray ray_of(RTCRayN* rays, unsigned count, unsigned k) {
  Ray ray;
  ray.origin = {RTCRayN_org_x(rays, count, k), RTCRayN_org_y(rays, count, k), RTCRayN_org_z(rays, count, k)};
  ray.direction = {RTCRayN_dir_x(rays, count, k), RTCRayN_dir_y(rays, count, k), RTCRayN_dir_z(rays, count, k)};
  ray.tnear = RTCRayN_tnear(rays, count, k), ray.tfar = RTCRayN_tfar(rays, count, k);
  return ray;
}

/// One call of Embree for one leaf, with RTCIntersectFunctionNArguments or RTCOccludedFunctionNArguments.
template <class Arguments>
class LeafCall {
 public:
  LeafCall(const Arguments* arguments, RTCRayN* rays)
      : arguments_(arguments),
        rays_(rays),
        source_(source_of(arguments->geometryUserPtr)),
        space_(source_.tracer().nets->largest()) {}

  /// Returns whether there is anything to hit.
  static bool is_open(const Arguments* arguments) {
    const ExactSource& source = source_of(arguments->geometryUserPtr);
    return source.fresh() && arguments->primID < source.tracer().primitives();
  }

  /// Finds the leaf's nearest root on one of the rays that no filter rejects, as a hit; the ray then ends there.
  bool meet(unsigned k, RTCHit& hit) {
    const Ray ray = ray_of(rays_, arguments_->N, k);
    if (!is_valid(ray)) return false;
    const RayLine line = source_.line(ray);
    if (line.empty) return false;
    RayQuery query(ray, line, RootsWanted::closest);
    search(query);
    if (!query.found) return false;
    if (accept(k, line, query.best, hit)) return true;
    return meet_behind(k, ray, line, query.best, hit);
  }

 private:
  void search(RayQuery& query) {
    kernel::RayProbe probe = probe_of(query);
    source_.tracer().search(arguments_->primID, probe, query, space_);
  }

  /// Continues after a filter has rejected the first root.
  bool meet_behind(unsigned k, const Ray& ray, const RayLine& line, LeafRoot before, RTCHit& hit) {
    RayQuery query(ray, line, RootsWanted::all);
    search(query);
    before.certified = false;  // it comes from a query for the closest root, which does not set its side
    std::sort(query.roots.begin(), query.roots.end(), [](const LeafRoot& a, const LeafRoot& b) { return a.s < b.s; });
    for (const LeafRoot& root : query.roots) {
      if (same_place(root, before)) continue;
      if (accept(k, line, root, hit)) return true;
      before = root;
    }
    return false;
  }

  /// Fills the hit and asks the filters.
  bool accept(unsigned k, const RayLine& line, const LeafRoot& root, RTCHit& hit) {
    const Hit found = source_.hit_at(line, root);
    hit.Ng_x = static_cast<float>(found.normal.x), hit.Ng_y = static_cast<float>(found.normal.y);
    hit.Ng_z = static_cast<float>(found.normal.z);
    hit.u = static_cast<float>(found.patch_u), hit.v = static_cast<float>(found.patch_v);
    hit.primID = found.patch, hit.geomID = arguments_->geomID;
    set_instances(*arguments_->context, hit);
    RTCRay ray = rtcGetRayFromRayN(rays_, arguments_->N, k);
    ray.tfar = static_cast<float>(found.t);
    int valid = -1;
    RTCFilterFunctionNArguments filter;
    filter.valid = &valid;
    filter.geometryUserPtr = arguments_->geometryUserPtr;
    filter.context = arguments_->context;
    filter.ray = reinterpret_cast<RTCRayN*>(&ray);
    filter.hit = reinterpret_cast<RTCHitN*>(&hit);
    filter.N = 1;
    filter_hit(arguments_, &filter);
    if (valid == 0) return false;
    RTCRayN_tfar(rays_, arguments_->N, k) = static_cast<float>(found.t);
    return true;
  }

  const Arguments* arguments_;
  RTCRayN* rays_;
  const ExactSource& source_;
  SearchSpace space_;
};

void intersect_leaf(const RTCIntersectFunctionNArguments* arguments) {
  using Call = LeafCall<RTCIntersectFunctionNArguments>;
  if (!Call::is_open(arguments)) return;
  Call call(arguments, RTCRayHitN_RayN(arguments->rayhit, arguments->N));
  for (unsigned k = 0; k < arguments->N; ++k) {
    RTCHit hit;
    if (arguments->valid[k] != 0 && call.meet(k, hit))
      rtcCopyHitToHitN(RTCRayHitN_HitN(arguments->rayhit, arguments->N), &hit, arguments->N, k);
  }
}

void occlude_leaf(const RTCOccludedFunctionNArguments* arguments) {
  using Call = LeafCall<RTCOccludedFunctionNArguments>;
  if (!Call::is_open(arguments)) return;
  Call call(arguments, arguments->ray);
  for (unsigned k = 0; k < arguments->N; ++k) {
    RTCHit hit;
    if (arguments->valid[k] != 0 && call.meet(k, hit)) RTCRayN_tfar(arguments->ray, arguments->N, k) = -infinity;
  }
}

/// Returns the scene's source, if Embree can hold it.
Result<const ExactSource*> usable_source(const RayScene& scene) {
  const ExactSource* const source = impl_of(scene).exact_source();
  if (source == nullptr)
    return Status(StatusCode::unsupported,
                  "a ray scene in grid mode cannot be an Embree geometry: make it in exact mode");
  if (!source->fresh())
    return Status(StatusCode::stale, "the patch set was edited after this ray scene was made: call refit");
  const Box3 box = scene.box();
  if (!(std::max(max_abs(box.lower), max_abs(box.upper)) <= max_ray_component && box.diagonal() >= smallest_size))
    return Status(StatusCode::unsupported, "the model has the size " + text(box.diagonal()) + " and reaches " +
                                               text(std::max(max_abs(box.lower), max_abs(box.upper))) +
                                               " from zero; Embree needs a size of at " + "least " +
                                               text(smallest_size) + " and at most " + text(max_ray_component) +
                                               " from zero: move or scale the model");
  return source;
}

void commit_geometry(const ExactSource& source, RTCGeometry geometry) {
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(source.tracer().primitives()));
  rtcCommitGeometry(geometry);
}

}  // namespace

Result<RTCGeometry> make_embree_geometry(const RayScene& scene, RTCDevice device) {
  return guarded([&]() -> Result<RTCGeometry> {
    if (device == nullptr) return Status(StatusCode::invalid_argument, "no Embree device");
    const Result<const ExactSource*> source = usable_source(scene);
    if (!source) return source.status();
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    if (geometry == nullptr) return Status(StatusCode::internal, "Embree: no geometry could be made");
    rtcSetGeometryUserData(geometry, const_cast<ExactSource*>(*source));
    rtcSetGeometryBoundsFunction(geometry, &bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, &intersect_leaf);
    rtcSetGeometryOccludedFunction(geometry, &occlude_leaf);
#if RTC_VERSION_MAJOR >= 4
    rtcSetGeometryEnableFilterFunctionFromArguments(geometry, true);
#endif
    commit_geometry(**source, geometry);
    return geometry;
  });
}

Status update_embree_geometry(const RayScene& scene, RTCGeometry geometry) {
  return guarded([&]() -> Status {
    if (geometry == nullptr) return Status(StatusCode::invalid_argument, "no Embree geometry");
    const Result<const ExactSource*> source = usable_source(scene);
    if (!source) return source.status();
    if (rtcGetGeometryUserData(geometry) != *source)
      return Status(StatusCode::invalid_argument, "the Embree geometry was not made of this ray scene");
    commit_geometry(**source, geometry);
    return {};
  });
}

Result<unsigned> attach(const RayScene& scene, RTCScene to) {
  return guarded([&]() -> Result<unsigned> {
    if (to == nullptr) return Status(StatusCode::invalid_argument, "no Embree scene");
    const Owned<RTCDevice, DeviceRelease> device(rtcGetSceneDevice(to));
    const Result<RTCGeometry> made = make_embree_geometry(scene, device.get());
    if (!made) return made.status();
    const Owned<RTCGeometry, GeometryRelease> geometry(*made);
    return rtcAttachGeometry(to, geometry.get());
  });
}

}  // namespace tessera::inline abi_0_1
