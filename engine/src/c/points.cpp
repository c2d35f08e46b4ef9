// Nearest points and solids of the C interface.

#include <algorithm>
#include <string>
#include <vector>

#include "c/objects.h"
#include "c/records.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 { namespace {

static_assert(sizeof(NearestKind) == 1 && static_cast<int>(NearestKind::found) == TSR_NEAREST_FOUND &&
              static_cast<int>(NearestKind::invalid_point) == TSR_NEAREST_INVALID_POINT);
static_assert(sizeof(NearestFlags) == 1);  // the test CPoints.NearestPointsAreThoseOfCpp compares its bits
static_assert(static_cast<int>(PointSide::inside) == TSR_SIDE_INSIDE &&
              static_cast<int>(PointSide::unknown) == TSR_SIDE_UNKNOWN &&
              static_cast<int>(PointSide::invalid_point) == TSR_SIDE_INVALID_POINT);

template <class T>
CStatus nearest_views(const tsr_nearest_out& from, NearestViews<T>& nearest) {
  CStatus status;
  const auto put = [&](const char* name, const tsr_out& out, auto& view) {
    if (status.code == TSR_OK) status = view_of(name, out, view);
  };
  put("kind", from.kind, nearest.kind), put("flags", from.flags, nearest.flags);
  put("surface", from.surface, nearest.surface), put("patch", from.patch, nearest.patch);
  put("distance", from.distance, nearest.distance);
  put("uv", component_of(from.uv, sizeof(T), 0), nearest.u), put("uv", component_of(from.uv, sizeof(T), 1), nearest.v);
  put("patch_uv", component_of(from.patch_uv, sizeof(T), 0), nearest.patch_u);
  put("patch_uv", component_of(from.patch_uv, sizeof(T), 1), nearest.patch_v);
  put("position", from.position, nearest.position), put("normal", from.normal, nearest.normal);
  return status;
}

/// Clears the bits of flags that C++ gives no meaning, and no value.
void clear_padding(const tsr_out& flags, std::size_t count) {
  constexpr unsigned known =
      TSR_NEAREST_CERTIFIED | TSR_NEAREST_AMBIGUOUS | TSR_NEAREST_BORDER | TSR_NEAREST_DEGENERATE_NORMAL;
  View1<std::uint8_t> view;
  if (view_of("flags", flags, view).code) return;  // it was checked
  write_records(view, count, [&](std::size_t k) { return view.at(k, 0) & known; });
}

template <class P, class N>
CStatus nearest_of(const PointScene& scene, const tsr_query_points& points, const tsr_nearest_out& out,
                   const Execution& execution) {
  PointViews<P> from;
  NearestViews<N> to;
  if (!points.position.data) return null_pointer("position");
  if (CStatus status = view_of("position", points.position, from.position); status.code) return status;
  if (CStatus status = view_for_all("max_distance", points.max_distance, points.position.count, from.max_distance);
      status.code)
    return status;
  if (CStatus status = nearest_views(out, to); status.code) return status;
  if (points.patches < 0) return bad("patches must be at least 0, found " + std::to_string(points.patches));
  from.patches = std::max<std::size_t>(1, static_cast<std::size_t>(points.patches));
  if (Status status = nearest(scene, from, to, execution); !status.ok()) return status;
  clear_padding(out.flags, points.position.count * from.patches);
  return {};
}

/// Copies points, which C++ takes for solids as Vec3.
template <class T>
CStatus copy_points(const tsr_in& position, std::vector<Vec3>& points) {
  View3<const T> view;
  if (CStatus status = view_of("position", position, view); status.code) return status;
  points.reserve(view.size);
  for (std::size_t k = 0; k < view.size; ++k)
    points.push_back({double{view.at(k, 0)}, double{view.at(k, 1)}, double{view.at(k, 2)}});
  return {};
}

/// Reads the struct of points for a solid.
CStatus solid_points(const tsr_query_points* points, tsr_query_points& from) {
  if (!points) return null_pointer("points");
  if (CStatus status = read_struct("tsr_query_points", points, from); status.code) return status;
  if (from.patches < 0 || from.patches > 1) return bad("patches must be 0 or 1: a point has one side");
  if (from.max_distance.data) return bad("max_distance must be a null pointer: sides have no largest distance");
  return from.position.data ? CStatus() : null_pointer("position");
}

CStatus copy_of(const tsr_query_points& from, std::vector<Vec3>& points) {
  return from.is_double ? copy_points<double>(from.position, points) : copy_points<float>(from.position, points);
}

}}}  // namespace tessera::abi_0_1

extern "C" {

tsr_status tsr_point_scene_new(tsr_point_scene** scene, const tsr_set* set, const tsr_run* run) {
  if (scene) *scene = nullptr;
  return c_call([&]() -> CStatus {
    if (!scene) return null_pointer("scene");
    const Held<CSet> of(set);
    if (!of) return of.error();
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) -> CStatus {
      Result<PointScene> made = PointScene::make(of->set, execution);
      if (!made) return made.status();
      return give(scene, std::make_shared<CPointScene>(*std::move(made), of.shared()));
    });
  });
}

tsr_status tsr_point_scene_refit(tsr_point_scene* scene, const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const Held<CPointScene> of(scene);
    if (!of) return of.error();
    const Changing changing(of->usage);
    if (!changing) return in_use(Object::Kind::point_scene);
    const Reading reading(of->set->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) { return of->scene.refit(execution); });
  });
}

tsr_status tsr_point_scene_describe(const tsr_point_scene* scene, tsr_point_scene_info* info) {
  return c_call([&]() -> CStatus {
    const InUse<CPointScene> of(scene);
    if (CStatus status = of.check(); status.code) return status;
    return write_struct("tsr_point_scene_info", info, {0, of->scene.memory_bytes(), of->scene.revision()});
  });
}

tsr_status tsr_point_scene_nearest(const tsr_point_scene* scene, const tsr_query_points* points,
                                   const tsr_nearest_out* nearest, const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const InUse<CPointScene> of(scene);
    if (CStatus status = of.check(); status.code) return status;
    if (!points || !nearest) return null_pointer(points ? "nearest" : "points");
    tsr_query_points from{};
    tsr_nearest_out to{};
    if (CStatus status = read_struct("tsr_query_points", points, from); status.code) return status;
    if (CStatus status = read_struct("tsr_nearest_out", nearest, to); status.code) return status;
    return run_work(run, [&](const Execution& execution) {
      const auto call = from.is_double ? (to.is_double ? &nearest_of<double, double> : &nearest_of<double, float>)
                                       : (to.is_double ? &nearest_of<float, double> : &nearest_of<float, float>);
      return call(of->scene, from, to, execution);
    });
  });
}

tsr_status tsr_solid_new(tsr_solid** solid, const tsr_scene* scene, const tsr_run* run) {
  if (solid) *solid = nullptr;
  return c_call([&]() -> CStatus {
    if (!solid) return null_pointer("solid");
    const InUse<CScene> of(scene);
    if (CStatus status = of.check(); status.code) return status;
    return run_work(run, [&](const Execution& execution) -> CStatus {
      Result<Solid> made = Solid::make(of->scene, execution);
      if (!made) return made.status();
      return give(solid, std::make_shared<CSolid>(*std::move(made), of.shared()));
    });
  });
}

tsr_status tsr_solid_describe(const tsr_solid* solid, tsr_solid_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CSolid> of(solid);
    if (!of) return of.error();
    return write_struct("tsr_solid_info", info, {0, of->solid.open_borders(), of->solid.is_closed(), 0});
  });
}

tsr_status tsr_solid_contains(const tsr_solid* solid, const tsr_query_points* points, const tsr_sides_out* sides,
                              const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const InUse<CSolid> of(solid);
    if (CStatus status = of.check(); status.code) return status;
    if (!sides) return null_pointer("sides");
    tsr_query_points from{};
    tsr_sides_out to{};
    if (CStatus status = solid_points(points, from); status.code) return status;
    if (CStatus status = read_struct("tsr_sides_out", sides, to); status.code) return status;
    const std::size_t count = from.position.count;
    View1<std::uint8_t> side, is_certified;
    if (CStatus status = output_of("side", to.side, count, side); status.code) return status;
    if (CStatus status = output_of("is_certified", to.is_certified, count, is_certified); status.code) return status;
    if (side.empty() && is_certified.empty()) return bad("neither side nor is_certified has memory");
    return run_work(run, [&](const Execution& execution) -> CStatus {
      std::vector<Vec3> list;
      if (CStatus status = copy_of(from, list); status.code) return status;
      std::vector<Containment> found(count);
      if (Status status = of->solid.contains(list, found, execution); !status.ok()) return status;
      write_records(side, count, [&](std::size_t k) { return found[k].side; });
      write_records(is_certified, count, [&](std::size_t k) { return found[k].certified; });
      return {};
    });
  });
}

tsr_status tsr_solid_winding_numbers(const tsr_solid* solid, const tsr_query_points* points, const tsr_out* numbers,
                                     const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const InUse<CSolid> of(solid);
    if (CStatus status = of.check(); status.code) return status;
    if (!numbers || !numbers->data) return null_pointer("numbers");
    tsr_query_points from{};
    if (CStatus status = solid_points(points, from); status.code) return status;
    View1<double> to;
    if (CStatus status = output_of("numbers", *numbers, from.position.count, to); status.code) return status;
    return run_work(run, [&](const Execution& execution) -> CStatus {
      std::vector<Vec3> list;
      if (CStatus status = copy_of(from, list); status.code) return status;
      std::vector<double> found(list.size());
      if (Status status = of->solid.winding_numbers(list, found, execution); !status.ok()) return status;
      write_records(to, found.size(), [&](std::size_t k) { return found[k]; });
      return {};
    });
  });
}

tsr_status tsr_solid_distances(const tsr_solid* solid, const tsr_point_scene* scene, const tsr_query_points* points,
                               const tsr_out* distances, const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const InUse<CSolid> of(solid);
    if (CStatus status = of.check(); status.code) return status;
    const InUse<CPointScene> near(scene);
    if (CStatus status = near.check(); status.code) return status;
    if (near->set != of->set) return {TSR_STALE, "the solid and the scene of points are of different sets"};
    if (!distances || !distances->data) return null_pointer("distances");
    tsr_query_points from{};
    if (CStatus status = solid_points(points, from); status.code) return status;
    const std::size_t count = from.position.count;
    View1<double> to;
    if (CStatus status = output_of("distances", *distances, count, to); status.code) return status;
    return run_work(run, [&](const Execution& execution) -> CStatus {
      std::vector<Vec3> list;
      if (CStatus status = copy_of(from, list); status.code) return status;
      std::vector<double> found(count);
      if (Status status = signed_distances(of->solid, near->scene, list, found, execution); !status.ok()) return status;
      write_records(to, count, [&](std::size_t k) { return found[k]; });
      return {};
    });
  });
}

}  // extern "C"
