#include "robustness/bad_input.h"

#include <gtest/gtest.h>

namespace tessera::test {
namespace {

/// Formats a text for a cell of a Markdown table. Leaves out words that differ between machines.
std::string cell(std::string text) {
  const std::string_view machine = "this machine has ";
  if (const std::size_t at = text.find(machine); at != std::string::npos)
    text.replace(at + machine.size(), std::string::npos, "...");
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '>' || c == '*' || c == '_') out += '\\';
    if (c == '\n')
      out += "<br>";
    else
      out += c;
  }
  return out;
}

std::string answer_of(const Status& status) {
  std::string answer = "`" + std::string(name(status.code())) + "`";
  if (status.index() != Status::no_index) answer += " at " + std::to_string(status.index());
  return answer + ": " + cell(status.message());
}

}  // namespace

void Table::of(const std::string& call) {
  call_ = call;
  text_ += "\n### `" + call + "`\n\n| input | comes back |\n| --- | --- |\n";
}

void Table::line(const std::string& input, const std::string& answer) {
  text_ += "| " + cell(input) + " | " + answer + " |\n";
}

void Table::row(const std::string& input, StatusCode code, const Status& status) {
  EXPECT_EQ(name(status.code()), name(code)) << call_ << ": " << input << ": " << status.message();
  EXPECT_FALSE(status.message().empty()) << call_ << ": " << input;
  line(input, answer_of(status));
}

void Table::row(const std::string& input, StatusCode code, const Status& status,
                const std::function<bool()>& untouched) {
  EXPECT_TRUE(untouched()) << call_ << ": " << input << ": something was written";
  row(input, code, status);
}

void Table::gives(const std::string& input, const std::string& what, bool holds) {
  EXPECT_TRUE(holds) << call_ << ": " << input << ": not " << what;
  line(input, cell(what));
}

void Table::says(const std::string& input, const std::string& answer) { line(input, cell(answer)); }

}  // namespace tessera::test
