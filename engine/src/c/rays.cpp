// Rays of the C interface.

#include <limits>
#include <type_traits>
#include <vector>

#include "c/objects.h"
#include "c/records.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 { namespace {

static_assert(sizeof(HitKind) == 1 && static_cast<int>(HitKind::hit) == TSR_HIT &&
              static_cast<int>(HitKind::invalid_ray) == TSR_INVALID_RAY);
static_assert(sizeof(HitFlags) == 1 && std::has_unique_object_representations_v<HitFlags>);  // no other bits

template <class T>
CStatus rays_of(const tsr_rays& from, RayViews<T>& rays) {
  const std::size_t count = from.direction.count;
  if (!from.origin.data || !from.direction.data) return null_pointer(from.origin.data ? "direction" : "origin");
  if (CStatus status = view_of("direction", from.direction, rays.direction); status.code) return status;
  if (CStatus status = view_for_all("origin", from.origin, count, rays.origin); status.code) return status;
  if (CStatus status = view_for_all("tnear", from.tnear, count, rays.tnear); status.code) return status;
  if (CStatus status = view_for_all("tfar", from.tfar, count, rays.tfar); status.code) return status;
  return view_for_all("spawn_offset", from.spawn_offset, count, rays.spawn_offset);
}

template <class T>
CStatus hits_of(const tsr_hits_out& from, HitViews<T>& hits) {
  CStatus status;
  const auto put = [&](const char* name, const tsr_out& out, auto& view) {
    if (status.code == TSR_OK) status = view_of(name, out, view);
  };
  put("kind", from.kind, hits.kind), put("flags", from.flags, hits.flags);
  put("surface", from.surface, hits.surface), put("patch", from.patch, hits.patch);
  put("t", from.t, hits.t), put("residual", from.residual, hits.residual);
  put("uv", component_of(from.uv, sizeof(T), 0), hits.u), put("uv", component_of(from.uv, sizeof(T), 1), hits.v);
  put("patch_uv", component_of(from.patch_uv, sizeof(T), 0), hits.patch_u);
  put("patch_uv", component_of(from.patch_uv, sizeof(T), 1), hits.patch_v);
  put("position", from.position, hits.position), put("normal", from.normal, hits.normal);
  put("du", from.du, hits.du), put("dv", from.dv, hits.dv);
  return status;
}

template <class R, class H>
CStatus closest_of(const RayScene& scene, const tsr_rays& rays, const tsr_hits_out& hits, const Execution& execution) {
  RayViews<R> from;
  HitViews<H> to;
  if (CStatus status = rays_of(rays, from); status.code) return status;
  if (CStatus status = hits_of(hits, to); status.code) return status;
  return closest(scene, from, to, {}, execution);
}

template <class R>
CStatus occluded_of(const RayScene& scene, const tsr_rays& rays, const tsr_out& out, const Execution& execution) {
  RayViews<R> from;
  View1<std::uint8_t> to;
  if (CStatus status = rays_of(rays, from); status.code) return status;
  if (CStatus status = view_of("occluded", out, to); status.code) return status;
  return occluded(scene, from, to, {}, execution);
}

/// The rays of arrays, one by one.
template <class R>
CStatus ray_list(const tsr_rays& rays, std::vector<Ray>& list) {
  RayViews<R> from;
  if (CStatus status = rays_of(rays, from); status.code) return status;
  const std::size_t count = from.direction.size;
  const auto is_short = [&](const auto& view) { return !view.empty() && view.stride != 0 && view.size < count; };
  if (is_short(from.origin) || is_short(from.tnear) || is_short(from.tfar) || is_short(from.spawn_offset))
    return {TSR_COUNT_MISMATCH, "a view has fewer records than direction, which has " + std::to_string(count)};
  list.reserve(count);
  const auto point = [](const View3<const R>& view, std::size_t k) {
    return Vec3{double{view.at(k, 0)}, double{view.at(k, 1)}, double{view.at(k, 2)}};
  };
  const auto number = [](const View1<const R>& view, std::size_t k, double none) {
    return view.empty() ? none : double{view.at(k, 0)};
  };
  for (std::size_t k = 0; k < count; ++k)
    list.push_back({.origin = point(from.origin, k),
                    .direction = point(from.direction, k),
                    .tnear = number(from.tnear, k, 0),
                    .tfar = number(from.tfar, k, std::numeric_limits<double>::infinity()),
                    .spawn_offset = number(from.spawn_offset, k, 0)});
  return {};
}

/// Writes a list of hits, as closest() writes its own.
template <class T>
CStatus write_hits(const std::vector<Hit>& hits, const tsr_hits_out& out) {
  HitViews<T> to;
  if (CStatus status = hits_of(out, to); status.code) return status;
  CStatus status;
  const auto put = [&](const auto& view, auto value) {
    if (view.empty() || status.code) return;
    if (view.size < hits.size() || view.stride < 1) {
      status = {TSR_BUFFER_TOO_SMALL, "an output holds " + std::to_string(view.size) + " records, there are " +
                                          std::to_string(hits.size()) + " hits"};
      return;
    }
    for (std::size_t k = 0; k < hits.size(); ++k) value(view, k);
  };
  const auto scalar = [&](const auto& view, auto Hit::*member) {
    put(view, [&](const auto& of, std::size_t k) {
      of.at(k, 0) = static_cast<std::remove_reference_t<decltype(of.at(k, 0))>>(hits[k].*member);
    });
  };
  const auto vector = [&](const View3<T>& view, Vec3 Hit::*member) {
    put(view, [&](const auto& of, std::size_t k) {
      const Vec3& from = hits[k].*member;
      of.at(k, 0) = static_cast<T>(from.x), of.at(k, 1) = static_cast<T>(from.y), of.at(k, 2) = static_cast<T>(from.z);
    });
  };
  scalar(to.kind, &Hit::kind), scalar(to.flags, &Hit::flags);
  scalar(to.surface, &Hit::surface), scalar(to.patch, &Hit::patch);
  scalar(to.t, &Hit::t), scalar(to.residual, &Hit::residual);
  scalar(to.u, &Hit::u), scalar(to.v, &Hit::v), scalar(to.patch_u, &Hit::patch_u), scalar(to.patch_v, &Hit::patch_v);
  vector(to.position, &Hit::position), vector(to.normal, &Hit::normal);
  vector(to.du, &Hit::du), vector(to.dv, &Hit::dv);
  return status;
}

}}}  // namespace tessera::abi_0_1

extern "C" {

void tsr_scene_defaults(tsr_scene_options* options) {
  if (options) *options = {.struct_size = sizeof *options, .tolerance = 0, .pieces = 1, .is_editable = 0};
}

tsr_status tsr_scene_new(tsr_scene** scene, const tsr_set* set, const tsr_scene_options* options, const tsr_run* run) {
  if (scene) *scene = nullptr;
  return c_call([&]() -> CStatus {
    if (!scene) return null_pointer("scene");
    const Held<CSet> of(set);
    if (!of) return of.error();
    tsr_scene_options own;
    tsr_scene_defaults(&own);
    if (CStatus status = read_struct("tsr_scene_options", options, own); status.code) return status;
    RaySceneOptions wanted{.pieces = own.pieces, .editable = own.is_editable != 0};
    if (own.tolerance != 0) wanted.tolerance = own.tolerance;
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) -> CStatus {
      Result<RayScene> made = RayScene::make(of->set, wanted, execution);
      if (!made) return made.status();
      return give(scene, std::make_shared<CScene>(*std::move(made), of.shared()));
    });
  });
}

tsr_status tsr_scene_refit(tsr_scene* scene, const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const Held<CScene> of(scene);
    if (!of) return of.error();
    const Changing changing(of->usage);
    if (!changing) return in_use(Object::Kind::scene);
    const Reading reading(of->set->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) { return of->scene.refit(execution); });
  });
}

tsr_status tsr_scene_describe(const tsr_scene* scene, tsr_scene_info* info) {
  return c_call([&]() -> CStatus {
    const InUse<CScene> of(scene);
    if (CStatus status = of.check(); status.code) return status;
    const Box3 box = of->scene.box();
    return write_struct("tsr_scene_info", info,
                        {0,
                         of->scene.memory_bytes(),
                         {box.lower.x, box.lower.y, box.lower.z},
                         {box.upper.x, box.upper.y, box.upper.z},
                         of->scene.spawn_offset()});
  });
}

tsr_status tsr_scene_closest(const tsr_scene* scene, const tsr_rays* rays, const tsr_hits_out* hits,
                             const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const InUse<CScene> of(scene);
    if (CStatus status = of.check(); status.code) return status;
    if (!rays || !hits) return null_pointer(rays ? "hits" : "rays");
    tsr_rays from{};
    tsr_hits_out to{};
    if (CStatus status = read_struct("tsr_rays", rays, from); status.code) return status;
    if (CStatus status = read_struct("tsr_hits_out", hits, to); status.code) return status;
    return run_work(run, [&](const Execution& execution) {
      const auto call = from.is_double ? (to.is_double ? &closest_of<double, double> : &closest_of<double, float>)
                                       : (to.is_double ? &closest_of<float, double> : &closest_of<float, float>);
      return call(of->scene, from, to, execution);
    });
  });
}

tsr_status tsr_scene_occluded(const tsr_scene* scene, const tsr_rays* rays, const tsr_out* occluded,
                              const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const InUse<CScene> of(scene);
    if (CStatus status = of.check(); status.code) return status;
    if (!rays || !occluded) return null_pointer(rays ? "occluded" : "rays");
    tsr_rays from{};
    if (CStatus status = read_struct("tsr_rays", rays, from); status.code) return status;
    return run_work(run, [&](const Execution& execution) {
      const auto call = from.is_double ? &occluded_of<double> : &occluded_of<float>;
      return call(of->scene, from, *occluded, execution);
    });
  });
}

tsr_status tsr_scene_all(tsr_hits** hits, const tsr_scene* scene, const tsr_rays* rays, const tsr_run* run) {
  if (hits) *hits = nullptr;
  return c_call([&]() -> CStatus {
    const InUse<CScene> of(scene);
    if (CStatus status = of.check(); status.code) return status;
    if (!rays || !hits) return null_pointer(rays ? "hits" : "rays");
    tsr_rays from{};
    if (CStatus status = read_struct("tsr_rays", rays, from); status.code) return status;
    return run_work(run, [&](const Execution& execution) -> CStatus {
      std::vector<Ray> list;
      if (CStatus status = from.is_double ? ray_list<double>(from, list) : ray_list<float>(from, list); status.code)
        return status;
      auto found = std::make_shared<CHits>();
      if (Status status = of->scene.all(list, found->lists, execution); !status.ok()) return status;
      return give(hits, std::move(found));
    });
  });
}

tsr_status tsr_hits_read(const tsr_hits* hits, size_t* count, uint64_t* first, const tsr_hits_out* out) {
  return c_call([&]() -> CStatus {
    const Held<CHits> of(hits);
    if (!of) return of.error();
    if (count) *count = of->lists.hits.size();
    if (first) std::ranges::copy(of->lists.first, first);
    if (!out) return {};
    tsr_hits_out to{};
    if (CStatus status = read_struct("tsr_hits_out", out, to); status.code) return status;
    return to.is_double ? write_hits<double>(of->lists.hits, to) : write_hits<float>(of->lists.hits, to);
  });
}

}  // extern "C"
