#include "io/json/json_reader.h"
#include "io/file/text_cursor.h"

#include <cmath>

#include "io/json/expression.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::string listed(std::initializer_list<std::string_view> words) {
  std::string list;
  for (const std::string_view word : words) list += (list.empty() ? "" : ", ") + std::string(word);
  return list;
}

}  // namespace

Fields::Fields(const JsonValue& value, std::initializer_list<std::string_view> keys,
               std::initializer_list<std::string_view> more)
    : value_(value) {
  if (!value.is(JsonKind::object)) value.fail_expected("an object");
  for (auto member = value.begin(); member != value.end();) {
    const JsonValue key = *member;
    ++member, ++member;  // past the key and its value
    const auto in = [&](const auto& list) { return std::find(list.begin(), list.end(), key.string()) != list.end(); };
    if (!in(keys) && !in(more))
      key.fail("unknown key " + quote(key.string()) + "; known keys are " + listed(keys) +
               (more.size() == 0 ? "" : ", " + listed(more)));
  }
}

JsonValue Fields::at(std::string_view key) const {
  const std::optional<JsonValue> member = find(key);
  if (!member) value_.fail("\"" + std::string(key) + "\" is missing");
  return *member;
}

JsonValue array(const JsonValue& value, std::string_view what, std::size_t least) {
  if (!value.is(JsonKind::array) || value.size() < least) value.fail_expected(what);
  return value;
}

JsonValue array_of(const JsonValue& value, std::string_view what, std::size_t count) {
  if (!value.is(JsonKind::array) || value.size() != count) value.fail_expected(what);
  return value;
}

double read_number(const JsonValue& value) {
  if (value.is(JsonKind::string)) return made(value, constant_value(value.string()));
  if (!value.is(JsonKind::number)) value.fail_expected("a number");
  return value.number();
}

int read_integer(const JsonValue& value, int least, int largest) {
  const bool fits = value.is(JsonKind::number) && value.number() >= least && value.number() <= largest &&
                    value.number() == std::floor(value.number());
  if (!fits) value.fail_expected("an integer from " + std::to_string(least) + " to " + std::to_string(largest));
  return static_cast<int>(value.number());
}

const std::string& read_text(const JsonValue& value) {
  if (!value.is(JsonKind::string)) value.fail_expected("a string");
  return value.string();
}

std::size_t read_word(const JsonValue& value, std::initializer_list<std::string_view> words) {
  if (value.is(JsonKind::string)) {
    const auto found = std::find(words.begin(), words.end(), value.string());
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  }
  value.fail_expected("one of " + listed(words));
}

Vec3 read_vector(const JsonValue& value) {
  const JsonValue numbers = array_of(value, "3 numbers [x, y, z]", 3);
  auto number = numbers.begin();
  Vec3 vector;
  for (double* const coordinate : {&vector.x, &vector.y, &vector.z}) {
    *coordinate = read_number(*number);
    ++number;
  }
  return vector;
}

std::vector<double> read_numbers(const JsonValue& value) {
  std::vector<double> numbers;
  for (const JsonValue number : array(value, "an array of numbers")) numbers.push_back(read_number(number));
  return numbers;
}

Interval read_interval(const JsonValue& value) {
  auto end = array_of(value, "2 numbers [from, to]", 2).begin();
  Interval interval{.from = read_number(*end)};
  ++end;
  interval.to = read_number(*end);
  if (!(interval.from < interval.to)) value.fail("the interval is empty or reversed");
  if (!std::isfinite(interval.to - interval.from)) value.fail("the interval is too long for doubles");
  return interval;
}

Domain read_domain(const JsonValue& value) {
  auto side = array_of(value, "2 intervals [[u0, u1], [v0, v1]]", 2).begin();
  const Interval u = read_interval(*side);
  ++side;
  const Interval v = read_interval(*side);
  return {u.from, u.to, v.from, v.to};
}

}}  // namespace tessera::abi_0_1
