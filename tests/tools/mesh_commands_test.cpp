// tessera info, tessellate and check.

#include <cmath>

#include "tessera/io.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using MeshTools = ToolTest;

TEST_F(MeshTools, InfoSaysWhatTheTeapotIs) {
  const json facts = json::parse(output_of({"info", teapot, "--json"}));
  EXPECT_EQ(facts["name"], "teapot");
  EXPECT_EQ(facts["surfaces"], 32);
  EXPECT_EQ(facts["patches"], 32);
  EXPECT_EQ(facts["kinds"], json::parse(R"({"Bezier patch": 32})"));
  EXPECT_EQ(facts["fit_error"]["distance"], 0);
  EXPECT_EQ(facts["degrees"], json::parse(R"([{"degree_u": 3, "degree_v": 3, "patches": 32}])"));
  EXPECT_EQ(facts["rational_patches"], 0);
  EXPECT_EQ(facts["collapsed_sides"], 8);
  EXPECT_EQ(facts["control_points"], 512);
  EXPECT_EQ(facts["box"]["lower"], json::parse("[-3.0, -2.0, 0.0]"));
  EXPECT_EQ(facts["box"]["upper"], json::parse("[3.525, 2.0, 3.15]"));
  EXPECT_GE(facts["memory_bytes"]["blocks"], 512u * 3 * sizeof(float));
  EXPECT_FALSE(facts["isa"]["available"].empty());
  const std::string text = output_of({"info", teapot});
  EXPECT_NE(text.find("32 of 3 x 3"), std::string::npos) << text;
}

TEST_F(MeshTools, WhatIsNotReadIsSaidOnceByEveryCommand) {
  folder_.file("m.bv", "3 1\n0 0 0\n1 0 0\n0 1 0\n4 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n1\n0 0\n");
  const std::string warnings =
      "tessera: warning: m.bv:1: 1 triangular patch is not read\n"
      "tessera: warning: m.bv:10: 1 polyhedron is not read\n";
  for (const std::vector<std::string>& command :
       {Names{"info", "m.bv"}, Names{"info", "m.bv", "--json"}, Names{"eval", "m.bv", "--grid", "2x2"},
        Names{"tessellate", "m.bv", "-o", "a.ply", "--grid", "2x2", "--json"},
        Names{"raycast", "m.bv", "-o", "a.png", "--size", "16x16"}}) {
    const ToolRun result = run(command);
    EXPECT_EQ(result.status, 0) << command[0];
    EXPECT_EQ(result.errors, warnings) << command[0];
    if (command.back() != "--json") continue;
    const json said = json::parse(result.output)["warnings"];
    EXPECT_EQ(said, json({"m.bv:1: 1 triangular patch is not read", "m.bv:10: 1 polyhedron is not read"}));
  }
}

TEST_F(MeshTools, AFileReadWholeHasNoWarnings) {
  EXPECT_EQ(json::parse(output_of({"info", teapot, "--json"}))["warnings"], json::array());
}

TEST_F(MeshTools, InfoCountsDegrees) {
  folder_.file("m.bpt", "2\n1 1\n0 0 0 0 1 0 1 0 0 1 1 0\n1 2\n0 0 0 0 1 0 0 2 0 1 0 0 1 1 0 1 2 0\n");
  const json facts = json::parse(output_of({"info", "m.bpt", "--json"}));
  EXPECT_EQ(facts["degrees"], json::parse(R"([{"degree_u": 1, "degree_v": 1, "patches": 1},
                                              {"degree_u": 1, "degree_v": 2, "patches": 1}])"));
  EXPECT_EQ(facts["control_points"], 10);
}

TEST_F(MeshTools, TheTeapotBecomesAMeshOfTheRightSize) {
  constexpr std::size_t n = 4, m = 6, patches = 32, poles = 8;
  for (const char* name : {"a.ply", "a.obj"}) {
    const json facts = json::parse(output_of({"tessellate", teapot, "-o", name, "--grid", "4x6", "--json"}));
    EXPECT_EQ(facts["output"], name);
    EXPECT_EQ(facts["vertices"], patches * (n + 1) * (m + 1));
    EXPECT_EQ(facts["triangles"], patches * 2 * n * m - poles * m);  // one triangle of each quad at a pole is left out
    const Result<Mesh> mesh = read_mesh(folder_ / name);
    ASSERT_TRUE(mesh.ok()) << mesh.status().message();
    EXPECT_EQ(facts["vertices"], mesh->vertex_count());
    EXPECT_EQ(facts["triangles"], mesh->triangle_count());
    EXPECT_EQ(mesh->normals.size(), mesh->positions.size());
    EXPECT_EQ(mesh->parameters.size(), 2 * mesh->vertex_count());
  }
  const std::string text = output_of({"tessellate", teapot, "-o", "a.ply", "--grid", "4x6"});
  EXPECT_EQ(text.rfind("a.ply: 1120 vertices, 1488 triangles", 0), 0u) << text;
  EXPECT_EQ(folder_.names(), (Names{"a.obj", "a.ply"}));
}

TEST_F(MeshTools, VerticesLieOnTheSurfacesAtTheirPlace) {
  output_of({"tessellate", teapot, "-o", "a.ply", "--grid", "3x5"});
  const Result<Mesh> mesh = read_mesh(folder_ / "a.ply");
  const Result<Model> model = read_model(teapot);
  ASSERT_TRUE(mesh.ok() && model.ok());
  for (std::size_t k = 0; k < mesh->vertex_count(); ++k) {
    const BezierPatch& patch = std::get<BezierPatch>(model->surfaces[k / 24].surface);
    const Vec3 expected = de_casteljau(patch, static_cast<double>(k / 6 % 4) / 3, static_cast<double>(k % 6) / 5);
    const Vec3 vertex{mesh->positions[3 * k], mesh->positions[3 * k + 1], mesh->positions[3 * k + 2]};
    EXPECT_LE(length(vertex - expected), 2e-6) << k;  // a few units of float, at coordinates up to 3.5
  }
}

TEST_F(MeshTools, BothFormatsHoldTheSameMesh) {
  output_of({"tessellate", teapot, "-o", "a.ply", "--grid", "5x5"});
  output_of({"tessellate", teapot, "-o", "a.obj", "--grid", "5x5"});
  const Result<Mesh> ply = read_mesh(folder_ / "a.ply"), obj = read_mesh(folder_ / "a.obj");
  ASSERT_TRUE(ply.ok() && obj.ok());
  EXPECT_EQ(ply->positions, obj->positions);
  EXPECT_EQ(ply->normals, obj->normals);
  EXPECT_EQ(ply->parameters, obj->parameters);
  EXPECT_EQ(ply->indices, obj->indices);
}

TEST_F(MeshTools, WeldingClosesPolesAndSeamsOfRealFiles) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::string file = std::string(data) + "/rib_nupatch/trimmed_nupatch_sphere.rib";
  for (const char* const relative : {"0.03", "0.01", "0.003", "0.001", "0.0003"}) {
    const ToolRun made = run({"tessellate", file, "-o", "a.ply", "--relative", relative, "--json"});
    ASSERT_EQ(made.status, 0) << made.errors;
    EXPECT_EQ(json::parse(made.output)["welded_borders"], 8);  // at its poles
    EXPECT_EQ(json::parse(made.output)["open_edges"], 0);
    const json mesh = json::parse(output_of({"check", "a.ply", "--json"}));
    EXPECT_EQ(mesh["closed"], true) << relative;
    EXPECT_EQ(mesh["degenerate_triangles"], 0) << relative;
  }
}

TEST_F(MeshTools, WeldingClosesRealBodiesWhosePatchesAreRounded) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const char* const name : {"/bezierview_bv/SurfLab__cubeg2.bv", "/bezierview_bv/SurfLab__twg2.bv"})
    for (const std::string relative : {"0.03", "0.01", "0.003"}) {
      const Names command{"tessellate", data + std::string(name), "-o", "a.ply", "--relative", relative};
      Names apart = command;
      apart.insert(apart.end(), {"--weld", "0", "--json"});
      const json open_edges = json::parse(output_of(apart))["open_edges"];
      EXPECT_GE(open_edges, json::parse(output_of({"check", "a.ply", "--json"}))["open_edges"]);
      EXPECT_TRUE(relative != "0.003" || open_edges > 0);  // coarse borders have corners alone, which do meet
      EXPECT_NE(output_of(command).find(", closed\n"), std::string::npos);
      const json mesh = json::parse(output_of({"check", "a.ply", "--json"}));
      EXPECT_EQ(mesh["closed"], true) << name << ' ' << relative;
      EXPECT_EQ(mesh["degenerate_triangles"], 0) << name << ' ' << relative;
      EXPECT_EQ(2 * mesh["distinct_positions"].get<int>(), mesh["triangles"].get<int>() + 4);
    }
}

TEST_F(MeshTools, WeldsAreLengths) {
  for (const char* const wrong : {"-1", "nan", "inf", "x", "auto", "1,2", ""})
    expect_failure({"tessellate", teapot, "-o", "d.ply", "--tolerance", "1", "--weld", wrong}, 2, "--weld");
  const json made =
      json::parse(output_of({"tessellate", teapot, "-o", "a.ply", "--tolerance", "0.01", "--weld", "1e-5", "--json"}));
  EXPECT_EQ(made["weld"], 1e-5);
  EXPECT_EQ(made["welded_borders"], 0);
}

TEST_F(MeshTools, AFailureLeavesTheOldMesh) {
  folder_.file("a.ply", "before");
  folder_.file("bad.bpt", "1\n3 3\n");
  expect_failure({"tessellate", "bad.bpt", "-o", "a.ply", "--grid", "2x2"}, 1, "bad.bpt:2:");
  EXPECT_EQ(content_of(folder_ / "a.ply"), "before");
}

TEST_F(MeshTools, CheckCounts) {
  // A tetrahedron is closed. Without one face it has three open edges; with a fin on one edge, a non-manifold one.
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 2 2\n";
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\n";
  folder_.file("closed.obj", corners + faces + "f 1 4 3\n");
  folder_.file("open.obj", corners + faces);
  folder_.file("fin.obj", corners + faces + "f 1 4 3\nf 1 2 5\n");
  folder_.file("flat.obj", corners + faces + "f 1 4 3\nf 1 1 2\n");
  const json closed = json::parse(output_of({"check", "closed.obj", "--json"}));
  EXPECT_EQ(closed["closed"], true);
  EXPECT_EQ(closed["open_edges"], 0);
  EXPECT_EQ(closed["triangles"], 4);
  EXPECT_EQ(closed["inconsistent_edges"], 0);
  const json open = json::parse(output_of({"check", "open.obj", "--json"}));
  EXPECT_EQ(open["closed"], false);
  EXPECT_EQ(open["open_edges"], 3);
  const json fin = json::parse(output_of({"check", "fin.obj", "--json"}));
  EXPECT_EQ(fin["non_manifold_edges"], 1);
  EXPECT_EQ(fin["open_edges"], 2);
  const json flat = json::parse(output_of({"check", "flat.obj", "--json"}));
  EXPECT_EQ(flat["degenerate_triangles"], 1);
  const std::string text = output_of({"check", "open.obj"});
  EXPECT_EQ(text.rfind("open.obj: not closed\n", 0), 0u) << text;
}

TEST_F(MeshTools, CheckRefusesNaNAndBadIndices) {
  folder_.file("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const ToolRun nan = run({"check", "nan.obj", "--json"});
  EXPECT_EQ(nan.status, 1);
  EXPECT_EQ(json::parse(nan.output)["non_finite_vertices"], 1);
  EXPECT_EQ(nan.errors, "tessera: nan.obj: 1 vertex with NaN or infinity\n");
  folder_.file("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  expect_failure({"check", "index.obj"}, 1,
                 "tessera: index.obj:4: expected an index into the vertices above, 1 to 3 or -3 to -1, found \"4\"");
  folder_.file("empty.ply", "");
  expect_failure({"check", "empty.ply"}, 1, "tessera: empty.ply: the file is empty");
  expect_failure({"check", teapot}, 1, "meshes are read as .obj, .ply, .stl, .glb, .gltf");
  expect_failure({"check", "missing.ply"}, 1, "tessera: missing.ply: cannot be opened");
}

TEST_F(MeshTools, NeighbourPatchesShareBordersInTheFiles) {
  // Two bicubic patches that share a border: the seam must not count as open, whatever origin was added.
  folder_.file("pair.bpt",
               "2\n1 2\n100.1 0 0  100.3 1 0.7  100.1 2 0  101.7 0 0.3  101.1 1 0.1  101.3 2 0\n"
               "1 2\n101.7 0 0.3  101.1 1 0.1  101.3 2 0  103 0 0  103 1 0.9  103.3 2 0.1\n");
  for (const char* name : {"a.ply", "a.obj"}) {
    output_of({"tessellate", "pair.bpt", "-o", name, "--grid", "7x9"});
    const json report = json::parse(output_of({"check", name, "--json"}));
    EXPECT_EQ(report["open_edges"], 2 * 9 + 4 * 7);
    EXPECT_EQ(report["non_manifold_edges"], 0);
    EXPECT_EQ(report["degenerate_triangles"], 0);
  }
}

TEST_F(MeshTools, TolerancesAndBudgets) {
  const json fine = json::parse(output_of({"tessellate", teapot, "-o", "a.ply", "--tolerance", "0.001", "--json"}));
  EXPECT_LE(fine["bound"], 0.001);
  EXPECT_EQ(fine["certified"], true);
  EXPECT_FALSE(fine.contains("rate_u"));
  const json coarse = json::parse(output_of({"tessellate", teapot, "-o", "b.ply", "--triangles", "5000", "--json"}));
  EXPECT_LE(coarse["triangles"], 5000);
  EXPECT_GT(coarse["triangles"], 3000);
  EXPECT_GT(coarse["bound"], fine["bound"]);
  const std::string text = output_of({"tessellate", teapot, "-o", "c.ply", "--relative", "0.01"});
  EXPECT_NE(text.find(" of the surfaces, proven, 58 open edges\n"), std::string::npos) << text;
  const json mesh = json::parse(output_of({"check", "a.ply", "--json"}));
  EXPECT_EQ(mesh["t_junctions"], 0);
  EXPECT_EQ(mesh["flipped_triangles"], 0);
  for (const char* const wrong : {"0", "-1", "nan", "x", ""})
    expect_failure({"tessellate", teapot, "-o", "d.ply", "--tolerance", wrong}, 2, "--tolerance");
  expect_failure({"tessellate", teapot, "-o", "d.ply", "--grid", "2x2", "--tolerance", "1"}, 2, "");
  expect_failure({"tessellate", teapot, "-o", "d.ply", "--tolerance", "1e-30"}, 1,
                 "the rounding of float vertices of patch");
  expect_failure({"tessellate", teapot, "-o", "d.ply", "--triangles", "3"}, 1,
                 "the budget is 3 triangles, and the mesh takes at least 56");
}

TEST_F(MeshTools, EveryTeasetModelBecomesAMesh) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  int models = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(data) / "classic_teaset")) {
    if (entry.path().extension() == ".rib") {  // a scene: warns of its other contents
      const ToolRun result = run({"tessellate", entry.path().string(), "-o", "a.ply", "--grid", "8x8", "--json"});
      EXPECT_EQ(result.status, 0) << result.errors;
      EXPECT_EQ(json::parse(result.output)["warnings"].size(), 1u);
      continue;
    }
    if (entry.path().extension() != ".bpt") {
      const std::string known = entry.path().extension().string();
      expect_failure({"info", entry.path().string()}, 1, "unsupported format \"" + known + "\"");
      continue;
    }
    ++models;
    const json facts =
        json::parse(output_of({"tessellate", entry.path().string(), "-o", "a.ply", "--grid", "8x8", "--json"}));
    const json report = json::parse(output_of({"check", "a.ply", "--json"}));
    EXPECT_EQ(report["triangles"], facts["triangles"]);
    EXPECT_EQ(report["non_finite_vertices"], 0);
    EXPECT_EQ(report["degenerate_triangles"], 0);
  }
  EXPECT_GE(models, 2);
}

}}  // namespace tessera::test
