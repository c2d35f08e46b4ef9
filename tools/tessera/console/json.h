#pragma once
// JSON values for output. The text itself is written by nlohmann/json, which only json.cpp includes: it takes seconds
// to compile.

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace tessera::cli {

/// Null, a truth value, a number, a text, a list, or an object whose members keep their order.
class Json {
 public:
  struct Member;

  Json() = default;                                       ///< null
  Json(std::same_as<bool> auto value) : value_(value) {}  ///< true or false
  Json(std::integral auto value) requires(!std::same_as<decltype(value), bool>)
      : value_(static_cast<std::int64_t>(value)) {}        ///< a whole number
  Json(double value) : value_(value) {}                    ///< a number; null if it is not finite
  Json(const char* value) : value_(std::string(value)) {}  ///< a text
  Json(std::string value) : value_(std::move(value)) {}    ///< a text; bytes that are not UTF-8 are replaced
  Json(const std::vector<std::string>& values);            ///< a list of texts
  Json(std::initializer_list<Member> members);             ///< an object

  static Json object();                                        ///< an object without members
  static Json array(std::initializer_list<Json> values = {});  ///< a list

  /// The member of this name, which is added if there is none.
  Json& operator[](const std::string& name);
  /// Appends to a list.
  void push_back(Json value);
  /// The members of an object.
  const std::vector<Member>& members() const;
  /// One line of text.
  std::string text() const;

 private:
  friend struct JsonText;
  using List = std::vector<Json>;
  using Object = std::vector<Member>;
  std::variant<std::monostate, bool, std::int64_t, double, std::string, List, Object> value_;
};

struct Json::Member {
  std::string name;
  Json value;
};

}  // namespace tessera::cli
