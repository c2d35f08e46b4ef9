// Options that every command has, and the messages for a wrong command line.

#include <chrono>
#include <filesystem>
#include <thread>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;
using CommonOptions = ToolTest;

TEST_F(CommonOptions, WrongWordsAreNamedWithWhatMayBeMeant) {
  expect_failure({"inof", teapot}, 2, "tessera: there is no command inof; did you mean info?\n");
  expect_failure({"ray", teapot}, 2, "there is no command ray; did you mean raycast?");
  expect_failure({"paint"}, 2, "there is no command paint\n");
  expect_failure({"tesselate", teapot, "-o", "y.glb"}, 2, "there is no command tesselate; did you mean tessellate?");
  expect_failure({"raycast", teapot, "-o", "a.png", "--sise", "20x20"}, 2,
                 "tessera: raycast has no option --sise; did you mean --size?");
  expect_failure({"raycast", teapot, "-o", "a.png", "--sise=20x20"}, 2, "did you mean --size?");
  expect_failure({"info", "--jsno"}, 2, "tessera: info has no option --jsno; did you mean --json?");
  expect_failure({"info", teapot, "--colourful"}, 2, "tessera: info has no option --colourful\n");
  expect_failure({"--versoin"}, 2, "there is no option --versoin before a command; did you mean --version?");
  expect_failure(
      {"raycast", teapot, "-o", "a.png", "--shade", "normal"}, 2,
      "expected lambert, normals, uv, patch, error, curvature, clay or steps, found \"normal\"; did you mean normals?");
}

TEST_F(CommonOptions, InstructionSetsAreForced) {
  EXPECT_EQ(json::parse(output_of({"info", teapot, "--json", "--isa", "sse2"}))["isa"]["used"], "sse2");
  expect_failure({"info", teapot, "--isa", "avx3"}, 2, "expected sse2, avx2 or avx512, found \"avx3\"");
  const json isas = json::parse(output_of({"info", teapot, "--json"}))["isa"]["available"];
  for (const char* const name : {"avx2", "avx512"}) {
    if (std::find(isas.begin(), isas.end(), name) != isas.end()) {
      EXPECT_EQ(json::parse(output_of({"info", teapot, "--json", "--isa", name}))["isa"]["used"], name);
    } else {
      expect_failure({"info", teapot, "--isa", name}, 2, "this machine lacks the instruction set");
    }
  }
}

TEST_F(CommonOptions, ThreadsAreAsManyAsAskedFor) {
  for (const char* const bad : {"0", "-1", "x", "1.5", "1025"})
    expect_failure({"info", teapot, "--threads", bad}, 2, "expected a whole number from 1 to 1024");
  for (const int threads : {1, 3}) {
    const RunningProgram tool(folder_, {TESSERA_TOOL, "raycast", teapot, "-o", "a.png", "--size", "4096x4096",
                                        "--threads", std::to_string(threads)});
    const std::string tasks = "/proc/" + std::to_string(tool.id()) + "/task";
    long most = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(threads == 1 ? 2 : 30);
    while (std::chrono::steady_clock::now() < end && (threads == 1 || most < threads)) {
      std::error_code error;
      most = std::max(most, static_cast<long>(std::distance(std::filesystem::directory_iterator(tasks, error), {})));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_EQ(most, threads);
  }
}

TEST_F(CommonOptions, ThePictureIsTheSameForAnyNumberOfThreads) {
  output_of({"raycast", teapot, "-o", "a.png", "--size", "96x64", "--threads", "1"});
  output_of({"raycast", teapot, "-o", "b.png", "--size", "96x64", "--threads", "4"});
  EXPECT_EQ(content_of(folder_ / "a.png"), content_of(folder_ / "b.png"));
}

TEST_F(CommonOptions, TimingsAreToldOnRequest) {
  folder_.file("p.csv", "x,y,z\n0,0,9\n");
  const std::vector<std::pair<Names, Names>> commands{
      {{"info", teapot}, {"read", "convert", "pack", "joined edges", "joins"}},
      {{"eval", teapot, "--grid", "2x2", "-o", "a.csv"}, {"read", "evaluate"}},
      {{"tessellate", teapot, "--grid", "2x2", "-o", "a.ply"}, {"read", "convert", "pack", "evaluate", "write"}},
      {{"raycast", teapot, "--size", "16x16", "-o", "a.png"},
       {"read", "convert", "pack", "build", "evaluate", "write"}},
      {{"section", teapot, "--at", "1", "-o", "a.svg"}, {"read", "convert", "pack", "section", "write"}},
      {{"project", teapot, "--points", "p.csv", "-o", "b.csv"},
       {"read", "convert", "pack", "build", "evaluate", "write"}},
      {{"check", "a.ply"}, {"read", "check"}},
      {{"compare", teapot, "a.ply", "--samples", "99", "-o", "c.ply"},
       {"read", "convert", "pack", "build", "mesh", "evaluate", "write"}},
      {{"measure", teapot}, {"read", "measure"}}};
  for (const auto& [command, phases] : commands) {
    Names with = command;
    with.push_back("--timings");
    const ToolRun text = run(with);
    EXPECT_EQ(text.status, 0);
    EXPECT_EQ(text.errors.rfind("tessera: " + command[1] + ": read ", 0), 0u) << text.errors;
    EXPECT_TRUE(text.errors.ends_with(" s in all\n")) << text.errors;
    with.push_back("--json");
    const json seconds = json::parse(output_of(with))["seconds"];
    double sum = 0;
    for (const std::string& phase : phases) {
      ASSERT_TRUE(seconds.contains(phase)) << command[0] << ' ' << phase;
      EXPECT_NE(text.errors.find(" " + phase + " "), std::string::npos) << phase;
      EXPECT_GE(seconds[phase], 0);
      sum += seconds[phase].get<double>();
    }
    EXPECT_EQ(seconds.size(), phases.size() + 1);
    EXPECT_GE(seconds["total"].get<double>(), sum);
    Names without = command;
    without.push_back("--json");
    EXPECT_FALSE(json::parse(output_of(without)).contains("seconds"));
  }
}

TEST_F(CommonOptions, RowsAreJsonOnStandardOutput) {
  const json rows = json::parse(output_of({"eval", teapot, "--grid", "2x2", "--json", "--timings"}));
  EXPECT_EQ(rows["rows"].size(), 32u * 4);
  EXPECT_TRUE(rows["seconds"].contains("read"));
  const json report = json::parse(output_of({"eval", teapot, "--grid", "2x2", "--json", "-o", "a.csv"}));
  EXPECT_EQ(report["rows"], 32 * 4);
  EXPECT_EQ(cells_of(content_of(folder_ / "a.csv")).size(), 1u + 32 * 4);
}

}}  // namespace tessera::test
