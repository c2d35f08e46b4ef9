// Output of the tool that only terminals see: pictures in characters, and the progress bar.

#include <algorithm>
#include <cmath>

#include "tools/run_in_terminal.h"
#include "tools/tool_test.h"

namespace tessera::test { namespace {

class Terminal : public ToolTest {
 protected:
  void SetUp() override {
    if (!has_pseudo_terminals()) GTEST_SKIP() << "this machine has no pseudo-terminals";
  }
  TerminalRun show(const std::vector<std::string>& arguments, const TerminalKind& kind = {}) const {
    return run_in_terminal(folder_, arguments, kind);
  }
  static std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++found;
    return found;
  }
  static constexpr const char* block = "\u2580";
};

TEST_F(Terminal, APictureOfTheTerminalsSize) {
  const TerminalRun run = show({"raycast", teapot}, {.columns = 60, .rows = 30});
  EXPECT_EQ(run.status, 0);
  // 60 columns are 60 pixels; at 8:5 that is 36 pixels high, two to a line.
  EXPECT_EQ(count(run.screen, block), 60u * 18) << run.screen;
  EXPECT_NE(run.screen.find("\x1b[38;2;"), std::string::npos);
  EXPECT_NE(run.screen.find("\x1b[0m"), std::string::npos);
  const TerminalRun low = show({"raycast", teapot}, {.columns = 200, .rows = 12});
  EXPECT_EQ(count(low.screen, block), 32u * 10);  // 10 lines are 20 pixels, 32 across
}

TEST_F(Terminal, SizesAreInPixels) {
  const TerminalRun run = show({"raycast", teapot, "--size", "20x10"});
  EXPECT_EQ(count(run.screen, block), 20u * 5);
}

TEST_F(Terminal, ColoursAreThoseThatTheTerminalHas) {
  TerminalKind few;
  few.variables = {"TERM=xterm-256color", "COLORTERM=", "NO_COLOR="};
  const TerminalRun run = show({"raycast", teapot, "--size", "20x10"}, few);
  EXPECT_NE(run.screen.find("38;5;"), std::string::npos);
  EXPECT_EQ(run.screen.find("38;2;"), std::string::npos);
  for (const std::vector<std::string>& variables :
       {Names{"TERM=xterm-256color", "COLORTERM=truecolor", "NO_COLOR=1"}, Names{"TERM=dumb", "NO_COLOR="},
        Names{"TERM=vt100", "COLORTERM=", "NO_COLOR="}}) {
    TerminalKind none;
    none.variables = variables;
    const TerminalRun plain = show({"raycast", teapot, "--size", "20x10"}, none);
    EXPECT_EQ(plain.status, 0);
    EXPECT_EQ(plain.screen.find("38;"), std::string::npos) << variables[0];
    EXPECT_EQ(count(plain.screen, block), 0u);
  }
}

TEST_F(Terminal, APipeGetsNoEscapesUnlessForced) {
  const std::string plain = output_of({"raycast", teapot, "--terminal", "--size", "20x10"});
  EXPECT_EQ(plain.find('\x1b'), std::string::npos);
  std::istringstream lines(plain);
  std::string line;
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(line.size(), 20u);
  }
  EXPECT_NE(output_of({"raycast", teapot, "--terminal", "--colour", "always", "--size", "20x10"}).find("\x1b[38;2;"),
            std::string::npos);
  expect_failure({"raycast", teapot}, 2, "expected -o FILE, or --rays FILE.csv and --hits FILE.csv, or --terminal");
}

TEST_F(Terminal, CharactersShowThePicture) {
  // A dark square before a bright floor would do, too; here: the patch colours differ, so characters do.
  const std::string plain = output_of({"raycast", teapot, "--terminal", "--size", "64x40", "--shade", "normals"});
  std::string kinds(plain);
  std::sort(kinds.begin(), kinds.end());
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  EXPECT_GT(kinds.size(), 5u) << plain;
}

TEST_F(Terminal, SeveralModelsFollowEachOther) {
  const TerminalRun run = show({"raycast", teapot, teapot, "--size", "20x10"});
  EXPECT_EQ(count(run.screen, block), 2u * 20 * 5);
  EXPECT_EQ(count(run.screen, "teapot.bpt\r\n"), 2u);
}

TEST_F(Terminal, LongWorkHasABarThatIsRemoved) {
  const TerminalRun run = show({"raycast", teapot, "-o", "a.png", "--size", "900x900"}, {.errors_only = true});
  EXPECT_EQ(run.status, 0);
  const std::size_t first = run.screen.find("\rcasting rays [");
  ASSERT_NE(first, std::string::npos) << run.screen;
  EXPECT_NE(run.screen.find("%", first), std::string::npos);
  EXPECT_TRUE(run.screen.ends_with("\r\x1b[K")) << run.screen;
  std::string rest = run.screen;
  std::size_t longest = 0, line = 0;
  for (const char c : rest) {
    line = c == '\r' ? 0 : line + 1;
    longest = std::max(longest, line);
  }
  EXPECT_LE(longest, 80u + 3);  // with "\x1b[K"
}

TEST_F(Terminal, SeveralFilesAreNamedInTheBar) {
  folder_.file("m.bpt", content_of(teapot));
  const TerminalRun run =
      show({"raycast", teapot, "m.bpt", "-o", "{name}.png", "--size", "700x700"}, {.errors_only = true});
  EXPECT_NE(run.screen.find("\r(1/2) teapot.bpt: casting rays ["), std::string::npos) << run.screen;
  EXPECT_NE(run.screen.find("\r(2/2, about "), std::string::npos) << run.screen;
  EXPECT_NE(run.screen.find(" s left) m.bpt: casting rays ["), std::string::npos) << run.screen;
}

TEST_F(Terminal, NoBarInAPipeAndOnADumbTerminal) {
  output_of({"raycast", teapot, "-o", "a.png", "--size", "500x500"});  // which expects no errors
  TerminalKind dumb{.errors_only = true};
  dumb.variables = {"TERM=dumb"};
  EXPECT_EQ(show({"raycast", teapot, "-o", "a.png", "--size", "500x500"}, dumb).screen, "");
}

}}  // namespace tessera::test
