#include "io/mesh/ply_header.h"
#include "io/file/text_cursor.h"

#include <algorithm>
#include <array>
#include <optional>

namespace tessera { inline namespace abi_0_1 {
namespace {

std::optional<PlyType> parse_type(std::string_view word) {
  struct Name {
    std::string_view old_name, new_name;
    PlyType type;
  };
  constexpr std::array<Name, 8> names{{{"char", "int8", PlyType::int8},
                                       {"uchar", "uint8", PlyType::uint8},
                                       {"short", "int16", PlyType::int16},
                                       {"ushort", "uint16", PlyType::uint16},
                                       {"int", "int32", PlyType::int32},
                                       {"uint", "uint32", PlyType::uint32},
                                       {"float", "float32", PlyType::float32},
                                       {"double", "float64", PlyType::float64}}};
  for (const Name& entry : names) {
    if (word == entry.old_name || word == entry.new_name) return entry.type;
  }
  return std::nullopt;
}

template <class Named>
bool has_name(const std::vector<Named>& list, std::string_view name) {
  return std::any_of(list.begin(), list.end(), [name](const Named& entry) { return entry.name == name; });
}

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, std::string_view name)
      : cursor_(bytes, name, {.comment = 0}), size_(bytes.size()) {}

  Result<PlyHeader> read() {
    if (next_word() != "ply") return cursor_.expected("ply");
    take_word();
    for (;;) {
      if (!cursor_.take_line_end()) return cursor_.expected("the end of the line");
      const std::string_view word = next_word();
      if (word == "end_header") break;
      const Status status = read_line(word);
      if (!status.ok()) return status;
    }
    if (!format_seen_) return cursor_.expected("format, before end_header");
    take_word();
    if (!cursor_.take_line_end()) return cursor_.expected("the end of the line");
    header_.bytes = size_ - cursor_.remaining();
    return std::move(header_);
  }

 private:
  std::string_view next_word() {
    cursor_.skip_blanks();
    return cursor_.peek_token();
  }
  std::string_view take_word() {
    const std::string_view word = next_word();
    cursor_.skip(word);
    return word;
  }

  Status read_line(std::string_view keyword) {
    if (keyword == "comment" || keyword == "obj_info") {
      while (!next_word().empty()) take_word();
      return {};
    }
    if (keyword != "format" && keyword != "element" && keyword != "property") {
      return cursor_.expected("format, element, property, comment or end_header");
    }
    take_word();
    if (keyword == "format") return read_format();
    return keyword == "element" ? read_element() : read_property();
  }

  Status read_format() {
    if (format_seen_) return cursor_.failure("the format is stated a second time");
    const std::string_view format = next_word();
    if (format == "binary_big_endian") {
      return Status(StatusCode::unsupported, cursor_.failure("unsupported format binary_big_endian").message());
    }
    if (format != "ascii" && format != "binary_little_endian") return cursor_.expected("ascii or binary_little_endian");
    take_word();
    header_.binary = format != "ascii";
    if (next_word() != "1.0") return cursor_.expected("the format's version 1.0");
    take_word();
    format_seen_ = true;
    return {};
  }

  Status read_element() {
    PlyElement element;
    element.name = next_word();
    if (element.name.empty()) return cursor_.expected("the name of an element");
    if (has_name(header_.elements, element.name)) return second("element", element.name);
    take_word();
    cursor_.skip_blanks();
    const TextCursor before = cursor_;
    std::int64_t count = 0;
    if (!cursor_.take_number(count) || count < 0)
      return before.expected("how many " + element.name + " records there are");
    element.count = static_cast<std::uint64_t>(count);
    header_.elements.push_back(std::move(element));
    return {};
  }

  Status second(const char* what, const std::string& name, const std::string& where = {}) const {
    return cursor_.failure(std::string("there is a second ") + what + " " + quote(name) + where);
  }

  Status read_type(PlyType& type) {
    const std::optional<PlyType> parsed = parse_type(next_word());
    if (!parsed) return cursor_.expected("a type (char, uchar, short, ushort, int, uint, float, double)");
    take_word();
    type = *parsed;
    return {};
  }

  Status read_property() {
    if (header_.elements.empty()) return cursor_.failure("expected element before the first property");
    PlyProperty property;
    property.is_list = next_word() == "list";
    Status status;
    if (property.is_list) {
      take_word();
      status = read_type(property.count_type);
    }
    if (status.ok()) status = read_type(property.type);
    if (!status.ok()) return status;
    property.name = next_word();
    if (property.name.empty()) return cursor_.expected("the name of a property");
    PlyElement& element = header_.elements.back();
    if (has_name(element.properties, property.name)) return second("property", property.name, " of " + element.name);
    if (is_corner_list(property) && std::any_of(element.properties.begin(), element.properties.end(), is_corner_list)) {
      return cursor_.failure("there is a second list of indices");
    }
    take_word();
    element.properties.push_back(std::move(property));
    return {};
  }

  TextCursor cursor_;
  std::size_t size_;
  PlyHeader header_;
  bool format_seen_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

bool is_corner_list(const PlyProperty& property) {
  return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

Result<PlyHeader> parse_ply_header(std::string_view bytes, std::string_view name) {
  return HeaderReader(bytes, name).read();
}

}}  // namespace tessera::abi_0_1
