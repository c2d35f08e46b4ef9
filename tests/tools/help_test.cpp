// Texts of the tool about itself: help, man page and completions agree, as they come from one definition.

#include <regex>
#include <set>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

class Help : public ToolTest {
 protected:
  static const Names& commands() {
    static const Names names{"info",  "eval",    "tessellate", "raycast", "convert",    "project", "section",
                             "check", "compare", "measure",    "view",    "completion", "man",     "help"};
    return names;
  }
  /// The long options in a text.
  static std::set<std::string> options_in(const std::string& text) {
    static const std::regex option("--[a-z][a-z-]*");
    return {std::sregex_token_iterator(text.begin(), text.end(), option), {}};
  }
  /// The long options in a command's help: lines "  -o, --output FILE ...".
  std::set<std::string> options_of(const std::string& command) const {
    static const std::regex line("\n  (-[a-z], )?(--[a-z-]+)(, --[a-z-]+)?");
    const std::string help = output_of({command, "--help"});
    std::set<std::string> found;
    for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) found.insert((*at)[2]);
    EXPECT_TRUE(found.count("--help")) << help;
    return found;
  }
  bool is_installed(const std::string& program) const {
    return run_program(folder_, {"sh", "-c", "command -v " + program}).status == 0;
  }
};

TEST_F(Help, TheToolsHelpSuffices) {
  const std::string help = output_of({"--help"});
  for (const std::string& command : commands()) EXPECT_NE(help.find("\n  " + command), std::string::npos) << command;
  for (const char* const word : {".bpt", ".bv", ".g2", ".json", ".obj", ".rib", ".ply", ".png", "{name}", "TESSERA_ISA",
                                 "NO_COLOR", "Exit status: 0 done", "\nExamples:\n"})
    EXPECT_NE(help.find(word), std::string::npos) << word;
}

TEST_F(Help, EveryOptionSaysWhatItTakesAndItsDefault) {
  for (const std::string& command : Names{"info", "eval", "tessellate", "raycast", "convert", "project", "section",
                                          "check", "compare", "measure", "view"}) {
    const std::set<std::string> options = options_of(command);
    for (const char* const common : {"--json", "--timings", "--threads", "--isa"})
      EXPECT_TRUE(options.count(common)) << command << ' ' << common;
    const std::string help = output_of({command, "--help"});
    EXPECT_NE(help.find("[all of the machine]"), std::string::npos);
    EXPECT_NE(help.find("sse2, avx2 or avx512"), std::string::npos);
    EXPECT_NE(help.find("\n  tessera " + command), std::string::npos) << "no example: " << help;
  }
  const std::string raycast = output_of({"raycast", "--help"});
  for (const char* const word :
       {"Pixels of the picture, 1 to 16384 each [1280x800", "field of view in degrees",
        "lambert, normals, uv, patch, error, curvature, clay or steps [lambert]", "auto, always or never [auto]"}) {
    std::string squeezed = std::regex_replace(raycast, std::regex("\\s+"), " ");
    EXPECT_NE(squeezed.find(word), std::string::npos) << word << squeezed;
  }
}

TEST_F(Help, TheManPageHoldsEveryOption) {
  const std::string page = output_of({"man"});
  EXPECT_EQ(page.rfind(".TH TESSERA 1 ", 0), 0u);
  for (const std::string& command : commands()) {
    const std::size_t begin = page.find(".SS \"tessera " + command + "\"");
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string section = page.substr(begin, page.find(".SS ", begin + 4) - begin);
    for (const std::string& option : options_of(command)) {
      const std::string roff = std::regex_replace(option, std::regex("-"), "\\-");
      EXPECT_NE(section.find("\\fB" + roff + "\\fR"), std::string::npos) << command << ' ' << option;
    }
  }
}

TEST_F(Help, TheManPageIsFormattedWithoutAWarning) {
  if (!is_installed("groff")) GTEST_SKIP() << "groff is not installed";
  folder_.file("tessera.1", output_of({"man"}));
  const ToolRun page = run_program(folder_, {"groff", "-man", "-ww", "-Tutf8", "-P-cbou", "tessera.1"});
  EXPECT_EQ(page.status, 0);
  EXPECT_EQ(page.errors, "");
  EXPECT_NE(page.output.find("NAME\n       tessera "), std::string::npos) << page.output;
  EXPECT_NE(page.output.find("--grid NxM"), std::string::npos);
}

/// Bash's completions for these words, the last of which is being typed.
class BashCompletion : public Help {
 protected:
  Names offers(const std::vector<std::string>& words) const {
    folder_.file("tessera.bash", output_of({"completion", "bash"}));
    const std::string script =
        "source ./tessera.bash; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _tessera; printf '%s\\n' "
        "\"${COMPREPLY[@]}\"";
    std::vector<std::string> command{"bash", "--norc", "-c", script, "bash", "tessera"};
    command.insert(command.end(), words.begin(), words.end());
    const ToolRun result = run_program(folder_, command);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.errors, "");
    Names names;
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) names.push_back(line);
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(BashCompletion, Commands) {
  Names all = commands();
  std::sort(all.begin(), all.end());
  EXPECT_EQ(offers({""}), all);
  EXPECT_EQ(offers({"t"}), Names{"tessellate"});
  EXPECT_EQ(offers({"--v"}), Names{"--version"});
}

TEST_F(BashCompletion, EveryOptionOfEveryCommand) {
  for (const std::string& command : commands()) {
    const Names offered = offers({command, "--"});
    for (const std::string& option : options_of(command))
      EXPECT_TRUE(std::find(offered.begin(), offered.end(), option) != offered.end()) << command << ' ' << option;
  }
  EXPECT_EQ(offers({"raycast", "a.bpt", "--sh"}), Names{"--shade"});
}

TEST_F(BashCompletion, WordsThatAnOptionTakes) {
  const Names shades{"clay", "curvature", "error", "lambert", "normals", "patch", "steps", "uv"};
  EXPECT_EQ(offers({"raycast", "--shade", ""}), shades);
  EXPECT_EQ(offers({"raycast", "--shade", "="}), shades);
  EXPECT_EQ(offers({"raycast", "--shade", "=", "n"}), Names{"normals"});
  EXPECT_EQ(offers({"info", "--isa", "avx"}), (Names{"avx2", "avx512"}));
  EXPECT_EQ(offers({"completion", ""}), (Names{"bash", "fish", "zsh"}));
  EXPECT_EQ(offers({"tessellate", "--grid", ""}), Names{});
}

TEST_F(BashCompletion, Files) {
  folder_.file("a model.bpt", "");
  folder_.file("other.bpt", "");
  EXPECT_EQ(offers({"info", "a"}), Names{"a model.bpt"});
  EXPECT_EQ(offers({"info", "other.bpt", "a"}), Names{"a model.bpt"});
  EXPECT_EQ(offers({"raycast", "x.bpt", "-o", "oth"}), Names{"other.bpt"});
}

TEST_F(Help, ZshAndFishTakeTheirScripts) {
  for (const char* const shell : {"zsh", "fish"}) {
    const std::string script = output_of({"completion", shell});
    for (const std::string& command : commands()) {
      for (const std::string& option : options_of(command)) {
        const std::string word = shell == std::string("zsh") ? option : "-l " + option.substr(2) + " ";
        EXPECT_NE(script.find(word), std::string::npos) << shell << ' ' << command << ' ' << option;
      }
    }
    if (!is_installed(shell)) continue;
    folder_.file("script", script);
    const ToolRun checked = run_program(folder_, {shell, "-n", "script"});
    EXPECT_EQ(checked.status, 0) << checked.errors;
    EXPECT_EQ(checked.errors, "");
  }
}

TEST_F(Help, FishCompletes) {
  if (!is_installed("fish")) GTEST_SKIP() << "fish is not installed";
  folder_.file("tessera.fish", output_of({"completion", "fish"}));
  folder_.file("other.bpt", "");
  const auto offers = [&](const std::string& line) {
    return run_program(folder_, {"fish", "--no-config", "-c", "source tessera.fish; complete -C '" + line + "'"})
        .output;
  };
  EXPECT_EQ(offers("tessera tess").rfind("tessellate\t", 0), 0u) << offers("tessera tess");
  EXPECT_NE(offers("tessera raycast --shade ").find("normals"), std::string::npos);
  EXPECT_NE(offers("tessera raycast --ca").find("--camera\t"), std::string::npos);
  EXPECT_NE(offers("tessera info oth").find("other.bpt"), std::string::npos);
}

}}  // namespace tessera::test
