#pragma once
// Shared by the tests of the commands: a folder to work in, and the teapot.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/run_tool.h"

namespace tessera::test {

class ToolTest : public testing::Test {
 protected:
  using Names = std::vector<std::string>;

  ToolRun run(const std::vector<std::string>& arguments, const std::vector<std::string>& variables = {}) const {
    return run_tool(folder_, arguments, variables);
  }
  /// Runs a command that must succeed without errors on standard error; returns its output.
  std::string output_of(const std::vector<std::string>& arguments) const {
    const ToolRun result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    return result.output;
  }
  /// Runs a command that must fail with this status and message, and print and leave nothing.
  void expect_failure(const std::vector<std::string>& arguments, int status, const std::string& message) const {
    const Names before = folder_.names();
    const ToolRun result = run(arguments);
    EXPECT_EQ(result.status, status) << result.errors;
    EXPECT_NE(result.errors.find(message), std::string::npos) << result.errors;
    EXPECT_EQ(result.errors.rfind("tessera: ", 0), 0u) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(folder_.names(), before);
  }

  const std::string teapot = TESSERA_SOURCE_DIR "/tools/models/teapot.bpt";
  ScratchFolder folder_;
};

/// The cells of a table; the header is the first row.
inline std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(csv);
  for (std::string line; std::getline(text, line);) {
    std::vector<std::string>& row = rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (line.ends_with(',')) row.emplace_back();
  }
  return rows;
}

}  // namespace tessera::test
