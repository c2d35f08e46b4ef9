// tessera eval: its tables against the reference evaluators, and errors of tables.

#include <charconv>
#include <cmath>

#include "tessera/io.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

class EvalTool : public ToolTest {
 protected:
  EvalTool() : model_(read_model(teapot)) {}
  const BezierPatch& patch(std::size_t surface) const {
    return std::get<BezierPatch>(model_->surfaces[surface].surface);
  }
  Result<Model> model_;
};

double number(const std::string& text) {
  double value = std::nan("");
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  EXPECT_TRUE(error == std::errc() && end == text.data() + text.size()) << text;
  return value;
}

Vec3 vector_at(const std::vector<std::string>& row, std::size_t first) {
  return {number(row[first]), number(row[first + 1]), number(row[first + 2])};
}

TEST_F(EvalTool, GridsCoverEverySurfaceFromBorderToBorder) {
  const auto rows = cells_of(output_of({"eval", teapot, "--grid", "3x5"}));
  ASSERT_EQ(rows.size(), 1 + 32u * 3 * 5);
  EXPECT_EQ(rows[0], (Names{"surface", "u", "v", "x", "y", "z", "nx", "ny", "nz"}));
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const std::vector<std::string>& row = rows[k + 1];
    const double u = static_cast<double>(k / 5 % 3) / 2, v = static_cast<double>(k % 5) / 4;
    ASSERT_EQ(row.size(), 9u);
    EXPECT_EQ(number(row[0]), static_cast<double>(k / 15));
    EXPECT_EQ(number(row[1]), u);
    EXPECT_EQ(number(row[2]), v);
    EXPECT_LE(length(vector_at(row, 3) - de_casteljau(patch(k / 15), u, v)), 1e-14);
    EXPECT_NEAR(length(vector_at(row, 6)), 1, 1e-14);
  }
}

TEST_F(EvalTool, DerivativesAreThoseOfTheReference) {
  folder_.file("p.csv",
               "\xEF\xBB\xBF# places\r\nsurface, u ,v\r\n\r\n4,0.25,0.75\r\n 31 , 1 , 0 # a corner\r\n20,0,0.5");
  const auto rows = cells_of(output_of({"eval", teapot, "--params", "p.csv", "--derivs", "2"}));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0],
            (Names{"surface", "u",    "v",    "x",    "y",    "z",    "dux",  "duy",  "duz",  "dvx", "dvy", "dvz",
                   "duux",    "duuy", "duuz", "duvx", "duvy", "duvz", "dvvx", "dvvy", "dvvz", "nx",  "ny",  "nz"}));
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const auto surface = static_cast<std::size_t>(number(rows[k][0]));
    const double u = number(rows[k][1]), v = number(rows[k][2]);
    const SurfaceJet jet = evaluate_jet(patch(surface), u, v);
    // 17 digits bring back every bit.
    EXPECT_EQ(vector_at(rows[k], 3), jet.position);
    EXPECT_EQ(vector_at(rows[k], 6), jet.du);
    EXPECT_EQ(vector_at(rows[k], 9), jet.dv);
    EXPECT_EQ(vector_at(rows[k], 12), jet.duu);
    EXPECT_EQ(vector_at(rows[k], 15), jet.duv);
    EXPECT_EQ(vector_at(rows[k], 18), jet.dvv);
    EXPECT_EQ(vector_at(rows[k], 21), unit_normal(patch(surface), u, v).direction);
  }
}

TEST_F(EvalTool, JsonAndCsvSayTheSame) {
  const auto rows = cells_of(output_of({"eval", teapot, "--grid", "2x3", "--derivs", "1"}));
  const auto json =
      nlohmann::json::parse(output_of({"eval", teapot, "--grid", "2x3", "--derivs", "1", "--format", "json"}));
  ASSERT_EQ(json["rows"].size(), rows.size() - 1);
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const auto& object = json["rows"][k];
    const std::vector<std::string>& row = rows[k + 1];
    EXPECT_EQ(object["surface"].get<double>(), number(row[0]));
    EXPECT_EQ(object["u"].get<double>(), number(row[1]));
    EXPECT_EQ(object["v"].get<double>(), number(row[2]));
    std::size_t column = 3;
    for (const char* name : {"position", "du", "dv", "normal"}) {
      for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(object[name][c].get<double>(), number(row[column++])) << name;
    }
    EXPECT_FALSE(object.contains("duu"));
  }
}

/// The normal of the function, not of the fitted patches, which is wrong by the square root of their error.
TEST_F(EvalTool, TheNormalAtTheTopOfAHemisphereIsUpright) {
  const std::string hemisphere = TESSERA_SOURCE_DIR "/tools/models/hemisphere.json";
  folder_.file("p.csv", "surface,u,v\n0,0,0\n0,0,1.25\n0,0,4\n");
  const auto rows = cells_of(output_of({"eval", hemisphere, "--params", "p.csv"}));
  ASSERT_EQ(rows.size(), 4u);
  for (std::size_t k = 1; k < rows.size(); ++k) EXPECT_LE(length(vector_at(rows[k], 6) - Vec3{0, 0, 1}), 1e-9) << k;
}

TEST_F(EvalTool, WhereThereIsNoNormalItIsZeroOrNull) {
  folder_.file("point.bpt", "1\n1 1\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n");
  const auto rows = cells_of(output_of({"eval", "point.bpt", "--grid", "2x2"}));
  EXPECT_EQ(vector_at(rows.at(1), 6), Vec3{});
  const auto json = nlohmann::json::parse(output_of({"eval", "point.bpt", "--grid", "2x2", "--format", "json"}));
  EXPECT_TRUE(json["rows"][0]["normal"].is_null());
}

TEST_F(EvalTool, TheFileHoldsWhatStandardOutputWould) {
  EXPECT_EQ(output_of({"eval", teapot, "--grid", "2x2", "-o", "a.csv"}), "");
  EXPECT_EQ(folder_.names(), Names{"a.csv"});
  EXPECT_EQ(content_of(folder_ / "a.csv"), output_of({"eval", teapot, "--grid", "2x2"}));
  EXPECT_EQ(output_of({"eval", teapot, "--grid", "2x2", "-o", "/dev/stdout"}), content_of(folder_ / "a.csv"));
}

TEST_F(EvalTool, BadTablesAreRefusedByLine) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "p.csv: the file is empty"},
      {"# nothing\n", "p.csv:1: expected a header line surface,u,v, found the end of the file"},
      {"0,0.5,0.5\n", "p.csv:1: expected a header line surface,u,v, found \"0\""},
      {"surface,u\n0,0.5\n", "p.csv:1: expected a header line surface,u,v"},
      {"surface,u,v,w\n0,0.5,0.5,1\n", "p.csv:1: expected a header line surface,u,v"},
      {"surface,u,v\n\n0,0.5\n", "p.csv:3: expected 3 numbers (surface,u,v), found the end of the line"},
      {"surface,u,v\n0,0.5,\n", "p.csv:2: expected 3 numbers (surface,u,v), found the end of the line"},
      {"surface,u,v\n0,,0.5\n", "p.csv:2: expected 3 numbers (surface,u,v), found \",\""},
      {"surface,u,v\n0,0.5,0.5,0.5\n", "p.csv:2: expected the end of the line after 3 numbers, found \",\""},
      {"surface,u,v\n0,0.5,a\n", "p.csv:2: expected 3 numbers (surface,u,v), found \"a\""},
      {"surface,u,v\n0,0.5,0.5\n32,0.5,0.5\n", "p.csv:3: expected a surface from 0 to 31, found 32"},
      {"surface,u,v\n-1,0.5,0.5\n", "p.csv:2: expected a surface from 0 to 31, found -1"},
      {"surface,u,v\n0.5,0.5,0.5\n", "p.csv:2: expected a surface from 0 to 31, found 0.5"},
      {"surface,u,v\nnan,0.5,0.5\n", "p.csv:2: expected a surface from 0 to 31, found nan"},
      {"surface,u,v\n0,1.5,0.5\n", "p.csv:2: expected u and v in the surface's domain [0,1] x [0,1], found 1.5,0.5"},
      {"surface,u,v\n0,0.5,nan\n", "p.csv:2: expected u and v in the surface's domain [0,1] x [0,1], found 0.5,nan"},
  };
  for (const auto& [text, message] : cases) {
    folder_.file("p.csv", text);
    expect_failure({"eval", teapot, "--params", "p.csv", "-o", "out.csv"}, 1, "tessera: " + message);
  }
  expect_failure({"eval", teapot, "--params", "missing.csv"}, 1, "missing.csv: cannot be opened");
}

TEST_F(EvalTool, NoRowsGiveAHeaderAlone) {
  folder_.file("p.csv", "surface,u,v\n");
  EXPECT_EQ(output_of({"eval", teapot, "--params", "p.csv"}), "surface,u,v,x,y,z,nx,ny,nz\n");
}

}}  // namespace tessera::test
