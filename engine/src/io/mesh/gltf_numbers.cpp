#include "io/mesh/gltf_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>

#include "io/file/base64.h"
#include "io/file/relative_path.h"
#include "io/file/text_cursor.h"
#include "io/json/json_reader.h"
#include "io/mesh/meshopt.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

template <class T>
double stored(const char* at, bool normalized) {
  T value;
  std::memcpy(&value, at, sizeof value);
  const auto number = static_cast<double>(value);
  // The specification, section 3.6.2.2: f = max(c / (2^n - 1), -1).
  return normalized ? std::max(number / static_cast<double>(std::numeric_limits<T>::max()), -1.0) : number;
}

/// The bytes of a component; 0 for a type that is none.
std::size_t size_of_component(std::size_t type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case 5126:
      return 4;
    default:
      return 0;
  }
}

/// Reads the members that EXT_meshopt_compression adds to a view (section "JSON schema updates").
MeshoptView meshopt_view(const JsonValue& packed) {
  MeshoptView view;
  view.count = read_count(member(packed, "count"));
  view.stride = read_count(member(packed, "byteStride"));
  const JsonValue mode = member(packed, "mode");
  const auto choice = [](const JsonValue& value, std::span<const std::string_view> names) {
    const auto known = std::ranges::find(names, read_text(value));
    if (known == names.end()) value.fail("found " + quote(value.string()) + ", which the extension does not have");
    return known - names.begin();
  };
  constexpr std::string_view modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
  constexpr std::string_view filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
  view.mode = static_cast<MeshoptMode>(choice(mode, modes));
  if (const auto filter = optional_member(packed, "filter"))
    view.filter = static_cast<MeshoptFilter>(choice(*filter, filters));
  return view;
}

std::size_t component_count(std::string_view type) {
  return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
}

}  // namespace

JsonValue member(const JsonValue& object, std::string_view key) {
  const std::optional<JsonValue> found = optional_member(object, key);
  if (!found) object.fail("\"" + std::string(key) + "\" is missing");
  return *found;
}

std::optional<JsonValue> optional_member(const JsonValue& object, std::string_view key) {
  if (!object.is(JsonKind::object)) object.fail_expected("an object");
  return object.find(key);
}

std::size_t read_count(const JsonValue& value) {
  constexpr double largest = 9007199254740992;  // 2^53: all below are exact
  const bool fits = value.is(JsonKind::number) && value.number() >= 0 && value.number() < largest &&
                    value.number() == std::floor(value.number());
  if (!fits) value.fail_expected("a whole number, 0 or above");
  return static_cast<std::size_t>(value.number());
}

std::size_t read_count(const JsonValue& object, std::string_view key, std::size_t otherwise) {
  const std::optional<JsonValue> value = optional_member(object, key);
  return value ? read_count(*value) : otherwise;
}

double GltfElements::at(std::size_t element, std::size_t component) const {
  const char* const begin = first + element * stride;
  switch (component_type) {
    case 5120:
      return stored<std::int8_t>(begin + component, normalized);
    case 5121:
      return stored<std::uint8_t>(begin + component, normalized);
    case 5122:
      return stored<std::int16_t>(begin + 2 * component, normalized);
    case 5123:
      return stored<std::uint16_t>(begin + 2 * component, normalized);
    case 5125:
      return stored<std::uint32_t>(begin + 4 * component, normalized);
    default:
      return stored<float>(begin + 4 * component, false);
  }
}

GltfNumbers::GltfNumbers(const JsonValue& root, std::optional<std::string_view> binary, std::string_view name)
    : root_(root), binary_(binary), name_(name) {}

const std::vector<JsonValue>& GltfNumbers::list(std::string_view name) {
  const auto known = lists_.find(name);
  if (known != lists_.end()) return known->second;
  std::vector<JsonValue>& elements = lists_[std::string(name)];
  if (const std::optional<JsonValue> found = optional_member(root_, name))
    for (const JsonValue element : array(*found, "an array of " + std::string(name))) elements.push_back(element);
  return elements;
}

JsonValue GltfNumbers::element(std::string_view list_name, const JsonValue& index) {
  const std::vector<JsonValue>& elements = list(list_name);
  const std::size_t k = read_count(index);
  if (k >= elements.size())
    index.fail("the index " + std::to_string(k) + " is beyond the " + std::to_string(elements.size()) +
               " elements of " + std::string(list_name));
  return elements[k];
}

GltfElements GltfNumbers::elements(const JsonValue& index, std::string_view type) {
  const JsonValue accessor = element("accessors", index);
  if (const auto sparse = optional_member(accessor, "sparse"))
    sparse->fail("sparse accessors are not read; export the file without them", StatusCode::unsupported);
  const JsonValue stated = member(accessor, "type"), component = member(accessor, "componentType");
  if (read_text(stated) != type) stated.fail_expected("\"" + std::string(type) + "\"");
  GltfElements found;
  found.components = component_count(type);
  found.count = read_count(member(accessor, "count"));
  const std::size_t bytes = size_of_component(read_count(component)) * found.components;
  if (bytes == 0) component.fail_expected("a type of component (5120, 5121, 5122, 5123, 5125 or 5126)");
  found.component_type = static_cast<int>(component.number());
  if (const auto normalized = optional_member(accessor, "normalized"))
    found.normalized = normalized->is(JsonKind::boolean) && normalized->number() != 0;
  const std::optional<JsonValue> view_index = optional_member(accessor, "bufferView");
  if (!view_index)
    accessor.fail("\"bufferView\" is missing: accessors of zeros or compressed ones are not read",
                  StatusCode::unsupported);
  const std::string_view all = view(*view_index, found.stride);
  if (found.stride == 0) found.stride = bytes;
  if (found.stride < bytes)
    accessor.fail("an element takes " + std::to_string(bytes) + " bytes, the view's byteStride is " +
                  std::to_string(found.stride));
  const std::size_t offset = read_count(accessor, "byteOffset", 0);
  const bool fits = found.count > 0 && offset <= all.size() && bytes <= all.size() - offset &&
                    (found.count - 1) <= (all.size() - offset - bytes) / found.stride;
  if (!fits)
    accessor.fail(std::to_string(found.count) + " elements of " + std::to_string(bytes) + " bytes, every " +
                  std::to_string(found.stride) + " bytes from byte " + std::to_string(offset) +
                  " on, are not in a view of " + std::to_string(all.size()) + " bytes");
  found.first = all.data() + offset;
  return found;
}

std::string_view GltfNumbers::view(const JsonValue& index, std::size_t& stride) {
  const JsonValue view = element("bufferViews", index);
  stride = 0;
  constexpr int largest_stride = 252;  // the specification, section 5.11.4
  if (const auto stated = optional_member(view, "byteStride"))
    stride = static_cast<std::size_t>(read_integer(*stated, 1, largest_stride));
  if (const auto extensions = optional_member(view, "extensions"))
    if (const auto packed = optional_member(*extensions, "EXT_meshopt_compression"))
      return unpacked(*packed, read_count(member(view, "byteLength")));
  return bytes_of(view);
}

/// The bytes of a buffer that an object with a buffer, an offset and a length states.
std::string_view GltfNumbers::bytes_of(const JsonValue& range) {
  const std::string_view all = buffer(member(range, "buffer"));
  const std::size_t offset = read_count(range, "byteOffset", 0), size = read_count(member(range, "byteLength"));
  if (offset > all.size() || size > all.size() - offset)
    range.fail(std::to_string(size) + " bytes from byte " + std::to_string(offset) + " on are not in a buffer of " +
               std::to_string(all.size()) + " bytes");
  return all.substr(offset, size);
}

/// The `size` bytes of a view that is packed.
std::string_view GltfNumbers::unpacked(const JsonValue& packed, std::size_t size) {
  if (const auto known = unpacked_.find(packed.place()); known != unpacked_.end()) return known->second;
  const MeshoptView view = meshopt_view(packed);
  const std::string_view bytes = bytes_of(packed);
  // The count and the stride are small enough for their product.
  if (!is_allowed(view) || view.count > std::numeric_limits<std::size_t>::max() / view.stride)
    packed.fail("elements of this mode and filter cannot be " + std::to_string(view.count) + " of " +
                std::to_string(view.stride) + " bytes");
  if (view.count * view.stride != size)
    packed.fail("expected the view's " + std::to_string(size) + " bytes (byteLength), found " +
                std::to_string(view.count) + " elements of " + std::to_string(view.stride));
  constexpr std::size_t times = 64, extra = std::size_t{16} << 20;
  const std::size_t limit = times * loaded_bytes_ + extra;
  if (size > limit - std::min(limit, unpacked_bytes_))
    packed.fail("the file's packed numbers take more than " + std::to_string(times) + " times its buffers and 16 MiB",
                StatusCode::unsupported);
  if (!has_meshopt())
    packed.fail("this build of Tessera does not unpack glTF: it lacks meshoptimizer", StatusCode::unsupported);
  std::string elements = unpack(view, bytes);
  if (elements.size() != size) packed.fail("the packed bytes are damaged");
  decoded_.push_back(std::make_unique<const std::string>(std::move(elements)));
  unpacked_bytes_ += size;
  return unpacked_[packed.place()] = *decoded_.back();
}

std::string_view GltfNumbers::buffer(const JsonValue& index) {
  const JsonValue buffer = element("buffers", index);
  const std::size_t k = read_count(index), size = read_count(member(buffer, "byteLength"));
  if (const auto known = buffers_.find(k); known != buffers_.end()) return known->second;
  std::string_view bytes;
  if (optional_member(buffer, "uri")) {
    bytes = load(buffer, size);
  } else {
    if (!binary_ || k != 0) buffer.fail("there is no \"uri\", and no binary chunk for this buffer");
    bytes = *binary_;
  }
  if (bytes.size() < size)
    buffer.fail("expected " + std::to_string(size) + " bytes (byteLength), found " + std::to_string(bytes.size()));
  loaded_bytes_ += size;
  return buffers_[k] = bytes.substr(0, size);
}

std::string_view GltfNumbers::load(const JsonValue& buffer, std::size_t size) {
  const JsonValue uri = member(buffer, "uri");
  if (size == 0) buffer.fail("expected 1 byte or more (byteLength), found 0");
  return read_text(uri).starts_with("data:") ? load_data(uri) : load_file(uri);
}

std::string_view GltfNumbers::load_data(const JsonValue& uri) {
  constexpr std::string_view headers[] = {"data:application/octet-stream;base64,",
                                          "data:application/gltf-buffer;base64,"};
  for (const std::string_view header : headers) {
    if (!uri.string().starts_with(header)) continue;
    std::optional<std::string> bytes = base64_decoded(uri.string().substr(header.size()));
    if (!bytes || bytes->empty()) break;
    decoded_.push_back(std::make_unique<const std::string>(*std::move(bytes)));
    return *decoded_.back();
  }
  uri.fail(
      "expected data:application/octet-stream;base64 or data:application/gltf-buffer;base64, and base64 after it, "
      "found " +
      quote(uri.string()));
}

std::string_view GltfNumbers::load_file(const JsonValue& uri) {
  const Result<std::string> decoded = percent_decoded(uri.string());
  if (!decoded) uri.fail(decoded.status().message());
  const Result<std::filesystem::path> path = path_beside(name_, *decoded);
  if (!path) uri.fail(path.status().message(), path.status().code());
  if (const Status status = check_below(name_, *path); !status.ok()) uri.fail(status.message(), status.code());
  auto& file = files_[path->string()];
  if (!file) {
    Result<std::string> bytes = read_regular_file(*path);
    if (!bytes) uri.fail(bytes.status().message(), bytes.status().code());
    file = std::make_unique<const std::string>(*std::move(bytes));
  }
  return *file;
}

}}  // namespace tessera::abi_0_1
