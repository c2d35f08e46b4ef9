// tessera measure: boxes, areas, volumes and inertia with their bounds.

#include <cmath>
#include <numbers>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

class Measure : public ToolTest {
 protected:
  /// A ball of radius 2 about (1, 0, 0), as a quadric.
  void write_ball() const {
    folder_.file("ball.json", R"({"format": "tessera", "version": 1, "surfaces": [{"kind": "quadric",
      "coefficients": {"a": 1, "b": 1, "c": 1, "g": -1, "k": -3}, "range": [["-pi", "pi"], ["-pi/2", "pi/2"]]}]})");
  }
};

void expect_measured(const json& found, double truth, double share) {
  EXPECT_LE(std::abs(found["value"].get<double>() - truth), found["error"].get<double>());
  EXPECT_LE(found["error"].get<double>(), share * truth);
}

TEST_F(Measure, ABallTakenAsEnclosed) {
  write_ball();
  const json ball = json::parse(output_of({"measure", "ball.json", "--enclosed", "--inertia", "--json"}));
  const double pi = std::numbers::pi, volume = 32.0 / 3.0 * pi;
  expect_measured(ball["area"], 16 * pi, 1e-8);
  expect_measured(ball["volume"], volume, 1e-8);
  expect_measured({{"value", ball["inertia"]["xx"]}, {"error", ball["inertia"]["error"]}}, 0.4 * volume * 4, 1e-6);
  EXPECT_NEAR(ball["volume_centroid"]["value"][0].get<double>(), 1, 1e-8);
  EXPECT_NEAR(ball["box"]["lower"][0].get<double>(), -1, 1e-8);
  EXPECT_NEAR(ball["box"]["upper"][2].get<double>(), 2, 1e-8);
  EXPECT_EQ(ball["bodies"], 1);
  const std::string text = output_of({"measure", "ball.json", "--enclosed", "--inertia"});
  for (const char* const words : {"ball.json: 1 surface\n", "\n  volume           33.51032",
                                  "\n  area             50.26548", "\n  principal 3      53.6165", " within "})
    EXPECT_NE(text.find(words), std::string::npos) << words << " in\n" << text;
}

TEST_F(Measure, AModelWithoutSolidsHasNoVolume) {
  write_ball();
  const json open = json::parse(output_of({"measure", "ball.json", "--json"}));
  EXPECT_EQ(open["bodies"], 0);
  EXPECT_TRUE(open["volume"].is_null());
  EXPECT_EQ(open["bodies_fault"], "the model has no solids");
  EXPECT_FALSE(open.contains("inertia"));
  const ToolRun required = run({"measure", "ball.json", "--require-solids"});
  EXPECT_EQ(required.status, 1);
  EXPECT_EQ(required.errors, "tessera: ball.json: the model has no solids\n");
}

TEST_F(Measure, ACoarserAccuracyHasAWiderBound) {
  const auto error = [&](const std::string& accuracy) {
    return json::parse(output_of({"measure", teapot, "--json", "--accuracy", accuracy}))["area"]["error"].get<double>();
  };
  const double coarse = error("1e-3"), fine = error("1e-11");
  EXPECT_GT(coarse, 1e3 * fine);
  EXPECT_LE(coarse, 0.5);
  expect_failure({"measure", teapot, "--accuracy", "1"}, 2, "--accuracy: expected a number from 1e-14 to 1e-2");
}

TEST_F(Measure, ACadPart) {
  const std::string block = TESSERA_SOURCE_DIR "/tools/models/bearing_block.step";
  const ToolRun found = run({"measure", block, "--json", "--require-solids"});
  if (found.errors.find("CAD") != std::string::npos) GTEST_SKIP() << found.errors;
  EXPECT_EQ(found.status, 0) << found.errors;
  const json part = json::parse(found.output);
  EXPECT_EQ(part["unit"], "mm");
  EXPECT_GE(part["bodies"], 1);
  double sum = 0;
  for (const json& body : part["each_body"]) sum += body["volume"]["value"].get<double>();
  EXPECT_NEAR(part["volume"]["value"].get<double>(), sum, 1e-9 * sum);
  EXPECT_LE(part["volume"]["error"].get<double>(), 1e-4 * sum);
}

}}  // namespace tessera::test
