// Every model that comes with the project goes through every command, and the commands agree with each other.

#include <array>
#include <cmath>
#include <filesystem>

#include "support/random_patches.h"
#include "tessera/io.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

/// Trimmed models have tests of their own: those here evaluate, mesh and hit whole surfaces.
std::vector<std::string> model_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(TESSERA_SOURCE_DIR "/tools/models")) {
    const std::string extension = entry.path().extension().string();
    const bool trimmed = entry.path().stem().string().starts_with("trimmed_");
    if (!trimmed && (extension == ".json" || extension == ".bpt")) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class Models : public ToolTest, public testing::WithParamInterface<std::string> {};

double models_number(const std::string& cell) { return std::stod(cell); }
Vec3 vector(const std::vector<std::string>& row, std::size_t first) {
  return {models_number(row[first]), models_number(row[first + 1]), models_number(row[first + 2])};
}

TEST_P(Models, IsEvaluatedAndMeshedWhole) {
  const json facts = json::parse(output_of({"info", GetParam(), "--json"}));
  EXPECT_GE(facts["patches"], facts["surfaces"]);
  const auto rows = cells_of(output_of({"eval", GetParam(), "--grid", "4x5", "--derivs", "2"}));
  EXPECT_EQ(rows.size(), 1 + 20 * facts["surfaces"].get<std::size_t>());
  for (std::size_t k = 1; k < rows.size(); ++k)
    for (const std::string& cell : rows[k]) EXPECT_TRUE(std::isfinite(models_number(cell))) << "row " << k;
  output_of({"tessellate", GetParam(), "-o", "a.ply", "--grid", "6x5"});
  const json mesh = json::parse(output_of({"check", "a.ply", "--json"}));
  EXPECT_EQ(mesh["non_finite_vertices"], 0);
  EXPECT_EQ(mesh["degenerate_triangles"], 0);
  EXPECT_EQ(mesh["non_manifold_edges"], 0);
}

/// Vertices - edges + triangles: a crack along an edge would change it.
long euler_number(const json& mesh) {
  const long triangles = mesh["triangles"], open = mesh["open_edges"], vertices = mesh["distinct_positions"];
  return vertices - (3 * triangles + open) / 2 + triangles;
}

TEST_P(Models, KeepsATolerance) {
  output_of({"tessellate", GetParam(), "-o", "a.ply", "--grid", "6x6"});
  const json uniform = json::parse(output_of({"check", "a.ply", "--json"}));
  output_of({"tessellate", GetParam(), "-o", "a.ply", "--grid", "17x17"});
  const json finer = json::parse(output_of({"check", "a.ply", "--json"}));
  const double size = json::parse(output_of({"info", GetParam(), "--json"}))["size"];
  // Its octants are turned into their places, so that their borders differ by rounding: cracks of the model's own.
  const bool apart = euler_number(uniform) != euler_number(finer);
  EXPECT_EQ(apart, GetParam().find("sphere_of_octants") != std::string::npos);
  for (const double relative : {0.03, 0.001}) {
    const json made = json::parse(output_of(
        {"tessellate", GetParam(), "-o", "b.ply", "--relative", std::to_string(relative), "--weld", "0", "--json"}));
    EXPECT_LE(made["bound"], relative * size * (1 + 1e-6));
    const json mesh = json::parse(output_of({"check", "b.ply", "--json"}));
    EXPECT_EQ(mesh["triangles"], made["triangles"]);
    EXPECT_EQ(mesh["non_finite_vertices"], 0);
    EXPECT_EQ(mesh["degenerate_triangles"], 0);
    EXPECT_EQ(mesh["non_manifold_edges"], 0);
    EXPECT_EQ(mesh["t_junctions"], 0);
    EXPECT_TRUE(apart || euler_number(mesh) == euler_number(uniform)) << relative;
    EXPECT_EQ(mesh["open_edges"] == 0, uniform["open_edges"] == 0) << relative;
  }
}

/// The distance, by rounding, of octants turned into their places, seams and poles.
TEST_P(Models, HasNoCrackOnceWelded) {
  output_of({"tessellate", GetParam(), "-o", "a.ply", "--grid", "6x6"});
  const json uniform = json::parse(output_of({"check", "a.ply", "--json"}));
  const double size = json::parse(output_of({"info", GetParam(), "--json"}))["size"];
  long euler = 0;
  for (const double relative : {0.03, 0.001}) {
    const json made = json::parse(
        output_of({"tessellate", GetParam(), "-o", "b.ply", "--relative", std::to_string(relative), "--json"}));
    EXPECT_LE(made["bound"], relative * size * (1 + 1e-6));
    const json mesh = json::parse(output_of({"check", "b.ply", "--json"}));
    EXPECT_GE(made["open_edges"], mesh["open_edges"]);
    EXPECT_EQ(mesh["degenerate_triangles"], 0);
    EXPECT_EQ(mesh["non_manifold_edges"], 0);
    EXPECT_EQ(mesh["t_junctions"], 0);
    EXPECT_TRUE(euler == 0 || euler_number(mesh) == euler);
    euler = euler_number(mesh);
    if (GetParam().find("sphere") != std::string::npos && GetParam().find("hemisphere") == std::string::npos) {
      EXPECT_EQ(mesh["closed"], true);
      EXPECT_EQ(euler, 2);
      EXPECT_EQ(made["welded_borders"].get<int>() > 0, GetParam().find("octants") != std::string::npos);
    }
  }
}

TEST_P(Models, IsDrawn) {
  output_of({"raycast", GetParam(), "-o", "a.png", "--size", "40x30"});
  EXPECT_GT(content_of(folder_ / "a.png").size(), 200u);
}

/// Casts rays onto points of the surfaces along their normals. Each must hit there or before, and evaluation at the hit
/// must give the same point, except for the error of fitted callables.
TEST_P(Models, HitsLieWhereEvaluationSaysThatTheyDo) {
  const json facts = json::parse(output_of({"info", GetParam(), "--json"}));
  const double size = facts["size"], fit = facts["fit_error"]["distance"];
  const auto points = cells_of(output_of({"eval", GetParam(), "--grid", "6x6"}));
  std::string rays = "ox,oy,oz,dx,dy,dz\n";
  std::size_t count = 0;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const std::size_t i = (k - 1) / 6 % 6, j = (k - 1) % 6;
    const bool border = i == 0 || j == 0 || i == 5 || j == 5;
    const Vec3 p = vector(points[k], 3), n = vector(points[k], 6);
    if (border || n == Vec3{}) continue;
    const Vec3 origin = p + size * n;
    for (const double value : {origin.x, origin.y, origin.z, -n.x, -n.y}) rays += json(value).dump() + ",";
    rays += json(-n.z).dump() + "\n";
    ++count;
  }
  ASSERT_GT(count, 0u);
  folder_.file("rays.csv", rays);
  output_of({"raycast", GetParam(), "--rays", "rays.csv", "--hits", "hits.csv"});
  const auto hits = cells_of(content_of(folder_ / "hits.csv"));
  ASSERT_EQ(hits.size(), count + 1);
  std::string places = "surface,u,v\n";
  for (std::size_t k = 1; k < hits.size(); ++k) {
    ASSERT_EQ(hits[k][1], "1") << "ray " << k;
    EXPECT_LE(models_number(hits[k][2]), size + fit + 1e-9 * size) << "ray " << k;
    places += hits[k][3] + "," + hits[k][5] + "," + hits[k][6] + "\n";
  }
  folder_.file("places.csv", places);
  const auto found = cells_of(output_of({"eval", GetParam(), "--params", "places.csv"}));
  ASSERT_EQ(found.size(), hits.size());
  for (std::size_t k = 1; k < hits.size(); ++k)
    EXPECT_LE(length(vector(found[k], 3) - vector(hits[k], 7)), fit + 1e-12 * size) << "ray " << k;
}

INSTANTIATE_TEST_SUITE_P(Tools, Models, testing::ValuesIn(model_files()), [](const auto& instance) {
  std::string name = std::filesystem::path(instance.param).stem().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

}}  // namespace tessera::test
