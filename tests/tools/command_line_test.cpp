// The command line itself: help, version, errors.

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using CommandLine = ToolTest;

TEST_F(CommandLine, HelpAndVersion) {
  const std::string help = output_of({"--help"});
  for (const char* command : {"info", "eval", "tessellate", "raycast", "check"}) {
    EXPECT_NE(help.find(command), std::string::npos);
    const std::string words = output_of({command, "--help"});
    EXPECT_NE(words.find(std::string("\n  tessera ") + command), std::string::npos) << "no example: " << words;
  }
  const std::string version = output_of({"--version"});
  EXPECT_EQ(version.rfind("tessera ", 0), 0u);
  EXPECT_NE(version.find("\nReads surfaces: .bpt, .bv, .g2, .json, .obj, .rib, .step"), std::string::npos) << version;
  const std::vector<std::pair<const char*, std::string>> readers{{"/", "/\n"},
                                                                 {"/no/reader", "/no/reader, which does not exist\n"}};
  for (const auto& [reader, words] : readers) {
    const std::string said = run({"--version"}, {std::string("TESSERA_CAD_READER=") + reader}).output;
    EXPECT_NE(said.find("\nCAD reader (IGES, BREP, STEP on request): " + words), std::string::npos) << said;
  }
}

TEST_F(CommandLine, NoOptionsFollowTwoDashes) {
  const std::string goblet = content_of(TESSERA_SOURCE_DIR "/tools/models/goblet.json");
  for (const char* const name : {"-part.json", "--json", "--", "-"}) folder_.file(name, goblet);
  std::filesystem::rename(folder_ / "--json", folder_ / "--json.json");
  EXPECT_NE(output_of({"info", "--", "-part.json"}).find("1 surface"), std::string::npos);
  EXPECT_NE(output_of({"info", "--", "--json.json"}).find("1 surface"), std::string::npos);
  EXPECT_EQ(output_of({"info", "--json", "--", "-part.json", "--json.json"}).front(), '{');
  output_of({"tessellate", "-o", "a.ply", "--", "-part.json"});
  EXPECT_EQ(output_of({"info", TESSERA_SOURCE_DIR "/tools/models/goblet.json", "--"}).empty(), false);
  expect_failure({"info", "--", "--"}, 1, "--: unsupported format");
  expect_failure({"info", "--"}, 2, "expected files");
  expect_failure({"completion", "bash", "--", "zsh"}, 2, "completion: the word zsh is not expected");
  expect_failure({"--", "info"}, 2, "the word info is not expected");
  expect_failure({"tessellate", "-part.json", "--"}, 2, "tessellate has no option -part.json");
}

TEST_F(CommandLine, HelpThatCannotBeWrittenEndsWithOne) {
  for (const char* option : {"--help", "--version"}) {
    const ToolRun result = run_program(folder_, {"sh", "-c", "exec \"$@\" >/dev/full", "sh", TESSERA_TOOL, option});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.errors, "tessera: standard output: cannot be written: No space left on device\n");
  }
}

TEST_F(CommandLine, OutputsThatCannotBeWrittenAreRefusedBeforeTheWork) {
  folder_.file("file", "x");
  // The model would be an error, too: it is not even read.
  for (const std::vector<std::string>& command :
       {Names{"tessellate", "missing.bpt", "--grid", "2x2", "-o", "file/a/a.ply"},
        Names{"eval", "missing.bpt", "--grid", "2x2", "-o", "file/a/a.csv"},
        Names{"raycast", "missing.bpt", "-o", "file/a/a.png"},
        Names{"raycast", "missing.bpt", "--rays", "missing.csv", "--hits", "file/a/a.csv"}}) {
    expect_failure(
        command, 1,
        "tessera: " + command.back() + ": cannot be written: the folder file/a cannot be made: Not a directory");
  }
}

TEST_F(CommandLine, EveryOptionIsInTheHelp) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> commands{
      {"info", {"MODEL", "--json"}},
      {"eval", {"MODEL", "--grid", "--params", "--derivs", "--format", "--output"}},
      {"tessellate", {"MODEL", "--output", "--grid", "--json"}},
      {"raycast", {"MODEL", "--output", "--size", "--shade", "--camera", "--rays", "--hits", "--mode", "--all-hits"}},
      {"check", {"MESH", "--json"}},
      {"compare", {"MODEL", "MESH", "--tolerance", "--samples", "--spacing", "--mesh-unit", "--output", "--json"}},
      {"measure", {"MODEL", "--accuracy", "--inertia", "--enclosed", "--require-solids", "--json"}}};
  for (const auto& [command, options] : commands) {
    const std::string help = output_of({command, "--help"});
    for (const std::string& option : options)
      EXPECT_NE(help.find(option), std::string::npos) << command << ' ' << option;
  }
}

TEST_F(CommandLine, WhatIsNoCommandLineEndsWithTwo) {
  expect_failure(
      {}, 2,
      "expected a command (info, eval, tessellate, raycast, convert, project, section, check, compare, measure, "
      "view, completion, man or "
      "help), found none");
  expect_failure({"paint"}, 2, "paint");
  expect_failure({"info"}, 2, "MODEL");
  expect_failure({"info", teapot, "--colour"}, 2, "--colour");
  expect_failure({"completion", "bash", "another"}, 2, "tessera: completion: the word another is not expected");
  expect_failure({"eval", teapot}, 2, "");
  expect_failure({"eval", teapot, "--grid", "3x3", "--params", "p.csv"}, 2, "");
  expect_failure({"eval", teapot, "--grid", "3x3", "--derivs", "3"}, 2, "--derivs");
  expect_failure({"eval", teapot, "--grid", "3x3", "--format", "xml"}, 2, "--format");
  expect_failure({"eval"}, 2, "tessera: eval: expected MODEL, found none\n");
  expect_failure({"tessellate", teapot, "--grid", "3x3"}, 2, "--output");
  expect_failure({"tessellate", teapot, "-o", "a.off", "--grid", "3x3"}, 2,
                 "meshes are written as .obj, .ply, .stl, .glb, .gltf");
  expect_failure({"raycast", teapot}, 2, "expected -o");
  expect_failure({"raycast", teapot, "-o", "a.gif"}, 2, "pictures are written as .png");
  expect_failure({"raycast", teapot, "--rays", "a.csv"}, 2, "--hits");
  expect_failure({"raycast", teapot, "--hits", "a.csv"}, 2, "--rays");
  expect_failure({"raycast", teapot, "-o", "a.png", "--rays", "a.csv", "--hits", "b.csv"}, 2, "--rays");
  expect_failure({"raycast", teapot, "-o", "a.png", "--shade", "toon"}, 2, "--shade");
}

TEST_F(CommandLine, RulesOfOptionsAreSaidInPlainWords) {
  expect_failure({"info"}, 2, "tessera: MODEL: expected files or --list FILE, found none\n");
  expect_failure({"tessellate", teapot, "--grid", "3x3"}, 2,
                 "tessera: tessellate: expected --output FILE, found none\n");
  expect_failure({"eval", teapot}, 2, "tessera: eval: expected --grid or --params, found none of them\n");
  expect_failure({"eval", teapot, "--grid", "3x3", "--params", "p.csv"}, 2,
                 "tessera: --params: cannot be combined with --grid\n");
  expect_failure({"eval", teapot, "--grid", "3x3", "--grid", "4x4"}, 2,
                 "tessera: --grid: is there 2 times; give it once\n");
  expect_failure({"eval", teapot, "--grid"}, 2, "tessera: --grid: expected NxM, found nothing\n");
  expect_failure({"raycast", teapot, "--rays", "a.csv"}, 2, "tessera: --rays: needs --hits FILE.csv\n");
  expect_failure({"help", "raycsat"}, 2, "tessera: there is no command raycsat; did you mean raycast?\n");
}

TEST_F(CommandLine, HelpOfACommandIsThatOfTheOption) {
  EXPECT_EQ(output_of({"help"}), output_of({"--help"}));
  for (const char* const command : {"info", "raycast", "help"}) {
    const std::string help = output_of({"help", command});
    EXPECT_EQ(help, output_of({command, "--help"}));
    EXPECT_EQ(help.find("[Option Group"), std::string::npos);
    EXPECT_EQ(help.find("Excludes"), std::string::npos);
  }
}

TEST_F(CommandLine, NumbersOfOptionsAreChecked) {
  for (const char* grid :
       {"3", "3x", "x3", "3x3x3", "0x3", "3x0", "-3x3", "3.5x3", "3 x 3", "axb", "3x4097", "99999999999x3", ""}) {
    expect_failure({"tessellate", teapot, "-o", "a.ply", "--grid", grid}, 2, "--grid");
  }
  expect_failure({"eval", teapot, "--grid", "1x2"}, 2, "from 2 to 65536");
  for (const char* size : {"0x10", "10x16385", "10"}) {
    expect_failure({"raycast", teapot, "-o", "a.png", "--size", size}, 2, "from 1 to 16384");
  }
  for (const char* camera :
       {"1,2,3", "1,2,3,4,5,6,7,8", "1,2,3,4,5,6,x", "1,2,3,4,5,6,nan", "0,0,0,1e999,0,0,40", "1,2,3,1,2,3,40",
        "1,2,3,4,5,6,0", "1,2,3,4,5,6,180", "1,2,3,4,5,6,", "1e19,0,0,0,0,0,40", "0,0,0,0,-1e19,0,40"}) {
    expect_failure({"raycast", teapot, "-o", "a.png", "--camera", camera}, 2, "--camera");
  }
}

TEST_F(CommandLine, InputsAreNotOverwritten) {
  const std::string model = content_of(teapot), rays = "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n",
                    places = "surface,u,v\n0,0,0\n";
  folder_.file("m.bpt", model);
  folder_.file("rays.csv", rays);
  folder_.file("places.csv", places);
  std::filesystem::create_symlink("m.bpt", folder_ / "link.ply");
  std::filesystem::create_hard_link(folder_ / "m.bpt", folder_ / "hard.png");
  expect_failure({"raycast", "m.bpt", "--rays", "rays.csv", "--hits", "./rays.csv"}, 2,
                 "--hits: ./rays.csv is the input");
  expect_failure({"raycast", "m.bpt", "--rays", "rays.csv", "--hits", "m.bpt"}, 2, "--hits: m.bpt is the input");
  expect_failure({"raycast", "m.bpt", "-o", "hard.png"}, 2, "--output: hard.png is the input m.bpt");
  expect_failure({"eval", "m.bpt", "--grid", "2x2", "-o", "m.bpt"}, 2, "--output: m.bpt is the input m.bpt");
  expect_failure({"eval", "m.bpt", "--params", "places.csv", "-o", "places.csv"}, 2,
                 "--output: places.csv is the input");
  expect_failure({"tessellate", "m.bpt", "--grid", "2x2", "-o", "link.ply"}, 2,
                 "--output: link.ply is the input m.bpt");
  EXPECT_EQ(content_of(folder_ / "m.bpt"), model);
  EXPECT_EQ(content_of(folder_ / "rays.csv"), rays);
  EXPECT_EQ(content_of(folder_ / "places.csv"), places);
}

TEST_F(CommandLine, EmptyFileNamesAreRefused) {
  folder_.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n");
  expect_failure({"eval", teapot, "--grid", "2x2", "-o", ""}, 2, "--output");
  expect_failure({"eval", teapot, "--params", ""}, 2, "--params");
  expect_failure({"tessellate", teapot, "--grid", "2x2", "-o", ""}, 2, "--output");
  expect_failure({"raycast", teapot, "-o", ""}, 2, "--output");
  expect_failure({"raycast", teapot, "--rays", "rays.csv", "--hits", ""}, 2, "--hits");
  expect_failure({"raycast", teapot, "--rays", "", "--hits", "hits.csv"}, 2, "--rays");
}

TEST_F(CommandLine, InstructionSetsAreForcedByTheEnvironment) {
  const ToolRun forced = run({"info", teapot, "--json"}, {"TESSERA_ISA=sse2"});
  ASSERT_EQ(forced.status, 0) << forced.errors;
  EXPECT_EQ(nlohmann::json::parse(forced.output)["isa"]["used"], "sse2");
  const ToolRun unknown = run({"info", teapot}, {"TESSERA_ISA=mmx"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.errors.find("mmx"), std::string::npos) << unknown.errors;
  EXPECT_EQ(unknown.output, "");
}

TEST_F(CommandLine, BadModelsEndWithOne) {
  const std::string good = content_of(teapot);
  expect_failure({"info", "missing.bpt"}, 1, "tessera: missing.bpt: cannot be opened: No such file or directory");
  expect_failure({"info", "."}, 1, "is a directory, not a file");
  folder_.file("empty.bpt", "");
  expect_failure({"info", "empty.bpt"}, 1, "tessera: empty.bpt: the file is empty");
  folder_.file("huge.bpt", "4000000000\n3 3\n0 0 0\n");
  expect_failure({"info", "huge.bpt"}, 1, "tessera: huge.bpt:3: the file ends after 1 of 16 control points of patch 1");
  folder_.file("cut.bpt", good.substr(0, good.size() / 2));
  expect_failure({"info", "cut.bpt"}, 1, "tessera: cut.bpt:");
  folder_.file("nan.bpt", "1\n1 1\n0 0 0\n0 1 nan\n1 0 0\n1 1 0\n");
  expect_failure({"info", "nan.bpt"}, 1, "tessera: nan.bpt:4: expected 3 finite numbers");
  folder_.file("inf.bpt", "1\n1 1\n0 0 0\n0 1 0\n1 inf 0\n1 1 0\n");
  expect_failure({"tessellate", "inf.bpt", "-o", "a.ply", "--grid", "2x2"}, 1, "tessera: inf.bpt:5:");
  folder_.file("degree0.bpt", "1\n0 1\n0 0 0\n0 1 0\n");
  expect_failure({"eval", "degree0.bpt", "--grid", "2x2"}, 1, "tessera: degree0.bpt:2: expected the degree along u");
  folder_.file("degree16.bpt", "1\n16 1\n0 0 0\n");
  expect_failure({"raycast", "degree16.bpt", "-o", "a.png"}, 1, "tessera: degree16.bpt:2: expected the degree along u");
  folder_.file("more.bpt", good + "1 2 3\n");
  expect_failure({"info", "more.bpt"}, 1, "expected the end of the file after 32 patches");
  folder_.file("large.bpt", "2\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n1 1\n0 0 0\n0 1 0\n1 0 0\n1e300 1 0\n");
  for (const std::vector<std::string>& command :
       {Names{"info", "large.bpt"}, Names{"tessellate", "large.bpt", "-o", "a.ply", "--grid", "2x2"},
        Names{"raycast", "large.bpt", "-o", "a.png"}}) {
    const ToolRun result = run(command);
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(result.errors.starts_with("tessera: large.bpt: surface 0: patch 0: ") ||
                result.errors.starts_with("tessera: large.bpt: surface 1: patch 1: "))
        << result.errors;
  }
  folder_.file("scene.k3d", "<k3dml/>");
  expect_failure({"info", "scene.k3d"}, 1,
                 "unsupported format \".k3d\": surfaces are read as .bpt, .bv, .g2, .json, .obj, .rib");
}

TEST_F(CommandLine, OutputsThatCannotBeWrittenEndWithOne) {
  folder_.file("file", "x");
  std::filesystem::create_directories(folder_.path() / "folder" / "teapot.ply");
  std::filesystem::create_directories(folder_.path() / "folder" / "teapot.png");
  expect_failure({"tessellate", teapot, "-o", "file/a/a.ply", "--grid", "2x2"}, 1, "file/a/a.ply: cannot be written");
  expect_failure({"tessellate", teapot, "-o", "folder", "--grid", "2x2"}, 1,
                 "folder/teapot.ply: cannot be written: it is a directory");
  expect_failure({"eval", teapot, "--grid", "2x2", "-o", "file/a/a.csv"}, 1, "file/a/a.csv: cannot be written");
  expect_failure({"eval", teapot, "--grid", "2x2", "-o", "/dev/full"}, 1, "No space left on device");
  expect_failure({"raycast", teapot, "-o", "file/a/a.png", "--size", "8x8"}, 1, "file/a/a.png");
  expect_failure({"raycast", teapot, "-o", "folder/", "--size", "8x8"}, 1, "folder/teapot.png");
  folder_.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n");
  expect_failure({"raycast", teapot, "--rays", "rays.csv", "--hits", "file/a/a.csv"}, 1,
                 "file/a/a.csv: cannot be written");
}

}}  // namespace tessera::test
