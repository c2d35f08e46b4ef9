// tessera tessellate --strict: faults of a mesh in the exit status.

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

class Strict : public ToolTest {
 protected:
  static constexpr const char* head = R"({"format": "tessera", "version": 1, "surfaces": [)";
  /// Runs with --strict; checks that the mesh is written and that a run without it succeeds.
  void expect_fault(const std::string& model, const std::string& output, const std::string& words,
                    const Names& options = {}) {
    Names command{"tessellate", model, "-o", output};
    command.insert(command.end(), options.begin(), options.end());
    EXPECT_EQ(run(command).status, 0);
    std::filesystem::remove(folder_ / output);
    command.push_back("--strict");
    const ToolRun result = run(command);
    EXPECT_EQ(result.status, 1) << words;
    EXPECT_NE(result.errors.find(output + ": the mesh is written, but not as --strict demands: "), std::string::npos)
        << result.errors;
    EXPECT_NE(result.errors.find(words), std::string::npos) << result.errors;
    EXPECT_TRUE(std::filesystem::exists(folder_ / output));
    command.push_back("--json");
    const json faults = json::parse(run(command).output)["faults"];
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_NE(faults[0].get<std::string>().find(words), std::string::npos) << faults;
  }
};

TEST_F(Strict, ARightMeshEndsWithZero) {
  for (const char* const model : {"goblet.json", "trimmed_plate.json", "bearing_block.step"}) {
    const std::string file = TESSERA_SOURCE_DIR "/tools/models/" + std::string(model);
#ifndef TESSERA_HAS_CAD_READER
    if (file.ends_with(".step")) continue;
#endif
    const ToolRun result = run({"tessellate", file, "-o", "a.ply", "--strict", "--json"});
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(json::parse(result.output)["faults"], json::array()) << model;
    EXPECT_TRUE(json::parse(output_of({"tessellate", file, "-o", "a.ply", "--json"}))["faults"].is_null());
  }
}

TEST_F(Strict, PartsThatAreSkippedCount) {
  folder_.file("mixed.rib", "Sphere 1 -1 1 360\nPolygon \"P\" [0 0 0 1 0 0 0 1 0]\n");
  expect_fault("mixed.rib", "a.ply", "1 part of the file skipped or changed");
}

TEST_F(Strict, FloatsTooCoarseCount) {
  folder_.file("far.json", std::string(head) + R"({"kind": "sphere", "radius": 1, "axis": {"origin": [1e8, 0, 0]}}]})");
  expect_fault("far.json", "a.stl", "the numbers of the file are too coarse for the tolerance");
}

TEST_F(Strict, IsNotForGrids) {
  expect_failure({"tessellate", teapot, "-o", "a.ply", "--grid", "2x2", "--strict"}, 2,
                 "cannot be combined with --grid");
}

}}  // namespace tessera::test
