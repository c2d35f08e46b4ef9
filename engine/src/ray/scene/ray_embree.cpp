#include "tessera/ray_embree.h"

#include <algorithm>
#include <limits>

#include "base/impl_access.h"
#include "base/text.h"
#include "ray/embree/embree_api.h"
#include "ray/embree/embree_device.h"
#include "ray/embree/embree_origin.h"
#include "ray/line/flush_denormals.h"
#include "ray/line/ray_segment.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double smallest_patch = 1e-15;

// Embree tests boxes of user geometries with a ray from `origin` in float, in robust scenes as in others. A side of a
// box is then off by at most 6 * 2^-24 (|side| + |origin|): the reciprocal of the direction rounds by 4 units of 2^-24,
// the products with side and origin by one each, the origin's with its full size. So the box is found for origins
// within 40,000 sizes of the scene, and farther away if it lies far from zero.
constexpr double pad_of_size = 1.0 / 64, pad_of_place = 2e-6;

const ExactSource& source_of(void* user_data) { return *static_cast<const ExactSource*>(user_data); }

/// Returns the box of the geometry's one primitive: the scene, whose own tree holds the pieces of patches.
void bounds(const RTCBoundsFunctionArguments* arguments) {
  const Box3 box = source_of(arguments->geometryUserPtr).reach();
  const double pad = pad_of_size * box.diagonal() + pad_of_place * std::max(max_abs(box.lower), max_abs(box.upper));
  const auto narrow = [](double x) { return static_cast<float>(std::clamp(x, -max_ray_component, max_ray_component)); };
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = narrow(box.lower.x - pad), out.upper_x = narrow(box.upper.x + pad);
  out.lower_y = narrow(box.lower.y - pad), out.upper_y = narrow(box.upper.y + pad);
  out.lower_z = narrow(box.lower.z - pad), out.upper_z = narrow(box.upper.z + pad);
}

Ray ray_of(RTCRayN* rays, unsigned count, unsigned k) {
  Ray ray;
  ray.origin = {RTCRayN_org_x(rays, count, k), RTCRayN_org_y(rays, count, k), RTCRayN_org_z(rays, count, k)};
  ray.direction = {RTCRayN_dir_x(rays, count, k), RTCRayN_dir_y(rays, count, k), RTCRayN_dir_z(rays, count, k)};
  ray.tnear = RTCRayN_tnear(rays, count, k), ray.tfar = RTCRayN_tfar(rays, count, k);
  return ray;
}

/// Finds the borders that rays from a surface need. If memory runs out, they are traced without.
void find_borders(const LeafTracer& tracer) noexcept {
  const CountDenormals count;  // Embree's callers flush them
  try {
    (void)tracer.borders->of(*tracer.set);
  } catch (...) {  // Embree cannot handle exceptions
  }
}

/// Accepts the roots behind those that filters of Embree have rejected.
class RootsBehind final : public RootFilter {
 public:
  void pass(const RayQuery& query) { last_ = query.best, t_ = query.best_t; }
  HitVerdict decide(const RayQuery& query, const LeafRoot& root) const noexcept override {
    const bool is_same = root.patch == last_.patch && root.is_on_edge == last_.is_on_edge && same_place(root, last_);
    const bool is_behind = !is_same && RayQuery::precedes(last_, t_, root, query.line.t_at(root.s));
    return is_behind ? HitVerdict::accept : HitVerdict::reject;
  }

 private:
  LeafRoot last_;
  double t_ = 0;
};

/// One call of Embree, with RTCIntersectFunctionNArguments or RTCOccludedFunctionNArguments. `has_origins`: its context
/// is an EmbreeOriginContext.
template <class Arguments>
class SceneCall {
 public:
  SceneCall(const Arguments* arguments, RTCRayN* rays, bool has_origins)
      : arguments_(arguments), rays_(rays), source_(source_of(arguments->geometryUserPtr)), has_origins_(has_origins) {}

  /// Finds the nearest root on one of the rays that no filter rejects, as a hit; the ray then ends there.
  bool meet(unsigned k, RTCHit& hit) const {
    Ray ray = ray_of(rays_, arguments_->N, k);
    LeftPoint left;
    const bool leaves = has_origins_ && leave_origin(k, ray, left);
    if (!is_valid(ray)) return false;
    const RayLine line = source_.line(ray);
    if (line.empty) return false;
    RootsBehind behind;
    for (const RootFilter* filter = nullptr;; filter = &behind) {
      RayQuery query(ray, line, RootsWanted::closest);
      query.filter = filter;
      if (leaves) query.left = &left;
      trace(query);
      if (!query.found || accept(k, query, hit)) return query.found;
      behind.pass(query);
    }
  }

 private:
  /// Makes the ray begin at its origin's point. Returns false if it has none here.
  bool leave_origin(unsigned k, Ray& ray, LeftPoint& left) const {
    const EmbreeContext& context = *arguments_->context;
    const EmbreeOrigin* const origin = origin_of(context, RTCRayN_id(rays_, arguments_->N, k));
    if (origin == nullptr || !names(*origin, arguments_->geomID, context)) return false;
    left = {origin->patch, origin->u, origin->v};
    const LeafTracer& tracer = source_.tracer();
    if (!tracer.has(left)) return false;
    if (tracer.borders->found() == nullptr) find_borders(tracer);
    ray.origin = tracer.at(left), ray.spawn_offset = source_.offset();
    return true;
  }

  void trace(RayQuery& query) const {
    const FlushDenormals flush;
    source_.trace(query);
  }

  /// Fills the hit and asks the filters.
  bool accept(unsigned k, const RayQuery& query, RTCHit& hit) const {
    const Hit found = source_.hit_at(query.line, query.best);
    const auto t = static_cast<float>(query.t_of(query.best));
    hit.Ng_x = static_cast<float>(found.normal.x), hit.Ng_y = static_cast<float>(found.normal.y);
    hit.Ng_z = static_cast<float>(found.normal.z);
    hit.u = static_cast<float>(found.patch_u), hit.v = static_cast<float>(found.patch_v);
    hit.primID = found.patch, hit.geomID = arguments_->geomID;
    set_instances(*arguments_->context, hit);
    RTCRay ray = rtcGetRayFromRayN(rays_, arguments_->N, k);
    ray.tfar = t;
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
    RTCRayN_tfar(rays_, arguments_->N, k) = t;
    return true;
  }

  const Arguments* arguments_;
  RTCRayN* rays_;
  const ExactSource& source_;
  bool has_origins_;
};

/// The functions of a geometry. `promised`: EmbreeGeometryOptions::origins.
template <bool promised>
void intersect_scene(const RTCIntersectFunctionNArguments* arguments) {
  if (!source_of(arguments->geometryUserPtr).fresh()) return;
  const SceneCall call(arguments, RTCRayHitN_RayN(arguments->rayhit, arguments->N),
                       has_origins(*arguments->context, promised));
  for (unsigned k = 0; k < arguments->N; ++k) {
    RTCHit hit;
    if (arguments->valid[k] != 0 && call.meet(k, hit))
      rtcCopyHitToHitN(RTCRayHitN_HitN(arguments->rayhit, arguments->N), &hit, arguments->N, k);
  }
}

template <bool promised>
void occlude_scene(const RTCOccludedFunctionNArguments* arguments) {
  if (!source_of(arguments->geometryUserPtr).fresh()) return;
  const SceneCall call(arguments, arguments->ray, has_origins(*arguments->context, promised));
  for (unsigned k = 0; k < arguments->N; ++k) {
    RTCHit hit;
    if (arguments->valid[k] != 0 && call.meet(k, hit))
      RTCRayN_tfar(arguments->ray, arguments->N, k) = -std::numeric_limits<float>::infinity();
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
  if (!(std::max(max_abs(box.lower), max_abs(box.upper)) <= max_ray_component && box.diagonal() >= smallest_patch))
    return Status(StatusCode::unsupported, "the model has the size " + text(box.diagonal()) + " and reaches " +
                                               text(std::max(max_abs(box.lower), max_abs(box.upper))) +
                                               " from zero; Embree needs a size of at " + "least " +
                                               text(smallest_patch) + " and at most " + text(max_ray_component) +
                                               " from zero: move or scale the model");
  return source;
}

void commit_geometry(RTCGeometry geometry) {
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcCommitGeometry(geometry);
}

}  // namespace

Result<RTCGeometry> make_embree_geometry(const RayScene& scene, RTCDevice device,
                                         const EmbreeGeometryOptions& options) {
  return guarded([&]() -> Result<RTCGeometry> {
    if (device == nullptr) return Status(StatusCode::invalid_argument, "no Embree device");
    const Result<const ExactSource*> source = usable_source(scene);
    if (!source) return source.status();
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    if (geometry == nullptr) return Status(StatusCode::internal, "Embree: no geometry could be made");
    rtcSetGeometryUserData(geometry, const_cast<ExactSource*>(*source));
    rtcSetGeometryBoundsFunction(geometry, &bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, options.origins ? &intersect_scene<true> : &intersect_scene<false>);
    rtcSetGeometryOccludedFunction(geometry, options.origins ? &occlude_scene<true> : &occlude_scene<false>);
#if RTC_VERSION_MAJOR >= 4
    rtcSetGeometryEnableFilterFunctionFromArguments(geometry, true);
#endif
    commit_geometry(geometry);
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
    commit_geometry(geometry);
    return {};
  });
}

Result<unsigned> attach(const RayScene& scene, RTCScene to, const EmbreeGeometryOptions& options) {
  return guarded([&]() -> Result<unsigned> {
    if (to == nullptr) return Status(StatusCode::invalid_argument, "no Embree scene");
    const Owned<RTCDevice, DeviceRelease> device(rtcGetSceneDevice(to));
    const Result<RTCGeometry> made = make_embree_geometry(scene, device.get(), options);
    if (!made) return made.status();
    const Owned<RTCGeometry, GeometryRelease> geometry(*made);
    return rtcAttachGeometry(to, geometry.get());
  });
}

}}  // namespace tessera::abi_0_1
