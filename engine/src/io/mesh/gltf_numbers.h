#pragma once
// The numbers of a glTF file, found through its accessors, buffer views and buffers.

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/json/json_document.h"

namespace tessera { inline namespace abi_0_1 {

/// Elements of an accessor, which all lie within its buffer.
struct GltfElements {
  const char* first = nullptr;
  std::size_t count = 0, stride = 0, components = 0;
  int component_type = 0;   ///< as in the file: 5120 int8, 5121 uint8, 5122 int16, 5123 uint16, 5125 uint32, 5126 float
  bool normalized = false;  ///< integers stand for fractions of their largest value

  bool empty() const { return count == 0; }
  /// A component of an element, as a number.
  double at(std::size_t element, std::size_t component) const;
  friend bool operator==(const GltfElements&, const GltfElements&) = default;
};

/// The lists of a glTF file. Members throw JsonFailure with the place. The root and `binary` must outlive it. Memory:
/// the bytes of the buffers.
class GltfNumbers {
 public:
  /// `binary` is the second chunk of a .glb file; `name` is the file's path, beside which its other files lie.
  GltfNumbers(const JsonValue& root, std::optional<std::string_view> binary, std::string_view name);

  /// The element of a list of the file ("nodes") with the index that `index` holds.
  JsonValue element(std::string_view list, const JsonValue& index);
  /// The elements of a list, none if there is no such list.
  const std::vector<JsonValue>& list(std::string_view name);
  /// The elements of the accessor with this index, of `type` "SCALAR", "VEC2" or "VEC3".
  GltfElements elements(const JsonValue& accessor, std::string_view type);
  /// The bytes of the buffers that were loaded.
  std::size_t loaded_bytes() const { return loaded_bytes_; }

 private:
  std::string_view view(const JsonValue& index, std::size_t& stride);
  std::string_view bytes_of(const JsonValue& range);
  std::string_view unpacked(const JsonValue& packed, std::size_t size);
  std::string_view buffer(const JsonValue& index);
  std::string_view load(const JsonValue& buffer, std::size_t size);
  std::string_view load_data(const JsonValue& uri);
  std::string_view load_file(const JsonValue& uri);

  JsonValue root_;
  std::optional<std::string_view> binary_;
  std::string name_;
  std::map<std::string, std::vector<JsonValue>, std::less<>> lists_;
  std::map<std::string, std::unique_ptr<const std::string>> files_;  // by path, so that none is read twice
  std::map<std::size_t, std::string_view> buffers_;                  // by index
  std::map<std::size_t, std::string_view> unpacked_;                 // views, by place in the text
  std::vector<std::unique_ptr<const std::string>> decoded_;
  std::size_t loaded_bytes_ = 0, unpacked_bytes_ = 0;
};

/// The member `key` of an object; throws if `object` is none or lacks it.
JsonValue member(const JsonValue& object, std::string_view key);
/// The member `key` of an object, if there is one; throws if `object` is none.
std::optional<JsonValue> optional_member(const JsonValue& object, std::string_view key);
/// The whole number that the member `key` holds, or `otherwise` without one.
std::size_t read_count(const JsonValue& object, std::string_view key, std::size_t otherwise);
std::size_t read_count(const JsonValue& value);

}}  // namespace tessera::abi_0_1
