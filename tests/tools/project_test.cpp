// tessera project: tables of nearest points.

#include <gmock/gmock.h>

#include <cmath>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using testing::HasSubstr;
using ProjectTool = ToolTest;

const std::string sphere_file = TESSERA_SOURCE_DIR "/tools/models/sphere.json";

TEST_F(ProjectTool, ASphereIsMetAlongItsRadius) {
  folder_.file("p.csv", "x,y,z\n3,0,0\n0,0.5,0\n# a comment\n0,0,-7\n");
  const std::string text = output_of({"project", sphere_file, "--points", "p.csv", "-o", "near.csv"});
  EXPECT_THAT(text, HasSubstr("near.csv: 3 points, 3 with a nearest one, 3 proven, largest distance 6, mean 2.8"));
  const std::string table = content_of(folder_ / "near.csv");
  EXPECT_EQ(table.substr(0, table.find('\n')),
            "point,found,distance,surface,patch,u,v,x,y,z,nx,ny,nz,certified,ambiguous,border,name");
  EXPECT_EQ(std::ranges::count(table, '\n'), 4);
  const json facts = json::parse(
      output_of({"project", sphere_file, "--points", "p.csv", "-o", "near.csv", "--json", "--max-distance", "2.5"}));
  EXPECT_EQ(facts["points"], 3);
  EXPECT_EQ(facts["found"], 2);
  EXPECT_EQ(facts["certified"], 3);
  EXPECT_NEAR(facts["largest_distance"], 2, 1e-14);
  EXPECT_NEAR(facts["mean_distance"], 1.25, 1e-14);
  EXPECT_THAT(content_of(folder_ / "near.csv"), HasSubstr("\n2,0,,,,,,,,,,,,,,,\n"));
}

TEST_F(ProjectTool, AnyNumberOfThreadsWritesTheSameBytes) {
  std::string points = "x,y,z\n";
  for (int k = 0; k < 3000; ++k)
    points +=
        std::to_string(std::sin(k)) + "," + std::to_string(std::cos(1.3 * k)) + "," + std::to_string(0.001 * k) + "\n";
  folder_.file("p.csv", points);
  output_of({"project", teapot, "--points", "p.csv", "-o", "a.csv", "--threads", "1"});
  output_of({"project", teapot, "--points", "p.csv", "-o", "b.csv", "--threads", "4"});
  EXPECT_EQ(content_of(folder_ / "a.csv"), content_of(folder_ / "b.csv"));
}

TEST_F(ProjectTool, WrongCommandsAndTablesAreTold) {
  folder_.file("p.csv", "x,y,z\n0,0,0\n");
  folder_.file("nan.csv", "x,y,z\n0,0,0\n0,nan,1\n");
  folder_.file("head.csv", "a,b\n1,2\n");
  expect_failure({"project", teapot, "-o", "a.csv"}, 2, "--points");
  expect_failure({"project", teapot, "--points", "p.csv"}, 2, "--output");
  expect_failure({"project", teapot, "--points", "p.csv", "-o", "a.csv", "--max-distance", "-1"}, 2, "--max-distance");
  expect_failure({"project", teapot, "--points", "no.csv", "-o", "a.csv"}, 1, "no.csv: cannot be opened");
  expect_failure({"project", teapot, "--points", "nan.csv", "-o", "a.csv"}, 1,
                 "nan.csv:3: expected a finite point, found 0,nan,1");
  expect_failure({"project", teapot, "--points", "head.csv", "-o", "a.csv"}, 1, "a header line x,y,z");
}

}}  // namespace tessera::test
