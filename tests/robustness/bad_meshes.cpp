// Tessellations, meshes, and the machine.

#include <cstdlib>

#include "robustness/bad_input.h"
#include "robustness/bad_views.h"
#include "support/grids.h"
#include "support/suite_isa.h"
#include "tessera/limits.h"
#include "tessera/model.h"
#include "tessera/tessellation.h"

namespace tessera::test {
namespace {

using enum StatusCode;

Mesh bad_meshes_filled(Mesh mesh) {
  for (auto* floats : {&mesh.positions, &mesh.normals, &mesh.parameters}) std::ranges::fill(*floats, -77.0f);
  for (auto* integers : {&mesh.patches, &mesh.indices}) std::ranges::fill(*integers, 77777777u);
  return mesh;
}
bool same(const Mesh& a, const Mesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.parameters == b.parameters &&
         a.patches == b.patches && a.indices == b.indices;
}

/// The rows of a plan's run().
void bad_mesh_views(Table& table, const PatchSet& set, const Tessellation& plan) {
  Mesh mesh = bad_meshes_filled(value_of(plan.allocate()));
  const Mesh clean = mesh;
  const auto refused = [&](const std::string& input, StatusCode code, const MeshViews& views) {
    table.row(input, code, plan.run(set, views), [&] { return same(mesh, clean); });
  };
  const auto with = [&](const std::string& input, StatusCode code, auto change) {
    MeshViews views = mesh.views();
    change(views);
    refused(input, code, views);
  };
  const std::size_t vertices = plan.capacity().vertices;
  refused("no view", invalid_argument, {});
  bad_view(
      "positions", mesh.views(), vertices, [](auto& views) -> auto& { return views.position; }, refused);
  bad_view(
      "parameters", mesh.views(), vertices, [](auto& views) -> auto& { return views.parameter; }, refused);
  with("normals in the place of positions", invalid_argument, [](MeshViews& v) { v.normal = v.position; });
  with("no indices", buffer_too_small, [](MeshViews& v) { v.indices = {}; });
  with("indices short by one", buffer_too_small,
       [](MeshViews& v) { v.indices = v.indices.first(v.indices.size() - 1); });
  with("patches short by one", buffer_too_small, [](MeshViews& v) { v.patch = v.patch.first(v.patch.size() - 1); });
  with("patches in the place of indices", invalid_argument, [](MeshViews& v) { v.patch = v.indices; });
  std::vector<std::uint32_t> quads(100000);
  with("quads of a plan without quads", invalid_argument, [&](MeshViews& v) { v.quads = quads; });
  const std::atomic<bool> cancel = true;
  table.row("a cancellation before the first task", cancelled, plan.run(set, mesh.views(), {.cancel = &cancel}));
}

void tolerance_options(Table& table, const PatchSet& set) {
  const auto row = [&](const std::string& input, StatusCode code, const TessellationOptions& options) {
    table.row(input, code, Tessellation::make(set, options));
  };
  row("neither rates nor a tolerance of any kind", invalid_argument, {});
  for (const auto& [tolerance, name] :
       {std::pair{0.0, "0"}, {-1.0, "-1"}, {not_a_number, "NaN"}, {infinity, "infinity"}})
    row(std::string("a tolerance of ") + name, invalid_argument, {.tolerance = tolerance});
  row("a tolerance below what float holds", invalid_argument, {.tolerance = 1e-12});
  row("a subnormal tolerance", invalid_argument, {.tolerance = 5e-324});
  row("a tolerance that takes too many triangles", invalid_argument, {.tolerance = 1e-4, .max_triangles = 100});
  row("an angle of 0", invalid_argument, {.angle = 0.0});
  row("an angle of NaN", invalid_argument, {.angle = not_a_number});
  row("an angle above pi / 2", invalid_argument, {.angle = 2.0});
  row("an angle rate of 0", invalid_argument, {.angle = 0.1, .angle_rate = 0});
  row("an angle rate of 4097", invalid_argument, {.angle = 0.1, .angle_rate = 4097});
  row("a weld of -1", invalid_argument, {.tolerance = 0.01, .joining = {.weld = -1}});
  row("a weld of NaN", invalid_argument, {.tolerance = 0.01, .joining = {.weld = not_a_number}});
  row("a weld of the set's size", invalid_argument, {.tolerance = 0.01, .joining = {.weld = 3}});
  row("a crease angle of 4", invalid_argument, {.tolerance = 0.01, .joining = {.crease_angle = 4.0}});
  row("a crease angle of NaN", invalid_argument, {.tolerance = 0.01, .joining = {.crease_angle = not_a_number}});
  row("a tolerance and a budget", invalid_argument, {.tolerance = 0.1, .budget = 100});
  row("a budget of no triangle", invalid_argument, {.budget = 0});
  row("a budget of less than one cell a patch", invalid_argument, {.budget = 2 * set.patch_count() - 1});
  row("a tolerance and less than one cell a patch", invalid_argument,
      {.tolerance = 100.0, .max_triangles = 2 * set.patch_count() - 1});
  row("a spare of -1", invalid_argument, {.tolerance = 0.01, .spare = -1});
  row("a spare of NaN", invalid_argument, {.tolerance = 0.01, .spare = not_a_number});
  row("an unknown instruction set", isa_unavailable, {.tolerance = 0.01, .isa = Isa{9}});
  const std::atomic<bool> cancel = true;
  table.row("a cancellation before the first task", cancelled,
            Tessellation::make(set, {.tolerance = 0.01}, {.cancel = &cancel}));
}

void pixel_options(Table& table, const PatchSet& set) {
  const View sound{.eye = {0, -3, 3}, .target = {1, 1, 0}};
  const auto row = [&](const std::string& input, double pixels, auto change) {
    View view = sound;
    change(view);
    table.row(input, invalid_argument, Tessellation::make(set, {.pixels = PixelTolerance{pixels, view}}));
  };
  const auto nothing = [](View&) {};
  row("0 pixels", 0, nothing);
  row("NaN pixels", not_a_number, nothing);
  row("an eye of NaN", 1, [](View& v) { v.eye.x = not_a_number; });
  row("an eye at the target", 1, [](View& v) { v.eye = v.target; });
  row("a field of view of 0", 1, [](View& v) { v.field_of_view = 0; });
  row("a field of view of 4", 1, [](View& v) { v.field_of_view = 4; });
  row("a width of 0", 1, [](View& v) { v.width = 0; });
  row("a height of -1", 1, [](View& v) { v.height = -1; });
  row("a negative near distance", 1, [](View& v) { v.near_distance = -1; });
  row("a near distance of NaN", 1, [](View& v) { v.near_distance = not_a_number; });
  row("parallel rays that show nothing", 1, [](View& v) {
    v.orthographic = true;
    v.extent = 0;
  });
  View inside = sound;
  inside.eye = {1, 1, 0.5};
  const auto plan = Tessellation::make(set, {.pixels = PixelTolerance{4, inside}});
  table.gives("a camera inside the model", "a plan", plan.ok());
}

void other_sets(Table& table, const TessellationOptions& options) {
  const std::vector<BezierPatch> patches = wavy_field(1, 2);
  PatchSet set = set_of(patches);
  const Tessellation plan = value_of(Tessellation::make(set, options));
  Mesh mesh = bad_meshes_filled(value_of(plan.allocate()));
  const Mesh clean = mesh;
  const PatchSet longer = set_of(wavy_field(1, 3)), equal = set_of(patches);
  table.row("a set of more patches", stale, plan.run(longer, mesh.views()), [&] { return same(mesh, clean); });
  table.row("another set of the same patches", stale, plan.run(equal, mesh.views()), [&] { return same(mesh, clean); });
  (void)set.set_control_points(1, std::vector<Vec3>(16, Vec3{1, 2, 3}));
  table.row("an edit by which a border collapses", stale, plan.run(set, mesh.views()),
            [&] { return same(mesh, clean); });
}

/// The rows of run(), of meshes from rates and from a tolerance.
void runs(Table& table, const PatchSet& set) {
  for (TessellationOptions options :
       {TessellationOptions{.rates = UniformRates{3, 2}}, TessellationOptions{.tolerance = 0.01}}) {
    table.of(options.rates ? "Tessellation::run(set, views, execution), with rates"
                           : "Tessellation::run(set, views, execution), with a tolerance");
    bad_mesh_views(table, set, value_of(Tessellation::make(set, options)));
    other_sets(table, options);
    options.quads = true;
    const Tessellation plan = value_of(Tessellation::make(set, options));
    Mesh mesh = value_of(plan.allocate());
    MeshViews views = mesh.views();
    views.quads = views.quads.first(views.quads.size() - 1);
    table.row("quads short by one index", buffer_too_small, plan.run(set, views));
    views.quads = {};
    table.row("no quads for a plan of quads", buffer_too_small, plan.run(set, views));
  }
  const auto shared = value_of(Tessellation::make(set, {.tolerance = 0.01, .joining = {.share_vertices = true}}));
  Mesh mesh = value_of(value_of(Tessellation::make(set, {.tolerance = 0.01})).allocate());
  table.row("normals of vertices that are shared everywhere", invalid_argument, shared.run(set, mesh.views()));
}

}  // namespace

void fill_tessellations(Table& table) {
  const PatchSet set = set_of(wavy_field(2, 2));
  table.of("Tessellation::make(set, options, execution)");
  const auto row = [&](const std::string& input, StatusCode code, const TessellationOptions& options) {
    table.row(input, code, Tessellation::make(set, options));
  };
  row("rate 0", invalid_argument, {.rates = UniformRates{.u = 0}});
  row("rate -2147483648", invalid_argument, {.rates = UniformRates{.v = std::numeric_limits<int>::min()}});
  row("rate 4097", invalid_argument, {.rates = UniformRates{.u = 4097}});
  row("rates and a tolerance", invalid_argument, {.rates = UniformRates{}, .tolerance = 0.01});
  row("rates and an angle", invalid_argument, {.rates = UniformRates{}, .angle = 0.1});
  row("rates and a budget", invalid_argument, {.rates = UniformRates{}, .budget = 100});
  row("rates and an unknown instruction set", isa_unavailable, {.rates = UniformRates{}, .isa = Isa{9}});
  const std::vector<BezierPatch> many(256, *BezierPatch::polynomial(1, 1, std::vector<Vec3>(4)));
  table.row("more vertices than 32 bits count", invalid_argument,
            Tessellation::make(set_of(many), {.rates = UniformRates{4096, 4096}}));
  tolerance_options(table, set);
  pixel_options(table, set);
  const PatchSet doubles = set_of(wavy_field(1, 1), {.blocks = {.float_bernstein = false, .double_bernstein = true}});
  table.row("rates of a set without float blocks", unsupported, Tessellation::make(doubles, {.rates = UniformRates{}}));
  table.row("a set without float blocks", unsupported, Tessellation::make(doubles, {.tolerance = 1.0}));
  runs(table, set);
}

void fill_meshes(Table& table) {
  Mesh sound;
  sound.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  sound.patches = {0};
  sound.indices = {0, 1, 2};
  const auto row = [&](const std::string& input, StatusCode code, auto change) {
    Mesh mesh = sound;
    change(mesh);
    table.row(input, code, check(mesh));
  };
  table.of("check(mesh)");
  table.gives("an empty mesh", "a report of nothing, which is not closed",
              check(Mesh{}).ok() && !check(Mesh{})->closed());
  row("an index that is out of range", invalid_argument, [](Mesh& m) { m.indices[1] = 3; });
  row("an index of 4294967295", invalid_argument, [](Mesh& m) { m.indices[2] = 4294967295u; });
  row("two indices", invalid_argument, [](Mesh& m) { m.indices.pop_back(); });
  row("eight position numbers", invalid_argument, [](Mesh& m) { m.positions.pop_back(); });
  row("normals for fewer vertices", invalid_argument, [](Mesh& m) { m.normals = {0, 0, 1}; });
  row("patches for more triangles", invalid_argument, [](Mesh& m) { m.patches = {0, 0}; });
  row("a corner of a quad that is out of range", invalid_argument, [](Mesh& m) { m.quads = {0, 1, 2, 3}; });
  row("five indices of quads", invalid_argument, [](Mesh& m) { m.quads = {0, 1, 2, 0, 1}; });
  row("patches without quads", invalid_argument, [](Mesh& m) { m.quad_patches = {0}; });
  Mesh bad = sound;
  bad.positions[4] = static_cast<float>(not_a_number);
  table.gives("NaN in a position", "a report with 1 non-finite vertex", check(bad)->non_finite_vertices == 1);
  table.of("split_quads(mesh)");
  Mesh parted = sound;
  parted.quads = {0, 1, 2};
  table.row("three indices of quads", count_mismatch, split_quads(parted));
  parted.quads = {0, 1, 2, 0};
  parted.parts = {{"a", 0, 1}};
  table.row("parts without the quads", count_mismatch, split_quads(parted));
  parted.parts[0].first_triangle = 1;
  table.row("a part beyond the triangles", invalid_argument, split_quads(parted));
  table.of("parts_by_surface(mesh, set, model)");
  const PatchSet set = set_of(wavy_field(1, 1));
  const Model model{.name = "m", .surfaces = {{"field", set.patch(0)}}};
  Mesh without = sound, beyond = sound;
  without.patches.clear();
  beyond.patches[0] = 7;
  table.row("a mesh without patches", count_mismatch, parts_by_surface(without, set, model));
  table.row("an unknown patch", invalid_argument, parts_by_surface(beyond, set, model));
  table.row("a model that lacks the surface", invalid_argument, parts_by_surface(sound, set, Model{}));
}

void fill_machine(Table& table) {
  table.of("parse_isa(text), default_isa()");
  table.row("an empty name", isa_unavailable, parse_isa(""));
  table.row("\"mmx\"", isa_unavailable, parse_isa("mmx"));
  {
    const ForcedIsa unknown("mmx");
    table.row("TESSERA_ISA=mmx in the environment", isa_unavailable, default_isa());
  }
  table.of("measure_limits(options)");
  table.row("an unknown instruction set", isa_unavailable, measure_limits({.isa = Isa{9}}));
  table.row("a buffer of 2^63 bytes", out_of_memory, measure_limits({.store_bytes = std::size_t{1} << 63}));
}

}  // namespace tessera::test
