#include "support/suite_isa.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace tessera::test {
namespace {

constexpr std::array<Isa, 4> all_isas{Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon64};

}  // namespace

std::vector<std::string> required_isas() {
  const char* const variable = std::getenv("TESSERA_REQUIRE_ISAS");
  std::string text = variable ? variable : "";
  for (char& c : text)
    if (c == ';' || c == ',') c = ' ';
  std::istringstream words(text);
  std::vector<std::string> names;
  for (std::string word; words >> word;) names.push_back(word);
  return names;
}

SuiteIsaChoice choose_suite_isa(std::string_view wanted, const std::vector<std::string>& required) {
  const Result<Isa> found = parse_isa(wanted);
  if (found) return {};
  const std::string& message = found.status().message();
  if (std::ranges::none_of(all_isas, [&](Isa isa) { return name(isa) == wanted; })) return {SuiteIsa::fails, message};
  if (std::ranges::count(required, wanted) == 0) return {SuiteIsa::skipped, "skipped: " + message};
  return {SuiteIsa::fails, "TESSERA_REQUIRE_ISAS names an instruction set that cannot be tested here: " + message +
                               ". Test on a machine that has it, or take it out of the variable."};
}

}  // namespace tessera::test
