#pragma once
// JSON in memory that knows the place of every value, so that errors name it: a line and a JSON pointer (RFC 6901).

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

enum class JsonKind : std::uint8_t { null, boolean, number, string, array, object };

/// Thrown by the readers of JSON; caught only where the reading of a document begins.
struct JsonFailure {
  Status status;
};

class JsonValue;

/// A text as a list of values, parents before children. Memory: 16 bytes per value, and the strings. Limits: nesting 64
/// deep, 2^32 - 1 bytes. Views the text, which must outlive it.
class JsonDocument {
 public:
  static constexpr std::size_t largest_depth = 64;
  /// Parses `text`; `name` stands for the file in messages. Errors: parse_error, with the line (not JSON, not UTF-8, a
  /// number beyond double, a duplicate key in an object, nesting too deep), unsupported (too long).
  static Result<JsonDocument> parse(std::string_view text, std::string_view name);

  JsonValue root() const;

 private:
  struct Children {
    std::uint32_t count, end;  // elements or members; the index behind this value and its children
  };
  union Content {
    double number;  // 0 or 1 for a boolean
    std::size_t string;
    Children children;
  };
  struct Node {
    JsonKind kind;
    std::uint32_t offset;  // in the text, of the byte behind its first one
    Content content;
    bool has_children() const { return kind == JsonKind::array || kind == JsonKind::object; }
  };
  JsonDocument(std::string_view text, std::string_view name) : text_(text), name_(name) {}
  std::string line_of(std::size_t offset) const;
  std::string pointer_to(std::size_t node) const;

  std::string_view text_;
  std::string name_;
  std::size_t behind(std::size_t node) const {
    return nodes_[node].has_children() ? nodes_[node].content.children.end : node + 1;
  }
  std::deque<Node> nodes_;  // an object holds key, value, key, value; a deque grows without a second copy
  std::vector<std::string> strings_;
  friend class JsonBuilder;
  friend class JsonValue;
};

/// One value of a document. The document must outlive it.
class JsonValue {
 public:
  JsonKind kind() const { return node().kind; }
  bool is(JsonKind kind) const { return node().kind == kind; }
  // The content; each call needs the matching kind.
  double number() const { return node().content.number; }
  const std::string& string() const { return document_->strings_[node().content.string]; }
  std::size_t size() const { return node().content.children.count; }  ///< elements or members
  /// Tells values of a document apart.
  std::size_t place() const { return at_; }
  /// The number of values within this one, itself included.
  std::size_t span() const { return document_->behind(at_) - at_; }

  /// Iterates over the elements of an array, or over the keys and values of an object in turn.
  class Iterator {
   public:
    Iterator(const JsonDocument* document, std::size_t at) : document_(document), at_(at) {}
    JsonValue operator*() const { return {document_, at_}; }
    Iterator& operator++() {
      at_ = document_->behind(at_);
      return *this;
    }
    bool operator!=(const Iterator& other) const { return at_ != other.at_; }

   private:
    const JsonDocument* document_;
    std::size_t at_;
  };
  Iterator begin() const { return {document_, at_ + 1}; }
  Iterator end() const { return {document_, document_->behind(at_)}; }
  /// The member `key` of an object. Takes time linear in the number of members.
  std::optional<JsonValue> find(std::string_view key) const;

  /// Throws "file:line: pointer: sentence".
  [[noreturn]] void fail(std::string_view sentence, StatusCode code = StatusCode::parse_error) const;
  /// Throws "file:line: pointer: expected <what>, found <what stands here>".
  [[noreturn]] void fail_expected(std::string_view what) const;

 private:
  friend class JsonDocument;
  JsonValue(const JsonDocument* document, std::size_t at) : document_(document), at_(at) {}
  const JsonDocument::Node& node() const { return document_->nodes_[at_]; }

  const JsonDocument* document_;
  std::size_t at_;
};

inline JsonValue JsonDocument::root() const { return {this, 0}; }

}}  // namespace tessera::abi_0_1
