// The choice of an instruction set by the programs that run their tests with each: what is skipped, what fails.

#include "support/suite_isa.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>

namespace tessera::test { namespace {

#if defined(__aarch64__)
constexpr const char* foreign = "avx2";
#else
constexpr const char* foreign = "neon64";
#endif

TEST(SuiteIsaChoice, RunsWhatTheMachineHas) {
  for (const Isa isa : available_isas()) EXPECT_EQ(choose_suite_isa(name(isa), {}).kind, SuiteIsa::usable);
}

TEST(SuiteIsaChoice, SkipsWhatTheMachineLacksUnlessItIsRequired) {
  const SuiteIsaChoice skipped = choose_suite_isa(foreign, {"sse2"}), required = choose_suite_isa(foreign, {foreign});
  EXPECT_EQ(skipped.kind, SuiteIsa::skipped);
  EXPECT_NE(skipped.message.find(foreign), std::string::npos) << skipped.message;
  EXPECT_EQ(required.kind, SuiteIsa::fails);
  EXPECT_NE(required.message.find("TESSERA_REQUIRE_ISAS"), std::string::npos) << required.message;
}

TEST(SuiteIsaChoice, FailsForUnknownNames) {
  for (const char* const wrong : {"avx3", "AVX2", "", "avx2 "})
    EXPECT_EQ(choose_suite_isa(wrong, {}).kind, SuiteIsa::fails) << wrong;
}

TEST(SuiteIsaChoice, TheMachineHasAllRequiredSets) {
  for (const std::string& name : required_isas()) {
    const Result<Isa> isa = parse_isa(name);
    EXPECT_TRUE(isa.ok()) << "TESSERA_REQUIRE_ISAS: " << isa.status().message();
  }
}

/// The exit code of this program, run with these settings of the environment and these arguments.
int exit_code(const std::string& environment, const std::string& arguments) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string filter = " --gtest_filter=SuiteIsa.* ";
  const int status = std::system(("env " + environment + " '" + program + "'" + filter + arguments + " 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(SuiteIsaProgram, ExitsByTheChoice) {
  const std::string unset = "-u TESSERA_ISA -u TESSERA_REQUIRE_ISAS ", other = foreign;
  for (const Isa isa : available_isas()) EXPECT_EQ(exit_code(unset, "--isa=" + std::string(name(isa))), 0);
  EXPECT_EQ(exit_code(unset, "--isa=avx3"), 1);
  EXPECT_EQ(exit_code(unset, "--iza=avx2"), 1) << "an argument that nothing reads";
  EXPECT_EQ(exit_code(unset + "TESSERA_ISA=avx3", ""), 1);
  EXPECT_EQ(exit_code(unset, "--isa=" + other), 77);
  EXPECT_EQ(exit_code(unset + "TESSERA_REQUIRE_ISAS='sse2;" + other + "'", "--isa=" + other), 1);
}

}}  // namespace tessera::test
