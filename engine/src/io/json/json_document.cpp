#include "io/json/json_document.h"
#include "io/file/text_cursor.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "io/json/json_scan.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Reads bytes, and counts those read.
struct CountingIterator {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char* at;
  std::size_t* count;

  reference operator*() const { return *at; }
  CountingIterator& operator++() {
    ++at, ++*count;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at == other.at; }
  bool operator!=(const CountingIterator& other) const { return at != other.at; }
};

/// The parser's message without its prefix; the text that it quotes is made printable.
std::string readable(std::string_view message) {
  const std::size_t place = message.find("column ");
  if (place != std::string_view::npos) {
    const std::size_t colon = message.find(": ", place);
    if (colon != std::string_view::npos) message.remove_prefix(colon + 2);
  } else if (const std::size_t bracket = message.find("] "); bracket != std::string_view::npos) {
    message.remove_prefix(bracket + 2);
  }
  constexpr std::string_view last_read = "last read: '";
  const std::size_t begin = message.find(last_read);
  if (begin == std::string_view::npos) return std::string(message);
  const std::size_t end = message.rfind('\'');
  const std::string_view token = message.substr(begin + last_read.size(), end - begin - last_read.size());
  return std::string(message.substr(0, begin)) + "last read: " + quote(token) + std::string(message.substr(end + 1));
}

}  // namespace

/// Turns a parser's events into the list of values. What the fast pass stops at is parsed by nlohmann's parser, which
/// says what is wrong; it needs one bit per level of nesting.
class JsonBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit JsonBuilder(JsonDocument& document) : document_(document) {}

  Status run() {
    if (JsonScan<JsonBuilder>(document_.text_, read_, *this).run()) return {};
    document_.nodes_.clear(), document_.strings_.clear();
    open_.clear(), read_ = 0, status_ = {};
    const char* const begin = document_.text_.data();
    const CountingIterator first{begin, &read_}, last{begin + document_.text_.size(), &read_};
    const bool whole = nlohmann::json::sax_parse(first, last, this);
    if (!whole && status_.ok()) status_ = failure("this is not JSON");
    return status_;
  }

  // Events of the fast pass that nlohmann's parser has in other forms.
  bool number(double value) { return add_number(value); }
  bool start_object() { return open(JsonKind::object); }
  bool start_array() { return open(JsonKind::array); }
  static std::optional<std::string> quoted(std::string_view token) {
    const nlohmann::json parsed = nlohmann::json::parse(token, nullptr, false);
    return parsed.is_string() ? std::optional(parsed.get<std::string>()) : std::nullopt;
  }

  bool null() override { return add(JsonKind::null, {.number = 0}); }
  bool boolean(bool value) override { return add(JsonKind::boolean, {.number = value ? 1.0 : 0.0}); }
  bool number_integer(number_integer_t value) override { return add_number(static_cast<double>(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add_number(static_cast<double>(value)); }
  bool number_float(number_float_t value, const string_t&) override { return add_number(value); }
  bool string(string_t& value) override {
    document_.strings_.push_back(std::move(value));
    return add(JsonKind::string, {.string = document_.strings_.size() - 1});
  }
  bool binary(binary_t&) override { return false; }  // does not occur in text
  bool key(string_t& value) override {
    document_.strings_.push_back(std::move(value));
    append(JsonKind::string, {.string = document_.strings_.size() - 1});  // its value counts it
    return true;
  }
  bool start_object(std::size_t) override { return open(JsonKind::object); }
  bool start_array(std::size_t) override { return open(JsonKind::array); }
  bool end_object() override { return has_distinct_keys(open_.back()) && close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    status_ = failure(readable(error.what()));
    return false;
  }

 private:
  using Content = JsonDocument::Content;

  Status failure(std::string_view sentence) const {
    return {StatusCode::parse_error, document_.line_of(read_) + std::string(sentence)};
  }
  void append(JsonKind kind, Content content) {
    document_.nodes_.push_back({kind, static_cast<std::uint32_t>(read_), content});
  }
  bool add(JsonKind kind, Content content) {
    if (!open_.empty()) ++document_.nodes_[open_.back()].content.children.count;
    append(kind, content);
    return true;
  }
  bool add_number(double value) { return add(JsonKind::number, {.number = value}); }
  bool open(JsonKind kind) {
    if (open_.size() == JsonDocument::largest_depth) {
      status_ = failure("nested more than " + std::to_string(JsonDocument::largest_depth) + " deep");
      return false;
    }
    add(kind, {.children = {0, 0}});
    open_.push_back(document_.nodes_.size() - 1);
    return true;
  }
  bool close() {
    document_.nodes_[open_.back()].content.children.end = static_cast<std::uint32_t>(document_.nodes_.size());
    open_.pop_back();
    return true;
  }
  /// Sorted: a hostile object may have a million keys.
  bool has_distinct_keys(std::size_t object) {
    const auto& nodes = document_.nodes_;
    const auto text_of = [&](std::size_t node) -> const std::string& {
      return document_.strings_[nodes[node].content.string];
    };
    std::vector<std::size_t> keys;
    for (std::size_t key = object + 1; key < nodes.size(); key = document_.behind(key + 1)) keys.push_back(key);
    std::stable_sort(keys.begin(), keys.end(), [&](auto a, auto b) { return text_of(a) < text_of(b); });
    const auto twice =
        std::adjacent_find(keys.begin(), keys.end(), [&](auto a, auto b) { return text_of(a) == text_of(b); });
    if (twice == keys.end()) return true;
    const std::size_t second = twice[1];
    status_ = {StatusCode::parse_error, document_.line_of(nodes[second].offset) + "the key " + quote(text_of(second)) +
                                            " occurs twice in one object"};
    return false;
  }

  JsonDocument& document_;
  std::size_t read_ = 0;  // bytes; the last may be the one behind a number
  std::vector<std::size_t> open_;
  Status status_;
};

Result<JsonDocument> JsonDocument::parse(std::string_view text, std::string_view name) {
  if (text.size() > std::numeric_limits<std::uint32_t>::max())
    return Status(StatusCode::unsupported, std::string(name) + ": JSON of more than 4 GB is not read");
  JsonDocument document(text, name);
  const Status status = JsonBuilder(document).run();
  if (!status.ok()) return status;
  return document;
}

std::string JsonDocument::line_of(std::size_t offset) const {
  // The last byte read belongs to the line, even if it is the line's end: a number ends only at the byte behind it.
  const std::string_view before = text_.substr(0, offset == 0 ? 0 : offset - 1);
  return name_ + ":" + std::to_string(std::count(before.begin(), before.end(), '\n') + 1) + ": ";
}

std::string JsonDocument::pointer_to(std::size_t node) const {
  std::string pointer;
  for (std::size_t at = 0; at != node;) {
    const bool is_object = nodes_[at].kind == JsonKind::object;
    std::size_t child = at + 1, index = 0;
    std::string name;
    for (;; child = behind(child), ++index) {
      if (is_object) {
        name = strings_[nodes_[child].content.string];
        if (child == node) return pointer;  // a key: point to its object
        ++child;
      }
      if (node < behind(child)) break;
    }
    if (is_object) {
      const std::string quoted = quote(name);
      pointer += "/" + quoted.substr(1, quoted.size() - 2);
    } else {
      pointer += "/" + std::to_string(index);
    }
    at = child;
  }
  return pointer;
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  for (Iterator member = begin(); member != end();) {
    const JsonValue name = *member;
    const JsonValue value = *++member;
    if (name.string() == key) return value;
    ++member;
  }
  return {};
}

void JsonValue::fail(std::string_view sentence, StatusCode code) const {
  const std::string pointer = document_->pointer_to(at_);
  throw JsonFailure{Status(
      code, document_->line_of(node().offset) + pointer + (pointer.empty() ? "" : ": ") + std::string(sentence))};
}

void JsonValue::fail_expected(std::string_view what) const {
  std::string found;
  switch (kind()) {
    case JsonKind::null:
      found = "null";
      break;
    case JsonKind::boolean:
      found = number() != 0 ? "true" : "false";
      break;
    case JsonKind::number:
      found = text(number());
      break;
    case JsonKind::string:
      found = quote(string());
      break;
    case JsonKind::array:
      found = size() == 0 ? "an empty array" : "an array of " + std::to_string(size());
      break;
    case JsonKind::object:
      found = "an object";
      break;
  }
  fail("expected " + std::string(what) + ", found " + found);
}

}}  // namespace tessera::abi_0_1
