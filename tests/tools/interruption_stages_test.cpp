// A request to terminate and Ctrl-C end the tool within a second, whatever it does: each command, in each of its
// stages.

#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

class InterruptedStages : public ToolTest {
 protected:
  using Words = std::vector<std::string>;

  /// A field of count x count bent bicubic patches.
  void make_patches(const std::string& name, int count) const {
    std::ofstream file(folder_ / name);
    file << count * count << '\n';
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        file << "3 3\n";
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b < 4; ++b) {
            const int x = 3 * i + a, y = 3 * j + b;
            file << x << ' ' << y << ' ' << (x * 7 + y * 5) % 11 * 0.25 << '\n';
          }
      }
  }

  /// Many copies of a plane with holes, each of which has many sides.
  void make_holes(const std::string& name, int count) const {
    std::string loops;
    for (int k = 0; k < 60; ++k) {
      std::string points;
      for (int p = 0; p <= 60; ++p) {
        const double angle = -2 * 3.14159265358979 * (p % 60) / 60, radius = 0.004 + 0.001 * (p % 2);
        points += (p ? ", [" : "[") + std::to_string(0.05 + 0.1 * (k % 10) + radius * std::cos(angle)) + ", " +
                  std::to_string(0.05 + 0.1 * (k / 10) + radius * std::sin(angle)) + "]";
      }
      loops += (k ? ", " : "") +
               std::string(R"({"curves": [{"kind": "b_spline", "degree": 1, "knots": "clamped", "points": [)") +
               points + "]}]}";
    }
    std::ofstream file(folder_ / name);
    file << R"({"format": "tessera", "version": 1, "surfaces": [)";
    for (int k = 0; k < count; ++k)
      file << (k ? "," : "") << R"({"kind": "sphere", "radius": 1, "axis": {"origin": [)" << 3 * k
           << R"(, 0, 0]}, "trims": [)" << loops << "]}";
    file << "]}";
  }

  /// A pipe that stays open, and is never read or written.
  int silent_pipe(const std::string& name) const {
    EXPECT_EQ(::mkfifo((folder_ / name).c_str(), 0600), 0);
    return ::open((folder_ / name).c_str(), O_RDWR | O_CLOEXEC);
  }

  static bool is_running(const RunningProgram& tool) {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(tool.id()), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0;
  }

  /// Runs a command, interrupts it after a while, and expects its end within a second, without a partial file.
  void expect_end(const Words& command, std::chrono::milliseconds after = 700ms, const Words& variables = {}) const {
    for (const int signal : {SIGTERM, SIGINT}) {
      double taken = seconds_to_end(command, signal, after, variables);
      for (int more = 0; more < 4 && taken >= 1; ++more)  // a busy machine
        taken = seconds_to_end(command, signal, after, variables);
      EXPECT_LT(taken, 1) << command[0];
    }
  }

  double seconds_to_end(const Words& command, int signal, std::chrono::milliseconds after,
                        const Words& variables) const {
    const Names before = folder_.names();
    Words words{TESSERA_TOOL};
    words.insert(words.end(), command.begin(), command.end());
    std::string shown;
    for (const std::string& word : command) shown += word + ' ';
    RunningProgram tool(folder_, words, variables);
    std::this_thread::sleep_for(after);
    const bool runs = is_running(tool);
    const auto asked = Clock::now();
    tool.signal(signal);
    const ToolRun result = tool.wait();
    const std::chrono::duration<double> taken = Clock::now() - asked;
    EXPECT_TRUE(runs) << shown << "ended before it was interrupted";
    EXPECT_EQ(result.status, 128 + signal) << shown << result.errors;
    EXPECT_EQ(result.errors, "") << shown;
    EXPECT_EQ(folder_.names(), before) << shown;
    return taken.count();
  }
};

TEST_F(InterruptedStages, ReadingFromAPipeThatIsSilent) {
  const int model = silent_pipe("silent.bpt"), mesh = silent_pipe("silent.ply"), rays = silent_pipe("silent.csv");
  for (const Words& command :
       {Words{"info", "silent.bpt"}, Words{"tessellate", "silent.bpt", "-o", "a.ply"},
        Words{"convert", "silent.bpt", "-o", "a.json"}, Words{"eval", "silent.bpt", "-o", "a.csv", "--grid", "4x4"},
        Words{"raycast", "silent.bpt", "-o", "a.png"}, Words{"check", "silent.ply"}, Words{"measure", "silent.bpt"},
        Words{"section", "silent.bpt", "-o", "a.svg", "--at", "1"},
        Words{"project", teapot, "--points", "silent.csv", "-o", "a.csv"}, Words{"compare", teapot, "silent.ply"},
        Words{"raycast", teapot, "--rays", "silent.csv", "--hits", "a.csv"}})
    expect_end(command, 300ms);
  for (const int pipe : {model, mesh, rays}) ::close(pipe);
}

TEST_F(InterruptedStages, WritingToAPipeThatIsFull) {
  const int obj = silent_pipe("full.obj"), csv = silent_pipe("full.csv");
  for (const Words& command : {Words{"tessellate", teapot, "-o", "full.obj", "--grid", "64x64"},
                               Words{"eval", teapot, "-o", "full.csv", "--grid", "64x64"}})
    expect_end(command);
  ::close(obj), ::close(csv);
}

TEST_F(InterruptedStages, ReadersOfCadFilesThatDoNotEnd) {
  const std::string reader = folder_.file("reader", "#!/bin/sh\ntrap '' TERM INT HUP\nwhile :; do sleep 0.1; done\n");
  std::filesystem::permissions(reader, std::filesystem::perms::owner_all);
  folder_.file("part.igs", "ISO-10303-21;\n");
  folder_.file("index.html", "");  // the page of view
  for (const Words& command : {Words{"info", "part.igs"}, Words{"tessellate", "part.igs", "-o", "a.glb"},
                               Words{"convert", "part.igs", "-o", "a.json"},
                               Words{"raycast", "part.igs", "-o", "a.png"}, Words{"view", "part.igs", "--web", "."}})
    expect_end(command, 300ms, {"TESSERA_CAD_READER=" + reader});
}

TEST_F(InterruptedStages, LargeFilesAreParsed) {
  make_patches("many.bpt", 500);
  for (const Words& command :
       {Words{"info", "many.bpt"}, Words{"tessellate", "many.bpt", "-o", "a.ply"},
        Words{"convert", "many.bpt", "-o", "a.json"}, Words{"raycast", "many.bpt", "-o", "a.png"}})
    expect_end(command, 150ms);
}

TEST_F(InterruptedStages, PlansAndMeshes) {
  make_patches("many.bpt", 200);
  for (const Words& command :
       {Words{"tessellate", "many.bpt", "-o", "a.ply", "--relative", "1e-5", "--fewest", "--threads", "1"},
        Words{"tessellate", "many.bpt", "-o", "a.ply", "--triangles", "3000000", "--fewest", "--threads", "1"},
        Words{"tessellate", teapot, "-o", "a.ply", "--relative", "1e-7", "--precision", "double", "--threads", "1"},
        Words{"tessellate", "many.bpt", "-o", "a.pvtp", "--relative", "1e-6", "--in-pieces", "16M", "--threads", "1"}})
    expect_end(command);
}

TEST_F(InterruptedStages, FacesThatLoopsCut) {
  make_holes("holes.json", 40);
  for (const Words& command :
       {Words{"tessellate", "holes.json", "-o", "a.ply", "--tolerance", "1e-7", "--threads", "1"},
        Words{"tessellate", "holes.json", "-o", "a.ply", "--triangles", "4000000", "--threads", "1"},
        Words{"raycast", "holes.json", "-o", "a.png", "--threads", "1"}})
    for (const auto after : {200ms, 800ms}) expect_end(command, after);
}

TEST_F(InterruptedStages, RaysAndSamples) {
  make_patches("many.bpt", 150);
  for (const Words& command :
       {Words{"raycast", "many.bpt", "-o", "a.png", "--threads", "1"},
        Words{"raycast", teapot, "-o", "a.png", "--size", "8000x8000", "--threads", "1"},
        Words{"raycast", teapot, "-o", "a.png", "--shade", "error", "--size", "4000x4000", "--threads", "1"},
        Words{"eval", teapot, "-o", "a.csv", "--grid", "2000x2000", "--derivs", "2", "--threads", "1"}})
    expect_end(command);
}

TEST_F(InterruptedStages, BatchesEndTheirWorkers) {
  make_patches("many.bpt", 200);
  std::filesystem::create_directory(folder_ / "meshes");
  make_patches("more.bpt", 200);
  folder_.file("list.txt", "many.bpt\nmore.bpt\n");
  folder_.file("list.txt.1-of-1.done", "");  // the record of each run
  expect_end({"tessellate", "--list", "list.txt", "-o", "meshes/{name}.ply", "--relative", "1e-5", "--fewest"});
}

}}  // namespace tessera::test
