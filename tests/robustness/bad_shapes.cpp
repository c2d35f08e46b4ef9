// Shapes, their edges and their meshes: ids of nothing, positions that are no numbers, edges that fit no face.

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "robustness/bad_assemblies.h"
#include "robustness/bad_input.h"
#include "tess_trim/closed_shape.h"
#include "tessera/edge_matching.h"
#include "tessera/mesh_assembly.h"
#include "tessera/parametric_surface.h"
#include "tessera/topology.h"

namespace tessera::test {
namespace {

using enum StatusCode;
using Change = std::function<void(Shape&)>;

/// A cube of 6 faces, 12 edges and 8 vertices.
Shape sound_cube() {
  Shape shape = joined(cube(), 1e-6);
  shape.name = std::string("cube");
  return shape;
}

Shape changed(Shape shape, const Change& change) {
  change(shape);
  return shape;
}

/// The loops of a face that name edges, to be changed.
std::vector<TrimLoop> loops_of(const ShapeFace& face) { return edge_loops(face); }
void set_loops(ShapeFace& face, std::vector<TrimLoop> loops) {
  (face.trims->empty() ? face.outline : face.trims) = std::move(loops);
}
void change_loop(Shape& shape, std::size_t face, const std::function<void(TrimLoop&)>& change) {
  std::vector<TrimLoop> loops = loops_of(shape.faces[face]);
  change(loops[0]);
  set_loops(shape.faces[face], std::move(loops));
}

/// A shape, sound except for the change of each row, that check_topology() refuses.
void bad_ids(const std::function<void(const std::string&, const Change&)>& row) {
  row("NaN in a vertex", [](Shape& s) { s.vertices[3].position.y = not_a_number; });
  row("a vertex at infinity", [](Shape& s) { s.vertices[3].position.z = -infinity; });
  row("a vertex with a tolerance of NaN", [](Shape& s) { s.vertices[0].tolerance = not_a_number; });
  row("a vertex with a negative tolerance", [](Shape& s) { s.vertices[0].tolerance = -1e-9; });
  row("a vertex with an infinite tolerance", [](Shape& s) { s.vertices[0].tolerance = infinity; });
  row("an edge from vertex 8 of 8", [](Shape& s) { s.edges[2].start = 8; });
  row("an edge to vertex 4294967294", [](Shape& s) { s.edges[2].end = no_id - 1; });
  row("an edge with an empty range", [](Shape& s) { s.edges[5].range = {1, 1}; });
  row("an edge with a reversed range", [](Shape& s) { s.edges[5].range = {1, 0}; });
  row("an edge with a range of NaN", [](Shape& s) { s.edges[5].range = {0, not_a_number}; });
  row("an edge with an infinite range", [](Shape& s) { s.edges[5].range = {-infinity, 0}; });
  row("an edge whose range overflows", [](Shape& s) { s.edges[5].range = {-1.5e308, 1.5e308}; });
  row("an edge with a tolerance of NaN", [](Shape& s) { s.edges[0].tolerance = not_a_number; });
  row("an edge with a negative tolerance", [](Shape& s) { s.edges[0].tolerance = -1; });
  row("a coedge of edge 12 of 12",
      [](Shape& s) { change_loop(s, 1, [](TrimLoop& loop) { loop.coedges[2].edge = 12; }); });
  row("a coedge of no edge", [](Shape& s) { change_loop(s, 1, [](TrimLoop& loop) { loop.coedges[2] = {}; }); });
  row("a coedge too few", [](Shape& s) { change_loop(s, 1, [](TrimLoop& loop) { loop.coedges.pop_back(); }); });
  const auto states = [&](const std::string& input, const Vec3& from, const Vec3& to) {
    row(input, [=](Shape& s) {
      change_loop(s, 1, [&](TrimLoop& loop) { loop.coedges[0].parameter = space_line(from, to); });
    });
  };
  states("parameters of a coedge that leave its curve", {-5, 0, 0}, {7, 0, 0});
  states("parameters of a coedge that stand still", {0.5, 0, 0}, {0.5, 0, 0});
  states("parameters of a coedge that run back", {1, 0, 0}, {0, 0, 0});
  row("no edges", [](Shape& s) { s.edges.clear(); });
  row("no vertices", [](Shape& s) { s.vertices.clear(); });
  row("a shell with face 6 of 6", [](Shape& s) { s.shells[0].faces[0] = 6; });
  row("a shell of solid 1 of 1", [](Shape& s) { s.shells[0].solid = 1; });
}

void topology(Table& table) {
  const Shape cube = sound_cube();
  table.of("check_topology(shape)");
  table.gives("a cube", "accepted", check_topology(cube).ok());
  table.gives("nothing", "accepted", check_topology(Shape()).ok());
  bad_ids([&](const std::string& input, const Change& change) {
    table.row(input, invalid_argument, check_topology(changed(cube, change)));
  });

  table.of("check_topology(model), make_patch_set(model), placed_faces(shapes, instances)");
  Model sound{.name = "two", .surfaces = {}, .shapes = {cube}};
  sound.instances = {{.name = std::string("left")}, {.first_surface = 6, .name = std::string("right")}};
  sound.surfaces = value_of(placed_faces(sound.shapes, sound.instances));
  const auto row = [&](const std::string& input, const std::function<void(Model&)>& change) {
    Model model = sound;
    change(model);
    table.row(input, invalid_argument, check_topology(model));
    const Status same = make_patch_set(model).status();
    EXPECT_EQ(same.message(), check_topology(model).message()) << input;
  };
  row("an instance of shape 1 of 1", [](Model& m) { m.instances[1].shape = 1; });
  row("an instance that begins at a wrong face", [](Model& m) { m.instances[1].first_surface = 5; });
  row("a face too few", [](Model& m) { m.surfaces.pop_back(); });
  row("a face too many", [](Model& m) { m.surfaces.push_back(m.surfaces[0]); });
  row("a shape with an edge to vertex 8 of 8", [](Model& m) { m.shapes[0].edges[1].end = 8; });
  sound.instances[1].shape = 1;
  table.row("placed_faces: an instance of shape 1 of 1", invalid_argument, placed_faces(sound.shapes, sound.instances));
}

void edges(Table& table) {
  const Shape cube = sound_cube();
  table.of("edge_gaps(shape, samples)");
  table.row("one sample", invalid_argument, edge_gaps(cube, 1));
  table.row("-1 samples", invalid_argument, edge_gaps(cube, -1));
  table.row("a face placed at NaN", non_finite, edge_gaps(changed(cube, [](Shape& s) {
              s.faces[1].placement = Affine::translated({0, not_a_number, 0});
            })));
  table.gives("nothing", "no gaps", value_of(edge_gaps({})).empty());

  table.of("joined_edges(shape, distance)");
  for (const auto& [input, distance] :
       {std::pair("a distance of 0", 0.0), std::pair("a negative distance", -1e-6),
        std::pair("a distance of NaN", not_a_number), std::pair("an infinite distance", infinity)})
    table.row(input, invalid_argument, joined_edges(cube, distance));
  bad_ids([&](const std::string& input, const Change& change) {
    const Shape bad = changed(cube, change);
    EXPECT_EQ(joined_edges(bad, 1e-6).status().message(), check_topology(bad).message()) << input;
  });
  table.says("a shape that check_topology() refuses", "its answer, for each row of it");
  table.row("a face placed at NaN", non_finite,
            joined_edges(changed(cube,
                                 [](Shape& s) {
                                   s.faces[1].placement = Affine::translated({0, not_a_number, 0});
                                   set_loops(s.faces[1], {});
                                 }),
                         1e-6));
  table.gives("a distance of 1e300", "every edge is a point", [&] {
    const Result<Shape> made = joined_shape(test::cube(), 1e300);
    return made && check_topology(*made).ok() &&
           std::ranges::all_of(made->edges, [](const BrepEdge& edge) { return edge.degenerate; });
  }());
  table.gives("a distance of 1e-300", "edges with equal points are joined", [&] {
    const Result<Shape> made = joined_shape(test::cube(), 1e-300);
    return made && closed_count(*made) == 1;
  }());

  table.of("joining_distance(shape), joined_shape(surfaces, distance)");
  table.gives("nothing", "a distance of 0, and a shape without faces",
              value_of(joining_distance({})) == 0 && value_of(joined_shape({}, 1)).faces.empty());
  std::vector<ModelSurface> faces = test::cube();
  table.row("surfaces, a distance of NaN", invalid_argument, joined_shape(faces, not_a_number));
  faces[2].placement = Affine::scaled({infinity, 1, 1});
  table.row("a surface with an infinite placement", non_finite, joined_shape(faces, 1e-6));
  faces[2] = {.name = std::string("hole"),
              .surface = value_of(ParametricSurface::make({.position = [](double u, double v) {
                const bool corner = (u == 0 || u == 1) && (v == 0 || v == 1);
                return Vec3{corner ? 0 : not_a_number, 0, 0};
              }}))};
  table.row("a function that gives NaN", non_finite, joined_shape(faces, 1e-6));
  Shape hollow;
  for (const ModelSurface& face : faces) hollow.faces.push_back({face});
  table.row("the same, the distance", non_finite, joining_distance(hollow));
  table.row("a coedge of edge 12 of 12, the distance", invalid_argument, joining_distance(changed(cube, [](Shape& s) {
              change_loop(s, 1, [](TrimLoop& loop) { loop.coedges[2].edge = 12; });
              set_loops(s.faces[2], {});
            })));
}

/// The word for a mesh of the shape: its faults if there are any that no shape may have.
std::string mesh_of_odd(const Shape& shape) {
  const Result<PatchSet> set = make_patch_set(shape);
  if (!set) return "no set: " + set.status().message();
  const Result<Tessellation> plan = Tessellation::make(*set, {.tolerance = 0.01});
  if (!plan) return "no plan: " + plan.status().message();
  Mesh mesh = value_of(plan->allocate());
  const Status status = plan->run(*set, mesh.views());
  if (!status.ok()) return "no mesh: " + status.message();
  const MeshReport report = value_of(check(mesh));
  if (report.non_finite_vertices > 0 || !std::isfinite(plan->bound()) || !std::isfinite(plan->gap()))
    return "a mesh that is not finite";
  if (report.open_edges > 0)
    return plan->open_edges() > 0 ? "a mesh with open edges"
                                  : "a mesh with open edges, which open_edges() does not count";
  if (report.non_manifold_edges > 0) return "a mesh with edges of more than two triangles";
  return plan->gap() > 1e-6 ? "a closed mesh, and a gap" : "a closed mesh";
}

void meshes(Table& table) {
  table.of("make_patch_set(shape), Tessellation::make(), run()");
  const Shape cube = sound_cube();
  table.row("no faces", invalid_argument, make_patch_set(Shape()));
  bad_ids([&](const std::string& input, const Change& change) {
    const Shape bad = changed(cube, change);
    EXPECT_EQ(make_patch_set(bad).status().message(), check_topology(bad).message()) << input;
  });
  table.says("a shape that check_topology() refuses", "its answer, for each row of it");
  table.row("a face placed at NaN", non_finite, make_patch_set(changed(cube, [](Shape& s) {
              s.faces[1].placement = Affine::scaled({1, not_a_number, 1});
            })));

  const auto odd = [&](const std::string& input, const std::string& expected, const Change& change) {
    const std::string found = mesh_of_odd(changed(cube, change));
    EXPECT_EQ(found, expected) << input;
    table.gives(input, found, found == expected);
  };
  const std::string closed = "a closed mesh", gap = "a closed mesh, and a gap", open = "a mesh with open edges",
                    uncounted = "a mesh with open edges, which open_edges() does not count",
                    many = "a mesh with edges of more than two triangles";
  odd("the cube", closed, [](Shape&) {});
  odd("a vertex that lies elsewhere", closed, [](Shape& s) { s.vertices[3].position = {9, 9, 9}; });
  odd("a vertex at 1e300", closed, [](Shape& s) { s.vertices[3].position.x = 1e300; });
  odd("tolerances of 1e300", closed, [](Shape& s) {
    for (BrepVertex& vertex : s.vertices) vertex.tolerance = 1e300;
    for (BrepEdge& edge : s.edges) edge.tolerance = 1e300;
  });
  odd("edges without vertices", closed, [](Shape& s) {
    for (BrepEdge& edge : s.edges) edge.start = edge.end = no_id;
    s.vertices.clear();
  });
  odd("edges that all end at one vertex", gap, [](Shape& s) {
    for (BrepEdge& edge : s.edges) edge.start = edge.end = 0;
  });
  odd("edges without curves, all of them points", gap, [](Shape& s) {
    for (BrepEdge& edge : s.edges) edge.curve.reset(), edge.degenerate = true;
  });
  odd("an edge range that is not that of its curves", closed, [](Shape& s) { s.edges[0].range = {100, 101}; });
  odd("an edge of 1e-300", closed, [](Shape& s) { s.edges[0].range = {0, 1e-300}; });
  odd("all coedges reversed", gap, [](Shape& s) {
    for (std::size_t k = 0; k < 6; ++k)
      change_loop(s, k, [](TrimLoop& loop) {
        for (Coedge& coedge : loop.coedges) coedge.reversed = !coedge.reversed;
      });
  });
  odd("one coedge reversed", gap, [](Shape& s) {
    change_loop(s, 1, [](TrimLoop& loop) { loop.coedges[0].reversed = !loop.coedges[0].reversed; });
  });
  odd("a face whose coedges are all of edge 0", uncounted, [](Shape& s) {
    change_loop(s, 1, [](TrimLoop& loop) {
      for (Coedge& coedge : loop.coedges) coedge.edge = 0;
    });
  });
  odd("all coedges of edge 0", gap, [](Shape& s) {
    for (std::size_t k = 0; k < 6; ++k)
      change_loop(s, k, [](TrimLoop& loop) {
        for (Coedge& coedge : loop.coedges) coedge.edge = 0;
      });
  });
  odd("a loop twice", open, [](Shape& s) {
    std::vector<TrimLoop> loops = loops_of(s.faces[1]);
    loops.push_back(loops[0]);
    set_loops(s.faces[1], loops);
  });
  odd("an outline without curves", closed, [](Shape& s) { set_loops(s.faces[1], {{}}); });
  odd("a face without loops", closed, [](Shape& s) { set_loops(s.faces[1], {}); });
  odd("a face twice: edges of three faces", many, [](Shape& s) { s.faces.push_back(s.faces[1]); });
  odd("a face that is far away", gap, [](Shape& s) { s.faces[1].placement = Affine::translated({1e3, 0, 0}); });
  odd("a face that is a point", open, [](Shape& s) { s.faces[1].placement = Affine::scaled({0, 0, 0}); });
  odd("a face that is a line", open, [](Shape& s) { s.faces[1].placement = Affine::scaled({1, 0, 0}); });
}

void assemblies(Table& table) {
  table.of("instances_of(model), parts_by_face(mesh, set, shape)");
  Model model{.name = "m", .surfaces = {}, .shapes = {sound_cube()}};
  model.instances = {{.shape = 1, .name = std::string("left")}};
  table.row("an instance of shape 1 of 1", invalid_argument, instances_of(model));
  const PatchSet set = value_of(make_patch_set(model.shapes[0]));
  const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = 0.1}));
  Mesh sound = value_of(plan.allocate());
  ASSERT_TRUE(plan.run(set, sound.views()).ok());
  const auto row = [&](const std::string& input, StatusCode code, const std::function<void(Mesh&, Shape&)>& change) {
    Mesh mesh = sound;
    Shape shape = model.shapes[0];
    change(mesh, shape);
    table.row(input, code, parts_by_face(mesh, set, shape));
  };
  row("a patch too few", count_mismatch, [](Mesh& m, Shape&) { m.patches.pop_back(); });
  row("patch 6 of 6", invalid_argument, [](Mesh& m, Shape&) { m.patches[3] = 6; });
  row("a shape with a face less", invalid_argument, [](Mesh&, Shape& s) { s.faces.pop_back(); });

  table.of("flatten(assembly)");
  bad_assemblies([&](const std::string& input, StatusCode code, const MeshAssembly& assembly) {
    table.row(input, code, flatten(assembly));
  });
  const auto is_sound = [](const MeshAssembly& assembly) {
    const Result<Mesh> flat = flatten(assembly);
    return flat && value_of(check(*flat)).non_finite_vertices == 0;
  };
  table.gives("nothing", "an empty mesh", value_of(flatten({})).positions.empty());
  odd_placements([&](const std::string& input, const MeshAssembly& assembly) {
    table.gives(input, "accepted", is_sound(assembly));
  });
}

}  // namespace

void fill_shapes(Table& table) {
  topology(table);
  edges(table);
  meshes(table);
  assemblies(table);
}

}  // namespace tessera::test
