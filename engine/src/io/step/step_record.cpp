#include "io/step/step_record.h"

#include <charconv>
#include <limits>

#include "io/step/step_scan.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '!'; }

Status unexpected(std::string_view text, std::size_t at, const char* wanted) {
  const std::string found = at < text.size() ? "\"" + std::string(text.substr(at, 12)) + "\"" : "the end";
  return Status(StatusCode::parse_error, std::string("expected ") + wanted + ", found " + found,
                static_cast<std::ptrdiff_t>(at));
}

/// Reads one value but no list. Returns the place behind it, or npos.
std::size_t read_atom(std::string_view text, std::size_t at, StepValue& value) {
  const char* const begin = text.data() + at;
  const char* const end = text.data() + text.size();
  const char c = text[at];
  const auto quoted = [&](char quote, StepKind kind) -> std::size_t {
    std::size_t last = at + 1;  // a doubled quote is one of the text's
    while (true) {
      last = text.find(quote, last);
      if (last == std::string_view::npos) return last;
      if (last + 1 >= text.size() || text[last + 1] != quote) break;
      last += 2;
    }
    value.kind = kind, value.text = text.substr(at + 1, last - at - 1);
    return last + 1;
  };
  if (c == '$' || c == '*') {
    value.kind = c == '$' ? StepKind::omitted : StepKind::derived;
    return at + 1;
  }
  if (c == '\'') return quoted('\'', StepKind::text);
  if (c == '"') return quoted('"', StepKind::binary);
  if (c == '#') {
    value.kind = StepKind::reference;
    const auto [last, error] = std::from_chars(begin + 1, end, value.reference);
    return error == std::errc() ? static_cast<std::size_t>(last - text.data()) : StepRecord::npos;
  }
  if (c == '.' && at + 1 < text.size() && is_letter(text[at + 1])) {
    const std::size_t last = text.find('.', at + 1);
    if (last == std::string_view::npos) return last;
    value.kind = StepKind::enumeration, value.text = text.substr(at + 1, last - at - 1);
    return last + 1;
  }
  // No words such as nan.
  const std::size_t digit = at + (c == '-' || c == '+');
  if (digit >= text.size() || (!is_digit(text[digit]) && text[digit] != '.')) return StepRecord::npos;
  const auto [last, error] = std::from_chars(begin + (c == '+'), end, value.number);
  if (error == std::errc::invalid_argument) return StepRecord::npos;
  if (error == std::errc::result_out_of_range) value.number = std::numeric_limits<double>::quiet_NaN();
  const std::string_view digits(begin, static_cast<std::size_t>(last - begin));
  value.kind = digits.find_first_of(".eE") == std::string_view::npos ? StepKind::integer : StepKind::real;
  return static_cast<std::size_t>(last - text.data());
}

/// Memory of records that are gone, by thread.
struct RecordMemory {
  std::vector<StepValue> values;
  std::vector<std::uint32_t> open;
};
std::vector<RecordMemory>& record_memory() {
  thread_local std::vector<RecordMemory> memory;
  return memory;
}
constexpr std::size_t most_records_kept = 32, most_values_kept = 4096;

}  // namespace

StepRecord::StepRecord() {
  std::vector<RecordMemory>& kept = record_memory();
  if (kept.empty()) return;
  values_.swap(kept.back().values);
  open_.swap(kept.back().open);
  kept.pop_back();
}

StepRecord::~StepRecord() {
  std::vector<RecordMemory>& kept = record_memory();
  if (kept.capacity() == 0) kept.reserve(most_records_kept);
  if (kept.size() < most_records_kept && values_.capacity() <= most_values_kept)
    kept.push_back({std::move(values_), std::move(open_)});
}

/// Takes "(" or "KIND(". Returns false if the parenthesis is missing.
bool StepRecord::open_value(std::string_view text, std::size_t& at) {
  std::size_t name = at;
  while (name < text.size() && (is_letter(text[name]) || is_digit(text[name]))) ++name;
  StepValue value;
  value.kind = name == at ? StepKind::list : StepKind::typed, value.text = text.substr(at, name - at);
  at = skip_blanks(text, name);
  if (at >= text.size() || text[at] != '(') return false;
  open_.push_back(static_cast<std::uint32_t>(values_.size()));
  values_.push_back(value);
  at = skip_blanks(text, at + 1);
  return true;
}

Status StepRecord::read(std::string_view text) {
  values_.clear(), open_.clear();
  const auto fail = [&](std::size_t at, const char* wanted) {
    values_.clear();
    return unexpected(text, at, wanted);
  };
  const auto size = [&] { return static_cast<std::uint32_t>(values_.size()); };
  std::size_t at = skip_blanks(text, 0);
  const bool has_several = at < text.size() && text[at] == '(';
  if (has_several) at = skip_blanks(text, at + 1);
  bool wants_value = true;  // or else a comma; before the end of a list both are taken, since some files write "(#1,)"
  for (bool is_done = false; !is_done;) {
    if (at >= text.size()) return fail(at, "a value or a parenthesis");
    const char c = text[at];
    if (c == ')') {
      if (open_.empty()) {  // of "(A()B())"
        if (!has_several || values_.empty()) return fail(at, "a record");
        at = skip_blanks(text, at + 1), is_done = true;
        continue;
      }
      values_[open_.back()].end = size();
      open_.pop_back();
      at = skip_blanks(text, at + 1), wants_value = false;
      is_done = open_.empty() && !has_several;
    } else if (c == ',' && !wants_value && !open_.empty()) {
      at = skip_blanks(text, at + 1), wants_value = true;
    } else if (!wants_value && !open_.empty()) {
      return fail(at, "a comma or a parenthesis");
    } else if (open_.empty() && !is_letter(c)) {
      return fail(at, "the name of a kind");
    } else if (is_letter(c) || c == '(') {
      if (!open_value(text, at)) return fail(at, "\"(\"");
      wants_value = true;
    } else {
      StepValue value;
      const std::size_t next = read_atom(text, at, value);
      if (next == npos) return fail(at, "a value");
      value.end = size() + 1;
      values_.push_back(value);
      at = skip_blanks(text, next), wants_value = false;
    }
  }
  return at == text.size() ? Status() : fail(at, "the end of the record");
}

std::size_t StepRecord::within(std::size_t of, std::size_t k) const {
  std::size_t at = of + 1;
  for (; k > 0 && at < values_[of].end; --k) at = values_[at].end;
  return at < values_[of].end ? at : 0;
}

std::size_t StepRecord::count(std::size_t of) const {
  std::size_t out = 0;
  for (std::size_t at = of + 1; at < values_[of].end; at = values_[at].end) ++out;
  return out;
}

std::size_t StepRecord::part(std::string_view kind) const {
  for (std::size_t at = 0; at < values_.size(); at = values_[at].end)
    if (values_[at].text == kind) return at;
  return npos;
}

}}  // namespace tessera::abi_0_1
