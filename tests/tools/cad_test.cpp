// STEP, IGES and BREP parts through the command line.

#include <chrono>
#include <cstdlib>
#include <thread>

#include "tools/picture.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using CadTool = ToolTest;

#ifdef TESSERA_HAS_CAD_READER

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
  for (const char* const part : {"step_cad/as1-oc-214.stp", "step_cad/face_recognition_sample_part.stp",
                                 "step_cad/screw.step", "iges_cad/occt_hammer.iges", "iges_cad/brlcad_wing128.igs",
                                 "iges_cad/igesio_input.igs", "brep_occt/bottle.brep"}) {
    const std::string path = (std::filesystem::path(data) / part).string();
    const ToolRun info = run({"info", path, "--json"});
    expect_warnings(info, path);
    const json facts = json::parse(info.output);
    EXPECT_GE(facts["patches"], facts["surfaces"]);
    EXPECT_GT(facts["size"], 1.0);
    expect_warnings(run({"tessellate", path, "-o", "a.ply"}), path);
    const json mesh = json::parse(output_of({"check", "a.ply", "--json"}));
    EXPECT_EQ(mesh["non_finite_vertices"], 0);
    const ToolRun picture = run({"raycast", path, "-o", "a.png", "--size", "64x48"});
    expect_warnings(picture, path);
    EXPECT_GT(content_of(folder_ / "a.png").size(), 500u);
  }
}

TEST_F(CadTool, HitsTellTheFaceAndWhetherTheRayPassesAnEdge) {
  const std::string block = TESSERA_SOURCE_DIR "/tools/models/bearing_block.step";
  folder_.file("rays.csv",
               "ox,oy,oz,dx,dy,dz\n"
               "100,-220,205,-100,200,-150\n"    // at a vertex of the bearing's rim, (0, -20, 55)
               "100,-220,205.3,-100,200,-150\n"  // a little above it
               "100,-220,205,100,200,150\n");
  const json facts = json::parse(output_of({"raycast", block, "--rays", "rays.csv", "--hits", "a.csv", "--json"}));
  EXPECT_EQ(facts["hits"], 2);
  EXPECT_EQ(facts["edge"], 1);
  const auto rows = cells_of(content_of(folder_ / "a.csv"));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1][13], "1");
  EXPECT_NEAR(std::stod(rows[1][2]), 1, 1e-6);
  EXPECT_EQ(rows[2][13], "0");
  EXPECT_EQ(rows[3][13], "");
  EXPECT_NE(rows[2][14], "");
}

TEST_F(CadTool, AFileWithShapesAndOneWithoutAreMeshedTogether) {
  const std::string models = TESSERA_SOURCE_DIR "/tools/models/";
  const std::string block = models + "bearing_block.step", teapot = models + "teapot.bpt";
  for (const auto& [first, second] : {std::pair(teapot, block), std::pair(block, teapot)}) {
    const json facts = json::parse(output_of({"tessellate", first, second, "-o", "a.ply", "--json"}));
    EXPECT_EQ(facts["models"].size(), 2u);
    EXPECT_GT(facts["triangles"], 1000);
  }
}

TEST_F(CadTool, TheBearingBlockIsMeshedClosedAndDrawnInItsColours) {
  const std::string block = TESSERA_SOURCE_DIR "/tools/models/bearing_block.step";
  const json facts = json::parse(output_of({"tessellate", block, "-o", "a.ply", "--json"}));
  EXPECT_EQ(facts["shapes"], 4);
  EXPECT_EQ(facts["instances"], 5);
  EXPECT_EQ(facts["solids"], 5);
  EXPECT_EQ(facts["open_edges"], 0);
  // Solids that touch have edges in one place, which one mesh of them all shows as edges of four triangles.
  EXPECT_EQ(json::parse(output_of({"check", "a.ply", "--json"}))["open_edges"], 0);
  for (const char* const shade : {"clay", "lambert"}) {
    output_of({"raycast", block, "-o", "a.png", "--size", "96x52", "--shade", shade, "--quality", "draft",
               "--camera=-115,-210,150,0,-4,31,24"});
    const Picture picture = read_picture(folder_ / "a.png");
    std::size_t blue = 0, brass = 0;
    for (std::size_t k = 0; k < picture.rgb.size(); k += 3) {
      const int red = picture.rgb[k], green = picture.rgb[k + 1], other = picture.rgb[k + 2];
      blue += other > green + 30 && green > red + 15;
      brass += red > green + 15 && green > other + 30;
    }
    EXPECT_GT(blue, 500u) << shade;   // the block has a fifth of 4992 pixels
    EXPECT_GT(brass, 150u) << shade;  // the bush has about a twentieth
  }
}

TEST_F(CadTool, EdgesSolidsAndUnitsOfRealPartsAreTold) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const auto facts_of = [&](const char* part) {
    return json::parse(run({"info", (std::filesystem::path(data) / part).string(), "--joins", "0", "--json"}).output);
  };
  const json assembly = facts_of("step_cad/as1-oc-214.stp"), topology = assembly["topology"];
  EXPECT_EQ(topology["shapes"], 5);
  EXPECT_EQ(topology["instances"], 18);
  EXPECT_EQ(topology["solids"], 18);
  EXPECT_EQ(topology["closed_shells"], 18);
  EXPECT_EQ(topology["open_shells"], 0);
  EXPECT_EQ(topology["edges"], 354);
  EXPECT_EQ(topology["edges_of_two_faces"], 354);
  EXPECT_EQ(topology["edges_of_one_face"], 0);
  EXPECT_EQ(topology["edges_of_more_faces"], 0);
  EXPECT_NEAR(topology["largest_gap"], 2.8e-5, 1e-6);
  EXPECT_EQ(assembly["unit"], "mm");
  EXPECT_EQ(assembly["file_unit"], "millimetre");
  EXPECT_TRUE(assembly["joined_topology"].is_null());
  const json hammer = facts_of("iges_cad/occt_hammer.iges"), joined = hammer["joined_topology"];
  EXPECT_EQ(hammer["topology"]["edges_of_one_face"], 208);
  EXPECT_EQ(hammer["topology"]["largest_gap"], 0);
  EXPECT_EQ(joined["edges_of_two_faces"], 104);
  EXPECT_EQ(joined["edges_of_one_face"], 0);
  EXPECT_EQ(joined["closed_shells"], 1);
  EXPECT_EQ(joined["open_shells"], 0);
  EXPECT_GT(joined["largest_gap"], 1);
  EXPECT_LT(joined["largest_gap"], 3);
  const json bottle = facts_of("brep_occt/bottle.brep");
  EXPECT_EQ(bottle["topology"]["degenerate_edges"], 16);
  EXPECT_TRUE(bottle["unit"].is_null());
  const std::string text =
      run({"info", (std::filesystem::path(data) / "step_cad/screw.step").string(), "--joins", "0"}).output;
  EXPECT_NE(text.find("  edges            22 edges: 22 of two faces, 0 of one, 0 of more\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("  solids           1 solid; shells: 1 closed, 0 open\n"), std::string::npos) << text;
  EXPECT_NE(text.find("; sampled, 65 points of each edge\n"), std::string::npos) << text;
}

TEST_F(CadTool, BrokenPartsAreRefused) {
  folder_.file("part.step", "ISO-10303-21;\nnonsense");
  expect_failure({"info", "part.step", "--step-reader", "opencascade"}, 1,
                 "tessera: part.step: OpenCASCADE cannot read it as STEP: Line ");
}

#else

TEST_F(CadTool, SaysWhatIsMissing) {
  folder_.file("part.step", "ISO-10303-21;");
  expect_failure({"info", "part.step", "--step-reader", "opencascade"}, 1,
                 "tessera: part.step: STEP files are read by the program tessera-cad-reader, which is neither");
}

#endif

TEST_F(CadTool, TheReaderIsNamedByOptionOrVariable) {
  folder_.file("part.step", "ISO-10303-21;");
  const auto reader = [&](const std::string& name, const std::string& script) {
    std::filesystem::permissions(folder_.file(name, "#!/bin/sh\n" + script), std::filesystem::perms::owner_all);
  };
  reader("one", "exit 11");
  reader("two", "exit 12");
  const std::string named = "tessera: part.step: the CAD reader ./one ended without a greeting (exit status 11)\n";
  const auto info = [](std::vector<std::string> more) {
    std::vector<std::string> words{"info", "part.step", "--step-reader", "opencascade"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  EXPECT_EQ(run(info({}), {"TESSERA_CAD_READER=./one"}).errors, named);
  EXPECT_EQ(run(info({"--cad-reader", "./one"}), {"TESSERA_CAD_READER=./two"}).errors, named);
  expect_failure(info({"--cad-reader", "none"}), 1,
                 "part.step: the CAD reader none cannot be started: No such file or directory");
  expect_failure(info({"--cad-reader", ""}), 2, "--cad-reader: ");
}

TEST_F(CadTool, TheReaderOfStepIsChosen) {
  folder_.file("part.step", "nonsense");
  std::filesystem::permissions(folder_.file("reader", "#!/bin/sh\ntouch started; exit 11"),
                               std::filesystem::perms::owner_all);
  for (const char* const command : {"info", "tessellate", "measure", "convert"}) {
    std::vector<std::string> words{command, "part.step", "--cad-reader", "./reader", "--step-reader", "tessera"};
    if (command == std::string("tessellate") || command == std::string("convert"))
      words.insert(words.end(), {"-o", command == std::string("convert") ? "a.json" : "a.ply"});
    const ToolRun result = run(words);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.errors.rfind("tessera: part.step: ", 0), 0u) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "started")) << command;
  }
  EXPECT_EQ(run({"info", "part.step", "--cad-reader", "./reader", "--step-reader", "either"}).status, 1);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "started"));
  expect_failure({"info", "part.step", "--step-reader", "occt"}, 2,
                 "--step-reader: expected tessera, opencascade or either, found \"occt\"");
  expect_failure({"info", "part.step", "--step-reader"}, 2, "--step-reader");
}

TEST_F(CadTool, PackedPartsAreHandedToTheReaderUnpacked) {
  // Only the content reaches the reader, which says how many bytes it sees.
  std::filesystem::permissions(folder_.file("reader", "#!/bin/sh\nwc -c < \"$2\" > seen; exit 11"),
                               std::filesystem::perms::owner_all);
  const std::string gz(
      "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03\x2b\xcf\x2f\x4a\x29\xe6\x02\x00\x86\xb4\xa8\xd6\x06\x00\x00\x00",
      26);  // "words\n"
  const std::string ended = ": the CAD reader ./reader ended without a greeting (exit status 11)\n";
  for (const char* const name : {"a.step.gz", "a.stpz", "a.igs.gz", "a.p21"}) {
    folder_.file(name, gz);
    const ToolRun result = run({"info", name, "--step-reader", "opencascade", "--cad-reader", "./reader"});
    EXPECT_EQ(result.errors, "tessera: " + std::string(name) + ended);
    EXPECT_EQ(content_of(folder_ / "seen"), "6\n") << name;
  }
  folder_.file("cut.stpz", gz.substr(0, 20));
  expect_failure({"info", "cut.stpz"}, 1, "tessera: cut.stpz: the file ends within the gzip data, after 20 bytes");
  folder_.file("bad.stpz", "PK\3\4");
  expect_failure({"info", "bad.stpz"}, 1, "tessera: bad.stpz: the zip archive has no end");
}

TEST_F(CadTool, AnInterruptEndsTheReader) {
  folder_.file("part.step", "ISO-10303-21;");
  std::filesystem::permissions(folder_.file("slow", "#!/bin/sh\necho $$ > pid; mv pid started; exec sleep 60"),
                               std::filesystem::perms::owner_all);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    RunningProgram tool(folder_, {TESSERA_TOOL, "tessellate", "part.step", "-o", "a.ply", "--grid", "2x2",
                                  "--step-reader", "opencascade", "--cad-reader", "./slow"});
    const std::string started = folder_ / "started";
    for (int k = 0; k < 20000 && !std::filesystem::exists(started); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const pid_t reader = std::stoi(content_of(started));
    EXPECT_EQ(::kill(reader, 0), 0);
    tool.signal(signal);
    const ToolRun result = tool.wait();
    EXPECT_EQ(result.status, 128 + signal);
    EXPECT_EQ(result.output + result.errors, "");
    EXPECT_EQ(::kill(reader, 0), -1) << "the reader still runs";
    std::filesystem::remove(started);
    EXPECT_EQ(folder_.names(), (Names{"part.step", "slow"}));
  }
}

}}  // namespace tessera::test
