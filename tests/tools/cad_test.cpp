// STEP and IGES parts through the command line.

#include <cstdlib>

#include "tools/tool_test.h"

namespace tessera::test {
namespace {

using nlohmann::json;
using CadTool = ToolTest;

#ifdef TESSERA_HAS_IO_OCCT

/// Runs a command that must succeed with only warnings on standard error.
void expect_warnings(const ToolRun& result, const std::string& path) {
  EXPECT_EQ(result.status, 0) << result.errors;
  std::istringstream lines(result.errors);
  for (std::string line; std::getline(lines, line);)
    EXPECT_EQ(line.find("tessera: warning: " + path + ": "), 0u) << line;
}

TEST_F(CadTool, RealPartsAreMeshedAndDrawn) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  for (const char* const part :
       {"step_cad/as1-oc-214.stp", "step_cad/face_recognition_sample_part.stp", "step_cad/screw.step",
        "iges_cad/occt_hammer.iges", "iges_cad/brlcad_wing128.igs", "iges_cad/igesio_input.igs"}) {
    const std::string path = (std::filesystem::path(data) / part).string();
    const ToolRun info = run({"info", path, "--json"});
    expect_warnings(info, path);
    const json facts = json::parse(info.output);
    EXPECT_GE(facts["patches"], facts["surfaces"]);
    EXPECT_GT(facts["size"], 1.0);
    expect_warnings(run({"tessellate", path, "-o", "a.ply", "--grid", "6x6"}), path);
    const json mesh = json::parse(output_of({"check", "a.ply", "--json"}));
    EXPECT_EQ(mesh["non_finite_vertices"], 0);
    const ToolRun picture = run({"raycast", path, "-o", "a.png", "--size", "64x48"});
    expect_warnings(picture, path);
    EXPECT_EQ(facts["warnings"].empty(), picture.errors.empty());
    EXPECT_GT(content_of(folder_ / "a.png").size(), 500u);
  }
}

TEST_F(CadTool, BrokenPartsAreRefused) {
  folder_.file("part.step", "ISO-10303-21;\nnonsense");
  expect_failure({"info", "part.step"}, 1, "tessera: part.step: OpenCASCADE cannot read it as STEP: Line ");
}

#else

TEST_F(CadTool, SaysWhatIsMissing) {
  folder_.file("part.step", "ISO-10303-21;");
  expect_failure({"info", "part.step"}, 1,
                 "STEP needs a Tessera that was built with OpenCASCADE (libocct-data-exchange-dev)");
}

#endif

}  // namespace
}  // namespace tessera::test
