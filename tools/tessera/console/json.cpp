#include "console/json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tessera::cli {

/// Json as nlohmann/json has it.
struct JsonText {
  using Library = nlohmann::ordered_json;

  Library operator()(std::monostate) const { return nullptr; }
  Library operator()(const Json::List& list) const {
    Library out = Library::array();
    for (const Json& value : list) out.push_back(std::visit(*this, value.value_));
    return out;
  }
  Library operator()(const Json::Object& object) const {
    Library out = Library::object();
    for (const Json::Member& member : object) out[member.name] = std::visit(*this, member.value.value_);
    return out;
  }
  Library operator()(const auto& plain) const { return plain; }
};

Json::Json(const std::vector<std::string>& values) : value_(List(values.begin(), values.end())) {}
Json::Json(std::initializer_list<Member> members) : value_(Object(members)) {}

Json Json::object() {
  Json out;
  out.value_ = Object();
  return out;
}

Json Json::array(std::initializer_list<Json> values) {
  Json out;
  out.value_ = List(values);
  return out;
}

Json& Json::operator[](const std::string& name) {
  if (!std::holds_alternative<Object>(value_)) value_ = Object();
  Object& members = std::get<Object>(value_);
  const auto found = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.name == name; });
  return found == members.end() ? members.emplace_back(Member{name, {}}).value : found->value;
}

void Json::push_back(Json value) {
  if (!std::holds_alternative<List>(value_)) value_ = List();
  std::get<List>(value_).push_back(std::move(value));
}

const std::vector<Json::Member>& Json::members() const { return std::get<Object>(value_); }

std::string Json::text() const {
  return std::visit(JsonText(), value_).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace tessera::cli
