// Free-form OBJ files of other programs, and the values that one of them expects: a table of what was read of each.
// The folder is named by the environment variable TESSERA_TEST_DATA.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "tessera/io.h"

namespace tessera {
namespace {

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

/// What is wrong with the files that are refused: words of the message.
const std::map<std::string, std::string> refused{
    {"ex1_taylor_curve.obj", ":2: expected a statement"},      // numbers of the page's formula before the data
    {"ex2_bezier_curve.obj", "no free-form surface in it"},    // a curve alone
    {"ex3_bspline_surface.obj", ":23: expected a statement"},  // a continuation that is none
    {"ex6_trimmed_nurb_surface.obj", ":26: surface 0: the domain is empty: it runs from knots v[2] = -2"},
    {"invalid_bmatrix_missing_step.obj", ":23: surface 0: there is no step for u"},
    {"invalid_wrong_control_count.obj",
     ":7: surface 0: its parameters and degrees want 3 x 3 control points, it has 4"},
};

TEST_F(ObjFiles, AllAreReadWholeOrRefusedWithTheirReason) {
  for (const char* folder : {"obj_freeform_spec", "obj_freeform_tests", "obj_freeform_files"}) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(data_ / folder))
      if (entry.path().extension() == ".obj") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    EXPECT_FALSE(paths.empty()) << folder;
    for (const fs::path& path : paths) {
      const std::string file = path.filename().string();
      const auto wrong = refused.find(file);
      const Result<Model> model = read_model(path);
      std::cout << folder << " | " << file << " | ";
      if (!model) {
        std::cout << "refused: " << model.status().message().substr(path.string().size()) << "\n";
        ASSERT_NE(wrong, refused.end()) << model.status().message();
        EXPECT_NE(model.status().message().find(wrong->second), std::string::npos) << model.status().message();
        continue;
      }
      EXPECT_EQ(wrong, refused.end()) << file;
      std::cout << model->surfaces.size() << " x " << kind_name(model->surfaces.front().surface);
      for (const std::string& warning : model->warnings) std::cout << " | " << warning.substr(path.string().size());
      std::cout << "\n";
      const Result<PatchSet> set = make_patch_set(*model);
      EXPECT_TRUE(set.ok()) << file << ": " << set.status().message();
    }
  }
}

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

}  // namespace
}  // namespace tessera
