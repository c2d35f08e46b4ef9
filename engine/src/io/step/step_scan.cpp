#include "io/step/step_scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace tessera { inline namespace abi_0_1 {
namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
/// A name of a kind; "!" begins one that a user has defined. Small letters are against the standard, but occur.
bool is_name(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '!' || is_digit(c); }

/// Characters at which end_of_statement() has to look.
constexpr std::array<bool, 256> stops = [] {
  std::array<bool, 256> out{};
  for (const char c : {';', '\'', '"', '/'}) out[static_cast<unsigned char>(c)] = true;
  return out;
}();

std::size_t find_from(std::string_view text, std::string_view what, std::size_t at) {
  const std::size_t found = text.find(what, at);
  return found == std::string_view::npos ? text.size() : found + what.size();
}

std::string_view name_at(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && is_name(text[end])) ++end;
  return text.substr(at, end - at);
}

/// Reads "#12 =" and returns the place behind it, or 0 if there is something else.
std::size_t read_number(std::string_view text, std::size_t at, std::uint64_t& number) {
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data() + at + 1, end, number);
  if (error != std::errc()) return 0;
  at = skip_blanks(text, static_cast<std::size_t>(last - text.data()));
  return at < text.size() && text[at] == '=' ? skip_blanks(text, at + 1) : 0;
}

}  // namespace

std::uint32_t KindNames::index_of(std::string_view name) {
  const auto [place, is_new] = known_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
  if (is_new) names_.push_back(name);
  return place->second;
}

std::size_t skip_blanks(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    if (is_blank(text[at]))
      ++at;
    else if (text[at] == '/' && at + 1 < text.size() && text[at + 1] == '*')
      at = find_from(text, "*/", at + 2);
    else
      break;
  }
  return std::min(at, text.size());
}

std::size_t end_of_statement(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    const char c = text[at];
    if (!stops[static_cast<unsigned char>(c)]) {
      ++at;
    } else if (c == ';') {
      return at;
    } else if (c == '/') {
      const bool is_comment = at + 1 < text.size() && text[at + 1] == '*';
      at = is_comment ? find_from(text, "*/", at + 2) : at + 1;
    } else {  // a doubled quote ends one string and begins the next
      at = find_from(text, text.substr(at, 1), at + 1);
    }
  }
  return text.size();
}

StepRun scan_instances(std::string_view text, std::size_t begin, std::size_t limit) {
  StepRun run;
  run.begin = run.end = begin;
  while (run.end < limit && text[run.end] == '#') {
    StepInstance instance{};
    const std::size_t record = read_number(text, run.end, instance.number);
    if (record == 0 || record >= text.size()) break;
    const std::string_view kind = is_digit(text[record]) ? std::string_view() : name_at(text, record);
    if (kind.empty() && text[record] != '(') break;
    const std::size_t end = end_of_statement(text, record);
    if (end == text.size() || end - record > std::numeric_limits<std::uint32_t>::max()) break;
    instance.begin = record, instance.length = static_cast<std::uint32_t>(end - record);
    instance.kind = kind.empty() ? StepIndex::several_kinds : run.kinds.index_of(kind);
    run.instances.push_back(instance);
    run.end = skip_blanks(text, end + 1);
  }
  return run;
}

std::size_t likely_instance(std::string_view text, std::size_t from, std::size_t limit) {
  while (true) {
    const std::size_t line = text.find("\n#", from);
    if (line == std::string_view::npos || line + 1 >= limit) return limit;
    std::size_t at = line + 2;
    while (at < text.size() && is_digit(text[at])) ++at;
    const bool has_digits = at > line + 2;
    while (at < text.size() && is_blank(text[at])) ++at;
    if (has_digits && at < text.size() && text[at] == '=') return line + 1;
    from = line + 2;
  }
}

}}  // namespace tessera::abi_0_1
