// Rules of the house that a text search can check: the length of files and functions, the names of types, and where
// instruction sets may be named.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "house/function_lengths.h"
#include "house/tree.h"

namespace tessera::house { namespace {

// "About 400 lines at the most": a source file that needs more holds more than one idea. Guides may be longer.
constexpr std::ptrdiff_t longest_file = 400;

// The formatter breaks code at 120 columns and leaves comments as they are.
TEST(House, NoCommentIsTooWide) {
  std::size_t checked = 0;
  for (const char* folder : {"engine", "bench", "tools", "tests"}) {
    for (const std::string& path : files_under(folder)) {
      if (!path.ends_with(".h") && !path.ends_with(".cpp")) continue;
      ++checked;
      std::istringstream text(read_text(path));
      std::size_t at = 0;
      for (std::string line; std::getline(text, line);)
        EXPECT_FALSE(++at && line.size() > 120 && line.find_first_not_of(' ') == line.find("//")) << path << ":" << at;
    }
  }
  EXPECT_GT(checked, 800u) << "the search finds too few files";
}

TEST(House, NoFileIsTooLong) {
  std::size_t checked = 0;
  for (const char* folder : {"engine", "bench", "tools"}) {
    for (const std::string& path : files_under(folder)) {
      if (!path.ends_with(".h") && !path.ends_with(".cpp")) continue;
      ++checked;
      const std::string text = read_text(path);
      EXPECT_LE(std::count(text.begin(), text.end(), '\n'), longest_file) << path;
    }
  }
  EXPECT_GT(checked, 500u) << "the search finds too few files";
}

// "About 40 lines": a longer function does more than one thing. Test cases may be longer: they are read from top to
// bottom.
constexpr std::size_t longest_function = 44;

// A table of one entry per option reads better in one piece.
constexpr const char* tables[] = {"add_picture_options("};

bool is_table(const FunctionLength& function) {
  return std::ranges::any_of(tables, [&](const char* name) { return function.head.find(name) != std::string::npos; });
}

TEST(House, NoFunctionIsTooLong) {
  std::size_t checked = 0;
  for (const char* folder : {"engine", "bench", "tools"}) {
    for (const std::string& path : files_under(folder)) {
      if (!path.ends_with(".h") && !path.ends_with(".cpp")) continue;
      for (const FunctionLength& function : function_lengths(read_text(path))) {
        ++checked;
        if (is_table(function)) continue;
        EXPECT_LE(function.length, longest_function) << path << ":" << function.line << ": " << function.head;
      }
    }
  }
  EXPECT_GT(checked, 2000u) << "the search finds too few functions";
}

TEST(House, SearchForFunctionsFindsThem) {
  const auto found = function_lengths(R"(
namespace a {
template <class T, int N>
class B : public C<T (int)> {
 public:
  B(int x)
      : x_(x),
        y_(0) {
    if (x) {
      call([&](int) {
        return 1;
      });
    }
  }
  int get() const { return x_; }
  // not a function (at all) {
};
enum class E : int {
  one
};
template <class T>
T long_one(T a,
           T b) {
  return a + b;
}
const int table[] = {
  1};
}
)");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].line, 8u);
  EXPECT_EQ(found[0].length, 5u);
  EXPECT_EQ(found[0].head, "B(int x) : x_(x), y_(0)");
  EXPECT_EQ(found[1].line, 23u);
  EXPECT_EQ(found[1].length, 1u);
}

// A flag that chooses instructions, in a build file or a script.
bool names_instructions(const std::string& text) {
  static const std::regex flag(
      R"re((^|[\s"';=])-m(arch|tune|cpu|sse|ssse|avx|fma|bmi|f16c|popcnt|lzcnt|adx|prefer-vector)[\w.=-]*)re");
  return std::regex_search(text, flag);
}

/// The types that a file defines at the level of a namespace which other files may open too, by their full names.
std::vector<std::string> type_names(const std::string& text) {
  const std::regex opens(R"(\bnamespace ?([\w:]*) \{)"), closes(R"((\}+)  // namespace.*)"),
      defines(R"((?:class|struct|union) (\w+)(?: final)?(?: :.*| ?\{.*))");
  std::vector<std::string> spaces, names;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    std::smatch found;
    if (line.starts_with("namespace"))
      for (std::sregex_iterator at(line.begin(), line.end(), opens); at != std::sregex_iterator(); ++at)
        spaces.push_back((*at)[1]);
    if (std::regex_match(line, found, closes))
      spaces.resize(spaces.size() - std::min(spaces.size(), static_cast<std::size_t>(found[1].length())));
    if (!std::regex_match(line, found, defines) || std::ranges::find(spaces, "") != spaces.end()) continue;
    std::string name;
    for (const std::string& space : spaces) name += space + "::";
    names.push_back(name + found[1].str());
  }
  return names;
}

TEST(House, SearchForTypesFindsThem) {
  EXPECT_EQ(type_names(
                "struct A;\nnamespace a::b {\nclass C : B {\n  struct D {\n};\n}  // namespace a::b\nstruct E final {\n"
                "namespace a { inline namespace b {\nnamespace {\nstruct F {\n}  // namespace\nunion G {};\n}}  // "
                "namespace a::b\n"
                "struct H {\n"),
            (std::vector<std::string>{"a::b::C", "E", "a::b::G", "H"}));
}

// Two types of one name are one to the linker: it keeps the inline functions of one of them, such as its destructor.
TEST(House, NoTwoTypesShareAName) {
  std::map<std::string, std::string> files;
  for (const std::string& path : files_under("engine")) {
    // Fragments stand in the namespaces of the files that include them, and a processor has one of these headers.
    if (path.ends_with(".inl.h") || path.ends_with("_neon64.h") || path.ends_with("_wasm128.h") ||
        (!path.ends_with(".h") && !path.ends_with(".cpp")))
      continue;
    for (const std::string& name : type_names(read_text(path))) {
      const auto [known, is_new] = files.emplace(name, path);
      EXPECT_TRUE(is_new) << name << " is defined in " << known->second << " and in " << path;
    }
  }
  EXPECT_GT(files.size(), 300u) << "the search finds too few types";
}

TEST(House, SearchForInstructionFlagsFindsThem) {
  for (const char* text : {"set(f -mavx2)", "\"-march=native\"", "CXXFLAGS=-mfma", "a\n-msse4.1;", "x;-mavx512f"}) {
    EXPECT_TRUE(names_instructions(text)) << text;
  }
  for (const char* text : {"cmake -m", "mkdir -mode", "a-mavx2", "-Wall -fno-math-errno"}) {
    EXPECT_FALSE(names_instructions(text)) << text;
  }
}

TEST(House, InstructionFlagsStandInOneFile) {
  std::vector<std::string> files{"CMakeLists.txt", "CMakePresets.json"};
  for (const char* folder : {"cmake", "engine", "tests", "tools", "bench"}) {
    for (const std::string& path : files_under(folder)) {
      if (path.ends_with("CMakeLists.txt") || path.ends_with(".cmake") || path.ends_with(".sh")) files.push_back(path);
    }
  }
  bool found = false;
  for (const std::string& path : files) {
    const bool names = names_instructions(read_text(path));
    if (path == "cmake/TesseraIsaFlags.cmake")
      found = names;
    else
      EXPECT_FALSE(names) << path << " names an instruction set; only cmake/TesseraIsaFlags.cmake may";
  }
  EXPECT_TRUE(found) << "cmake/TesseraIsaFlags.cmake names no instruction set: has it moved?";
}

TEST(House, NoFunctionChoosesInstructionsForItself) {
  static const std::regex attribute(
      R"re(\btarget(_clones)?\s*\(\s*"|#\s*pragma\s+(GCC|clang)\s+(push_)?(target|attribute))re");
  for (const std::string& path : files_under("engine")) {
    if (path == "engine/CMakeLists.txt" || path.starts_with("engine/docs/")) continue;
    EXPECT_FALSE(std::regex_search(read_text(path), attribute)) << path;
  }
  EXPECT_TRUE(std::regex_search(std::string("__attribute__((target(\"avx2\")))"), attribute));
  EXPECT_TRUE(std::regex_search(std::string("#pragma GCC target(\"avx2\")"), attribute));
}

}}  // namespace tessera::house
