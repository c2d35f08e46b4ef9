#pragma once
// The instruction set that the tests of a program run with: --isa=NAME on its command line, or TESSERA_ISA.

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/execution.h"

namespace tessera::test {

/// Sets TESSERA_ISA for its lifetime, or removes it if `text` is null; then restores what was there.
class ForcedIsa {
 public:
  explicit ForcedIsa(const char* text) {
    if (const char* const before = std::getenv("TESSERA_ISA")) before_ = before, had_one_ = true;
    put(text);
  }
  explicit ForcedIsa(Isa isa) : ForcedIsa(std::string(name(isa)).c_str()) {}
  ForcedIsa(const ForcedIsa&) = delete;
  ForcedIsa& operator=(const ForcedIsa&) = delete;
  ~ForcedIsa() { put(had_one_ ? before_.c_str() : nullptr); }

 private:
  static void put(const char* text) { text ? ::setenv("TESSERA_ISA", text, 1) : ::unsetenv("TESSERA_ISA"); }
  std::string before_;
  bool had_one_ = false;
};

/// Returns the names in the environment variable TESSERA_REQUIRE_ISAS, which semicolons, commas or spaces separate.
std::vector<std::string> required_isas();

/// Whether a program can run its tests with an instruction set; the values are exit codes of the program, for ctest.
enum class SuiteIsa { usable = 0, fails = 1, skipped = 77 };

struct SuiteIsaChoice {
  SuiteIsa kind = SuiteIsa::usable;
  std::string message;  ///< why the tests don't run
};

/// Decides about the instruction set `wanted`. One that this machine lacks is skipped, unless `required` names it. An
/// unknown one fails.
SuiteIsaChoice choose_suite_isa(std::string_view wanted, const std::vector<std::string>& required);

}  // namespace tessera::test
