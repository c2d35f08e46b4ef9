#include <string>
#include <vector>

#include "base/impl_access.h"
#include "base/infinity.h"
#include "query/point_scene_impl.h"
#include "ray/scene/batch_checks.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Calls visit(name, view) for each output.
template <class T, class Visit>
void for_each_output(const NearestViews<T>& views, const Visit& visit) {
  visit("kind", views.kind);
  visit("patch", views.patch);
  visit("surface", views.surface);
  visit("u", views.u);
  visit("v", views.v);
  visit("patch_u", views.patch_u);
  visit("patch_v", views.patch_v);
  visit("distance", views.distance);
  visit("position", views.position);
  visit("normal", views.normal);
  visit("flags", views.flags);
}

template <class T>
void write(const NearestPoint& point, const NearestViews<T>& out, std::size_t k) {
  const bool is_found = point.kind == NearestKind::found;
  const auto set = [&](const auto& view, auto value) {
    if (!view.empty()) view.at(k, 0) = value;
  };
  const auto number = [&](const View1<T>& view, double value) { set(view, static_cast<T>(value)); };
  const auto vector = [&](const View3<T>& view, const Vec3& value) {
    if (view.empty()) return;
    view.at(k, 0) = static_cast<T>(value.x), view.at(k, 1) = static_cast<T>(value.y);
    view.at(k, 2) = static_cast<T>(value.z);
  };
  set(out.kind, point.kind), set(out.flags, point.flags);
  set(out.patch, is_found ? point.patch : no_id), set(out.surface, is_found ? point.surface : no_id);
  number(out.u, point.u), number(out.v, point.v);
  number(out.patch_u, point.patch_u), number(out.patch_v, point.patch_v), number(out.distance, point.distance);
  vector(out.position, point.position), vector(out.normal, point.normal);
}

template <class T, class U>
Status nearest_of(const PointScene& scene, const PointViews<T>& points, const NearestViews<U>& nearest,
                  const Execution& execution) {
  constexpr std::size_t max_patches = std::size_t{1} << 20;
  const std::size_t patches = points.patches;
  if (!(patches >= 1 && patches <= max_patches))
    return {StatusCode::invalid_argument,
            "the patches for a point must be from 1 to 2^20, found " + std::to_string(patches)};
  return guarded([&]() -> Status {
    BatchChecks checks(points.position.size, patches);
    checks.input("position", points.position);
    if (!points.max_distance.empty()) checks.input("max_distance", points.max_distance);
    for_each_output(nearest, [&](const char* name, const auto& view) { checks.output(name, view); });
    if (Status status = checks.status(); !status.ok()) return status;
    const PointScene::Impl& impl = impl_of(scene);
    if (Status status = impl.check_fresh(); !status.ok()) return status;
    const View3<const T>& p = points.position;
    const auto at = [&](std::size_t k) { return Vec3{p.at(k, 0), p.at(k, 1), p.at(k, 2)}; };
    return impl.for_points(p.size, execution, at, [&](std::size_t k, NearestSearch& search, QueryTree::Path& path) {
      const double reach = points.max_distance.empty() ? infinity : double(points.max_distance.at(k, 0));
      if (patches == 1) return write(impl.nearest(at(k), reach, search, path), nearest, k);
      std::vector<NearestPoint> several(patches);
      impl.nearest_patches(at(k), reach, search, path, several);
      for (std::size_t j = 0; j < patches; ++j) write(several[j], nearest, k * patches + j);
    });
  });
}

}  // namespace

Status nearest(const PointScene& scene, const PointViews<float>& points, const NearestViews<float>& nearest,
               const Execution& execution) {
  return nearest_of(scene, points, nearest, execution);
}
Status nearest(const PointScene& scene, const PointViews<float>& points, const NearestViews<double>& nearest,
               const Execution& execution) {
  return nearest_of(scene, points, nearest, execution);
}
Status nearest(const PointScene& scene, const PointViews<double>& points, const NearestViews<float>& nearest,
               const Execution& execution) {
  return nearest_of(scene, points, nearest, execution);
}
Status nearest(const PointScene& scene, const PointViews<double>& points, const NearestViews<double>& nearest,
               const Execution& execution) {
  return nearest_of(scene, points, nearest, execution);
}

}}  // namespace tessera::abi_0_1
