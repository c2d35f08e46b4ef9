// Free-form OBJ files, and the values that another program expects of them. The folder is named by the environment
// variable TESSERA_TEST_DATA.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tessera/io.h"

namespace tessera { namespace {

namespace fs = std::filesystem;

class ObjFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* const data = std::getenv("TESSERA_TEST_DATA");
    if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
    data_ = data;
  }
  fs::path data_;
};

TEST_F(ObjFiles, PointsAreThoseThatAnotherReaderExpects) {
  const auto json = nlohmann::json::parse(std::ifstream(data_ / "peer_cases" / "obj_freeform_oxideav_A.json"));
  std::size_t values = 0;
  for (const auto& entry : json.at("cases")) {
    const std::string file = entry.at("file").get<std::string>();
    const Result<Model> model = read_model(data_ / file);
    if (entry.at("kind") == "invalid") {
      EXPECT_FALSE(model.ok()) << file;
      continue;
    }
    ASSERT_TRUE(model.ok()) << model.status().message();
    const double tolerance = entry.at("tolerance").get<double>();
    for (const auto& eval : entry.at("evals")) {
      const auto at = eval.at("params").get<std::array<double, 2>>();
      const auto p = eval.at("point").get<std::array<double, 3>>();
      const Result<SurfaceJet> jet = evaluate_jet(model->surfaces.at(0), at[0], at[1]);
      ASSERT_TRUE(jet.ok()) << jet.status().message();
      EXPECT_LE(max_abs(jet->position - Vec3{p[0], p[1], p[2]}), tolerance) << file << " at " << at[0] << ", " << at[1];
      ++values;
    }
  }
  EXPECT_GT(values, 100u);
  std::cout << values << " values\n";
}

}}  // namespace tessera
