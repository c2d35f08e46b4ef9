// Functions, ruled surfaces and Coons patches on grids; grids and meshes that follow their patches.

#include <stdexcept>

#include "robustness/bad_input.h"
#include "robustness/bad_views.h"
#include "support/borders.h"
#include "support/grids.h"
#include "tessera/coons_patch.h"
#include "tessera/evaluate.h"
#include "tessera/model.h"
#include "tessera/parametric_surface.h"
#include "tessera/tessellation.h"

namespace tessera::test {
namespace {

using enum StatusCode;
using Numbers = std::vector<double>;

/// The rows that all surfaces on [0,1]^2 have in common.
template <class Surface>
void surface_grid(Table& table, const Surface& surface) {
  const Numbers t{0, 0.5, 1};
  Numbers memory(27, -7);
  const Numbers clean = memory;
  const View3<double> sound = View3<double>::interleaved(memory);
  const auto refused = [&](const std::string& input, StatusCode code, const Numbers& u, const Numbers& v,
                           const View3<double>& out) {
    table.row(input, code, evaluate(surface, u, v, out), [&] { return memory == clean; });
  };
  refused("no parameters", invalid_argument, {}, t, sound);
  refused("a parameter outside the domain", invalid_argument, {0, 0.5, 1.5}, t, sound);
  refused("a parameter of NaN", non_finite, t, {0, not_a_number, 1}, sound);
  refused("an infinite parameter", non_finite, t, {-infinity}, sound);
  refused("no view", invalid_argument, t, t, {});
  bad_view(
      "positions", sound, 9, [](auto& view) -> auto& { return view; },
      [&](const std::string& input, StatusCode code, const View3<double>& out) { refused(input, code, t, t, out); });
  const std::atomic<bool> cancel = true;
  table.row("a cancellation before the first task", cancelled, evaluate(surface, t, t, sound, {.cancel = &cancel}));
}

void functions(Table& table) {
  table.of("evaluate(ParametricSurface, u, v, out, execution, calls)");
  const auto with = [](auto position) {
    return value_of(ParametricSurface::make({.position = [=](double u, double v) {
      return (u == 0 || u == 1) && (v == 0 || v == 1) ? Vec3{u, v, 0} : position(u, v);
    }}));
  };
  surface_grid(table, with([](double u, double v) { return Vec3{u, v, 0}; }));
  const Numbers t{0, 0.5, 1};
  Numbers memory(27);
  std::vector<float> floats(27);
  const auto out = View3<double>::interleaved(memory);
  table.row("a function that gives NaN", non_finite,
            evaluate(with([](double, double) {
                       return Vec3{not_a_number, 0, 0};
                     }),
                     t, t, out));
  table.row("a function that throws", invalid_argument,
            evaluate(with([](double, double) -> Vec3 { throw std::runtime_error("no value here"); }), t, t, out));
  table.row("a position of 1e300, in float", non_finite,
            evaluate(with([](double, double) {
                       return Vec3{1e300, 0, 0};
                     }),
                     t, t, View3<float>::interleaved(floats)));
}

void transfinite(Table& table) {
  const auto line = [](const Vec3& a, const Vec3& b) { return quadratic(a, b - a, {}); };
  const CoonsBorders square{line({0, 0, 0}, {1, 0, 0}), line({0, 1, 0}, {1, 1, 0}), line({0, 0, 0}, {0, 1, 0}),
                            line({1, 0, 0}, {1, 1, 0})};
  table.of("evaluate(CoonsPatch, u, v, out, execution)");
  surface_grid(table, coons(square));
  table.of("evaluate(RuledSurface, u, v, out, execution)");
  surface_grid(table, value_of(RuledSurface::make(square.c1, square.c2)));
  const Numbers t{0, 0.5, 1};
  std::vector<float> floats(27, -7);
  const std::vector<float> clean = floats;
  const auto far = value_of(RuledSurface::make(line({0, 0, 0}, {1e300, 0, 0}), square.c2));
  table.row("positions of 1e300, in float", non_finite, evaluate(far, t, t, View3<float>::interleaved(floats)),
            [&] { return floats == clean; });
  const auto hole = callable([](double x) { return x == 0.5 ? Vec3{not_a_number, 0, 0} : Vec3{x, 0, 0}; });
  table.row("a border that gives NaN", non_finite,
            evaluate(value_of(RuledSurface::make(hole, square.c2)), t, t, View3<float>::interleaved(floats)),
            [&] { return floats == clean; });
}

/// Edits of a set of two patches, sound except for the change of each row.
struct Edited {
  std::vector<BezierPatch> patches = wavy_field(1, 2);
  PatchSet set = set_of(patches);
  std::vector<std::uint32_t> patch{1};
  std::vector<Vec3> points{patches[1].points().begin(), patches[1].points().end()};
  bool changed(std::uint64_t revision) const { return set.revision() != revision; }
};

/// `run(edited)` makes the call; `clean()` says whether its outputs are untouched.
template <class Run, class Clean>
void bad_edits(Table& table, Edited& edited, Run run, Clean clean) {
  const Edited sound;
  const auto refused = [&](const std::string& input, StatusCode code, auto change) {
    edited.patch = sound.patch;
    edited.points = sound.points;
    change(edited);
    const std::uint64_t before = edited.set.revision();
    const Status status = run(edited);
    table.row(input, code, status, [&] { return clean() && !edited.changed(before); });
  };
  refused("an unknown patch", invalid_argument, [](Edited& e) { e.patch[0] = 2; });
  refused("patch 4294967295", invalid_argument, [](Edited& e) { e.patch[0] = 4294967295u; });
  refused("a patch named twice", invalid_argument, [](Edited& e) {
    e.patch = {1, 1};
    e.points.insert(e.points.end(), 16, Vec3{});
  });
  refused("a point too few", count_mismatch, [](Edited& e) { e.points.pop_back(); });
  refused("points without a patch", count_mismatch, [](Edited& e) { e.patch.clear(); });
  refused("NaN in a point", non_finite, [](Edited& e) { e.points[9].y = not_a_number; });
  refused("a point of 1e300", non_finite, [](Edited& e) { e.points[9].y = 1e300; });
  edited.patch = sound.patch;
  edited.points = sound.points;
}

void grid_updates(Table& table) {
  table.of("GridUpdate::run(set, plan, edits, QuantityViews, execution)");
  Edited edited;
  const Numbers t = uniform_parameters(3);
  const GridPlan plan = value_of(GridPlan::make(edited.set, t, t));
  AllBuffers<float> memory(plan), clean(plan);
  GridUpdate update = value_of(GridUpdate::make(edited.set));
  const auto run = [&](Edited& e, const QuantityViews<float>& out) {
    return update.run(e.set, plan, {e.patch, e.points}, out);
  };
  const auto untouched = [&] { return memory == clean; };
  bad_edits(
      table, edited, [&](Edited& e) { return run(e, memory.views()); }, untouched);
  const auto refused = [&](const std::string& input, StatusCode code, const QuantityViews<float>& views) {
    table.row(input, code, run(edited, views), untouched);
  };
  bad_view(
      "positions", memory.views(), plan.capacity(), [](auto& views) -> auto& { return views.position; }, refused);
  refused("no view", invalid_argument, {});
  const GridPlan own =
      value_of(GridPlan::make(edited.set, PatchParameters{.u = Numbers(4, 0.5), .v = Numbers(4, 0.5)}));
  table.row("parameters of each patch's own", unsupported,
            update.run(edited.set, own, {edited.patch, edited.points}, memory.views()), untouched);
  PatchSet other = set_of(wavy_field(2, 2));
  const GridPlan others = value_of(GridPlan::make(other, t, t));
  AllBuffers<float> more(others);
  table.row("another set than the update's", stale,
            update.run(other, others, {edited.patch, edited.points}, more.views()));
}

/// The rows of a plan's update(), of a mesh from rates or from a tolerance.
void mesh_updates(Table& table, const TessellationOptions& options) {
  Edited edited;
  table.of(options.rates ? "Tessellation::update(set, edits, views, execution), with rates"
                         : "Tessellation::update(set, edits, views, execution), with a tolerance");
  Tessellation plan = value_of(Tessellation::make(edited.set, options));
  Mesh mesh = value_of(plan.allocate());
  const std::vector<float> clean = mesh.positions;
  const auto untouched = [&] { return mesh.positions == clean; };
  const auto update = [&](PatchSet& set, const MeshViews& views) {
    return plan.update(set, {edited.patch, edited.points}, views);
  };
  bad_edits(
      table, edited, [&](Edited& e) { return update(e.set, mesh.views()).status(); }, untouched);
  const auto refused = [&](const std::string& input, StatusCode code, const MeshViews& views) {
    const std::uint64_t before = edited.set.revision();
    table.row(input, code, update(edited.set, views).status(), [&] { return untouched() && !edited.changed(before); });
  };
  refused("no positions", invalid_argument, {});
  bad_view(
      "normals", mesh.views(), mesh.vertex_count(), [](auto& views) -> auto& { return views.normal; }, refused);
  PatchSet other = set_of(wavy_field(3, 3));
  table.row("a set of more patches", stale, update(other, mesh.views()).status(), untouched);
  (void)value_of(plan.update(edited.set, {edited.patch, edited.points}, mesh.views()));
  PatchSet equal = set_of(edited.patches);
  const std::vector<float> moved = mesh.positions;
  table.row("another set of the same patches", stale, update(equal, mesh.views()).status(),
            [&] { return mesh.positions == moved; });
  std::vector<Vec3> pole = edited.points;
  for (std::size_t j = 1; j < 4; ++j) pole[j] = pole[0];
  const auto collapsed = plan.update(edited.set, {edited.patch, pole}, mesh.views());
  table.gives("points that collapse a border", "another topology, nothing written",
              collapsed.ok() && collapsed->topology && mesh.positions == moved);
}

/// The rows of a mesh whose topology has changed.
void changed_meshes(Table& table) {
  table.of("Tessellation::update(set, edits, views, execution), after another topology");
  Edited edited;
  TessellationOptions options{.tolerance = 0.01};
  Tessellation plan = value_of(Tessellation::make(edited.set, options));
  Mesh mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(edited.set, mesh.views()).ok());
  const auto times = [&](double by) {
    std::vector<Vec3> points = edited.points;
    for (Vec3& p : points) p.z *= by;
    return points;
  };
  const auto row = [&](const std::string& input, StatusCode code, double by) {
    const std::vector<float> clean = mesh.positions;
    const std::uint64_t before = edited.set.revision();
    table.row(input, code, plan.update(edited.set, {edited.patch, times(by)}, mesh.views()).status(),
              [&] { return mesh.positions == clean && !edited.changed(before); });
  };
  const auto change_to = [&](double by) {
    EXPECT_TRUE(value_of(plan.update(edited.set, {edited.patch, times(by)}, mesh.views())).topology);
  };
  change_to(9);
  row("views of the old size, which is smaller", buffer_too_small, 8);
  table.row("a run into views of the old size", buffer_too_small, plan.run(edited.set, mesh.views()));
  mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(edited.set, mesh.views()).ok());
  change_to(0.1);
  row("views of the old size, which is larger", count_mismatch, 0.2);
  options.max_triangles = value_of(Tessellation::make(edited.set, options)).capacity().triangles;
  plan = value_of(Tessellation::make(edited.set, options));
  mesh = value_of(plan.allocate());
  const std::vector<float> clean = mesh.positions;
  table.row("points that take more triangles than the limit", invalid_argument,
            plan.update(edited.set, {edited.patch, times(9)}, mesh.views()).status(),
            [&] { return mesh.positions == clean; });
}

/// The rows of edits of a spline surface.
void spline_updates(Table& table) {
  table.of("Tessellation::update(set, surface edits, views, execution)");
  const std::vector<double> knots{0, 0, 0, 0, 1, 2, 2, 2, 2};
  std::vector<Vec3> points;
  for (int k = 0; k < 25; ++k) points.push_back({double(k / 5), double(k % 5), double(k % 3)});
  const BSplineSurface spline = value_of(BSplineSurface::polynomial(3, knots, 3, knots, std::span(points)));
  PatchSet set = value_of(make_patch_set(value_of(to_bezier(spline))));
  Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 0.01}));
  Mesh mesh = value_of(plan.allocate());
  const Mesh clean = mesh;
  const auto row = [&](const std::string& input, StatusCode code, auto change) {
    std::vector<SurfaceEdits> edits;
    edits.reserve(2);
    edits.push_back({.spline = spline, .points = points});
    change(edits);
    table.row(input, code, plan.update(set, edits, mesh.views()).status(),
              [&] { return mesh.positions == clean.positions && set.revision() == 0; });
  };
  using Edits = std::vector<SurfaceEdits>;
  const std::vector<std::uint32_t> beyond{25};
  row("a control point too few", count_mismatch, [&](Edits& e) { e[0].points = std::span(points).first(24); });
  row("a control point beyond the last", invalid_argument, [&](Edits& e) { e[0].moved = beyond; });
  row("a surface that the set has not", invalid_argument, [](Edits& e) { e[0].surface = 1; });
  row("a surface named twice", invalid_argument, [](Edits& e) { e.push_back(e[0]); });
  const BSplineSurface other = value_of(BSplineSurface::polynomial(3, std::vector<double>{0, 0, 0, 0, 1, 1, 1, 1}, 3,
                                                                   knots, std::span(points).first(20)));
  row("a spline of other knots", invalid_argument, [&](Edits& e) {
    e[0].spline = other;
    e[0].points = std::span(points).first(20);
  });
  std::vector<Vec3> bad = points;
  bad[12].x = not_a_number;
  row("NaN in a control point", non_finite, [&](Edits& e) { e[0].points = bad; });
  row("a placement of infinity", non_finite, [](Edits& e) { e[0].placement.translation.z = infinity; });
}

}  // namespace

void fill_functions(Table& table) {
  functions(table);
  transfinite(table);
}

void fill_updates(Table& table) {
  grid_updates(table);
  for (const TessellationOptions& options :
       {TessellationOptions{.rates = UniformRates{3, 2}}, TessellationOptions{.tolerance = 0.01}})
    mesh_updates(table, options);
  changed_meshes(table);
  spline_updates(table);
}

}  // namespace tessera::test
