// tessera section: drawings of where planes cut surfaces.

#include <gmock/gmock.h>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using testing::HasSubstr;
using SectionTool = ToolTest;

const std::string models = TESSERA_SOURCE_DIR "/tools/models/";

TEST_F(SectionTool, TheWordsCountPolylines) {
  const std::string text = output_of({"section", models + "sphere.json", "--at", "0.25", "-o", "a.svg"});
  EXPECT_THAT(text, HasSubstr("a.svg: 1 plane, 1 polyline (1 closed, 0 open), "));
  EXPECT_THAT(text, HasSubstr(", proven\n"));
  EXPECT_THAT(content_of(folder_ / "a.svg"), HasSubstr("<path fill-rule=\"evenodd\""));
  EXPECT_THAT(output_of({"section", models + "vase.json", "--plane", "0,1,0,0", "-o", "b.dxf"}),
              HasSubstr("(0 closed, "));
}

TEST_F(SectionTool, JsonHasTheLengthAndTheBoundOfEachPlane) {
  const json facts = json::parse(output_of({"section", models + "sphere.json", "--axis", "x", "--at", "0", "--at",
                                            "0.6", "--at", "7", "--tolerance", "1e-5", "-o", "a.ply", "--json"}));
  ASSERT_EQ(facts["planes"].size(), 3u);
  EXPECT_NEAR(facts["planes"][0]["length"], 2 * std::numbers::pi, 1e-4);
  EXPECT_NEAR(facts["planes"][1]["length"], 1.6 * std::numbers::pi, 1e-4);
  EXPECT_EQ(facts["planes"][2]["polylines"], 0);
  EXPECT_EQ(facts["polylines"], 2);
  EXPECT_EQ(facts["closed"], 2);
  EXPECT_EQ(facts["open"], 0);
  EXPECT_LE(facts["bound"], 1e-5);
  EXPECT_EQ(facts["certified"], true);
}

TEST_F(SectionTool, LayersLieInTheMiddlesOfEqualParts) {
  const json facts =
      json::parse(output_of({"section", models + "sphere.json", "--layers", "4", "-o", "a.dxf", "--json"}));
  ASSERT_EQ(facts["planes"].size(), 4u);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(facts["planes"][k]["offset"], -0.75 + 0.5 * k, 1e-12);
  EXPECT_THAT(content_of(folder_ / "a.dxf"), HasSubstr("SECTION_3"));
}

TEST_F(SectionTool, PolylinesGoOnFromPatchToPatch) {
  // Two squares that meet at x = 1.
  const auto square = [](double x) {
    const std::string a = std::to_string(x), b = std::to_string(x + 1);
    return "{\"kind\": \"bezier\", \"points\": [[[" + a + ",0,0],[" + a + ",1,0]],[[" + b + ",0,0],[" + b + ",1,0]]]}";
  };
  folder_.file("m.json",
               "{\"format\": \"tessera\", \"version\": 1, \"surfaces\": [" + square(0) + "," + square(1) + "]}");
  const json facts =
      json::parse(output_of({"section", "m.json", "--axis", "y", "--at", "0.5", "-o", "a.svg", "--json"}));
  EXPECT_EQ(facts["polylines"], 1);
  EXPECT_NEAR(facts["length"], 2, 1e-12);
}

TEST_F(SectionTool, AnySetOfThreadsAndStreamsGiveTheSameBytes) {
  for (const char* const format : {"svg", "dxf", "ply"}) {
    const std::string name = std::string("a.") + format;
    output_of({"section", teapot, "--layers", "50", "-o", name, "--threads", "1"});
    const ToolRun streamed =
        run({"section", teapot, "--layers", "50", "-o", "-", "--format", format, "--threads", "4"});
    EXPECT_EQ(streamed.status, 0);
    EXPECT_EQ(streamed.output, content_of(folder_ / name)) << format;
    EXPECT_THAT(streamed.errors, HasSubstr("-: 50 planes, "));
  }
}

TEST_F(SectionTool, AFolderGetsADrawingPerModel) {
  output_of({"section", models + "sphere.json", models + "torus.json", "--at", "0.1", "-o", "out/"});
  EXPECT_GT(content_of(folder_ / "out/sphere.svg").size(), 1000u);
  EXPECT_GT(content_of(folder_ / "out/torus.svg").size(), 1000u);
}

TEST_F(SectionTool, WrongCommandsAreToldAtOnce) {
  expect_failure({"section", teapot, "--at", "1"}, 2, "section: expected --output FILE, found none");
  expect_failure({"section", teapot, "-o", "a.svg"}, 2, "--plane");
  expect_failure({"section", teapot, "--at", "1", "-o", "a.stl"}, 2, "sections are written as .dxf, .ply, .svg");
  expect_failure({"section", teapot, "--plane", "0,0,0,1", "-o", "a.svg"}, 2, "A, B and C must not all be 0");
  expect_failure({"section", teapot, "--plane", "1,0,1", "-o", "a.svg"}, 2, "--plane");
  expect_failure({"section", teapot, "--plane", "1,0,nan,0", "-o", "a.svg"}, 2, "--plane");
  expect_failure({"section", teapot, "--plane", "1,0,0,0", "--at", "1", "-o", "a.svg"}, 2, "--plane");
  expect_failure({"section", teapot, "--plane", "1,0,0,0", "--axis", "x", "-o", "a.svg"}, 2, "--axis");
  expect_failure({"section", teapot, "--layers", "0", "-o", "a.svg"}, 2, "--layers");
  expect_failure({"section", teapot, "--at", "1", "--tolerance", "0", "-o", "a.svg"}, 2, "--tolerance");
  expect_failure({"section", "missing.bpt", "--at", "1", "-o", "a.svg"}, 1, "missing.bpt: cannot be opened");
  expect_failure({"section", teapot, "--at", "1", "--tolerance", "1e-200", "-o", "a.svg"}, 1, "max_points");
}

}}  // namespace tessera::test
