// Meshes through C: those of C++, byte for byte; updates, files, and shapes at their places.

#include <map>
#include <set>

#include "c/c_objects.h"
#include "support/file_triangles.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"
#include "tessera/tessellation.h"
#include "tessera/tessera_c_shapes.h"

namespace tessera::test { namespace {

Mesh mesh_in_cpp(const std::vector<BezierPatch>& patches, const TessellationOptions& options) {
  const PatchSet set = value_of(PatchSet::make(patches));
  const Tessellation plan = value_of(Tessellation::make(set, options));
  Mesh mesh = value_of(plan.allocate());
  EXPECT_TRUE(plan.run(set, mesh.views()).ok());
  return mesh;
}

void expect_same(const MeshMemory& found, const Mesh& wanted) {
  EXPECT_EQ(found.positions, wanted.positions);
  EXPECT_EQ(found.normals, wanted.normals);
  EXPECT_EQ(found.triangles, wanted.indices);
  EXPECT_EQ(found.patches, wanted.patches);
  EXPECT_EQ(found.quads, wanted.quads);
}

TEST(CMesh, BytesOfCpp) {
  const std::vector<BezierPatch> patches = wavy_field(3, 4);
  const Handle<tsr_set> set = set_of(patches);
  const struct {
    std::uint32_t flags;
    TessellationOptions options;
  } cases[] = {{0, {.tolerance = 1e-3}},
               {TSR_PLAN_RELATIVE, {.tolerance = 1e-3, .relative = true}},
               {TSR_PLAN_QUADS, {.tolerance = 1e-3, .quads = true}},
               {TSR_PLAN_SHARE, {.tolerance = 1e-3, .joining = {.share_vertices = true}}},
               {TSR_PLAN_FEWEST, {.tolerance = 1e-3, .fewest = true}}};
  for (const auto& [flags, options] : cases) {
    const Handle<tsr_plan> plan = plan_of(set.get(), 1e-3, flags);
    MeshMemory memory(plan.get());
    if (flags == TSR_PLAN_SHARE) memory.parameters.clear();
    tsr_mesh mesh = memory.mesh();
    if (flags == TSR_PLAN_SHARE) mesh.parameter = {};
    ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr)) << flags;
    expect_same(memory, mesh_in_cpp(patches, options));
  }
}

using Segment = std::set<std::vector<float>>;

/// The positions of the ends of edges of triangles that no other triangle has, by index.
std::set<Segment> borders_of(const MeshMemory& mesh, const auto& segment) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const std::size_t next = k % 3 == 2 ? k - 2 : k + 1;
    ++uses[std::minmax(mesh.triangles[k], mesh.triangles[next])];
  }
  std::set<Segment> borders;
  for (const auto& [ends, count] : uses)
    if (count == 1) borders.insert(segment(ends.first, ends.second));
  return borders;
}

TEST(CMesh, EdgesOfShapesAsLines) {
  tsr_model* made = nullptr;
  ASSERT_C(tsr_model_join(&made, model_of(wavy_field(2, 2)).get(), 0));
  const Handle<tsr_model> joined(made);
  const Handle<tsr_set> set = set_of(made);
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-3, TSR_PLAN_EDGES);
  MeshMemory memory(plan.get());
  tsr_mesh mesh = memory.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  const auto segment = [&](std::uint32_t from, std::uint32_t to) {
    const float* const p = memory.positions.data();
    return Segment{{p + 3 * from, p + 3 * from + 3}, {p + 3 * to, p + 3 * to + 3}};
  };

  std::size_t count = 0, again = 0;
  ASSERT_C(tsr_plan_edges(plan.get(), nullptr, 0, &count));
  ASSERT_GT(count, 12u);
  std::vector<std::uint32_t> ends(2 * count);
  expect_c_error(tsr_plan_edges(plan.get(), ends.data(), count - 1, &again), TSR_BUFFER_TOO_SMALL, "there are");
  EXPECT_EQ(again, count);
  ASSERT_C(tsr_plan_edges(plan.get(), ends.data(), count, &count));
  std::set<Segment> lines;
  for (std::size_t k = 0; k < count; ++k) lines.insert(segment(ends[2 * k], ends[2 * k + 1]));
  EXPECT_EQ(lines.size(), count);  // every edge once
  EXPECT_EQ(lines, borders_of(memory, segment));
  expect_c_error(tsr_plan_edges(plan_of(set.get(), 1e-3).get(), nullptr, 0, &count), TSR_INVALID_ARGUMENT,
                 "without TSR_PLAN_EDGES");
  tsr_plan_options both;
  tsr_plan_defaults(&both);
  both.tolerance = 1e-3, both.flags = TSR_PLAN_EDGES | TSR_PLAN_APART;
  tsr_plan* none = nullptr;
  expect_c_error(tsr_plan_new(&none, set.get(), &both, nullptr), TSR_INVALID_ARGUMENT, "one of both");
}

TEST(CMesh, OptionsOfEveryKind) {
  const Handle<tsr_set> set = set_of(wavy_field(3, 3));
  tsr_plan_options options;
  tsr_plan_defaults(&options);
  options.angle = 0.1, options.crease_angle = 0.01, options.pixels = 0.5;
  options.eye[2] = 10, options.target[2] = 0, options.target[1] = 0;
  tsr_plan* made = nullptr;
  ASSERT_C(tsr_plan_new(&made, set.get(), &options, nullptr));
  const Handle<tsr_plan> plan(made);
  tsr_plan_info info = sized<tsr_plan_info>();
  ASSERT_C(tsr_plan_describe(plan.get(), &info));
  EXPECT_TRUE(info.is_certified);
  EXPECT_GT(info.angle, 0);
  EXPECT_LE(info.angle, 0.1);
  EXPECT_GT(info.pixels, 0);
  EXPECT_LE(info.pixels, 0.5);
  tsr_plan_defaults(&options);
  options.rate_u = 3, options.rate_v = 5;
  ASSERT_C(tsr_plan_new(&made, set.get(), &options, nullptr));
  const Handle<tsr_plan> uniform(made);
  ASSERT_C(tsr_plan_describe(uniform.get(), &info));
  EXPECT_EQ(info.triangles, 9u * 3 * 5 * 2);
  EXPECT_FALSE(info.is_certified);
  EXPECT_EQ(info.bound, std::numeric_limits<double>::infinity());
}

TEST(CMesh, StridesPlaceRecords) {
  const std::vector<BezierPatch> patches = wavy_field(2, 2);
  const Handle<tsr_plan> plan = plan_of(set_of(patches).get(), 1e-2);
  MeshMemory packed(plan.get());
  const tsr_mesh mesh = packed.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  const std::size_t count = packed.positions.size() / 3;
  std::vector<float> columns(3 * count), records(8 * count);
  tsr_mesh other = mesh;
  other.position = {columns.data(), count, sizeof(float), static_cast<std::int64_t>(count * sizeof(float))};
  other.normal = {records.data() + 4, count, 8 * sizeof(float), sizeof(float)};
  ASSERT_C(tsr_plan_write(plan.get(), &other, nullptr));
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(columns[c * count + k], packed.positions[3 * k + c]);
      EXPECT_EQ(records[8 * k + 4 + c], packed.normals[3 * k + c]);
    }
}

TEST(CMesh, UpdatesFollowEdits) {
  std::vector<BezierPatch> patches = wavy_field(2, 2);
  const Handle<tsr_set> set = set_of(patches);
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-2);
  MeshMemory memory(plan.get());
  tsr_mesh mesh = memory.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  std::vector<Vec3> points(patches[3].points().begin(), patches[3].points().end());
  points[5].z += 1e-3;
  const std::uint32_t patch = 3;
  std::int32_t topology = -1;
  ASSERT_C(tsr_plan_update(plan.get(), &patch, 1, &points[0].x, 16, &mesh, &topology, nullptr));
  EXPECT_EQ(topology, 0);
  std::vector<double> kept(48);
  ASSERT_C(tsr_set_patch(set.get(), 3, nullptr, kept.data(), nullptr));
  EXPECT_EQ(kept[5 * 3 + 2], points[5].z);
  MeshMemory again(plan.get());
  const tsr_mesh anew = again.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &anew, nullptr));
  EXPECT_EQ(memory.positions, again.positions);
  points[5].z += 5;
  ASSERT_C(tsr_plan_update(plan.get(), &patch, 1, &points[0].x, 16, &mesh, &topology, nullptr));
  EXPECT_EQ(topology, 1);
}

TEST(CMesh, FollowsViewsAndTolerancesOfSurfaces) {
  const Handle<tsr_set> set = set_of(wavy_field(2, 2));
  tsr_plan_options options;
  tsr_plan_defaults(&options);
  options.pixels = 0.5;
  options.eye[2] = 30;
  tsr_plan* made = nullptr;
  ASSERT_C(tsr_plan_new(&made, set.get(), &options, nullptr));
  const Handle<tsr_plan> plan(made);
  MeshMemory memory(plan.get());
  const tsr_mesh mesh = memory.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  options.eye[2] = 5;
  ASSERT_C(tsr_plan_set_view(plan.get(), &options));
  std::int32_t topology = 0;
  ASSERT_C(tsr_plan_update(plan.get(), nullptr, 0, nullptr, 0, &mesh, &topology, nullptr));
  EXPECT_EQ(topology, 1);
  tsr_plan_info info = sized<tsr_plan_info>();
  ASSERT_C(tsr_plan_describe(plan.get(), &info));
  EXPECT_GT(info.triangles, 2 * mesh.triangle_count);
  EXPECT_LE(info.pixels, 0.5);
  EXPECT_LE(info.seen_bound, info.bound);
  options.width = 0;
  EXPECT_EQ(tsr_plan_set_view(plan.get(), &options), TSR_INVALID_ARGUMENT);
  EXPECT_EQ(tsr_plan_set_view(plan.get(), nullptr), TSR_INVALID_ARGUMENT);

  tsr_plan_defaults(&options);
  const std::vector<double> tolerances(5, 1e-2);
  options.surface_tolerances = tolerances.data();
  tsr_set_info of_set = sized<tsr_set_info>();
  ASSERT_C(tsr_set_describe(set.get(), &of_set));
  options.surface_tolerance_count = of_set.surfaces;
  options.headroom = 0.5;
  ASSERT_C(tsr_plan_new(&made, set.get(), &options, nullptr));
  const Handle<tsr_plan> other(made);
  ASSERT_C(tsr_plan_describe(other.get(), &info));
  EXPECT_EQ(info.tolerance, 1e-2);
  EXPECT_LE(info.bound, 0.51e-2);
  options.surface_tolerance_count = of_set.surfaces + 1;
  EXPECT_EQ(tsr_plan_new(&made, set.get(), &options, nullptr), TSR_COUNT_MISMATCH);
  options.surface_tolerances = nullptr;
  EXPECT_EQ(tsr_plan_new(&made, set.get(), &options, nullptr), TSR_INVALID_ARGUMENT);
}

TEST(CMesh, ChecksAndFiles) {
  const ScratchFolder folder;
  const Handle<tsr_set> set = set_of(wavy_field(2, 2));
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-2);
  MeshMemory memory(plan.get());
  const tsr_mesh mesh = memory.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  tsr_mesh_report report = sized<tsr_mesh_report>();
  ASSERT_C(tsr_mesh_check(&mesh, &report));
  EXPECT_EQ(report.triangles, mesh.triangle_count);
  EXPECT_GT(report.open_edges, 0u);
  EXPECT_EQ(report.t_junctions, 0u);
  const std::string path = folder / "wavy.ply";
  ASSERT_C(tsr_mesh_save(&mesh, set.get(), path.c_str()));
  const Mesh read = value_of(read_mesh(path));
  EXPECT_EQ(read.triangle_count(), mesh.triangle_count);
  tsr_set_info info = sized<tsr_set_info>();
  ASSERT_C(tsr_set_describe(set.get(), &info));
  EXPECT_NEAR(read.positions[0], memory.positions[0] + info.origin[0], 1e-6);
  expect_c_error(tsr_mesh_save(&mesh, set.get(), (folder / "wavy.xyz").c_str()), TSR_UNSUPPORTED, ".xyz");
}

TEST(CMesh, ShapesAtTheirPlaces) {
  const ScratchFolder folder;
  const Handle<tsr_model> model = model_of(wavy_field(1, 2));
  tsr_model* made = nullptr;
  ASSERT_C(tsr_model_join(&made, model.get(), 0));
  const Handle<tsr_model> joined(made);
  tsr_model_info info = sized<tsr_model_info>();
  ASSERT_C(tsr_model_describe(joined.get(), &info));
  EXPECT_EQ(info.shapes, 1u);
  EXPECT_EQ(info.instances, 1u);
  const Handle<tsr_set> set = set_of(joined.get(), 0, 0);
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-2);
  MeshMemory memory(plan.get());
  const tsr_mesh mesh = memory.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  const tsr_mesh* const meshes[] = {&mesh};
  const tsr_set* const sets[] = {set.get()};
  const std::string path = folder / "two.glb";
  ASSERT_C(tsr_model_save_meshes(joined.get(), meshes, sets, 1, path.c_str()));
  EXPECT_EQ(value_of(read_mesh(path)).triangle_count(), mesh.triangle_count);
  expect_c_error(tsr_model_save_meshes(joined.get(), meshes, sets, 2, path.c_str()), TSR_COUNT_MISMATCH, "1 shapes");
  expect_c_error(tsr_model_save_meshes(model.get(), meshes, sets, 1, path.c_str()), TSR_INVALID_ARGUMENT, "no shapes");
}

TEST(CMesh, FilesFarFromZeroKeepTheBoundAndTheirRounding) {
  const char ball[] =
      R"({"format": "tessera", "version": 1, "surfaces": [{"kind": "sphere", "radius": 1,
          "axis": {"origin": [12958095.124851028, 4865499.469870342, 0]}}]})";
  tsr_model* read = nullptr;
  ASSERT_C(tsr_model_parse(&read, ball, sizeof ball - 1, "ball"));
  const Handle<tsr_model> model(read);
  const Handle<tsr_set> set = set_of(model.get());
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-2);
  tsr_plan_info info = sized<tsr_plan_info>();
  ASSERT_C(tsr_plan_describe(plan.get(), &info));
  MeshMemory memory(plan.get());
  const tsr_mesh mesh = memory.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  const ScratchFolder folder;
  for (const std::string name : {"a.stl", "a.obj", "a.ply", "a.glb"}) {
    double rounding = -1;
    ASSERT_C(tsr_mesh_rounding(&mesh, set.get(), name.c_str(), &rounding)) << name;
    ASSERT_C(tsr_mesh_save(&mesh, set.get(), (folder / name).c_str())) << name;
    const double found =
        distance_from_sphere(triangles_of_file(folder / name), {12958095.124851028, 4865499.469870342, 0}, 1);
    EXPECT_LE(found, info.bound + rounding + 1e-8) << name;
    EXPECT_EQ(rounding > 0.01, name == "a.stl") << name;
  }
  double kept = 7;
  expect_c_error(tsr_mesh_rounding(&mesh, set.get(), "a.xyz", &kept), TSR_UNSUPPORTED, ".xyz");
  expect_c_error(tsr_mesh_rounding(&mesh, set.get(), "a.stl", nullptr), TSR_INVALID_ARGUMENT, "rounding is a null");
  EXPECT_EQ(kept, 7);
}

}}  // namespace tessera::test
