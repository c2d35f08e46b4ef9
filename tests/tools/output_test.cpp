// Where models come from and meshes go: folders, streams, a limit of memory, and the density without options.

#include <gmock/gmock.h>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using testing::HasSubstr;

class Output : public ToolTest {
 protected:
  /// Runs the tool with standard input from a file.
  ToolRun run_with_input(const std::string& input, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"sh", "-c", "exec \"$@\" <" + input, "sh", TESSERA_TOOL});
    return run_program(folder_, arguments);
  }
};

TEST_F(Output, WithoutADensityARelativeToleranceIsUsedAndSaid) {
  const std::string text = output_of({"tessellate", teapot, "-o", "default.ply"});
  EXPECT_THAT(text, HasSubstr(", proven (--relative 0.001, the default), 182 open edges\n"));
  EXPECT_THAT(output_of({"tessellate", teapot, "-o", "relative.ply", "--relative", "0.001"}),
              testing::Not(HasSubstr("default)")));
  EXPECT_EQ(content_of(folder_ / "default.ply"), content_of(folder_ / "relative.ply"));
  const json facts = json::parse(output_of({"tessellate", teapot, "-o", "default.ply", "--json"}));
  EXPECT_EQ(facts["default_relative"], 0.001);
}

TEST_F(Output, MissingFoldersAreMade) {
  folder_.file("p.csv", "x,y,z\n0,0,9\n");
  const std::vector<std::vector<std::string>> commands{{"tessellate", teapot, "--grid", "2x2", "-o", "a/b/mesh.ply"},
                                                       {"eval", teapot, "--grid", "2x2", "-o", "c/points.csv"},
                                                       {"convert", teapot, "-o", "d/e/model.obj"},
                                                       {"section", teapot, "--at", "1", "-o", "g/cut.svg"},
                                                       {"project", teapot, "--points", "p.csv", "-o", "h/near.csv"},
                                                       {"compare", teapot, "a/b/mesh.ply", "-o", "i/deviations.ply"},
                                                       {"raycast", teapot, "--size", "8x8", "-o", "f/picture.png"}};
  for (const std::vector<std::string>& command : commands) {
    output_of(command);
    EXPECT_GT(content_of(folder_ / command.back()).size(), 0u) << command.back();
  }
}

TEST_F(Output, AFailureLeavesNoFolder) {
  expect_failure({"tessellate", "missing.bpt", "-o", "a/b/mesh.ply"}, 1, "missing.bpt: cannot be opened");
  std::filesystem::create_directory(folder_ / "mine");
  expect_failure({"tessellate", "missing.bpt", "-o", "mine/b/mesh.ply"}, 1, "missing.bpt: cannot be opened");
  folder_.file("file", "x");
  expect_failure({"tessellate", teapot, "-o", "file/b/mesh.ply"}, 1,
                 "tessera: file/b/mesh.ply: cannot be written: the folder file/b cannot be made: Not a directory\n");
}

TEST_F(Output, StreamsHoldTheBytesOfFiles) {
  for (const char* const format : {"obj", "ply", "stl", "glb"}) {
    const std::string name = std::string("a.") + format;
    output_of({"tessellate", teapot, "--grid", "3x3", "-o", name});
    const ToolRun streamed = run({"tessellate", teapot, "--grid", "3x3", "-o", "-", "--format", format});
    EXPECT_EQ(streamed.status, 0);
    EXPECT_EQ(streamed.output, content_of(folder_ / name)) << format;
    EXPECT_THAT(streamed.errors, HasSubstr("-: 512 vertices, 552 triangles"));
  }
  output_of({"convert", teapot, "-o", "a.obj"});
  const ToolRun converted = run({"convert", teapot, "-o", "-", "--format", "obj"});
  EXPECT_EQ(converted.output, content_of(folder_ / "a.obj"));
  output_of({"raycast", teapot, "--size", "16x16", "-o", "a.png"});
  EXPECT_EQ(run({"raycast", teapot, "--size", "16x16", "-o", "-", "--format", "png"}).output,
            content_of(folder_ / "a.png"));
}

TEST_F(Output, ModelsAreReadFromStandardInput) {
  output_of({"tessellate", teapot, "--grid", "3x3", "-o", "a.ply"});
  const ToolRun streamed =
      run_with_input(teapot, {"tessellate", "-", "--input-format", "bpt", "-o", "b.ply", "--grid", "3x3"});
  EXPECT_EQ(streamed.status, 0) << streamed.errors;
  EXPECT_EQ(content_of(folder_ / "b.ply"), content_of(folder_ / "a.ply"));
  folder_.file("cut.bpt", "2\n3 3\n");
  const ToolRun cut = run_with_input("cut.bpt", {"info", "-", "--input-format", "bpt"});
  EXPECT_EQ(cut.status, 1);
  EXPECT_EQ(cut.errors.rfind("tessera: standard input:", 0), 0u) << cut.errors;
}

TEST_F(Output, PartsAreReadFromStandardInput) {
  folder_.file("part", "words\n");
  std::filesystem::permissions(folder_.file("reader", "#!/bin/sh\ncat \"$2\" > seen; exit 11"),
                               std::filesystem::perms::owner_all);
  for (const char* const format : {"step", "p21", "stpz", "igs", "brep"}) {
    const ToolRun result = run_with_input(
        "part", {"info", "-", "--input-format", format, "--step-reader", "opencascade", "--cad-reader", "./reader"});
    EXPECT_EQ(result.errors,
              "tessera: standard input: the CAD reader ./reader ended without a greeting (exit status 11)\n");
    EXPECT_EQ(content_of(folder_ / "seen"), "words\n") << format;
    std::filesystem::remove(folder_ / "seen");
  }
}

TEST_F(Output, StreamsNeedAFormat) {
  expect_failure({"info", "-"}, 2, "MODEL: - needs --input-format NAME");
  expect_failure({"info", "-", "-", "--input-format", "bpt"}, 2, "MODEL: - is there 2 times; give it once");
  expect_failure({"info", teapot, "--input-format", "bpt"}, 2, "--input-format: is for MODEL - only");
  expect_failure({"info", "-", "--input-format", "doc"}, 2, "--input-format: ");
  expect_failure({"tessellate", teapot, "-o", "-"}, 2, "--output: - needs --format NAME");
  expect_failure({"tessellate", teapot, "-o", "a.ply", "--format", "ply"}, 2,
                 "--format: is for -o - only; the extension of a.ply decides its format");
}

TEST_F(Output, AMeshThatNeedsTooMuchMemoryIsRefusedWithTheNumbers) {
  expect_failure({"tessellate", teapot, "-o", "a.ply", "--grid", "4096x4096", "--max-memory", "1G"}, 1,
                 "a mesh of 1073709056 triangles needs 51.6 GB of memory, the limit is 1.07 GB; use fewer segments");
  expect_failure({"tessellate", teapot, "-o", "a.ply", "--grid", "64x64", "--max-memory", "1M"}, 1,
                 "of memory, the limit is 1.05 MB; use fewer segments, a tolerance, or --max-memory");
  expect_failure({"tessellate", teapot, "-o", "a.ply", "--relative", "1e-5", "--max-memory", "1M"}, 1,
                 "the limit is 1.05 MB");
  output_of({"tessellate", teapot, "-o", "a.ply", "--grid", "8x8", "--max-memory", "1M"});
  const Names fine{"tessellate", teapot, "-o", "a.ply", "--relative", "1e-3", "--max-memory", "600K"};
  output_of(fine);
  Names finer = fine;
  finer.insert(finer.end(), {"--precision", "double"});
  expect_failure(finer, 1, "of memory, the limit is 614 kB");
  for (const char* const size : {"0", "-1", "12Q", "M", "1e9", "99999999999999999999", "20000000T", ""})
    expect_failure({"tessellate", teapot, "-o", "b.ply", "--max-memory", size}, 2,
                   "--max-memory: expected a size like 800M or 12G, found ");
}

TEST_F(Output, OpenMeshesAreAnErrorOnRequest) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\n";
  folder_.file("open.obj", corners + faces);
  folder_.file("closed.obj", corners + faces + "f 1 4 3\n");
  output_of({"check", "open.obj"});
  output_of({"check", "closed.obj", "--require-closed"});
  const ToolRun open = run({"check", "open.obj", "--require-closed"});
  EXPECT_EQ(open.status, 1);
  EXPECT_EQ(open.errors, "tessera: open.obj: expected a closed mesh, found 3 open edges and 0 non-manifold edges\n");
  EXPECT_EQ(open.output.rfind("open.obj: not closed\n", 0), 0u);
}

}}  // namespace tessera::test
