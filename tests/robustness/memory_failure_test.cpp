// Memory that runs out: each time the call returns a Status, nothing leaks, and all existing objects remain usable.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <limits>
#include <random>

#include "io/file/output_file.h"
#include "io/file/text_cursor.h"
#include "robustness/memory_failure.h"
#include "robustness/scene.h"
#include "support/borders.h"
#include "support/random_splines.h"
#include "tessera/bezier_operations.h"
#include "tessera/convert.h"
#include "tessera/coons_patch.h"
#include "tessera/evaluate.h"
#include "tessera/generic_callable.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"
#include "tessera/parametric_surface.h"
#include "tessera/trim_region.h"
#include "trim/trim_shapes.h"
#ifdef TESSERA_HAS_IO
#include "support/scratch_folder.h"
#include "tessera/cad.h"
#include "tessera/io.h"
#endif

namespace tessera::test { namespace {

TEST(MemoryFails, WhereCurvesAndPatchesAreMade) {
  Random random(1);
  const std::vector<Vec3> points = random_cloud(random, 16);
  const std::vector<double> weights = random_positive(random, 16), knots{0, 0, 0, 0, 1, 2, 2, 2, 2};
  survives("BezierPatch::rational", [&] { return BezierPatch::rational(3, 3, points, weights); });
  survives("Curve::nurbs",
           [&] { return Curve::nurbs(3, std::span(points).first(5), std::span(weights).first(5), knots); });
  const BSplineSurface surface = random_surface(random, 3, 2, {.multiple = true}, {}, true);
  survives("BSplineSurface::rational", [&] {
    return BSplineSurface::rational(3, surface.knots_u(), 2, surface.knots_v(), surface.points(), surface.weights());
  });
  survives("to_bezier(BSplineSurface)", [&] { return to_bezier(surface); });
  survives("elevate_degree(BSplineSurface)", [&] { return elevate_degree(surface, 1, 2); });
  const double inside = 0.5 * (surface.domain().u0 + surface.domain().u1);
  survives("insert_knots(BSplineSurface)", [&] { return insert_knots(surface, std::span(&inside, 1), {}); });
  survives("nurbs_torus", [&] { return make_nurbs_torus({}, 3, 1); });
  survives("HermitePatch, to_bezier", [&]() -> Result<PatchGrid> {
    const auto made = HermitePatch::make(points);
    return made ? to_bezier(*made) : made.status();
  });
  const std::array<double, 3> u{0, 1, 2}, v{0, 1, 3};
  const std::array<HermiteNode, 9> nodes{};
  survives("HermiteNetwork, to_bezier", [&]() -> Result<PatchGrid> {
    const auto made = HermiteNetwork::on_knots(u, v, nodes);
    return made ? to_bezier(*made) : made.status();
  });
  survives("QuadricPiece, to_bezier", [&]() -> Result<PatchGrid> {
    const auto ball = Quadric::make({.a = 1, .b = 1, .c = 1, .k = -1});
    if (!ball) return ball.status();
    const auto piece = QuadricPiece::make(*ball, {0, 6, -1, 1});
    return piece ? to_bezier(*piece) : piece.status();
  });
  survives("Quadric::make", [&] { return Quadric::make({.a = 1, .b = 2, .c = 1, .k = -1}); });
}

TEST(MemoryFails, WhereLoopsBecomeRegions) {
  std::mt19937 random(5);
  const std::vector<double> breaks{0, 0.25, 0.5, 1};
  std::vector<TrimLoop> loops{circle({1, 0.5}, 0.25, true), random_loop(random), {}};
  loops.push_back({{line({0.1, 0.1}, {0.9, 0.1}), line({0.9, 0.1}, {0.9, 0.9})}, false});  // stops short
  loops.push_back({{line({0.2, 0.2}, {0.4, 0.3}), line({0.4, 0.3}, {0.2, 0.2})}, false});  // retraced
  loops.push_back({{line({0, 0.75}, {1, 0.75})}, false});                                  // around the surface
  const TrimOptions around{.periodic_u = true};
  survives("TrimRegion::make", [&] { return TrimRegion::make(loops, breaks, breaks); });
  survives("TrimRegion::make, over a seam", [&] { return TrimRegion::make(loops, breaks, breaks, around); });
  loops.push_back(circle({1e200, 0}, 1));
  survives(
      "TrimRegion::make, too far", [&] { return TrimRegion::make(loops, breaks, breaks); }, StatusCode::unsupported);
  survives(
      "TrimRegion::make, one break", [&] { return TrimRegion::make(loops, breaks, {}); }, StatusCode::invalid_argument);
}

TEST(MemoryFails, WhereErrorsAreStated) {
  using enum StatusCode;
  Random random(4);
  const BorderCurve curve = value_of(Curve::bezier(random_cloud(random, 4)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  survives(
      "position(BorderCurve), NaN", [&] { return position(curve, nan); }, non_finite);
  survives(
      "evaluate_jet(BorderCurve), NaN", [&] { return evaluate_jet(curve, nan); }, non_finite);

  const auto wave = [](double u, double v) { return Vec3{u, v, 0.1 * std::sin(5 * u)}; };
  const Surface surface = value_of(ParametricSurface::make({.position = wave}));
  const ModelSurface placed{"a surface with a long name", surface, Affine::translated({1e9, 0, 0})};
  const ModelSurface far{"", surface, Affine::scaled({1e308, 1e308, 1e308}) * Affine::translated({1, 1, 1})};
  survives("evaluate_jet(ModelSurface)", [&] { return evaluate_jet(placed, 0.5, 0.5); });
  survives(
      "evaluate_jet(ModelSurface), far", [&] { return evaluate_jet(far, 1, 1); }, non_finite);
  survives("to_bezier(ModelSurface)", [&] { return to_bezier(placed, {.tolerance = 1e-3}); });
  survives(
      "to_bezier(ModelSurface), far", [&] { return to_bezier(placed, {.tolerance = 1e-6}); }, invalid_argument);
  const Model model{.name = "m", .surfaces = {placed}};
  const Status error(io_error, "a sentence of more than fifteen bytes");
  survives(
      "in_surface", [&] { return in_surface(model, 0, error); }, io_error);
}

TEST(MemoryFails, WhereFunctionsBecomeSeries) {
  const auto line = [](auto t) { return std::array{t, 2 * t, t * t}; };
  const auto bowl = [](auto u, auto v) { return std::array{u, v, u * v}; };
  survives("generic_curve", [&] { return generic_curve(line); });
  survives("generic_surface", [&] { return generic_surface(bowl); });
  survives("generic_surface_over_disc", [&] { return generic_surface_over_disc(bowl); });
}

TEST(MemoryFails, WhereSurfacesAreConverted) {
  Random random(2);
  const CoonsBorders borders = random_borders(random, {{{3, 1}, {2, 0}, {3, 0}, {3, 2, true}}});
  survives("CoonsPatch::make", [&] { return CoonsPatch::make(borders); });
  const CoonsPatch patch = coons(borders);
  survives("to_bezier(CoonsPatch)", [&] { return to_bezier(patch); });
  const RuledSurface ruled = value_of(RuledSurface::make(borders.c1, borders.c2));
  survives("to_bezier(RuledSurface)", [&] { return to_bezier(ruled); });
  const auto wave = [](double u, double v) { return Vec3{u, v, 0.1 * std::sin(5 * u)}; };
  const ParametricSurface surface = value_of(ParametricSurface::make({.position = wave}));
  survives("to_bezier(ParametricSurface)", [&] { return to_bezier(surface, {.tolerance = 1e-3}); });
  const BezierPatch p = random_rational(random, 3, 3), q = random_polynomial(random, 3, 3);
  survives("split_u", [&] { return split_u(p, 0.3); });
  survives("elevate_degree", [&] { return elevate_degree(p, 5, 4); });
  survives("measure_join", [&] { return measure_join({p, Side::u1}, {q, Side::u0}); });
  survives("make_join", [&] { return make_join({q, Side::u1}, {q, Side::u0}); });
  const std::vector<double> t = uniform_parameters(40);
  std::vector<float> memory(3 * 1600);
  survives("evaluate(CoonsPatch)", [&] { return evaluate(patch, t, t, View3<float>::interleaved(memory)); });
  survives("evaluate(RuledSurface)", [&] { return evaluate(ruled, t, t, View3<float>::interleaved(memory)); });
  survives("evaluate(ParametricSurface)", [&] { return evaluate(surface, t, t, View3<float>::interleaved(memory)); });
}

TEST(MemoryFails, WhereSetsAreEvaluated) {
  const std::vector<BezierPatch> patches = various_patches(3);
  survives("PatchSet::make", [&] { return PatchSet::make(patches, with_points()); });
  PatchSet set = set_of(patches, with_points());
  const std::vector<double> t = uniform_parameters(5);
  survives("GridPlan::make", [&] { return GridPlan::make(set, t, t); });
  const GridPlan plan = value_of(GridPlan::make(set, t, t));
  AllBuffers<float> out(plan);
  survives("evaluate(set, plan)", [&] { return evaluate(set, plan, out.views()); });
  Random random(3);
  const Samples<float> samples = random_samples<float>(random, set.patch_count(), 500);
  AllBuffers<float> points(500);
  survives("evaluate(set, samples)", [&] { return evaluate(set, samples.views(), points.views()); });
  survives("SurfaceMap::make", [&] { return SurfaceMap::make(set); });
  survives("GridUpdate::make", [&] { return GridUpdate::make(set); });
  const std::vector<Vec3> net(set.patch(2).points().begin(), set.patch(2).points().end());
  const std::vector<std::uint32_t> edited{2};
  survives("GridUpdate::run, all of it", [&]() -> Status {
    Result<PatchSet> own = PatchSet::make(patches);
    if (!own) return own.status();
    Result<GridUpdate> update = GridUpdate::make(*own);
    if (!update) return update.status();
    return update->run(*own, plan, {edited, net}, QuantityViews<float>{.position = out.views().position});
  });
  survives("set_control_points", [&] { return set.set_control_points(2, net); });
  const Model model{.name = "m", .surfaces = {{"a", patches[0], Affine::translated({1, 0, 0})}, {"b", patches[9]}}};
  survives("make_patch_set(model)", [&] { return make_patch_set(model); });
}

TEST(MemoryFails, WhereFacesAreTrimmed) {
  Random random(5);
  const BSplineSurface surface = random_surface(random, 3, 2, {.multiple = true}, {}, true);
  const Domain d = surface.domain();
  const auto square = [&](double from, double to) {  // shares of the domain
    return rectangle(d.u_at(from), d.u_at(to), d.v_at(from), d.v_at(to));
  };
  const std::vector<TrimLoop> loops{square(0.1, 0.7), square(0.4, 0.95)};  // these cross
  Model model;
  model.surfaces.push_back({"a", surface, {}, loops});
  survives("make_patch_set(trimmed model)", [&] { return make_patch_set(model); });
  const PatchSet set = value_of(make_patch_set(model));
  ASSERT_GT(set.cut_count(), 0u);
  survives("Tessellation::make, trimmed", [&] { return Tessellation::make(set, {.tolerance = 0.3}); });
  const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 0.3}));
  Mesh mesh = value_of(plan.allocate());
  survives("Tessellation::run, trimmed", [&] { return plan.run(set, mesh.views()); });
}

TEST(MemoryFails, WhereMeshesAreMade) {
  const std::vector<BezierPatch> patches = various_patches(2);
  PatchSet set = set_of(various_patches(3));
  survives("Tessellation::make", [&] { return Tessellation::make(set, {.rates = UniformRates{}}); });
  const Tessellation uniform = value_of(Tessellation::make(set, {.rates = UniformRates{}}));
  survives("Tessellation::allocate", [&] { return uniform.allocate(); });
  Mesh mesh = value_of(uniform.allocate());
  survives("Tessellation::run", [&] { return uniform.run(set, mesh.views()); });
  survives("check(mesh)", [&] { return check(mesh); });
  TessellationOptions options{.tolerance = 0.01};
  survives("Tessellation::make", [&] { return Tessellation::make(set, options); });
  options.joining.weld = 1e-4;
  options.joining.crease_angle = 0.1;
  options.joining.share_vertices = true;
  options.angle = 0.3;
  options.fewest = true;
  survives("Tessellation::make, welded", [&] { return Tessellation::make(set, options); });
  const auto plan = value_of(Tessellation::make(set, options));
  Mesh certified = value_of(plan.allocate());
  survives("Tessellation::run", [&] { return plan.run(set, certified.views()); });
  options.quads = true;
  const auto of_quads = value_of(Tessellation::make(set, options));
  Mesh quads = value_of(of_quads.allocate());
  survives("Tessellation::run, quads", [&] { return of_quads.run(set, quads.views()); });
  survives("split_quads", [&] { return split_quads(quads); });
  const std::vector<Vec3> net(set.patch(2).points().begin(), set.patch(2).points().end());
  const std::vector<std::uint32_t> edited{2};
  std::vector<Vec3> bulging = net;
  for (std::size_t k = 5; k < 11; ++k) bulging[k].z += 3;
  for (const bool other_topology : {false, true})
    for (const TessellationOptions& how :
         {TessellationOptions{.rates = UniformRates{}}, TessellationOptions{.tolerance = 0.02}, options})
      survives("Tessellation::update", [&]() -> Status {
        Result<PatchSet> own = PatchSet::make(patches);
        if (!own) return own.status();
        auto own_plan = Tessellation::make(*own, how);
        if (!own_plan) return own_plan.status();
        Result<Mesh> own_mesh = own_plan->allocate();
        if (!own_mesh) return own_mesh.status();
        return own_plan->update(*own, {edited, other_topology ? bulging : net}, own_mesh->views()).status();
      });
}

#ifdef TESSERA_HAS_RAY
TEST(MemoryFails, WhereRaysAreCast) {
  const PatchSet set = set_of(various_patches(2));
  const std::vector<Ray> rays = rays_at(set, 700);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> dark(rays.size());
  for (const RayMode mode : {RayMode::exact, RayMode::grid}) {
    const std::string name = mode == RayMode::exact ? "exact" : "grid";
    survives("RayScene::make, " + name, [&] { return RayScene::make(set, {.mode = mode, .rate = 3}); });
    RayScene scene = value_of(RayScene::make(set, {.mode = mode, .rate = 3}));
    survives("closest, " + name, [&] { return scene.closest(rays, hits); });
    survives("occluded, " + name, [&] { return scene.occluded(rays, dark); });
    // A failed refit leaves the scene in another state, so each has a scene of its own.
    survives("make and refit, " + name, [&]() -> Status {
      Result<RayScene> own = RayScene::make(set, {.mode = mode, .rate = 3});
      if (!own) return own.status();
      const Status status = own->refit();
      return status.ok() || own->refit().ok() ? status : Status(StatusCode::internal, "a second refit fails");
    });
    if (mode == RayMode::grid) continue;
    bool defined = true;
    survives("all, " + name, [&] {
      HitLists lists;
      const Status status = scene.all(rays, lists);
      defined = defined && (status.ok() ? lists.first.size() == rays.size() + 1 : lists.hits.empty());
      return status;
    });
    EXPECT_TRUE(defined);
  }
}
#endif

#ifdef TESSERA_HAS_IO
TEST(MemoryFails, WhereFilesAreReadAndWritten) {
  const std::string corpus = TESSERA_SOURCE_DIR "/tests/corpus/", models = TESSERA_SOURCE_DIR "/tools/models/";
  for (const std::filesystem::path path :
       {corpus + "bpt/bilinear.bpt", corpus + "bv/kinds.bv", corpus + "g2/splines.g2", corpus + "obj/trimmed.obj",
        corpus + "rib/scene.rib", corpus + "json/coons_own_blends.json", models + "vase.json", models + "torus.json",
        models + "quadric_ellipsoid.json", models + "trimmed_cylinder.json"})
    survives("read_model " + path.filename().string(), [&] { return read_model(path); });
  const std::string patches = value_of(read_file(corpus + "bpt/bilinear.bpt"));
  survives("parse_model", [&] { return parse_model(patches, "model", {.format = "bpt"}); });
  for (const std::filesystem::path path :
       {corpus + "obj_mesh/quad.obj", corpus + "ply/binary.ply", corpus + "stl/ascii.stl",
        corpus + "gltf/embedded.gltf", corpus + "gltf/strip.glb"})
    survives("read_mesh " + path.filename().string(), [&] { return read_mesh(path); });
  const ScratchFolder folder;
  const PatchSet set = set_of(various_patches(1));
  const Tessellation plan = value_of(Tessellation::make(set, {.rates = UniformRates{2, 2}}));
  Mesh mesh = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set, mesh.views()).ok());
  for (const char* const name : {"m.obj", "m.ply", "m.stl", "m.glb", "m.gltf"}) {
    const std::filesystem::path path = folder / name;
    survives(std::string("write_mesh ") + name, [&] { return write_mesh(mesh, path); });
  }
  const Model model{.name = "m", .surfaces = {{"a", set.patch(0)}, {"b", set.patch(3)}}};
  const std::filesystem::path path = folder / "m.obj";
  survives("write_model m.obj", [&] { return write_model(model, path); });
  const Model trimmed = value_of(read_model(models + "trimmed_cylinder.json"));
  for (const char* const name : {"n.obj", "n.json"}) {
    const std::filesystem::path trimmed_path = folder / name;
    survives(std::string("write_model ") + name, [&] { return write_model(trimmed, trimmed_path); });
  }
  EXPECT_LE(folder.names().size(), 8u);  // no file beside those that were to be written
}

/// Opens `path`, writes, does `before_commit`, and commits.
template <class Act>
Status written(const std::filesystem::path& path, const std::atomic<bool>* cancel, Act before_commit) {
  Result<OutputFile> out = OutputFile::make(path, cancel);
  if (!out) return out.status();
  out->write("content");
  before_commit();
  return out->commit();
}

TEST(MemoryFails, WhereOutputsAreOpenedAndClosed) {
  using enum StatusCode;
  const ScratchFolder folder;
  const std::filesystem::path path = folder / "a_name_that_is_longer_than_any_string_object.txt";
  const auto nothing = [] {};
  survives("OutputFile", [&] { return written(path, nullptr, nothing); });
  ASSERT_TRUE(std::filesystem::remove(path));
  // A folder that takes the place of the file before it is renamed.
  const auto take_place = [&] { ::mkdir(path.c_str(), 0700); };
  const auto obstructed = [&] {
    Status status = written(path, nullptr, take_place);
    ::rmdir(path.c_str());
    return status;
  };
  survives("OutputFile, obstructed", obstructed, io_error);
  const std::atomic<bool> cancel = true;
  survives(
      "OutputFile, cancelled", [&] { return written(path, &cancel, nothing); }, cancelled);
  const std::filesystem::path full = "/dev/full";
  survives(
      "OutputFile, full device", [&] { return written(full, nullptr, nothing); }, io_error);
  survives("OutputFile::standard_output", [&] { return OutputFile::standard_output(); });
  EXPECT_TRUE(folder.names().empty());
}

TEST(MemoryFails, WhereFormatsAndTextsAreChecked) {
  using enum StatusCode;
  const std::filesystem::path mesh = "a_folder_with_a_name/mesh.ply", odd = "a_folder_with_a_name/model.extension";
  survives("check_mesh_format", [&] { return check_mesh_format(mesh); });
  survives(
      "check_mesh_format, unknown", [&] { return check_mesh_format(odd); }, unsupported);
  survives(
      "check_model_format, unknown", [&] { return check_model_format(odd); }, unsupported);
  const TextCursor text("a token that is no number", "a_file_with_a_long_name.txt");
  const Status error(invalid_argument, "a sentence of more than fifteen bytes");
  survives(
      "TextCursor::expected", [&] { return text.expected("a number of a control point"); }, parse_error);
  survives(
      "TextCursor::failure", [&] { return text.failure("a sentence of more than fifteen bytes"); }, parse_error);
  survives(
      "refused_element", [&] { return refused_element(text, error); }, parse_error);

  const std::filesystem::path part = "a_folder_with_a_long_name/a_part_with_a_long_extension.of_a_part.STEP";
  const std::size_t before = allocation_count();
  EXPECT_TRUE(is_cad_file(part));
  EXPECT_EQ(allocation_count(), before);
}
#endif

}}  // namespace tessera::test
