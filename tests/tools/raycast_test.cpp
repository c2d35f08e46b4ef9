// tessera raycast: pictures and hits.

#include <charconv>
#include <cmath>

#include "tessera/io.h"
#include "tessera/ray_scene.h"
#include "tools/picture.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using RaycastTool = ToolTest;

/// Width and height as the header of a PNG file states them, big endian (PNG specification, 11.2.2).
std::pair<unsigned, unsigned> png_size(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  if (bytes.size() < 24) return {};
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
    return value;
  };
  return {number(16), number(20)};
}

TEST_F(RaycastTool, PicturesHaveTheSizeAskedFor) {
  for (const char* shade : {"lambert", "normals", "uv", "patch", "error", "curvature", "clay", "steps"}) {
    const std::string name = std::string(shade) + ".png";
    output_of({"raycast", teapot, "-o", name, "--size", "64x48", "--shade", shade});
    EXPECT_EQ(png_size(content_of(folder_ / name)), (std::pair{64u, 48u}));
  }
  EXPECT_EQ(folder_.names(), (Names{"clay.png", "curvature.png", "error.png", "lambert.png", "normals.png", "patch.png",
                                    "steps.png", "uv.png"}));
  EXPECT_NE(content_of(folder_ / "uv.png"), content_of(folder_ / "patch.png"));
}

/// The fewer segments, the more of the outline is lost.
TEST_F(RaycastTool, RatesOfGrids) {
  const auto picture = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"raycast", teapot, "-o", "a.png", "--size", "96x64", "--shade", "patch"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    output_of(arguments);
    return content_of(folder_ / "a.png");
  };
  EXPECT_NE(picture({"--mode", "grid", "--rate", "2"}), picture({"--mode", "grid", "--rate", "64"}));
  expect_failure({"raycast", teapot, "-o", "a.png", "--rate", "4"}, 2, "--mode grid");
  expect_failure({"raycast", teapot, "-o", "a.png", "--mode", "grid", "--rate", "0"}, 2, "--rate");
  expect_failure({"raycast", teapot, "-o", "a.png", "--mode", "grid", "--shade", "steps"}, 2, "--mode exact");
}

/// A finer mesh, the same colours by another measure; a mesh from a file has its own.
TEST_F(RaycastTool, ErrorsOfMeshesAreShown) {
  const auto error_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"raycast", teapot,    "-o",    "a.png", "--size",
                                       "48x32",   "--shade", "error", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return json::parse(output_of(arguments)).at("error");
  };
  const json coarse = error_of({"--relative", "0.01"}), usual = error_of({});
  EXPECT_TRUE(coarse.at("certified"));
  EXPECT_GT(coarse.at("red"), usual.at("red"));
  EXPECT_LT(coarse.at("triangles"), usual.at("triangles"));
  for (const json& error : {coarse, usual}) {
    EXPECT_LE(error.at("found"), error.at("red"));
    EXPECT_GE(error.at("found").get<double>(), 0.2 * error.at("red").get<double>());
  }
  output_of({"tessellate", teapot, "-o", "mesh.ply", "--grid", "3x3"});
  const json given = error_of({"--mesh", "mesh.ply"});
  EXPECT_FALSE(given.at("certified"));
  EXPECT_EQ(given.at("found"), given.at("red"));
  EXPECT_GT(given.at("found"), usual.at("found"));
  expect_failure({"raycast", teapot, "-o", "a.png", "--shade", "uv", "--mesh", "mesh.ply"}, 2, "--shade error");
  expect_failure({"raycast", teapot, "-o", "a.png", "--shade", "error", "--relative", "0"}, 2, "above 0");
  expect_failure({"raycast", teapot, "-o", "a.png", "--shade", "error", "--mesh", "none.ply"}, 1, "none.ply");
}

TEST_F(RaycastTool, MeshesAreDrawn) {
  output_of({"tessellate", teapot, "-o", "mesh.ply", "--grid", "4x4", "--quads"});
  for (const char* const format : {"obj", "stl"})
    output_of({"tessellate", teapot, "-o", std::string("mesh.") + format, "--grid", "4x4"});
  std::vector<std::string> pictures;
  for (const char* const mesh : {"mesh.ply", "mesh.obj", "mesh.stl"}) {
    const json facts =
        json::parse(output_of({"raycast", mesh, "-o", "a.png", "--size", "64x48", "--shade", "clay", "--json"}));
    EXPECT_EQ(facts["triangles"], 32 * 32 - 32) << mesh;  // without those of no area, at the poles of four patches
    pictures.push_back(content_of(folder_ / "a.png"));
  }
  EXPECT_EQ(pictures[0], pictures[1]);
  EXPECT_NE(pictures[0], pictures[2]);  // an .stl file has no normals
  output_of({"raycast", "mesh.stl", "-o", "a.png", "--size", "64x48", "--shade", "clay", "--edges"});
  EXPECT_NE(content_of(folder_ / "a.png"), pictures[2]);
  EXPECT_EQ(output_of({"raycast", "mesh.stl", "-o", "b.png", "--size", "64x48"}), "b.png: 64 x 48, 992 triangles\n");
}

TEST_F(RaycastTool, LinesAreDrawnWhereSurfacesEnd) {
  // Two squares side by side, the left one of two patches.
  folder_.file("squares.json", R"({"format": "tessera", "version": 1, "surfaces": [
    {"kind": "b_spline", "degree": [1, 1], "knots_u": "clamped", "knots_v": "clamped",
     "points": [[[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 2, 0], [1, 2, 0], [2, 2, 0]]]},
    {"kind": "b_spline", "degree": [1, 1], "knots_u": "clamped", "knots_v": "clamped",
     "points": [[[2, 0, 0], [4, 0, 0]], [[2, 2, 0], [4, 2, 0]]]}]})");
  const auto draw = [&](const Names& options) {
    Names command{"raycast", "squares.json", "-o",
                  "a.png",   "--size",       "81x81",
                  "--shade", "clay",         "--camera=2.01,1,6,2.01,1,0,40"};
    command.insert(command.end(), options.begin(), options.end());
    output_of(command);
    return read_picture(folder_ / "a.png");
  };
  const auto dark_columns = [](const Picture& picture) {
    std::vector<unsigned> columns;
    const std::size_t row = 3 * std::size_t{picture.width} * 40;
    for (unsigned x = 0; x < picture.width; ++x)
      if (picture.rgb[row + 3 * x] < 100) columns.push_back(x);
    return columns;
  };
  EXPECT_TRUE(dark_columns(draw({})).empty());
  const std::vector<unsigned> dark = dark_columns(draw({"--edges"}));
  // The left border, the common one in the middle, and the right one; none where the patches of the left square meet.
  ASSERT_FALSE(dark.empty());
  for (const unsigned x : dark) EXPECT_TRUE(x < 6 || (x >= 39 && x <= 41) || x > 74) << x;
  EXPECT_TRUE(std::ranges::any_of(dark, [](unsigned x) { return x >= 39 && x <= 41; }));
}

TEST_F(RaycastTool, OptionsThatMeshesCannotHave) {
  output_of({"tessellate", teapot, "-o", "mesh.ply", "--grid", "4x4"});
  folder_.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n");
  expect_failure({"raycast", "mesh.ply", "--rays", "rays.csv", "--hits", "hits.csv"}, 1,
                 "tessera: --rays needs surfaces, found the mesh mesh.ply\n");
  expect_failure({"raycast", "mesh.ply", "-o", "a.exr"}, 1, "an .exr picture needs surfaces, found the mesh mesh.ply");
  expect_failure({"raycast", "mesh.ply", "-o", "a.png", "--shade", "uv"}, 1, "need surfaces, found the mesh mesh.ply");
  expect_failure({"raycast", "mesh.ply", teapot, "-o", "a.png"}, 1,
                 "shows surfaces or meshes, found the mesh mesh.ply and");
  expect_failure({"raycast", teapot, "-o", "a.png", "--edges", "--shade", "uv"}, 1,
                 "--edges needs --shade lambert, normals or clay, and a .png picture");
  folder_.file("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  expect_failure({"raycast", "flat.obj", "-o", "a.png"}, 1, "flat.obj: the mesh has no triangle with an area");
  folder_.file("far.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 4\n");
  expect_failure({"raycast", "far.obj", "-o", "a.png"}, 1, "far.obj");
}

TEST_F(RaycastTool, TheAxisThatPointsUp) {
  std::vector<std::string> pictures;
  for (const char* const up : {"x", "y", "z"}) {
    output_of({"raycast", teapot, "-o", "a.png", "--size", "32x32", "--shade", "clay", "--up", up});
    pictures.push_back(content_of(folder_ / "a.png"));
  }
  EXPECT_NE(pictures[0], pictures[1]);
  EXPECT_NE(pictures[1], pictures[2]);
  output_of({"raycast", teapot, "-o", "a.png", "--size", "32x32", "--shade", "clay"});
  EXPECT_EQ(content_of(folder_ / "a.png"), pictures[2]);
  expect_failure({"raycast", teapot, "-o", "a.png", "--up", "w"}, 2, "--up: ");
}

TEST_F(RaycastTool, DraftsDiffer) {
  output_of({"raycast", teapot, "-o", "a.png", "--size", "32x32", "--quality", "draft"});
  output_of({"raycast", teapot, "-o", "b.png", "--size", "32x32"});
  EXPECT_NE(content_of(folder_ / "a.png"), content_of(folder_ / "b.png"));
}

TEST_F(RaycastTool, CamerasMatter) {
  output_of({"raycast", teapot, "-o", "a.png", "--size", "32x32", "--shade", "normals"});
  output_of(
      {"raycast", teapot, "-o", "b.png", "--size", "32x32", "--shade", "normals", "--camera", "-9,3,4,0,0,1.5,40"});
  EXPECT_NE(content_of(folder_ / "a.png"), content_of(folder_ / "b.png"));
}

TEST_F(RaycastTool, HitsLieOnTheirSurfacesAndRays) {
  std::string table = "ox,oy,oz,dx,dy,dz\n";
  std::vector<Ray> rays;
  for (int k = 0; k < 400; ++k) {
    const double angle = 0.7 * k, z = -0.5 + 4.0 * (k % 20) / 19;
    Ray ray{.origin = {8 * std::cos(angle), 8 * std::sin(angle), z}};
    ray.direction = Vec3{0.1, -0.2, 1.3} - ray.origin;
    rays.push_back(ray);
    const Vec3 &o = ray.origin, &d = ray.direction;
    for (const double value : {o.x, o.y, o.z, d.x, d.y, d.z}) {
      char text[32];
      table.append(text, std::to_chars(text, text + sizeof text, value).ptr);
      table += ',';
    }
    table.back() = '\n';
  }
  folder_.file("rays.csv", table);
  output_of({"raycast", teapot, "--rays", "rays.csv", "--hits", "hits.csv"});
  const auto rows = cells_of(content_of(folder_ / "hits.csv"));
  ASSERT_EQ(rows.size(), rays.size() + 1);
  EXPECT_EQ(rows[0],
            (Names{"ray", "hit", "t", "surface", "patch", "u", "v", "x", "y", "z", "nx", "ny", "nz", "edge", "name"}));
  const Result<Model> model = read_model(teapot);
  ASSERT_TRUE(model.ok());
  std::size_t hits = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    const std::vector<std::string>& row = rows[k + 1];
    ASSERT_EQ(row.size(), 15u);
    EXPECT_EQ(row[0], std::to_string(k));
    if (row[1] != "1") {
      EXPECT_EQ(row[1], "0");
      for (std::size_t c = 2; c < 15; ++c) EXPECT_EQ(row[c], "");
      continue;
    }
    ++hits;
    const auto number = [&](std::size_t c) { return std::stod(row[c]); };
    const Vec3 position{number(7), number(8), number(9)}, normal{number(10), number(11), number(12)};
    const BezierPatch& patch = std::get<BezierPatch>(model->surfaces.at(std::stoul(row[3])).surface);
    EXPECT_LE(length(de_casteljau(patch, number(5), number(6)) - position), 1e-6);
    EXPECT_LE(length(rays[k].origin + number(2) * rays[k].direction - position), 1e-4);
    EXPECT_NEAR(length(normal), 1, 1e-6);
  }
  EXPECT_GT(hits, rays.size() / 2);  // they aim at the middle of the pot; those that look in over the rim may leave
}

TEST_F(RaycastTool, RangesAndMissesAreKept) {
  folder_.file("rays.csv",
               "ox,oy,oz,dx,dy,dz,tnear,tfar\n"
               "0.3,0.2,9,0,0,-1,0,inf\n"  // from above onto the lid
               "0.3,0.2,9,0,0,-1,0,2\n"    // ends before it
               "0.3,0.2,9,0,0,1,0,inf\n"   // away from it
               "0.3,0.2,9,0,0,-2,0,inf\n");
  output_of({"raycast", teapot, "--rays", "rays.csv", "--hits", "hits.csv"});
  const auto rows = cells_of(content_of(folder_ / "hits.csv"));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[1][1] + rows[2][1] + rows[3][1] + rows[4][1], "1001");
  EXPECT_NEAR(std::stod(rows[1][2]), 2 * std::stod(rows[4][2]), 1e-9);
}

TEST_F(RaycastTool, RaysThatAreNotValidAreRefusedByLine) {
  const std::string header = "ox,oy,oz,dx,dy,dz\n", ranged = "ox,oy,oz,dx,dy,dz,tnear,tfar\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "rays.csv: the file is empty"},
      {"x,y,z\n1,2,3\n", "rays.csv:1: expected a header line ox,oy,oz,dx,dy,dz[,tnear,tfar], found \"x\""},
      {header + "0,0,0,0,0\n", "rays.csv:2: expected 6 numbers (ox,oy,oz,dx,dy,dz), found the end of the line"},
      {ranged + "0,0,0,0,0,1\n",
       "rays.csv:2: expected 8 numbers (ox,oy,oz,dx,dy,dz,tnear,tfar), found the end of the line"},
      {header + "0,0,9,0,0,-1\n\n0,nan,0,0,0,1\n", "rays.csv:4: a ray that is not valid: the origin is not finite"},
      {header + "0,0,0,0,inf,1\n", "rays.csv:2: a ray that is not valid: the direction is not finite"},
      {header + "0,0,0,0,0,1e400\n", "rays.csv:2: a ray that is not valid: the direction is not finite"},
      {header + "0,0,0,0,-0,0\n", "rays.csv:2: a ray that is not valid: the direction is zero"},
      {ranged + "0,0,0,0,0,1,-1,2\n", "rays.csv:2: a ray that is not valid: tnear is -1, it must be at least 0"},
      {ranged + "0,0,0,0,0,1,nan,2\n", "rays.csv:2: a ray that is not valid: tnear is nan, it must be at least 0"},
      {ranged + "0,0,0,0,0,1,3,2\n", "rays.csv:2: a ray that is not valid: tfar is 2, it must be at least tnear"},
      {ranged + "0,0,0,0,0,1,0,nan\n", "rays.csv:2: a ray that is not valid: tfar is nan, it must be at least tnear"},
      {header + "0,0,9,0,0,-1\n1e19,0,0,-1,0,0\n",
       "rays.csv:3: a ray that is not valid: the origin or the direction has a component beyond 1.844e+18"},
      {header + "0,0,9,0,0,-1.845e18\n",
       "rays.csv:2: a ray that is not valid: the origin or the direction has a component beyond 1.844e+18"},
      {ranged + "0,0,0,0,0,1,inf,inf\n", "rays.csv:2: a ray that is not valid: tnear is not finite"},
  };
  for (const auto& [text, message] : cases) {
    folder_.file("rays.csv", text);
    expect_failure({"raycast", teapot, "--rays", "rays.csv", "--hits", "hits.csv"}, 1, "tessera: " + message);
  }
}

TEST_F(RaycastTool, EveryTeasetModelIsDrawn) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  int models = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(data) / "classic_teaset")) {
    if (entry.path().extension() != ".bpt") continue;
    output_of({"raycast", entry.path().string(), "-o", std::to_string(models++) + ".png", "--size", "64x64"});
  }
  ASSERT_GE(models, 2);
  // One pot from two sources gives one picture.
  EXPECT_EQ(content_of(folder_ / "0.png"), content_of(folder_ / "1.png"));
}

TEST_F(RaycastTool, AnInterruptedPictureDoesNotAppear) {
  // `timeout` interrupts the tool long before so large a picture is done, and reports that by 124.
  const ToolRun result = run_program(
      folder_, {"timeout", "--signal=INT", "1", TESSERA_TOOL, "raycast", teapot, "-o", "a.png", "--size", "8192x8192"});
  EXPECT_EQ(result.status, 124);
  EXPECT_EQ(result.output, "");
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(RaycastTool, AllHitsAreRowsInOrder) {
  folder_.file("rays.csv", "ox,oy,oz,dx,dy,dz\n-9,0.1,1,1,0,0\n-9,0.1,9,1,0,0\n");
  output_of({"raycast", teapot, "--rays", "rays.csv", "--hits", "all.csv", "--all-hits"});
  output_of({"raycast", teapot, "--rays", "rays.csv", "--hits", "first.csv", "--mode", "exact"});
  const auto all = cells_of(content_of(folder_ / "all.csv")), first = cells_of(content_of(folder_ / "first.csv"));
  ASSERT_EQ(first.size(), 3u);
  ASSERT_GE(all.size(), 4u);  // in and out at least
  EXPECT_EQ(all[1], first[1]);
  EXPECT_EQ(all.back(), first[2]);
  EXPECT_EQ(all.back()[1], "0");
  for (std::size_t k = 2; k + 1 < all.size(); ++k) EXPECT_GT(std::stod(all[k][2]), std::stod(all[k - 1][2]));
  expect_failure({"raycast", teapot, "--rays", "rays.csv", "--hits", "a.csv", "--all-hits", "--mode", "grid"}, 2,
                 "--all-hits");
  expect_failure({"raycast", teapot, "-o", "a.png", "--all-hits"}, 2, "--rays");
  expect_failure({"raycast", teapot, "-o", "a.png", "--mode", "fast"}, 2, "--mode");
}

TEST_F(RaycastTool, ExactPicturesHaveTheSizeAskedFor) {
  output_of({"raycast", teapot, "-o", "exact.png", "--size", "40x30", "--mode", "exact"});
  EXPECT_EQ(png_size(content_of(folder_ / "exact.png")), (std::pair{40u, 30u}));
}

}}  // namespace tessera::test
