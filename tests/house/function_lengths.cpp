#include "house/function_lengths.h"

#include <algorithm>
#include <regex>
#include <sstream>

namespace tessera::house {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::size_t indent_of(const std::string& line) { return std::min(line.find_first_not_of(' '), line.size()); }

bool starts(const std::string& line, const char* with) { return line.compare(indent_of(line), 2, with) == 0; }

/// Whether a statement cannot go on after this line.
bool ends_statement(const std::string& line) {
  const std::size_t last = line.find_last_not_of(' ');
  return last == std::string::npos || starts(line, "//") || line[indent_of(line)] == '#' ||
         std::string_view(";{}:").find(line[last]) != std::string_view::npos;
}

/// Whether what begins with this text, without its template parameters, is a scope of functions.
bool is_scope(const std::string& head) {
  static const std::regex scope(R"re(^(template <.*> )?(inline )?(namespace|class|struct|union|enum|extern)\b)re"
                                R"re((?!.*\) (const )?(noexcept )?(override )?$))re");
  return std::regex_search(head, scope);
}

}  // namespace

std::vector<FunctionLength> function_lengths(const std::string& text) {
  const std::vector<std::string> lines = lines_of(text);
  std::vector<FunctionLength> functions;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (!lines[k].ends_with(" {") || starts(lines[k], "//")) continue;
    std::size_t first = k;
    while (first > 0 && !ends_statement(lines[first - 1])) --first;
    std::string head;
    for (std::size_t line = first; line <= k; ++line) head += lines[line].substr(indent_of(lines[line])) + ' ';
    head.resize(head.size() - 3);
    if (is_scope(head + ' ') || head.find('(') == std::string::npos) continue;
    const std::string brace = std::string(indent_of(lines[first]), ' ') + '}';
    std::size_t end = k + 1;
    while (end < lines.size() && !lines[end].starts_with(brace)) ++end;
    functions.push_back({k + 1, end - k - 1, head});
    k = end;
  }
  return functions;
}

}  // namespace tessera::house
