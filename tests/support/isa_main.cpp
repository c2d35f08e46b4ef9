// Runs all tests of a program with one instruction set: --isa=NAME, or TESSERA_ISA, or else the machine's best. Exits
// with 77 if the machine lacks the set of --isa, and with 1 if its name is wrong.

#include <gtest/gtest.h>

#include <iostream>

#include "support/suite_isa.h"

namespace {

using tessera::test::SuiteIsa;

/// Expects before each test that the instruction set is still the wanted one: a test may have changed the environment.
class IsaStays : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override {
    const tessera::Result<tessera::Isa> now = tessera::default_isa();
    EXPECT_TRUE(now.ok() && *now == wanted_) << "an earlier test has changed TESSERA_ISA; use ForcedIsa instead";
  }
  tessera::Isa wanted_ = *tessera::default_isa();
};

/// Takes --isa=NAME out of the arguments and puts NAME into TESSERA_ISA. Returns usable, or the program's exit code.
SuiteIsa take_isa(int& count, char** arguments) {
  constexpr std::string_view option = "--isa=";
  for (int k = 1; k < count; ++k) {
    const std::string_view argument = arguments[k];
    if (!argument.starts_with(option)) continue;
    const std::string name(argument.substr(option.size()));
    const auto choice = tessera::test::choose_suite_isa(name, tessera::test::required_isas());
    if (!choice.message.empty()) std::cerr << choice.message << '\n';
    if (choice.kind != SuiteIsa::usable) return choice.kind;
    ::setenv("TESSERA_ISA", name.c_str(), 1);
    for (--count; k < count; ++k) arguments[k] = arguments[k + 1];
  }
  if (const auto isa = tessera::default_isa(); !isa) {
    std::cerr << isa.status().message() << '\n';
    return SuiteIsa::fails;
  }
  return SuiteIsa::usable;
}

}  // namespace

int main(int count, char** arguments) {
  if (const SuiteIsa isa = take_isa(count, arguments); isa != SuiteIsa::usable) return static_cast<int>(isa);
  testing::InitGoogleTest(&count, arguments);
  if (count > 1) {
    std::cerr << "unknown argument \"" << arguments[1] << "\": there are --isa=NAME and those of GoogleTest (--help)\n";
    return 1;
  }
  testing::UnitTest::GetInstance()->listeners().Append(new IsaStays);
  return RUN_ALL_TESTS();
}
