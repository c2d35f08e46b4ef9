// The symbols that the shared libraries show to the loader.

#include "house/exported_symbols.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "house/output_of.h"
#include "house/tree.h"

namespace tessera::house { namespace {

TEST(ExportedSymbols, DeclarationsAreFoundByName) {
  const std::string header =
      "namespace tessera {\nclass [[nodiscard]] Status {\n  bool ok() const;\n  ~Status();\n};\n"
      "class GridPlan {\n  static Result<GridPlan> make(int);\n  class Impl;\n};\nclass Later;\n"
      "Vec3 operator+(Vec3 a, Vec3 b);\nstruct Map { double operator()(double) const; };\nStatus evaluate(int);\n}";
  for (const char* declared :
       {"tessera::GridPlan::make(int)", "tessera::GridPlan::GridPlan(tessera::GridPlan&&)", "tessera::evaluate(int)",
        "tessera::operator+(tessera::Vec3, tessera::Vec3)", "tessera::Map::operator()(double) const",
        "tessera::Status tessera::evaluate<float, 3>(int)", "tessera::evaluate[abi:cxx11](int)"})
    EXPECT_TRUE(is_declared(declared, header)) << declared;
  for (const char* other :
       {"tessera::GridPlan::Impl::make(int)", "tessera::GridPlan::run(int)", "tessera::evaluate_all(int)",
        "std::evaluate(int)", "tessera::kernel::evaluate(int)", "tessera::(anonymous namespace)::evaluate(int)",
        "tessera::Later::make(int)", "std::vector<tessera::GridPlan>::make(int)", "evaluate",
        "tessera::operator-(tessera::Vec3, tessera::Vec3)"})
    EXPECT_FALSE(is_declared(other, header)) << other;
}

/// The symbols that the loader sees, by library.
const std::map<std::string, std::set<std::string>>& exports() {
  static const auto all = [] {
    std::map<std::string, std::set<std::string>> found;
    std::ifstream list(TESSERA_SHARED_LIBRARIES);
    for (std::string file; std::getline(list, file) && !file.empty();)
      for (const auto& [type, name] : symbols_of(output_of("'" TESSERA_NM "' -D -C --defined-only '" + file + "'")))
        if (type != 'A') found[file].insert(name.substr(0, name.find("@@")));  // A: the version itself
    return found;
  }();
  return all;
}

const std::vector<std::string>& headers() {
  static const auto all = [] {
    std::vector<std::string> texts;
    for (const std::string& path : files_under("engine/include/tessera")) texts.push_back(read_text(path));
    return texts;
  }();
  return all;
}

bool declared_in_public(const std::string& symbol) {
  return std::any_of(headers().begin(), headers().end(),
                     [&](const std::string& text) { return is_declared(symbol, text); });
}

/// Constants of public headers, whose address something takes.
bool is_public_constant(const std::string& symbol) {
  if (symbol.find_first_of("(<[") != std::string::npos) return false;
  const std::string name = symbol.substr(symbol.rfind(':') + 1);
  return std::ranges::any_of(headers(), [pattern = std::regex("inline constexpr [\\w:]+ " + name + " = ")](
                                            const std::string& text) { return std::regex_search(text, pattern); });
}

/// Functions inside the core that have the name of a public one.
bool is_inner_overload(const std::string& symbol) {
  // Functions of border curves that take the curve's name for messages, and the bound for both kinds of curve.
  const bool of_border =
      symbol.find("(std::variant<tessera::Curve, tessera::ParametricCurve> const&") != std::string::npos;
  if (of_border && (symbol.ends_with(", char const*)") || symbol.starts_with("tessera::derivative_bound(")))
    return true;
  return takes_inner_types(symbol, headers());
}

TEST(ExportedSymbols, InnerTypesAreKnown) {
  const std::vector<std::string> texts{"class PatchSet {", "struct Ray;"};
  EXPECT_TRUE(takes_inner_types("tessera::evaluate(tessera::PatchSet::Impl const&)", texts));
  EXPECT_TRUE(takes_inner_types("tessera::evaluate(tessera::PatchSet const&, tessera::SplineNet&)", texts));
  EXPECT_FALSE(takes_inner_types("tessera::evaluate(tessera::PatchSet const&, std::span<tessera::Ray>)", texts));
}

TEST(ExportedSymbols, AreThoseOfThePublicHeaders) {
  if (exports().empty()) GTEST_SKIP() << "no shared libraries are built under sanitizers";
  for (const auto& [file, symbols] : exports())
    for (const std::string& symbol : symbols)
      EXPECT_TRUE(declared_in_public(symbol) || is_public_constant(symbol) || is_internal_export(symbol))
          << file << " exports " << symbol;
}

// Inline functions (weak) belong to their callers.
TEST(ExportedSymbols, NothingPublicIsLeftOut) {
  if (exports().empty()) GTEST_SKIP() << "no shared libraries are built under sanitizers";
  std::set<std::string> exported;
  for (const auto& [file, symbols] : exports()) exported.insert(symbols.begin(), symbols.end());
  std::ifstream list(TESSERA_OBJECTS);
  std::size_t checked = 0;
  for (std::string object; std::getline(list, object);) {
    for (const auto& [type, name] : symbols_of(output_of("'" TESSERA_NM "' -C --defined-only '" + object + "'"))) {
      // Explicit instantiations are weak as well.
      const bool is_instance = type == 'W' && name.find(" tessera::evaluate<") != std::string::npos;
      if ((type != 'T' && !is_instance) || !declared_in_public(name) || is_inner_overload(name)) continue;
      ++checked;
      EXPECT_TRUE(exported.contains(name)) << object << " hides " << name;
    }
  }
  EXPECT_GT(checked, 100u);
}

// Each public header exports what it declares, from the namespace's beginning to its end.
TEST(ExportedSymbols, PublicHeadersSaySo) {
  for (const std::string& path : files_under("engine/include/tessera")) {
    if (path.ends_with("/tessera.h") || path.ends_with("/queries.h")) continue;  // these declare nothing
    // The headers for C have no namespace; the test c.abi lists their functions.
    if (path.find("/tessera_c") != std::string::npos) continue;
    const std::string text = read_text(path);
    EXPECT_NE(text.find("\n#pragma GCC visibility push(default)\nnamespace tessera { inline namespace abi_0_1 {\n"),
              std::string::npos)
        << path;
    EXPECT_TRUE(text.ends_with("}}  // namespace tessera::abi_0_1\n#pragma GCC visibility pop\n")) << path;
  }
}

}}  // namespace tessera::house
