// Memory that runs out where shapes are checked, joined, meshed and written.

#include "robustness/memory_failure.h"
#include "tess_trim/closed_shape.h"
#include "tessera/edge_matching.h"
#include "tessera/mesh_assembly.h"
#include "tessera/topology.h"
#ifdef TESSERA_HAS_IO
#include "support/scratch_folder.h"
#include "tessera/io.h"
#endif

namespace tessera::test { namespace {

using enum StatusCode;

TEST(MemoryFails, WhereTopologyIsChecked) {
  Model model{.name = "m", .surfaces = {}, .shapes = {joined(cube(), 1e-6)}};
  model.instances = {{.name = std::string("an instance with a long name")}};
  model.surfaces = value_of(placed_faces(model.shapes, model.instances));
  const Shape& shape = model.shapes[0];
  survives("check_topology", [&] { return check_topology(model); });
  survives("placed_faces", [&] { return placed_faces(model.shapes, model.instances); });
  survives("edge_uses", [&] { return edge_uses(shape); });
  survives("closed_shells", [&] { return closed_shells(shape); });
  survives("edge_gaps", [&] { return edge_gaps(shape); });
  survives("instances_of", [&] { return instances_of(model); });
  Model lost = model;
  lost.instances[0].shape = 1;
  lost.shapes[0].edges[7].end = 99;
  survives(
      "check_topology, ids", [&] { return check_topology(lost); }, invalid_argument);
  survives(
      "make_patch_set(shape), ids", [&] { return make_patch_set(lost.shapes[0]); }, invalid_argument);
  survives(
      "joined_edges, ids", [&] { return joined_edges(lost.shapes[0], 1e-6); }, invalid_argument);
  survives(
      "instances_of, ids", [&] { return instances_of(lost); }, invalid_argument);
}

TEST(MemoryFails, WhereEdgesAreJoined) {
  const std::vector<ModelSurface> faces = one_against_three(0.3, 0.7, 1e-4);
  Shape loose;
  for (const ModelSurface& face : faces) loose.faces.push_back({face});
  survives("joining_distance", [&] { return joining_distance(loose); });
  survives("joined_shape", [&] { return joined_shape(faces, 1e-3); });
  const Shape apart = value_of(joined_shape(faces, 1e-6));  // all edges of one use
  survives("joined_edges", [&] { return joined_edges(apart, 1e-3); });
  survives(
      "joined_edges, distance", [&] { return joined_edges(apart, -1); }, invalid_argument);
}

TEST(MemoryFails, WhereShapesAreMeshed) {
  const Shape shape = joined(drilled_plate(), 1e-6);
  survives("make_patch_set(shape)", [&] { return make_patch_set(shape); });
  const PatchSet set = value_of(make_patch_set(shape));
  survives("Tessellation::make, shape", [&] { return Tessellation::make(set, {.tolerance = 0.3}); });
  const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 0.3}));
  Mesh mesh = value_of(plan.allocate());
  survives("Tessellation::run, shape", [&] { return plan.run(set, mesh.views()); });
  survives("parts_by_face", [&] { return parts_by_face(mesh, set, shape); });
  EXPECT_TRUE(value_of(check(mesh)).closed());
}

TEST(MemoryFails, WhereAssembliesAreWritten) {
  const ShapeMesh made = mesh_of(joined(cube(), 1e-6), {.tolerance = 0.1});
  MeshAssembly assembly{.name = "assembly", .shapes = {{"cube", made.mesh}}, .unit = "mm"};
  assembly.instances = {{.name = "one"}, {.name = "two", .placement = Affine::translated({2, 0, 0})}};
  assembly.instances.push_back({.name = "sheared", .placement = {.columns = {Vec3{1, 0, 0}, {1, 1, 0}, {0, 0, 1}}}});
  survives("flatten", [&] { return flatten(assembly); });
#ifdef TESSERA_HAS_IO
  const ScratchFolder folder;
  for (const char* const name : {"a.obj", "a.ply", "a.stl", "a.glb", "a.gltf"}) {
    const std::filesystem::path path = folder / name;
    survives(std::string("write_assembly ") + name, [&] { return write_assembly(assembly, path); });
  }
  EXPECT_LE(folder.names().size(), 6u);  // .gltf has a file of numbers beside it
#endif
  assembly.instances[1].placement.translation.x = 1e300;
  survives(
      "flatten, too far", [&] { return flatten(assembly); }, non_finite);
}

}}  // namespace tessera::test
