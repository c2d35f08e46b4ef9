// Plans of the C interface.

#include <numbers>
#include <span>
#include <vector>

#include "c/mesh.h"
#include "c/objects.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 { namespace {

Vec3 vector_of(const double (&from)[3]) { return {from[0], from[1], from[2]}; }

View view_of(const tsr_plan_options& from) {
  return {.eye = vector_of(from.eye),
          .target = vector_of(from.target),
          .up = vector_of(from.up),
          .orthographic = from.extent != 0,
          .field_of_view = from.field_of_view,
          .extent = from.extent != 0 ? from.extent : 1,
          .width = from.width,
          .height = from.height,
          .near_distance = from.near_distance};
}

CStatus read_options(const tsr_plan_options& from, TessellationOptions& to) {
  constexpr std::uint32_t known = TSR_PLAN_RELATIVE | TSR_PLAN_SHARE | TSR_PLAN_QUADS | TSR_PLAN_FEWEST |
                                  TSR_PLAN_SMALLEST | TSR_PLAN_DOUBLE | TSR_PLAN_APART | TSR_PLAN_UV_SURFACE |
                                  TSR_PLAN_UV_UNIT | TSR_PLAN_UV_PATCH | TSR_PLAN_EDGES;
  if (from.flags & ~known) return bad("tsr_plan_options: flags has bits that mean nothing");
  const auto has = [&](std::uint32_t flag) { return (from.flags & flag) != 0; };
  if (has(TSR_PLAN_EDGES) && has(TSR_PLAN_APART))
    return bad("tsr_plan_options: edges are wanted, and that faces do not share them: set one of both flags");
  if (from.rate_u != 0 || from.rate_v != 0) to.rates = UniformRates{from.rate_u, from.rate_v};
  if (from.tolerance != 0) to.tolerance = from.tolerance;
  if (from.angle != 0) to.angle = from.angle;
  if (from.pixels != 0) to.pixels = PixelTolerance{.pixels = from.pixels, .view = view_of(from)};
  if (from.surface_tolerance_count > 0 && !from.surface_tolerances) return null_pointer("surface_tolerances");
  to.surface_tolerances.assign(from.surface_tolerances, from.surface_tolerances + from.surface_tolerance_count);
  to.headroom = from.headroom;
  if (!(from.weld < 0)) to.joining.weld = from.weld;
  if (!(from.crease_angle < 0)) to.joining.crease_angle = from.crease_angle;
  if (!(from.max_gap < 0)) to.joining.max_gap = from.max_gap;
  to.relative = has(TSR_PLAN_RELATIVE), to.joining.share_vertices = has(TSR_PLAN_SHARE), to.quads = has(TSR_PLAN_QUADS);
  to.fewest = has(TSR_PLAN_FEWEST), to.joining.close_edges = !has(TSR_PLAN_APART);
  to.joining.edge_vertices = has(TSR_PLAN_EDGES);
  if (has(TSR_PLAN_DOUBLE)) to.precision = Precision::double_precision;
  to.spare = from.spare, to.max_triangles = from.max_triangles;
  if (has(TSR_PLAN_SMALLEST)) to.budget = from.max_triangles;
  if (has(TSR_PLAN_UV_SURFACE)) to.parameters = VertexParameters::surface;
  if (has(TSR_PLAN_UV_UNIT)) to.parameters = VertexParameters::unit;
  if (has(TSR_PLAN_UV_PATCH)) to.parameters = VertexParameters::patch;
  return {};
}

/// The edits of tsr_plan_update().
PatchEdits edits_of(const uint32_t* patches, std::size_t count, const double* points, std::size_t point_count) {
  if (count == 0) return {};
  return {.patch = {patches, count}, .points = {reinterpret_cast<const Vec3*>(points), point_count}};
}

/// Gives the two vertices of each line along the edges to `line`, those of each edge's first use. Vertices of patches
/// that meet at one parameter make no line.
template <class Line>
void each_line(std::span<const EdgeVertex> vertices, Line&& line) {
  std::size_t first = 0;  // of the edge
  for (std::size_t k = 1; k < vertices.size(); ++k) {
    const EdgeVertex &from = vertices[k - 1], &to = vertices[k];
    if (to.edge != from.edge) first = k;
    if (to.edge != from.edge || to.use != vertices[first].use) continue;
    if (to.s != from.s && to.vertex != from.vertex) line(from.vertex, to.vertex);
  }
}

}}}  // namespace tessera::abi_0_1

extern "C" {

void tsr_plan_defaults(tsr_plan_options* options) {
  if (!options) return;
  *options = {};
  options->struct_size = sizeof *options;
  options->target[1] = 1;  // any direction, for a view that is not used
  options->up[2] = 1;
  options->field_of_view = 40 * std::numbers::pi / 180;
  options->width = 1280, options->height = 800;
  options->weld = options->crease_angle = options->max_gap = -1;
  options->spare = 0.25;
  options->max_triangles = std::uint64_t{1} << 30;
}

tsr_status tsr_plan_new(tsr_plan** plan, const tsr_set* set, const tsr_plan_options* options, const tsr_run* run) {
  if (plan) *plan = nullptr;
  return c_call([&]() -> CStatus {
    if (!plan) return null_pointer("plan");
    const Held<CSet> of(set);
    if (!of) return of.error();
    tsr_plan_options own;
    tsr_plan_defaults(&own);
    TessellationOptions wanted;
    if (CStatus status = read_struct("tsr_plan_options", options, own); status.code) return status;
    if (CStatus status = read_options(own, wanted); status.code) return status;
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) -> CStatus {
      Result<Tessellation> made = Tessellation::make(of->set, wanted, execution);
      if (!made) return made.status();
      const bool has_normals = !wanted.joining.share_vertices || wanted.joining.crease_angle.has_value();
      return give(plan,
                  std::make_shared<CPlan>(*std::move(made), of.shared(), has_normals, wanted.joining.edge_vertices));
    });
  });
}

tsr_status tsr_plan_describe(const tsr_plan* plan, tsr_plan_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CPlan> of(plan);
    if (!of) return of.error();
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::plan);
    const Tessellation& from = of->plan;
    const MeshCapacity size = from.capacity();
    tsr_plan_info filled{};
    filled.vertices = size.vertices, filled.triangles = size.triangles, filled.quads = size.quads;
    filled.tolerance = from.tolerance(), filled.bound = from.bound(), filled.gap = from.gap();
    filled.angle = from.angle(), filled.pixels = from.pixels(), filled.seen_bound = seen_bound(from);
    filled.is_certified = from.certified(), filled.has_normals = of->has_normals;
    filled.open_edges = from.open_edges(), filled.crossed_patches = from.crossed_patches().size();
    return write_struct("tsr_plan_info", info, filled);
  });
}

tsr_status tsr_plan_write(const tsr_plan* plan, const tsr_mesh* mesh, const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const Held<CPlan> of(plan);
    if (!of) return of.error();
    tsr_mesh read{};
    MeshViews views;
    if (CStatus status = mesh_views(mesh, read, views); status.code) return status;
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::plan);
    const Reading of_set(of->set->usage);
    if (!of_set) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) { return of->plan.run(of->set->set, views, execution); });
  });
}

tsr_status tsr_plan_edges(const tsr_plan* plan, uint32_t* vertices, size_t capacity, size_t* count) {
  return c_call([&]() -> CStatus {
    const Held<CPlan> of(plan);
    if (!of) return of.error();
    if (!count) return null_pointer("count");
    if (!of->has_edges) return bad("the plan was made without TSR_PLAN_EDGES");
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::plan);
    const Result<std::vector<EdgeVertex>> listed = edge_vertices(of->plan);
    if (!listed) return listed.status();
    *count = 0;
    each_line(*listed, [&](std::uint32_t, std::uint32_t) { ++*count; });
    if (!vertices) return {};
    if (capacity < *count)
      return {TSR_BUFFER_TOO_SMALL,
              "vertices holds " + std::to_string(capacity) + " lines, there are " + std::to_string(*count)};
    each_line(*listed, [&](std::uint32_t from, std::uint32_t to) { *vertices++ = from, *vertices++ = to; });
    return {};
  });
}

tsr_status tsr_plan_set_view(tsr_plan* plan, const tsr_plan_options* view) {
  return c_call([&]() -> CStatus {
    const Held<CPlan> of(plan);
    if (!of) return of.error();
    tsr_plan_options own;
    tsr_plan_defaults(&own);
    if (!view) return null_pointer("view");
    if (CStatus status = read_struct("tsr_plan_options", view, own); status.code) return status;
    const Changing changing(of->usage);
    if (!changing) return in_use(Object::Kind::plan);
    return of->plan.set_view(view_of(own));
  });
}

tsr_status tsr_plan_update(tsr_plan* plan, const uint32_t* patches, size_t count, const double* points,
                           size_t point_count, const tsr_mesh* mesh, int32_t* topology, const tsr_run* run) {
  if (topology) *topology = 0;
  return c_call([&]() -> CStatus {
    const Held<CPlan> of(plan);
    if (!of) return of.error();
    if (!topology) return null_pointer("topology");
    if (count > 0 && (!patches || !points)) return null_pointer(patches ? "points" : "patches");
    tsr_mesh read{};
    MeshViews views;
    if (CStatus status = mesh_views(mesh, read, views); status.code) return status;
    const Changing changing(of->usage);
    if (!changing) return in_use(Object::Kind::plan);
    const Changing of_set(of->set->usage);
    if (!of_set) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) -> CStatus {
      const PatchEdits edits = edits_of(patches, count, points, point_count);
      const Result<MeshChange> change = of->plan.update(of->set->set, edits, views, execution);
      if (!change) return change.status();
      *topology = change->topology;
      return {};
    });
  });
}

}  // extern "C"
