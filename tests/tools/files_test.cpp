// Commands on several files: patterns, outputs, and files that fail among others that don't.

#include <filesystem>

#include "tessera/io.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

class Files : public ToolTest {
 protected:
  Files() {
    // Squares one above the other, of one to three patches.
    for (int k = 1; k <= 3; ++k) {
      const std::string z = std::to_string(k);
      std::string text = z + "\n";
      for (int p = 0; p < k; ++p) {
        const std::string x0 = std::to_string(p), x1 = std::to_string(p + 1);
        text += "1 1\n" + x0 + " 0 " + z + "\n" + x0 + " 1 " + z + "\n" + x1 + " 0 " + z + "\n" + x1 + " 1 " + z + "\n";
      }
      folder_.file("m" + z + ".bpt", text);
    }
    folder_.file("bad.bpt", "1\n3 3\n");
  }

  static std::vector<json> lines_of(const std::string& text) {
    std::vector<json> objects;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) objects.push_back(json::parse(line));
    return objects;
  }
};

TEST_F(Files, PatternsStandForTheFilesThatMatchInOrder) {
  std::filesystem::create_directory(folder_ / "m9.bpt");  // folders are skipped
  const std::vector<json> facts = lines_of(output_of({"info", "m*.bpt", "--json"}));
  ASSERT_EQ(facts.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(facts[k]["model"], "m" + std::to_string(k + 1) + ".bpt");
    EXPECT_EQ(facts[k]["patches"], k + 1);
  }
  EXPECT_EQ(lines_of(output_of({"info", "m[13].bpt", "m2.bpt", "--json"})).size(), 3u);
  EXPECT_EQ(lines_of(output_of({"info", "m?.bpt", "--json"})).size(), 3u);
}

TEST_F(Files, ANameWithStarsThatIsAFileIsThatFile) {
  folder_.file("m*.bpt", "1\n1 1\n0 0 0 0 1 0 1 0 0 1 1 0\n");
  const std::vector<json> facts = lines_of(output_of({"info", "m*.bpt", "--json"}));
  ASSERT_EQ(facts.size(), 1u);
  EXPECT_EQ(facts[0]["model"], "m*.bpt");
}

TEST_F(Files, APatternThatMatchesNothingIsAnError) {
  expect_failure({"info", "x*.bpt"}, 1, "tessera: x*.bpt: expected files that match, found none");
  const ToolRun run = this->run({"info", "x*.bpt", "m1.bpt"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.output.rfind("m1.bpt: 1 surface, 1 Bezier patch", 0), 0u) << run.output;
}

TEST_F(Files, AFileThatFailsDoesNotStopTheOthers) {
  const ToolRun run = this->run({"info", "m1.bpt", "bad.bpt", "missing.bpt", "m2.bpt", "--json"});
  EXPECT_EQ(run.status, 1);
  const std::vector<json> facts = lines_of(run.output);
  ASSERT_EQ(facts.size(), 4u);
  EXPECT_EQ(facts[0]["patches"], 1);
  EXPECT_EQ(facts[1]["files"], json({"bad.bpt"}));
  EXPECT_EQ(facts[1]["error"]["code"], "parse_error");
  EXPECT_EQ(facts[2]["error"]["code"], "io_error");
  EXPECT_EQ(facts[3]["patches"], 2);
  EXPECT_EQ(run.errors, "tessera: " + facts[1]["error"]["message"].get<std::string>() +
                            "\ntessera: " + facts[2]["error"]["message"].get<std::string>() + "\n");
}

TEST_F(Files, OneOutputTakesThemTogether) {
  const json report =
      json::parse(output_of({"tessellate", "m1.bpt", "m2.bpt", "-o", "a.ply", "--grid", "2x2", "--json"}));
  EXPECT_EQ(report["models"], json({"m1.bpt", "m2.bpt"}));
  EXPECT_EQ(report["surfaces"], 3);
  const Result<Mesh> mesh = read_mesh(folder_ / "a.ply");
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh->vertex_count(), 3u * 9);
  // The numbers of surfaces continue from file to file.
  const auto rows = cells_of(output_of({"eval", "m1.bpt", "m2.bpt", "--grid", "2x2"}));
  ASSERT_EQ(rows.size(), 1u + 3 * 4);
  EXPECT_EQ(rows[4][0], "0");
  EXPECT_EQ(rows[5][0], "1");
  EXPECT_EQ(rows[4][5], "1");
  EXPECT_EQ(rows[5][5], "2");  // z
  folder_.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0.5,0.5,9,0,0,-1\n0.5,0.5,-9,0,0,1\n");
  output_of({"raycast", "m1.bpt", "m2.bpt", "--rays", "rays.csv", "--hits", "hits.csv"});
  const auto hits = cells_of(content_of(folder_ / "hits.csv"));
  EXPECT_EQ(hits[1][3], "1");
  EXPECT_EQ(hits[2][3], "0");
}

TEST_F(Files, TogetherWithoutThoseThatFail) {
  const ToolRun run = this->run({"tessellate", "m1.bpt", "bad.bpt", "-o", "a.ply", "--grid", "2x2", "--json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.errors.rfind("tessera: bad.bpt:2:", 0), 0u) << run.errors;
  const json report = json::parse(run.output);
  EXPECT_EQ(report["models"], json({"m1.bpt"}));
  EXPECT_EQ(report["failed"][0]["file"], "bad.bpt");
  EXPECT_EQ(report["vertices"], 9);
  const ToolRun none = this->run({"tessellate", "bad.bpt", "missing.bpt", "-o", "b.ply", "--grid", "2x2"});
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.errors.find("none of the 2 models can be used"), std::string::npos) << none.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.ply"));
}

TEST_F(Files, FoldersAndPatternsTakeOneEach) {
  std::filesystem::create_directory(folder_ / "out");
  output_of({"tessellate", "m*.bpt", "-o", "out", "--grid", "2x2"});
  output_of({"tessellate", "m*.bpt", "-o", "out/{name}-fine.obj", "--grid", "4x4"});
  const ToolRun drafts = run({"raycast", "m*.bpt", "-o", "out/", "--size", "16x16"});
  EXPECT_EQ(drafts.status, 0);
  EXPECT_NE(drafts.errors.find("3 pictures are drawn as drafts; --quality final takes"), std::string::npos);
  EXPECT_EQ(run({"raycast", "m*.bpt", "-o", "out/", "--size", "16x16", "--quality", "final"}).errors, "");
  EXPECT_EQ(run({"raycast", "m1.bpt", "-o", "out/m1.png", "--size", "16x16"}).errors, "");
  output_of({"eval", "m*.bpt", "-o", "out/{name}.csv", "--grid", "2x2"});
  for (const char* const name : {"m1.ply", "m2.ply", "m3.ply", "m1-fine.obj", "m2-fine.obj", "m3-fine.obj", "m1.png",
                                 "m2.png", "m3.png", "m1.csv", "m2.csv", "m3.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out" / name)) << name;
  const Result<Mesh> mesh = read_mesh(folder_.path() / "out" / "m2.ply");
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(mesh->vertex_count(), 2u * 9);
}

TEST_F(Files, TwoFilesAreNotWrittenToOnePlace) {
  std::filesystem::create_directory(folder_ / "sub");
  folder_.file("sub/m1.bpt", content_of(folder_ / "m1.bpt"));
  expect_failure({"raycast", "m1.bpt", "sub/m1.bpt", "-o", "{name}.png"}, 2,
                 "--output: m1.bpt and sub/m1.bpt would both be written as m1.png");
  folder_.file("m1.ply", "");
  expect_failure({"tessellate", "m1.bpt", "m1.ply", "-o", "{name}.ply", "--grid", "2x2"}, 2, "m1.ply");
}

TEST_F(Files, ErrorsNameTheFileAndItsOwnSurface) {
  folder_.file("large.bpt", "2\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n1 1\n-1e300 0 0\n0 1 0\n1 0 0\n1e300 1 0\n");
  const ToolRun run = this->run({"tessellate", "m2.bpt", "large.bpt", "-o", "a.ply", "--grid", "2x2"});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("tessera: large.bpt: surface 1: "), std::string::npos) << run.errors;
}

TEST_F(Files, MeshesAreCheckedOneByOne) {
  output_of({"tessellate", "m*.bpt", "-o", "{name}.ply", "--grid", "2x2"});
  const std::vector<json> reports = lines_of(output_of({"check", "m*.ply", "--json"}));
  ASSERT_EQ(reports.size(), 3u);
  EXPECT_EQ(reports[2]["mesh"], "m3.ply");
}

}}  // namespace tessera::test
