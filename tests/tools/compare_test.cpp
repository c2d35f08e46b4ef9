// tessera compare: deviations of meshes from models, both ways.

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>

#include "support/file_triangles.h"
#include "support/triangle_distance.h"
#include "tools/picture.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string model_folder = TESSERA_SOURCE_DIR "/tools/models/";

class Compare : public ToolTest {
 protected:
  /// The rectangle from (0, 0, 0) to (10, 4, 0).
  std::string plate() const { return folder_.file("plate.bpt", "1\n1 1\n0 0 0\n0 4 0\n10 0 0\n10 4 0\n"); }
  /// Two triangles over the rectangle from (0, 0) to (right, 4), at these heights left and right.
  std::string sheet(double right, double left_height, double right_height) const {
    const std::string x = std::to_string(right), low = std::to_string(left_height), high = std::to_string(right_height);
    return folder_.file("sheet.obj", "v 0 0 " + low + "\nv " + x + " 0 " + high + "\nv " + x + " 4 " + high +
                                         "\nv 0 4 " + low + "\nf 1 2 3\nf 1 3 4\n");
  }
  json compared(Names words) const {
    words.insert(words.begin(), "compare");
    words.push_back("--json");
    return json::parse(output_of(words));
  }
};

TEST_F(Compare, ASphereIsWithinItsBoundAndNearIt) {
  const std::string sphere = model_folder + "sphere.json";
  const json mesh = json::parse(output_of({"tessellate", sphere, "-o", "a.stl", "--tolerance", "0.01", "--json"}));
  double deepest = 1;
  for (const FileTriangle& t : triangles_of_file(folder_ / "a.stl"))
    deepest = std::min(deepest, distance_to_triangle({}, t[0], t[1], t[2]));
  const double truth = 1 - deepest, rounding = 1e-6;
  const json found = compared({sphere, "a.stl"});
  for (const char* const way : {"mesh_to_model", "model_to_mesh"}) {
    const double largest = found[way]["largest"];
    EXPECT_LE(largest, mesh["bound"].get<double>() + rounding) << way;
    EXPECT_GT(largest, 0.97 * truth) << way;
    EXPECT_EQ(found[way]["uncertified"], 0) << way;
    EXPECT_EQ(found[way]["samples"], 100000) << way;
    EXPECT_LT(found[way]["mean"], found[way]["rms"]) << way;
    EXPECT_LT(found[way]["rms"], found[way]["percentile_99"]) << way;
    EXPECT_LT(found[way]["percentile_99"], largest) << way;
  }
  EXPECT_LE(found["mesh_to_model"]["largest"], truth + rounding);
  EXPECT_TRUE(found["closed"]);
  EXPECT_EQ(found["sides"]["inside"], found["mesh_to_model"]["largest"]);
  EXPECT_LT(found["sides"]["outside"], rounding);
  EXPECT_NEAR(found["sides"]["mean"].get<double>(), -found["mesh_to_model"]["mean"].get<double>(), rounding);
  const Vec3 at{found["mesh_to_model"]["largest_at"]["mesh_point"][0],
                found["mesh_to_model"]["largest_at"]["mesh_point"][1],
                found["mesh_to_model"]["largest_at"]["mesh_point"][2]};
  EXPECT_NEAR(1 - length(at), found["mesh_to_model"]["largest"], 1e-12);
  EXPECT_EQ(found["mesh_to_model"]["largest_at"]["name"], "sphere");
}

TEST_F(Compare, ASheetMovedAlongItsNormalIsAsFarEverywhere) {
  const json found = compared({plate(), sheet(10, 0.25, 0.25)});
  for (const char* const way : {"mesh_to_model", "model_to_mesh"})
    for (const char* const figure : {"largest", "mean", "rms", "percentile_99"})
      EXPECT_NEAR(found[way][figure].get<double>(), 0.25, 1e-14) << way << ' ' << figure;
  EXPECT_EQ(found["mesh_to_model"]["vertices"], 4);
  EXPECT_FALSE(found["closed"]);
  EXPECT_TRUE(found["sides"].is_null());
}

/// Heights from 0 to 1 over the length of 10: the mean is 1/2 of the distance from the plane, seen along the normal.
TEST_F(Compare, MeansAreThoseOfAreas) {
  const json found = compared({plate(), sheet(10, 0, 1), "--samples", "20000"})["mesh_to_model"];
  EXPECT_DOUBLE_EQ(found["largest"].get<double>(), 1);
  EXPECT_NEAR(found["mean"].get<double>(), 0.5, 1e-3);
  EXPECT_NEAR(found["rms"].get<double>(), std::sqrt(1.0 / 3), 1e-3);
  EXPECT_NEAR(found["percentile_99"].get<double>(), 0.99, 1e-3);
  EXPECT_EQ(found["samples"], 20000);
}

TEST_F(Compare, PartsThatTheMeshLacksAreSeenFromTheModelAlone) {
  const json lacks = compared({plate(), sheet(4, 0, 0)});
  EXPECT_LT(lacks["mesh_to_model"]["largest"].get<double>(), 1e-14);
  EXPECT_NEAR(lacks["model_to_mesh"]["largest"].get<double>(), 6, 1e-14);
  EXPECT_EQ(lacks["model_to_mesh"]["largest_at"]["model_point"][0], 10);
  const json adds = compared({plate(), sheet(12, 0, 0)});
  EXPECT_NEAR(adds["mesh_to_model"]["largest"].get<double>(), 2, 1e-14);
  EXPECT_LT(adds["model_to_mesh"]["largest"].get<double>(), 1e-14);
}

/// The holes of a plate: a mesh without them lies in them, and a mesh with them is missed by nothing that is kept.
TEST_F(Compare, LoopsCountOnBothSides) {
  const std::string holes = model_folder + "trimmed_plate.json";
  const json mesh = json::parse(output_of({"tessellate", holes, "-o", "a.ply", "--tolerance", "0.001", "--json"}));
  const json found = compared({holes, "a.ply"});
  for (const char* const way : {"mesh_to_model", "model_to_mesh"})
    EXPECT_LE(found[way]["largest"], mesh["bound"].get<double>() + 1e-6) << way;
  output_of({"tessellate", holes, "-o", "whole.ply", "--tolerance", "0.001", "--untrimmed"});
  const json whole = compared({holes, "whole.ply"});
  EXPECT_GT(whole["mesh_to_model"]["largest"], 0.1);
  EXPECT_LE(whole["model_to_mesh"]["largest"], 0.001);
  EXPECT_LE(compared({holes, "whole.ply", "--untrimmed"})["mesh_to_model"]["largest"], 0.001);
}

TEST_F(Compare, TheStatusTellsWhetherTheToleranceIsKept) {
  const std::string kept = output_of({"compare", plate(), sheet(10, 0.25, 0.25), "--tolerance", "0.26"});
  EXPECT_THAT(kept, HasSubstr("\n  tolerance        0.26, kept\n"));
  for (const double right : {10.0, 4.0}) {  // the mesh is too far away, then the model is
    const ToolRun broken =
        run({"compare", plate(), sheet(right, right == 10 ? 0.25 : 0, 0), "--tolerance", "0.2", "-o", "a.ply"});
    EXPECT_EQ(broken.status, 1);
    EXPECT_THAT(broken.output, HasSubstr("\n  tolerance        0.2, not kept\n"));
    EXPECT_THAT(broken.errors, HasSubstr("sheet.obj: the largest deviation is "));
    EXPECT_THAT(broken.errors, HasSubstr(", more than 0.2\n"));
    EXPECT_TRUE(std::filesystem::remove(folder_ / "a.ply"));
  }
  EXPECT_EQ(compared({plate(), "sheet.obj", "--tolerance", "9"})["within_tolerance"], true);
}

/// The colours of a picture's pixels below the bar and above the caption.
std::set<std::array<unsigned char, 3>> colours_of(const Picture& picture) {
  std::set<std::array<unsigned char, 3>> colours;
  for (unsigned y = picture.height / 8; y < picture.height - picture.height / 8; ++y)
    for (unsigned x = 0; x < picture.width; ++x) {
      const unsigned char* const pixel = &picture.rgb[3 * (std::size_t{y} * picture.width + x)];
      colours.insert({pixel[0], pixel[1], pixel[2]});
    }
  return colours;
}

TEST_F(Compare, PicturesShowDeviationsInColours) {
  const auto is_magenta = [](const auto& c) { return c[0] > c[1] + 60 && c[2] > c[1] + 60; };
  output_of({"compare", plate(), sheet(10, 0, 1), "-o", "a.png", "--size", "160x120"});
  const Picture tilted = read_picture(folder_ / "a.png");
  EXPECT_EQ(tilted.width, 160u);
  EXPECT_GT(colours_of(tilted).size(), 50u);
  EXPECT_TRUE(std::ranges::none_of(colours_of(tilted), is_magenta));
  output_of({"compare", plate(), "sheet.obj", "-o", "b.png", "--size", "160x120", "--full", "0.5"});
  EXPECT_TRUE(std::ranges::any_of(colours_of(read_picture(folder_ / "b.png")), is_magenta));
  output_of({"compare", plate(), sheet(10, 1, 1), "-o", "c.png", "--size", "160x120"});
  EXPECT_LT(colours_of(read_picture(folder_ / "c.png")).size(), colours_of(tilted).size() / 2);  // red alone
  EXPECT_EQ(run({"compare", plate(), "sheet.obj", "-o", "-", "--format", "png", "--size", "160x120"}).output,
            content_of(folder_ / "c.png"));
}

/// Ellipsoids about a ball: blue within it, red without.
TEST_F(Compare, PicturesOfClosedModelsTellTheSides) {
  folder_.file("ball.json", R"({"format": "tessera", "version": 1, "surfaces": [{"kind": "sphere", "radius": 2}]})");
  output_of({"tessellate", "ball.json", "-o", "ball.stl", "--tolerance", "0.001"});
  for (const bool larger : {false, true}) {
    const std::string scale = larger ? "1.01" : "0.99";
    const json found = compared({"ball.json", "ball.stl", "--scale", scale, "-o", "a.png", "--size", "80x60"});
    EXPECT_NEAR(found["sides"][larger ? "outside" : "inside"].get<double>(), 0.02, 0.0011);
    EXPECT_LT(found["sides"][larger ? "inside" : "outside"], 1e-6);
    for (const auto& colour : colours_of(read_picture(folder_ / "a.png"))) {
      const bool is_red = colour[0] > colour[2] + 20, is_blue = colour[2] > colour[0] + 20;
      EXPECT_FALSE(larger ? is_blue : is_red) << int{colour[0]} << ' ' << int{colour[1]} << ' ' << int{colour[2]};
    }
  }
}

TEST_F(Compare, MeshesHoldTheDeviationOfEachVertex) {
  output_of({"compare", plate(), sheet(10, 0.25, 0.5), "-o", "a.ply"});
  const std::string bytes = content_of(folder_ / "a.ply"), end = "end_header\n";
  EXPECT_THAT(bytes, HasSubstr("property float x\nproperty float y\nproperty float z\nproperty float quality\n"));
  ASSERT_EQ(bytes.size(), bytes.find(end) + end.size() + 4 * 16 + 2 * 13);
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<float, 4> vertex{};
    std::memcpy(vertex.data(), &bytes[bytes.find(end) + end.size() + 16 * k], 16);
    EXPECT_EQ(vertex[3], vertex[2]) << k;  // its height
  }
  EXPECT_THAT(output_of({"check", "a.ply"}), HasSubstr("triangles             2\n"));
}

TEST_F(Compare, AnyNumberOfThreadsFindsTheSame) {
  output_of({"tessellate", teapot, "-o", "a.ply"});
  const auto report = [&](const char* threads) {
    return output_of({"compare", teapot, "a.ply", "--samples", "40000", "--json", "--threads", threads});
  };
  EXPECT_EQ(report("1"), report("3"));
}

TEST_F(Compare, UnitsAndScalesOfMeshes) {
  const json doubled = compared({plate(), sheet(5, 0.125, 0.125), "--scale", "2"});
  EXPECT_NEAR(doubled["model_to_mesh"]["largest"].get<double>(), 0.25, 1e-14);
  const std::string block = model_folder + "bearing_block.step";
  for (const Names& mesh : {Names{"a.stl"}, {"a.glb"}, {"a.stl", "--mesh-unit", "mm"}, {"a.glb", "--scale", "1000"}}) {
    const json made = json::parse(output_of({"tessellate", block, "-o", mesh[0], "--tolerance", "0.05", "--json"}));
    Names words{block, "--samples", "20000"};
    words.insert(words.begin() + 1, mesh.begin(), mesh.end());
    const json found = compared(words);
    EXPECT_EQ(found["scale"], mesh[0] == "a.glb" ? 1000 : 1);
    EXPECT_EQ(found["unit"], "mm");
    EXPECT_TRUE(found["closed"]);
    for (const char* const way : {"mesh_to_model", "model_to_mesh"}) {
      EXPECT_LE(found[way]["largest"], made["bound"].get<double>() + 1e-4) << mesh[0] << way;
      EXPECT_GT(found[way]["largest"], 0.03) << mesh[0] << way;
    }
  }
  const ToolRun wrong = run({"compare", block, "a.stl", "--mesh-unit", "m", "--samples", "100"});
  EXPECT_THAT(wrong.errors, HasSubstr("a.stl: the mesh is 1e+03 times as large as the model; --mesh-unit"));
  expect_failure({"compare", plate(), "a.stl", "--mesh-unit", "m"}, 1,
                 "plate.bpt: --mesh-unit: the model states no unit; use --scale FACTOR");
}

/// A box whose faces name no edges, two of them trimmed: their edges are joined.
TEST_F(Compare, FacesWithoutEdgesAreJoinedToTellSides) {
  std::string faces;
  for (const char* const height : {"0", "1"})
    faces += std::string(R"({"kind": "bezier", "points": [[[-2, -2, )") + height + R"(], [-2, 2, )" + height +
             R"(]], [[2, -2, )" + height + R"(], [2, 2, )" + height +
             R"(]]], "trims": [{"curves": [{"kind": "bezier", "points": [[0.25, 0.25], [0.75, 0.25]]},
             {"kind": "bezier", "points": [[0.75, 0.25], [0.75, 0.75]]}, {"kind": "bezier", "points": [[0.75, 0.75],
             [0.25, 0.75]]}, {"kind": "bezier", "points": [[0.25, 0.75], [0.25, 0.25]]}]}]},)";
  for (const char* const wall : {"[[-1,-1,0],[-1,-1,1]],[[1,-1,0],[1,-1,1]]", "[[1,-1,0],[1,-1,1]],[[1,1,0],[1,1,1]]",
                                 "[[1,1,0],[1,1,1]],[[-1,1,0],[-1,1,1]]", "[[-1,1,0],[-1,1,1]],[[-1,-1,0],[-1,-1,1]]"})
    faces += std::string(R"({"kind": "bezier", "points": [)") + wall + "]},";
  faces.pop_back();
  folder_.file("box.json", R"({"format": "tessera", "version": 1, "surfaces": [)" + faces + "]}");
  output_of({"tessellate", "box.json", "-o", "box.ply"});
  const json found = compared({"box.json", "box.ply", "--scale", "1.5", "--samples", "1000"});
  EXPECT_TRUE(found["closed"]);
  EXPECT_NEAR(found["sides"]["outside"].get<double>(), std::sqrt(0.75), 1e-12);  // at a corner
  EXPECT_EQ(found["sides"]["unsure"], 0);
}

/// An IGES file's faces share no edges.
TEST_F(Compare, ShapesWithoutEdgesAreJoinedToo) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const std::string mug = std::string(data) + "/iges_bodies/mug_solid.igs";
  const json mesh = json::parse(output_of({"tessellate", mug, "-o", "a.stl", "--json"}));
  const json found = compared({mug, "a.stl", "--samples", "20000"});
  EXPECT_TRUE(found["closed"]);
  const double largest = found["mesh_to_model"]["largest"];
  EXPECT_LE(largest, mesh["bound"].get<double>() + mesh["gap"].get<double>() + 1e-5);
  EXPECT_EQ(largest, std::max(found["sides"]["inside"].get<double>(), found["sides"]["outside"].get<double>()));
  EXPECT_GT(found["sides"]["inside"], 0.5 * largest);   // chords of the outer wall are inside,
  EXPECT_GT(found["sides"]["outside"], 0.5 * largest);  // those of the inner one outside
}

TEST_F(Compare, AMeshThatIsFarAwayHasItsDistance) {
  folder_.file("far.obj", "v 1e12 0 0\nv 1.000001e12 0 0\nv 1e12 1e6 0\nf 1 2 3\n");
  const ToolRun far = run({"compare", plate(), "far.obj", "--samples", "100", "--json"});
  EXPECT_EQ(far.status, 0);
  const json found = json::parse(far.output);
  EXPECT_NEAR(found["mesh_to_model"]["largest"].get<double>(), 1.000001e12, 1e5);
  EXPECT_NEAR(found["model_to_mesh"]["largest"].get<double>(), 1e12, 1e5);
  EXPECT_GT(found["mesh_rounding"], 1e4);
}

TEST_F(Compare, MeshesThatCannotBeComparedAreNamed) {
  const std::string model = plate(), mesh = sheet(10, 0, 0);
  folder_.file("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
  folder_.file("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  folder_.file("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  folder_.file("empty.ply", "");
  expect_failure({"compare", model, "nan.obj"}, 1, "nan.obj: vertex 2 is not finite");
  expect_failure({"compare", model, "points.obj"}, 1, "points.obj: the mesh has no triangle");
  expect_failure({"compare", model, "line.obj"}, 1, "line.obj: the mesh has no triangle with an area");
  expect_failure({"compare", model, "empty.ply"}, 1, "empty.ply: the file is empty");
  expect_failure({"compare", model, "missing.ply", "-o", "a/a.png"}, 1, "missing.ply: cannot be opened");
  expect_failure({"compare", "missing.bpt", mesh}, 1, "missing.bpt: cannot be opened");
  expect_failure({"compare", model, teapot}, 1, "meshes are read as .obj, .ply, .stl, .glb, .gltf");
  expect_failure({"compare", model, mesh, "--scale", "1e300"}, 1, "sheet.obj: the areas of the mesh's triangles ");
  expect_failure({"compare", model, mesh, "--spacing", "1e-9"}, 1,
                 "--spacing: points 1e-09 apart are more than 100000000");
}

TEST_F(Compare, WrongCommandLinesAreTold) {
  const std::string model = plate(), mesh = sheet(10, 0, 0);
  expect_failure({"compare", model}, 2, "compare: expected MESH, found none");
  expect_failure({"compare", model, mesh, mesh}, 2, "is not expected");
  expect_failure({"compare", "-", mesh}, 2, "MODEL: - needs --input-format NAME");
  expect_failure({"compare", model, mesh, "--tolerance", "0"}, 2, "--tolerance");
  expect_failure({"compare", model, mesh, "--samples", "100000001"}, 2, "--samples");
  expect_failure({"compare", model, mesh, "--samples", "9", "--spacing", "1"}, 2, "cannot be combined with");
  expect_failure({"compare", model, mesh, "--mesh-unit", "mile"}, 2, "--mesh-unit");
  expect_failure({"compare", model, mesh, "--scale", "2", "--mesh-unit", "mm"}, 2, "cannot be combined with");
  expect_failure({"compare", model, mesh, "--size", "9x9"}, 2, "--size: needs --output FILE");
  expect_failure({"compare", model, mesh, "-o", "a.gif"}, 2, "deviations are written as .png, .ply");
  expect_failure({"compare", model, mesh, "-o", "-"}, 2, "--output: - needs --format NAME");
  expect_failure({"compare", model, folder_.file("a.ply", "x"), "-o", "a.ply"}, 2, "which would be overwritten");
}

}}  // namespace tessera::test
