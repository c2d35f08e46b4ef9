// tessera tessellate far from zero: the bound that is printed holds for the numbers of the file.

#include "support/file_triangles.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

const Vec3 centre{12958095.124851028, 4865499.469870342, 0};

class FarMeshTool : public ToolTest {
 protected:
  /// A file with a unit sphere about a point.
  std::string ball(const Vec3& at) const {
    const json surface{{"kind", "sphere"}, {"radius", 1}, {"axis", {{"origin", {at.x, at.y, at.z}}}}};
    return folder_.file("ball.json", json{{"format", "tessera"}, {"version", 1}, {"surfaces", {surface}}}.dump());
  }
  /// Meshes it; returns the report, and the distance from the sphere that is found in the file.
  std::pair<json, double> meshed(const Vec3& at, const std::string& output, const Names& options = {}) const {
    Names words{"tessellate", ball(at), "-o", output, "--json"};
    words.insert(words.end(), options.begin(), options.end());
    const ToolRun result = run(words);
    EXPECT_EQ(result.status, 0) << result.errors;
    errors_ = result.errors;
    return {json::parse(result.output), distance_from_sphere(triangles_of_file(folder_ / output), at, 1)};
  }
  mutable std::string errors_;  ///< of the last run
};

TEST_F(FarMeshTool, EachFormatKeepsItsBound) {
  for (const char* const name : {"a.ply", "a.obj", "a.glb", "a.stl"}) {
    for (const double away : {0.0, 5.0, 200.0, 3e4, 1e6}) {
      const Vec3 at{away, away / 3, -away / 7};
      const auto [report, found] = meshed(at, name, {"--tolerance", "0.01"});
      EXPECT_LE(found, report["bound"].get<double>() + 1e-8) << name << " " << away;
      if (std::string(name) == "a.stl" && away > 1e5) continue;  // floats of a sixteenth
      EXPECT_LE(report["bound"], 0.01) << name << " " << away;
      EXPECT_TRUE(report["certified"]) << name << " " << away;
      EXPECT_EQ(errors_, "") << name << " " << away;
    }
  }
}

TEST_F(FarMeshTool, FormatsWithDoublesKeepTheToleranceAndStlSaysThatItDoesNot) {
  for (const char* const name : {"a.ply", "a.obj", "a.glb"}) {
    const auto [report, found] = meshed(centre, name);
    EXPECT_LE(found, report["bound"].get<double>() + 1e-8) << name;
    EXPECT_LE(report["bound"], report["tolerance"]) << name;
    EXPECT_TRUE(report["certified"]) << name;
    EXPECT_EQ(report["precision"], std::string(name) == "a.glb" ? "float" : "double");
    EXPECT_EQ(errors_, "") << name;
  }
  const auto [report, found] = meshed(centre, "a.stl");
  EXPECT_GT(found, 0.2);
  EXPECT_LE(found, report["bound"].get<double>());
  EXPECT_FALSE(report["certified"]);
  EXPECT_NE(errors_.find("tessera: warning: a.stl: floats of this file move vertices by up to "), std::string::npos)
      << errors_;
  EXPECT_NE(errors_.find(".glb does, and .ply and .obj"), std::string::npos) << errors_;
  const ToolRun text = run({"tessellate", "ball.json", "-o", "a.stl"});
  EXPECT_NE(text.output.find(", more than the tolerance"), std::string::npos) << text.output;
  EXPECT_EQ(text.output.find("proven"), std::string::npos) << text.output;
}

TEST_F(FarMeshTool, FloatsOnRequestAreTold) {
  const auto [report, found] = meshed(centre, "a.ply", {"--precision", "float"});
  EXPECT_LE(found, report["bound"].get<double>() + 1e-8);
}

TEST_F(FarMeshTool, AnglesPixelsAndBudgetsHaveBoundsOfTheFileToo) {
  const std::string camera = "--camera=12958105.1,4865499.5,0,12958095.1,4865499.5,0,40";
  for (const char* const name : {"a.ply", "a.obj", "a.glb", "a.stl"}) {
    for (const Names& options :
         {Names{"--angle", "10"}, Names{"--triangles", "2000"}, Names{"--pixels", "1", camera}}) {
      const auto [report, found] = meshed(centre, name, options);
      EXPECT_LE(found, report["bound"].get<double>() + 1e-8) << name << options[0];
    }
    const auto [report, found] = meshed(centre, name, {"--pixels", "1", camera});
    EXPECT_EQ(report["pixels"] > 1, std::string(name) == "a.stl") << name;
  }
}

TEST_F(FarMeshTool, PiecesHaveTheBytesOfTheWhole) {
  std::string patches = "8\n";
  for (int k = 0; k < 8; ++k) {
    patches += "1 1\n";
    for (int i = 0; i < 4; ++i)
      patches +=
          std::to_string(5000000 + 2 * k + i / 2) + ' ' + std::to_string(i % 2) + ' ' + std::to_string(i % 3) + '\n';
  }
  folder_.file("row.bpt", patches);
  for (const char* const tolerance : {"0.001", "0.5", "20"}) {
    output_of({"tessellate", "row.bpt", "-o", "whole.ply", "--tolerance", tolerance});
    output_of({"tessellate", "row.bpt", "-o", "pieces.ply", "--tolerance", tolerance, "--in-pieces", "1K"});
    EXPECT_TRUE(content_of(folder_ / "pieces.ply") == content_of(folder_ / "whole.ply")) << tolerance;
  }
}

}}  // namespace tessera::test
