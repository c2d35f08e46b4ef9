// Functions, ruled surfaces and Coons patches on grids; grids and meshes that follow their patches.

#include <stdexcept>

#include "robustness/bad_input.h"
#include "robustness/bad_views.h"
#include "support/borders.h"
#include "support/grids.h"
#include "tessera/coons_patch.h"
#include "tessera/evaluate.h"
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

void mesh_updates(Table& table) {
  Edited edited;
  const auto plan_for = [](const PatchSet& set) {
    return value_of(CertifiedTessellation::make(set, {.tolerance = 0.01}));
  };
  table.of("MeshUpdate::make(set, plan)");
  const PatchSet other = set_of(wavy_field(3, 3));
  table.row("a plan for another number of patches", stale, MeshUpdate::make(other, plan_for(edited.set)));
  CertifiedTessellation early = plan_for(edited.set);
  (void)edited.set.set_control_points(1, edited.points);
  table.row("a plan for another revision", stale, MeshUpdate::make(edited.set, std::move(early)));

  table.of("MeshUpdate::run(set, edits, views, execution)");
  MeshUpdate update = value_of(MeshUpdate::make(edited.set, plan_for(edited.set)));
  Mesh mesh = value_of(update.plan().allocate());
  const std::vector<float> clean = mesh.positions;
  const auto untouched = [&] { return mesh.positions == clean; };
  bad_edits(
      table, edited,
      [&](Edited& e) {
        return update.run(e.set, {e.patch, e.points}, mesh.views());
      },
      untouched);
  const auto refused = [&](const std::string& input, StatusCode code, const MeshViews& views) {
    table.row(input, code, update.run(edited.set, {edited.patch, edited.points}, views), untouched);
  };
  refused("no positions", invalid_argument, {});
  bad_view(
      "normals", mesh.views(), mesh.vertex_count(), [](auto& views) -> auto& { return views.normal; }, refused);
  const std::vector<Vec3> pole(16, Vec3{1, 2, 3});
  table.row("points that collapse a border", stale, update.run(edited.set, {edited.patch, pole}, mesh.views()),
            untouched);
  (void)edited.set.set_control_points(0, edited.patches[0].points());
  refused("a set that was edited by other means", stale, mesh.views());
  table.of("MeshUpdate::restate(set), retessellate(set, spare)");
  table.row("a set that was edited by other means", stale, update.restate(edited.set));
  table.row("a spare of -1", invalid_argument, update.retessellate(edited.set, -1));
  table.row("a spare of NaN", invalid_argument, update.retessellate(edited.set, not_a_number));
  table.row("another number of patches", stale, update.retessellate(other));
}

}  // namespace

void fill_functions(Table& table) {
  functions(table);
  transfinite(table);
}

void fill_updates(Table& table) {
  grid_updates(table);
  mesh_updates(table);
}

}  // namespace tessera::test
