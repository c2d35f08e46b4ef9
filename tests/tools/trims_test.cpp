// Trimmed models: meshes and pictures show what is kept, and say how.

#include "tessera/io.h"
#include "tools/picture.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

class Trims : public ToolTest {
 protected:
  Trims() {
    const std::string square =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvp 0.2 0.2\nvp 0.8 0.2\nvp 0.8 0.8\nvp 0.2 0.2\n"
        "cstype bezier\ndeg 1\ncurv2 1 2 3 4 1\nparm u 0 1 2 3 4\nend\n"
        "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\n";
    folder_.file("plain.obj", square + "end\n");
    folder_.file("trimmed.obj", square + "trim 0 4 1\nend\n");
  }
};

// The triangle that the loop keeps has an area of 0.18, the square of 1.
TEST_F(Trims, DecideWhatIsMeshed) {
  const auto area = [&](const Names& options) {
    Names command{"tessellate", "trimmed.obj", "-o", "a.ply"};
    command.insert(command.end(), options.begin(), options.end());
    const ToolRun result = run(command);
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    const Result<Mesh> mesh = read_mesh(folder_ / "a.ply");
    double sum = 0;
    for (std::size_t t = 0; mesh && t < mesh->triangle_count(); ++t) {
      const auto at = [&](std::size_t c) { return &mesh->positions[3 * std::size_t{mesh->indices[3 * t + c]}]; };
      sum += double((at(1)[0] - at(0)[0]) * (at(2)[1] - at(0)[1]) - (at(1)[1] - at(0)[1]) * (at(2)[0] - at(0)[0])) / 2;
    }
    return sum;
  };
  EXPECT_NEAR(area({}), 0.18, 1e-6);
  EXPECT_NEAR(area({"--untrimmed"}), 1, 1e-6);
  expect_failure({"tessellate", "trimmed.obj", "-o", "a.ply", "--grid", "2x2"}, 1,
                 "uniform rates need whole patches, and trimming loops cut 1 patch of this set");
  EXPECT_NEAR(area({"--grid", "2x2", "--untrimmed"}), 1, 1e-6);
}

TEST_F(Trims, AreKeptByRaysOfBothModes) {
  for (const Names& command : {Names{"raycast", "trimmed.obj", "-o", "a.png", "--size", "16x16", "--shade", "uv"},
                               Names{"raycast", "trimmed.obj", "-o", "a.exr", "--size", "16x16"}}) {
    Names by_facets = command;
    by_facets.insert(by_facets.end(), {"--mode", "grid"});
    for (const Names& rays : {command, by_facets}) EXPECT_EQ(output_of(rays).find("trimmed:"), std::string::npos);
  }
  for (const Names& command : {Names{"info", "trimmed.obj"}, Names{"eval", "trimmed.obj", "--grid", "2x2"},
                               Names{"raycast", "trimmed.obj", "--terminal", "--size", "16x16"}})
    output_of(command);
}

TEST_F(Trims, AreInTheFacts) {
  const json facts = json::parse(run({"info", "trimmed.obj", "--json"}).output);
  EXPECT_EQ(facts["trimmed_surfaces"], 1);
  EXPECT_EQ(json::parse(output_of({"info", "plain.obj", "--json"}))["trimmed_surfaces"], 0);
  EXPECT_EQ(facts["loops"], 1);
  EXPECT_NE(run({"info", "trimmed.obj"}).output.find("\n  trims            1 of 1 face, 1 loop\n"), std::string::npos);
}

TEST_F(Trims, ThePictureSaysSo) {
  const Names options{"--size", "400x300", "--json"};
  Names plain{"raycast", "plain.obj", "-o", "plain.png"}, trimmed{"raycast", "trimmed.obj", "-o", "trimmed.png"};
  plain.insert(plain.end(), options.begin(), options.end());
  trimmed.insert(trimmed.end(), options.begin(), options.end());
  trimmed.push_back("--edges");
  EXPECT_EQ(json::parse(output_of(plain))["caption"], "");
  const json report = json::parse(run(trimmed).output);
  const std::string caption = report["caption"];
  EXPECT_EQ(caption.rfind("1 surface is trimmed: drawn by a mesh within ", 0), 0u) << caption;
  EXPECT_EQ(report["trimmed_surfaces"], 1);
  // In the metadata: a tEXt chunk with the keyword Warning (PNG specification, 11.3.4.3).
  EXPECT_NE(content_of(folder_ / "trimmed.png").find(std::string("tEXtWarning\0", 12) + "1 surface is trimmed"),
            std::string::npos);
  EXPECT_EQ(content_of(folder_ / "plain.png").find("tEXt"), std::string::npos);
  // In the picture: the strip at the bottom is dark with bright letters, and less of the square is seen above it.
  const Picture a = read_picture(folder_ / "plain.png"), b = read_picture(folder_ / "trimmed.png");
  ASSERT_EQ(a.rgb.size(), b.rgb.size());
  const std::size_t row = 3 * a.width;
  std::size_t bright = 0;
  for (std::size_t k = (a.height - 9) * row; k < b.rgb.size(); k += 3) bright += b.rgb[k] > 200;
  EXPECT_GT(bright, 200u);  // 40 letters of about 12 dots
  EXPECT_LT(bright, 9u * a.width / 2);
}

TEST_F(Trims, SmallPicturesSayItShorter) {
  for (const char* const size : {"150x40", "50x40", "20x12", "16x9", "9x5", "1x1"}) {
    const ToolRun result = run({"raycast", "trimmed.obj", "-o", "a.png", "--size", size, "--edges"});
    EXPECT_EQ(result.status, 0) << result.errors;
  }
}

TEST_F(Trims, TheTerminalSaysSo) {
  EXPECT_NE(run({"raycast", "trimmed.obj", "--terminal", "--size", "16x16", "--edges"})
                .output.find("\ntrimmed.obj: 1 surface is trimmed: drawn by a mesh within "),
            std::string::npos);
}

TEST_F(Trims, RaysHitWhatLoopsKeep) {
  std::string rays = "ox,oy,oz,dx,dy,dz\n";
  constexpr int side = 40;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      rays += std::to_string((i + 0.5) / side) + "," + std::to_string((j + 0.5) / side) + ",5,0,0,-1\n";
  folder_.file("rays.csv", rays);
  const auto hits = [&](const std::string& file, const std::string& mode) {
    output_of({"raycast", file, "--rays", "rays.csv", "--hits", "hits.csv", "--mode", mode});
    std::size_t count = 0;
    for (const std::vector<std::string>& row : cells_of(content_of(folder_ / "hits.csv"))) count += row[1] == "1";
    return count;
  };
  for (const char* const mode : {"exact", "grid"}) {
    EXPECT_EQ(hits("plain.obj", mode), std::size_t{side * side});
    EXPECT_NEAR(static_cast<double>(hits("trimmed.obj", mode)) / (side * side), 0.18, 0.03);
  }
}

TEST_F(Trims, HitsNameTheirFaces) {
  folder_.file("named.json", R"({"format": "tessera", "version": 1, "surfaces": [
    {"kind": "bezier", "name": "wall", "points": [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]},
    {"kind": "bezier", "name": "bore, \"left\"", "points": [[[2, 0, 0], [2, 1, 0]], [[3, 0, 0], [3, 1, 0]]]}]})");
  folder_.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0.5,0.5,5,0,0,-1\n2.5,0.5,5,0,0,-1\n9,9,5,0,0,-1\n");
  output_of({"raycast", "named.json", "--rays", "rays.csv", "--hits", "hits.csv"});
  const std::string table = content_of(folder_ / "hits.csv");
  EXPECT_NE(table.find("nz,edge,name\n"), std::string::npos);
  EXPECT_NE(table.find(",0,wall\n"), std::string::npos);
  EXPECT_NE(table.find(",0,\"bore, \"\"left\"\"\"\n"), std::string::npos);
  EXPECT_NE(table.find("\n2,0,,,,,,,,,,,,,\n"), std::string::npos);
}

}}  // namespace tessera::test
