#include "house/isa_symbols.h"

#include <array>
#include <regex>
#include <sstream>

namespace tessera::house {
namespace {

constexpr std::array<IsaUnit, 5> isa_units{{
    {"sse2", "sse2"},
    {"avx2", "avx|avx2|fma3|fma5"},
    {"avx512", "avx512[a-z]*"},
    {"neon64", "neon64"},
    {"wasm128", "wasm128"},
}};

// Functions that the linker sees: global and weak ones, and indirect ones. Data holds no instructions.
bool is_visible_function(char type) { return type == 'T' || type == 'W' || type == 'i'; }

// All names of x86 architectures in xsimd.
const std::regex& any_architecture() {
  static const std::regex pattern(R"(\bxsimd::(sse[0-9_]*|ssse3|avx[0-9a-z]*|fma[0-9]|generic_for_dispatch)\b)");
  return pattern;
}

bool is_own(const IsaUnit& unit, const std::string& symbol) {
  const std::regex own{std::string(unit.architectures)};
  bool over_own = false;
  for (auto found = std::sregex_iterator(symbol.begin(), symbol.end(), any_architecture());
       found != std::sregex_iterator(); ++found) {
    if (!std::regex_match((*found)[1].str(), own)) return false;
    over_own = true;
  }
  return over_own || symbol.find("::kernel::isa_" + std::string(unit.isa) + "::") != std::string::npos;
}

}  // namespace

std::optional<IsaUnit> isa_unit_of(std::string_view object_path) {
  for (const IsaUnit& unit : isa_units)
    for (const char* const target : {".dir/", "_mesh.dir/"})
      if (object_path.find("/tessera_kernel_" + std::string(unit.isa) + target) != std::string_view::npos) return unit;
  return std::nullopt;
}

std::vector<std::string> foreign_functions(const IsaUnit& unit, std::string_view listing) {
  static const std::regex line_form(R"(^[0-9a-fA-F]+ (\S) (.*)$)");
  std::vector<std::string> foreign;
  std::istringstream stream{std::string(listing)};
  for (std::string line; std::getline(stream, line);) {
    std::smatch found;
    if (!std::regex_match(line, found, line_form)) continue;
    if (is_visible_function(found[1].str()[0]) && !is_own(unit, found[2])) foreign.push_back(found[2]);
  }
  return foreign;
}

}  // namespace tessera::house
