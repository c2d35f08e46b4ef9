#include "tessera/ray_scene.h"

#include <algorithm>
#include <optional>
#include <string>

#include "base/impl_access.h"
#include "base/infinity.h"
#include "base/text.h"
#include "ray/scene/batch_checks.h"
#include "ray/scene/batch_filter.h"
#include "ray/scene/batch_layout.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

template <class T>
class RayArrays final : public RayReader {
 public:
  explicit RayArrays(const RayViews<T>& views) : views_(views) {}

  std::span<const Ray> read(std::size_t first, std::size_t count, std::span<Ray> room) const override {
    const std::span<Ray> rays = room.first(count);
    for (std::size_t k = 0; k < count; ++k) {
      const View3<const T>&o = views_.origin, &d = views_.direction;
      const std::size_t at = first + k;
      rays[k].origin = {o.at(at, 0), o.at(at, 1), o.at(at, 2)};
      rays[k].direction = {d.at(at, 0), d.at(at, 1), d.at(at, 2)};
    }
    const auto set = [&](double Ray::*number, const View1<const T>& from, double otherwise) {
      for (std::size_t k = 0; k < count; ++k) rays[k].*number = from.empty() ? otherwise : from.at(first + k, 0);
    };
    set(&Ray::tnear, views_.tnear, 0);
    set(&Ray::tfar, views_.tfar, infinity);
    set(&Ray::spawn_offset, views_.spawn_offset, 0);
    return rays;
  }
  std::uint32_t mask(std::size_t ray) const override { return views_.mask.empty() ? ~0u : views_.mask.at(ray, 0); }

 private:
  const RayViews<T>& views_;
};

/// Calls visit(name, view) for each output.
template <class T, class Visit>
void for_each_output(const HitViews<T>& views, const Visit& visit) {
  visit("kind", views.kind);
  visit("t", views.t);
  visit("u", views.u);
  visit("v", views.v);
  visit("patch_u", views.patch_u);
  visit("patch_v", views.patch_v);
  visit("patch", views.patch);
  visit("surface", views.surface);
  visit("instance", views.instance);
  visit("position", views.position);
  visit("normal", views.normal);
  visit("du", views.du);
  visit("dv", views.dv);
  visit("residual", views.residual);
  visit("flags", views.flags);
}

template <class T>
class HitArrays final : public HitWriter {
 public:
  explicit HitArrays(const HitViews<T>& views) : views_(views) {}

  HitParts parts() const override {
    return {.point = !views_.position.empty() || !views_.residual.empty(),
            .derivatives = !views_.du.empty() || !views_.dv.empty(),
            .normal = !views_.normal.empty() || !views_.flags.empty()};
  }
  std::span<Hit> place(std::size_t, std::size_t count, std::span<Hit> room) const override { return room.first(count); }
  void write(std::size_t first, std::span<const Hit> hits) const override {
    const auto each = [&](const auto& view, const auto& of) {
      if (view.empty()) return;
      for (std::size_t k = 0; k < hits.size(); ++k) view.at(first + k, 0) = of(hits[k]);
    };
    const auto number = [&](const View1<T>& view, double Hit::*member) {
      each(view, [&](const Hit& hit) { return static_cast<T>(hit.*member); });
    };
    const auto index = [&](const View1<std::uint32_t>& view, std::uint32_t Hit::*member) {
      each(view, [&](const Hit& hit) { return hit.kind == HitKind::hit ? hit.*member : HitViews<T>::no_hit; });
    };
    const auto vector = [&](const View3<T>& view, Vec3 Hit::*member) {
      if (view.empty()) return;
      for (std::size_t k = 0; k < hits.size(); ++k) {
        const Vec3& from = hits[k].*member;
        view.at(first + k, 0) = static_cast<T>(from.x), view.at(first + k, 1) = static_cast<T>(from.y);
        view.at(first + k, 2) = static_cast<T>(from.z);
      }
    };
    each(views_.kind, [](const Hit& hit) { return hit.kind; });
    each(views_.flags, [](const Hit& hit) { return hit.flags; });
    number(views_.t, &Hit::t);
    number(views_.u, &Hit::u), number(views_.v, &Hit::v);
    number(views_.patch_u, &Hit::patch_u), number(views_.patch_v, &Hit::patch_v);
    number(views_.residual, &Hit::residual);
    index(views_.patch, &Hit::patch), index(views_.surface, &Hit::surface), index(views_.instance, &Hit::instance);
    vector(views_.position, &Hit::position), vector(views_.normal, &Hit::normal);
    vector(views_.du, &Hit::du), vector(views_.dv, &Hit::dv);
  }

 private:
  const HitViews<T>& views_;
};

template <class T>
void add_rays(const RayViews<T>& rays, BatchChecks& checks) {
  checks.input("origin", rays.origin), checks.input("direction", rays.direction);
  if (!rays.tnear.empty()) checks.input("tnear", rays.tnear);
  if (!rays.tfar.empty()) checks.input("tfar", rays.tfar);
  if (!rays.spawn_offset.empty()) checks.input("spawn_offset", rays.spawn_offset);
  if (!rays.mask.empty()) checks.input("mask", rays.mask);
}

/// Runs call(batch, rays) for rays whose views are valid.
template <class T, class Call>
Status run(const RayViews<T>& rays, const BatchOptions& options, const BatchChecks& checks, const Call& call) {
  if (Status status = checks.status(); !status.ok()) return status;
  std::optional<BatchFilter> filter;
  if (options.filter) filter.emplace(options.filter);
  const RayArrays<T> reader(rays);
  return call({reader, filter ? &*filter : nullptr}, rays.direction.size);
}

template <class T, class U>
Status closest_of(const RayScene& scene, const RayViews<T>& rays, const HitViews<U>& hits, const BatchOptions& options,
                  const Execution& execution) {
  return guarded([&] {
    BatchChecks checks(rays.direction.size);
    add_rays(rays, checks);
    for_each_output(hits, [&](const char* name, const auto& view) { checks.output(name, view); });
    return run(rays, options, checks, [&](const RayBatch& batch, std::size_t count) {
      return impl_of(scene).closest(batch, HitArrays<U>(hits), count, execution);
    });
  });
}

template <class T>
Status occluded_of(const RayScene& scene, const RayViews<T>& rays, const View1<std::uint8_t>& occluded,
                   const BatchOptions& options, const Execution& execution) {
  return guarded([&] {
    BatchChecks checks(rays.direction.size);
    add_rays(rays, checks);
    checks.output("occluded", occluded);
    return run(rays, options, checks, [&](const RayBatch& batch, std::size_t count) {
      return impl_of(scene).occluded(batch, occluded, count, execution);
    });
  });
}

}  // namespace

Status closest(const RayScene& scene, const RayViews<float>& rays, const HitViews<float>& hits,
               const BatchOptions& options, const Execution& execution) {
  return closest_of(scene, rays, hits, options, execution);
}
Status closest(const RayScene& scene, const RayViews<float>& rays, const HitViews<double>& hits,
               const BatchOptions& options, const Execution& execution) {
  return closest_of(scene, rays, hits, options, execution);
}
Status closest(const RayScene& scene, const RayViews<double>& rays, const HitViews<float>& hits,
               const BatchOptions& options, const Execution& execution) {
  return closest_of(scene, rays, hits, options, execution);
}
Status closest(const RayScene& scene, const RayViews<double>& rays, const HitViews<double>& hits,
               const BatchOptions& options, const Execution& execution) {
  return closest_of(scene, rays, hits, options, execution);
}

Status occluded(const RayScene& scene, const RayViews<float>& rays, const View1<std::uint8_t>& occluded,
                const BatchOptions& options, const Execution& execution) {
  return occluded_of(scene, rays, occluded, options, execution);
}
Status occluded(const RayScene& scene, const RayViews<double>& rays, const View1<std::uint8_t>& occluded,
                const BatchOptions& options, const Execution& execution) {
  return occluded_of(scene, rays, occluded, options, execution);
}

}}  // namespace tessera::abi_0_1
