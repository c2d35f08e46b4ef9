// tessera tessellate by angles, by pixels of a camera's picture, and with a cap on triangles.

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

const std::string camera = "--camera=4,-8,5,0,0,1.5,40";

class Tolerances : public ToolTest {
 protected:
  json made(const Names& options) const {
    Names command{"tessellate", teapot, "-o", "a.ply", "--json"};
    command.insert(command.end(), options.begin(), options.end());
    return json::parse(output_of(command));
  }
  json checked() const { return json::parse(output_of({"check", "a.ply", "--json"})); }
  void expect_refusal(const Names& options, int status, const std::string& part) const {
    Names command{"tessellate", teapot, "-o", "b.ply"};
    command.insert(command.end(), options.begin(), options.end());
    expect_failure(command, status, part);
  }
};

TEST_F(Tolerances, AnglesAloneAndWithALength) {
  const json coarse = made({"--angle", "20"}), fine = made({"--angle", "5"});
  EXPECT_GT(coarse["angle"], 5);
  EXPECT_LE(coarse["angle"], 20.0001);
  EXPECT_LE(fine["angle"], 5.0001);
  EXPECT_GT(fine["triangles"], 4 * coarse["triangles"].get<int>());
  EXPECT_EQ(checked()["t_junctions"], 0);
  EXPECT_TRUE(fine["pixels"].is_null());
  const json both = made({"--angle", "20", "--tolerance", "0.001"});
  EXPECT_LE(both["bound"], 0.001001);
  EXPECT_LE(both["angle"], 20.0001);
  EXPECT_TRUE(made({"--tolerance", "0.001"})["angle"].is_null());
  const std::string text = output_of({"tessellate", teapot, "-o", "a.ply", "--angle", "20"});
  EXPECT_NE(text.find(" degrees"), std::string::npos) << text;
}

TEST_F(Tolerances, PixelsOfACamera) {
  const json half = made({"--pixels", "0.5", camera}), four = made({"--pixels", "4", camera});
  EXPECT_LE(half["pixels"], 0.500001);
  EXPECT_LE(four["pixels"], 4.00001);
  EXPECT_GT(half["triangles"], four["triangles"]);
  EXPECT_EQ(checked()["t_junctions"], 0);
  // A picture of twice the size needs the tolerance of half the pixels. Parts outside the frame could differ, but do
  // not here.
  EXPECT_EQ(made({"--pixels", "1", camera, "--size", "2560x1600"})["triangles"], half["triangles"]);
  const json parallel = made({"--pixels", "0.5", camera, "--orthographic", "7"});
  EXPECT_LE(parallel["pixels"], 0.500001);
  // Inside of the pot, near its wall.
  const json inside = made({"--pixels", "1", "--camera=0,0,1,1,0.3,1,60", "--near", "0.05"});
  EXPECT_LE(inside["pixels"], 1.000001);
  EXPECT_EQ(checked()["t_junctions"], 0);
  const json all = made({"--pixels", "2", camera, "--relative", "0.01", "--angle", "15"});
  EXPECT_LE(all["angle"], 15.0001);
  EXPECT_LE(all["pixels"], 2.00001);
}

TEST_F(Tolerances, ACapSaysHowManyItWouldTake) {
  const json free = made({"--relative", "0.003"});
  const std::string count = free["triangles"].dump();
  EXPECT_EQ(made({"--relative", "0.003", "--max-triangles", count})["triangles"], free["triangles"]);
  expect_refusal({"--relative", "0.003", "--max-triangles", std::to_string(free["triangles"].get<int>() - 1)}, 1,
                 " takes " + count + " triangles");
  expect_refusal({"--angle", "0.01"}, 1, "segments along a parameter of patch");
  expect_refusal({"--angle", "0.01"}, 1, "triangles in all");
}

TEST_F(Tolerances, NeighboursShareVertices) {
  const json apart = made({"--relative", "0.003"});
  const json all = made({"--relative", "0.003", "--share-vertices"});
  const json places = checked();
  EXPECT_EQ(all["vertices"], 1 + places["distinct_positions"].get<int>());  // the handle and the body touch in a corner
  EXPECT_EQ(all["triangles"], apart["triangles"]);
  const json smooth = made({"--relative", "0.003", "--share-vertices", "--crease", "5"});
  EXPECT_LT(smooth["vertices"], apart["vertices"]);
  EXPECT_GE(smooth["vertices"], all["vertices"]);
  EXPECT_EQ(checked()["flipped_triangles"], 0);
  EXPECT_EQ(made({"--relative", "0.003", "--crease", "5"})["vertices"], apart["vertices"]);
}

TEST_F(Tolerances, CellsAreQuads) {
  const json plain = made({"--relative", "0.003"}), places = checked();
  EXPECT_EQ(plain["quads"], 0);
  EXPECT_EQ(places["quads"], 0);
  const json quads = made({"--relative", "0.003", "--quads"});
  EXPECT_GT(quads["quads"], 100);
  EXPECT_EQ(quads["triangles"].get<int>() + 2 * quads["quads"].get<int>(), plain["triangles"]);
  json report = checked();
  EXPECT_EQ(report["quads"], quads["quads"]);
  report["quads"] = 0;
  EXPECT_EQ(report, places);
  const std::string text = output_of({"tessellate", teapot, "-o", "a.obj", "--grid", "4x3", "--quads"});
  EXPECT_NE(text.find(" triangles, "), std::string::npos) << text;
  EXPECT_NE(text.find(" quads"), std::string::npos) << text;
  EXPECT_GT(json::parse(output_of({"check", "a.obj", "--json"}))["quads"], 28 * 9);
  for (const char* const name : {"b.stl", "b.glb", "b.gltf"})
    expect_failure({"tessellate", teapot, "-o", name, "--grid", "4x3", "--quads"}, 2, "can hold only triangles");
}

TEST_F(Tolerances, OnlyGltfIsCompressed) {
  output_of({"tessellate", teapot, "-o", "plain.glb", "--grid", "9x9"});
  for (const char* const name : {"a.stl", "a.ply", "a.obj"})
    expect_failure({"tessellate", teapot, "-o", name, "--compress"}, 2, "--compress: is for .glb and .gltf, found .");
  const ToolRun made = run({"tessellate", teapot, "-o", "packed.glb", "--grid", "9x9", "--compress"});
  if (made.status != 0) {
    EXPECT_NE(made.errors.find("it lacks meshoptimizer"), std::string::npos) << made.errors;
    return;
  }
  EXPECT_LT(content_of(folder_ / "packed.glb").size(), content_of(folder_ / "plain.glb").size() * 2 / 3);
  const auto report = [&](const char* name) { return json::parse(run({"check", name, "--json"}).output); };
  json plain = report("plain.glb"), packed = report("packed.glb");
  EXPECT_EQ(plain["distinct_positions"], packed["distinct_positions"]);
  EXPECT_EQ(plain["triangles"], packed["triangles"]);
}

TEST_F(Tolerances, PositionsInDouble) {
  const json single = made({"--relative", "0.003"}), twice = made({"--relative", "0.003", "--precision", "double"});
  EXPECT_EQ(single["precision"], "float");
  EXPECT_EQ(twice["precision"], "double");
  EXPECT_LE(twice["bound"], single["bound"].get<double>() * 1.01);
  EXPECT_EQ(checked()["t_junctions"], 0);
  expect_refusal({"--tolerance", "1e-8"}, 1, "is enough; positions in double keep ");
  expect_refusal({"--relative", "0.003", "--precision", "half"}, 2, "expected float or double");
  expect_refusal({"--grid", "4x4", "--precision", "double"}, 2, "--grid");
  for (const char* const name : {"a.stl", "a.glb", "a.gltf"})
    expect_failure({"tessellate", teapot, "-o", name, "--relative", "0.003", "--precision", "double"}, 2,
                   "can hold only positions in float");
}

TEST_F(Tolerances, FewerTrianglesForMoreTime) {
  const json plain = made({"--relative", "0.001"}), fewest = made({"--relative", "0.001", "--fewest"});
  EXPECT_LT(fewest["triangles"], 0.9 * plain["triangles"].get<double>());
  EXPECT_EQ(checked()["t_junctions"], 0);
  expect_refusal({"--grid", "4x4", "--fewest"}, 2, "--grid");
}

TEST_F(Tolerances, WrongOnesAreRefused) {
  expect_refusal({"--relative", "0.01", "--crease", "200"}, 2, "expected an angle of 0 to 180 degrees");
  expect_refusal({"--grid", "4x4", "--share-vertices"}, 2, "--grid");

  for (const char* const option : {"--angle", "--tolerance", "--relative"})
    for (const char* const wrong : {"0", "-1", "nan", "inf", "x", "", "1,2"})
      expect_refusal({option, wrong}, 2, option);
  expect_refusal({"--angle", "91"}, 2, "at most 90");
  for (const char* const wrong : {"0", "-1", "nan", "x"}) expect_refusal({"--pixels", wrong, camera}, 2, "--pixels");
  expect_refusal({"--pixels", "1"}, 2, "--camera");
  expect_refusal({"--tolerance", "1", camera}, 2, "--pixels");
  expect_refusal({"--tolerance", "1", "--size", "8x8"}, 2, "--camera");
  expect_refusal({"--pixels", "1", "--camera=0,0,0,0,0,0,40"}, 2, "the same point");
  expect_refusal({"--pixels", "1", "--camera=0,0,9,0,0,0,180"}, 2, "field of view");
  expect_refusal({"--pixels", "1", camera, "--near", "-1"}, 2, "--near");
  expect_refusal({"--pixels", "1", camera, "--orthographic", "0"}, 2, "--orthographic");
  expect_refusal({"--pixels", "1", camera, "--size", "0x5"}, 2, "--size");
  expect_refusal({"--tolerance", "1", "--relative", "1"}, 2, "");
  expect_refusal({"--grid", "2x2", "--angle", "5"}, 2, "");
  expect_refusal({"--triangles", "99", "--max-triangles", "9"}, 2, "");
}

}}  // namespace tessera::test
