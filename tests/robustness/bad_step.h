#pragma once
// Rows of the table of bad input about STEP files.

#include <functional>
#include <string>
#include <string_view>

#include "robustness/bad_input.h"

namespace tessera::test {

Status parse_step(std::string_view text);
/// Calls `row` for each text that cannot be read.
void step_rows(const std::function<void(const std::string& input, const std::string& text, StatusCode code)>& row);
/// Adds texts of which something can be read.
void step_answers(Table& table);

}  // namespace tessera::test
