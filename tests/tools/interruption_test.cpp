// Signals and limits while the tool writes: no partial file remains, and the exit status says what happened.

#include <sys/stat.h>

#include <chrono>
#include <thread>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

class Interruption : public ToolTest {
 protected:
  /// Waits until the folder holds a temporary of at least `bytes` bytes.
  bool temporary_appears(std::uintmax_t bytes) const {
    for (int k = 0; k < 20000; ++k) {
      for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
        std::error_code error;
        const bool temporary = entry.path().filename().string().find(".tessera-") != std::string::npos;
        if (temporary && entry.file_size(error) >= bytes && !error) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
};

TEST_F(Interruption, WhileWritingKeepsTheFileFromAppearing) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    RunningProgram tool(folder_, {TESSERA_TOOL, "tessellate", teapot, "-o", "a.obj", "--grid", "256x256"});
    ASSERT_TRUE(temporary_appears(1));
    tool.signal(signal);
    const ToolRun result = tool.wait();
    EXPECT_EQ(result.status, 128 + signal);
    EXPECT_EQ(result.output + result.errors, "");
    EXPECT_EQ(folder_.names(), Names{}) << signal;
  }
}

TEST_F(Interruption, WhileNothingListensASecondOneEndsTheToolAndItsTemporary) {
  // A pipe that stays open and silent: the tool waits for its model.
  const std::string model = folder_ / "silent.bpt";
  ASSERT_EQ(::mkfifo(model.c_str(), 0600), 0);
  const int pipe = ::open(model.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(pipe, 0);
  const std::vector<std::vector<std::string>> commands{{"tessellate", model, "-o", "a.ply", "--grid", "4x4"},
                                                       {"eval", model, "-o", "a.csv", "--grid", "4x4"},
                                                       {"raycast", model, "-o", "a.png"}};
  for (std::vector<std::string> words : commands) {
    words.insert(words.begin(), TESSERA_TOOL);
    RunningProgram tool(folder_, words);
    ASSERT_TRUE(temporary_appears(0)) << words[1];
    tool.signal(SIGINT);
    tool.signal(SIGTERM);
    EXPECT_GT(tool.wait().status, 128);
    EXPECT_EQ(folder_.names(), Names{"silent.bpt"}) << words[1];
  }
  ::close(pipe);
}

TEST_F(Interruption, TheNextRunRemovesTheTemporaryOfAKilledOne) {
  RunningProgram tool(folder_, {TESSERA_TOOL, "tessellate", teapot, "-o", "a.obj", "--grid", "256x256"});
  ASSERT_TRUE(temporary_appears(1));
  tool.signal(SIGKILL);
  EXPECT_EQ(tool.wait().status, 128 + SIGKILL);
  EXPECT_EQ(folder_.names(), Names{"a.obj.tessera-0.tmp"});
  output_of({"tessellate", teapot, "-o", "b.obj", "--grid", "2x2"});  // of another file: stays
  EXPECT_EQ(folder_.names(), (Names{"a.obj.tessera-0.tmp", "b.obj"}));
  output_of({"tessellate", teapot, "-o", "a.obj", "--grid", "2x2"});
  EXPECT_EQ(folder_.names(), (Names{"a.obj", "b.obj"}));
}

TEST_F(Interruption, TheTemporaryOfALivingRunIsUnchanged) {
  const std::string model = folder_ / "silent.bpt";
  ASSERT_EQ(::mkfifo(model.c_str(), 0600), 0);
  const int pipe = ::open(model.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(pipe, 0);
  RunningProgram tool(folder_, {TESSERA_TOOL, "tessellate", model, "-o", "a.ply", "--grid", "4x4"});
  ASSERT_TRUE(temporary_appears(0));
  output_of({"tessellate", teapot, "-o", "a.ply", "--grid", "2x2"});
  EXPECT_EQ(folder_.names(), (Names{"a.ply", "a.ply.tessera-0.tmp", "silent.bpt"}));
  tool.signal(SIGINT);
  tool.signal(SIGTERM);
  tool.wait();
  ::close(pipe);
}

TEST_F(Interruption, FilesBeyondTheLimitAreAnError) {
  const std::vector<std::vector<std::string>> commands{{"tessellate", teapot, "-o", "a.ply", "--grid", "64x64"},
                                                       {"tessellate", teapot, "-o", "a.obj", "--grid", "64x64"},
                                                       {"eval", teapot, "-o", "a.csv", "--grid", "64x64"},
                                                       {"raycast", teapot, "-o", "a.png", "--size", "128x128"}};
  for (const std::vector<std::string>& command : commands) {
    std::vector<std::string> words{"sh", "-c", "ulimit -f 8 && exec \"$@\"", "sh", TESSERA_TOOL};
    words.insert(words.end(), command.begin(), command.end());
    const ToolRun result = run_program(folder_, words);
    EXPECT_EQ(result.status, 1) << command[3];
    EXPECT_EQ(result.errors, "tessera: " + command[3] + ": cannot be written: File too large\n");
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(folder_.names(), Names{});
  }
}

}}  // namespace tessera::test
