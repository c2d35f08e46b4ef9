// tessera convert; and the formats of meshes and pictures that not every command reads.

#include "tessera/io.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using ConvertTool = ToolTest;

const std::string models = TESSERA_SOURCE_DIR "/tools/models/";

TEST_F(ConvertTool, TheTeapotGoesThroughBothFormatsUnchanged) {
  EXPECT_EQ(output_of({"convert", teapot, "-o", "a.obj"}), "a.obj: 32 surfaces, 32 patches\n");
  EXPECT_EQ(output_of({"convert", "a.obj", "-o", "b.bpt"}), "b.bpt: 32 surfaces, 32 patches\n");
  output_of({"convert", teapot, "-o", "c.bpt"});
  EXPECT_EQ(content_of(folder_ / "b.bpt"), content_of(folder_ / "c.bpt"));
  EXPECT_EQ(output_of({"eval", "b.bpt", "--grid", "3x3"}), output_of({"eval", teapot, "--grid", "3x3"}));
  EXPECT_EQ(output_of({"eval", "a.obj", "--grid", "3x3"}), output_of({"eval", teapot, "--grid", "3x3"}));
}

TEST_F(ConvertTool, JsonSaysWhatWasWritten) {
  const json facts = json::parse(output_of({"convert", models + "seashell.json", "-o", "a.obj", "--json"}));
  EXPECT_EQ(facts["output"], "a.obj");
  EXPECT_EQ(facts["surfaces"], 1);
  EXPECT_GT(facts["fit_error"]["distance"], 0);
  EXPECT_EQ(facts["warnings"], json::array());
  EXPECT_EQ(facts["patches"], json::parse(output_of({"info", "a.obj", "--json"}))["patches"]);
  const std::string text = output_of({"convert", models + "seashell.json", "-o", "a.obj", "--fit-tolerance", "0.01"});
  EXPECT_NE(text.find("functions fitted to within"), std::string::npos) << text;
}

TEST_F(ConvertTool, WhatIsLostIsAWarning) {
  folder_.file("m.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvp 0.2 0.2\nvp 0.8 0.2\nvp 0.5 0.8\nvp 0.2 0.2\n"
               "cstype bspline\ndeg 1\ncurv2 1 2 3 4\nparm u 0 0 1 2 3 3\nend\n"
               "g rim\ncstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\ntrim 0 3 1\nend\n");
  const ToolRun kept = run({"convert", "m.obj", "-o", "a.obj", "--json"});
  EXPECT_EQ(json::parse(kept.output)["warnings"], json::array());
  const Result<Model> read = read_model(folder_ / "a.obj");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->surfaces.at(0).trims->size(), 1u);
  const ToolRun lost = run({"convert", "m.obj", "-o", "a.bpt", "--json"});
  EXPECT_EQ(lost.status, 0);
  EXPECT_NE(lost.errors.find("tessera: warning: surface 0 (rim): 1 trim is not written: .bpt has none\n"),
            std::string::npos)
      << lost.errors;
  EXPECT_EQ(json::parse(lost.output)["warnings"].size(), 1u);
}

TEST_F(ConvertTool, WhatCannotBeConverted) {
  expect_failure({"convert", teapot}, 2, "convert: expected --output FILE, found none");
  expect_failure({"convert", teapot, "-o", "a.ply"}, 2, "surfaces are written as .bpt, .json, .obj");
  expect_failure({"convert", models + "goblet.json", "-o", "a.bpt"}, 1,
                 "tessera: a.bpt: surface 0 (goblet): its patch 0 is rational, but .bpt has no weights: write .obj");
  expect_failure({"convert", "missing.bpt", "-o", "a.obj"}, 1, "missing.bpt: cannot be opened");
  folder_.file("m.bpt", content_of(teapot));
  expect_failure({"convert", "m.bpt", "-o", "m.bpt"}, 2, "which would be overwritten");
  expect_failure({"convert", "m.bpt", "-o", "m.bpt/a/m.obj"}, 1, "the folder m.bpt/a cannot be made");
}

TEST_F(ConvertTool, MeshesOfEveryFormatAreWritten) {
  output_of({"tessellate", teapot, "-o", "a.obj", "--grid", "4x4"});
  EXPECT_NE(content_of(folder_ / "a.obj").find("\ng surface 31\n"), std::string::npos);
  output_of({"tessellate", teapot, "-o", "a.stl", "--grid", "4x4"});
  const json obj = json::parse(output_of({"check", "a.obj", "--json"}));
  const json stl = json::parse(output_of({"check", "a.stl", "--json"}));
  for (const char* const name : {"a.glb", "a.gltf"}) {
    output_of({"tessellate", teapot, "-o", name, "--grid", "4x4"});
    EXPECT_EQ(json::parse(output_of({"check", name, "--json"}))["triangles"], stl["triangles"]);
  }
  for (const char* fact : {"distinct_positions", "triangles", "open_edges", "non_manifold_edges"})
    EXPECT_EQ(obj[fact], stl[fact]) << fact;
  EXPECT_EQ(stl["vertices"], stl["distinct_positions"]);
  output_of({"tessellate", teapot, "-o", "a.gltf", "--grid", "4x4"});
  const json gltf = json::parse(content_of(folder_ / "a.gltf"));
  EXPECT_EQ(gltf["meshes"].size(), 32u);
  EXPECT_EQ(gltf["meshes"][7]["name"], "surface 7");
  output_of({"tessellate", teapot, "-o", "a.glb", "--grid", "4x4"});
  EXPECT_EQ(content_of(folder_ / "a.glb").substr(0, 4), "glTF");
}

TEST_F(ConvertTool, PicturesOfNumbers) {
  const std::string text = output_of({"raycast", teapot, "-o", "a.exr", "--size", "40x30"});
  EXPECT_EQ(text.rfind("a.exr: 40 x 30, 32 patches", 0), 0u) << text;
  const std::string bytes = content_of(folder_ / "a.exr");
  EXPECT_EQ(bytes.substr(0, 4), "\x76\x2f\x31\x01");  // "OpenEXR File Layout": the magic number
  for (const char* channel : {"N.X", "UV.V", "Z", "patch", "surface"})
    EXPECT_NE(bytes.find(std::string(channel) + '\0'), std::string::npos) << channel;
  expect_failure({"raycast", teapot, "-o", "b.exr", "--shade", "uv"}, 2, "--shade: an .exr picture holds numbers");
  expect_failure({"raycast", teapot, "-o", "b.tif"}, 2, "pictures are written as .png, .exr");
}

}}  // namespace tessera::test
