// Reads PLY, the polygon file format (G. Turk, The PLY Polygon File Format, 1994).

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "io/file/text_cursor.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/ply_header.h"
#include "io/mesh/polygon.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is read in the machine's own byte order");

/// The values of a binary body, one after the other.
class BinaryValues {
 public:
  BinaryValues(std::string_view bytes, std::size_t begin, std::string_view name)
      : at_(bytes.data() + begin), end_(bytes.data() + bytes.size()), name_(name) {}

  bool take(PlyType type, double& value) {
    switch (type) {
      case PlyType::int8:
        return copy<std::int8_t>(value);
      case PlyType::uint8:
        return copy<std::uint8_t>(value);
      case PlyType::int16:
        return copy<std::int16_t>(value);
      case PlyType::uint16:
        return copy<std::uint16_t>(value);
      case PlyType::int32:
        return copy<std::int32_t>(value);
      case PlyType::uint32:
        return copy<std::uint32_t>(value);
      case PlyType::float32:
        return copy<float>(value);
      case PlyType::float64:
        return copy<double>(value);
    }
    return false;
  }
  /// The fewest bytes that a value takes, and the bytes left.
  static std::size_t min_bytes(PlyType type) { return size_of(type); }
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  bool at_end() { return at_ == end_; }
  Status failure(const std::string& place) const { return error("the file ends in " + place); }
  Status error(const std::string& sentence) const {
    return Status(StatusCode::parse_error, std::string(name_) + ": " + sentence);
  }

 private:
  template <class T>
  bool copy(double& value) {
    if (remaining() < sizeof(T)) return false;
    T stored;
    std::memcpy(&stored, at_, sizeof(T));
    at_ += sizeof(T);
    value = static_cast<double>(stored);
    return true;
  }

  const char *at_, *end_;
  std::string_view name_;
};

/// The values of an ascii body.
class AsciiValues {
 public:
  AsciiValues(std::string_view bytes, std::size_t begin, std::string_view name) : cursor_(bytes, name, {.comment = 0}) {
    cursor_.skip(std::string_view(cursor_.position(), begin - (bytes.size() - cursor_.remaining())));
  }

  bool take(PlyType, double& value) {
    cursor_.skip_space();
    return cursor_.take_number(value);
  }
  static std::size_t min_bytes(PlyType) { return 2; }                // a digit and a separator
  std::size_t remaining() const { return cursor_.remaining() + 1; }  // the last value may end with the file
  bool at_end() {
    cursor_.skip_space();
    return cursor_.at_end();
  }
  Status failure(const std::string& place) const { return cursor_.expected("a number of " + place); }
  Status error(const std::string& sentence) const { return cursor_.failure(sentence); }

 private:
  TextCursor cursor_;
};

/// The components of a vertex that a mesh keeps, in this order.
constexpr std::array<std::string_view, 8> vertex_names{"x", "y", "z", "nx", "ny", "nz", "u", "v"};
constexpr std::size_t not_kept = vertex_names.size();

std::string record_of(const PlyElement& element, std::uint64_t k) {
  return element.name + " " + std::to_string(k + 1) + " of " + std::to_string(element.count);
}

bool is_index(double value) {
  return value >= 0 && value <= double{std::numeric_limits<std::uint32_t>::max()} && value == std::floor(value);
}

template <class Values>
class BodyReader {
 public:
  BodyReader(Values values, const MeshReadOptions& options) : values_(values), options_(options) {}

  Result<Mesh> read(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
      Status status = check_size(element);
      if (status.ok()) {
        status = element.name == "vertex" ? read_vertices(element)
                 : element.name == "face" ? read_faces(element)
                                          : skip(element);
      }
      if (!status.ok()) return status;
    }
    if (!values_.at_end()) return values_.error("there is data after the last element");
    if (mesh_.positions.empty()) return values_.error("there are no vertices");
    for (const auto* indices : {&mesh_.indices, &mesh_.quads}) {
      const auto bad = std::find_if(indices->begin(), indices->end(),
                                    [&](std::uint32_t index) { return index >= mesh_.vertex_count(); });
      if (bad != indices->end())
        return values_.error("a face has the vertex index " + std::to_string(*bad) + ", but there are " +
                             std::to_string(mesh_.vertex_count()) + " vertices");
    }
    return std::move(mesh_);
  }

 private:
  /// Checks, before anything is allocated, that the file can hold what it states.
  Status check_size(const PlyElement& element) {
    std::uint64_t least = 0;
    for (const PlyProperty& property : element.properties) {
      least += Values::min_bytes(property.is_list ? property.count_type : property.type);
    }
    if (least != 0 && element.count > values_.remaining() / least) {
      return values_.error("the header states " + std::to_string(element.count) + " " + element.name +
                           " records; the file is too short for so many");
    }
    return {};
  }

  Status read_vertices(const PlyElement& element) {
    std::vector<std::size_t> places;
    std::array<bool, vertex_names.size() + 1> present{};
    for (const PlyProperty& property : element.properties) {
      const auto found = std::find(vertex_names.begin(), vertex_names.end(), property.name);
      places.push_back(property.is_list ? not_kept : static_cast<std::size_t>(found - vertex_names.begin()));
      present[places.back()] = true;
    }
    if (!present[0] || !present[1] || !present[2]) return values_.error("vertices have no x, y, z");
    const bool normals = present[3] && present[4] && present[5], parameters = present[6] && present[7];
    const auto count = static_cast<std::size_t>(element.count);  // the file has as many bytes: see check_size()
    mesh_.positions.reserve(3 * count);
    if (normals) mesh_.normals.reserve(3 * count);
    if (parameters) mesh_.parameters.reserve(2 * count);
    std::array<float, vertex_names.size() + 1> vertex{};
    for (std::uint64_t k = 0; k < element.count; ++k) {
      for (std::size_t p = 0; p < places.size(); ++p) {
        double value = 0;
        const PlyProperty& property = element.properties[p];
        if (!(property.is_list ? skip_list(property) : values_.take(property.type, value))) {
          return values_.failure(record_of(element, k));
        }
        vertex[places[p]] = static_cast<float>(value);
      }
      mesh_.positions.insert(mesh_.positions.end(), vertex.begin(), vertex.begin() + 3);
      if (normals) mesh_.normals.insert(mesh_.normals.end(), vertex.begin() + 3, vertex.begin() + 6);
      if (parameters) mesh_.parameters.insert(mesh_.parameters.end(), vertex.begin() + 6, vertex.begin() + 8);
    }
    return {};
  }

  Status read_faces(const PlyElement& element) {
    for (std::uint64_t k = 0; k < element.count; ++k) {
      const std::size_t before = mesh_.triangle_count() + mesh_.quad_count();
      double patch = -1;
      for (const PlyProperty& property : element.properties) {
        Status status;
        double ignored = 0;
        if (is_corner_list(property)) {
          status = read_polygon(property, element, k);
        } else if (!(property.is_list ? skip_list(property)
                                      : values_.take(property.type, property.name == "patch" ? patch : ignored))) {
          status = values_.failure(record_of(element, k));
        }
        if (!status.ok()) return status;
      }
      if (is_index(patch)) {
        mesh_.patches.resize(mesh_.triangle_count(), static_cast<std::uint32_t>(patch));
        mesh_.quad_patches.resize(mesh_.quad_count(), static_cast<std::uint32_t>(patch));
      }
      if (mesh_.triangle_count() + mesh_.quad_count() == before)
        return values_.error(record_of(element, k) + " has no vertex_indices");
    }
    if (!mesh_.has_patches()) {
      mesh_.patches.clear();
      mesh_.quad_patches.clear();
    }
    return {};
  }

  Status read_polygon(const PlyProperty& property, const PlyElement& element, std::uint64_t k) {
    double count = 0;
    if (!values_.take(property.count_type, count)) return values_.failure(record_of(element, k));
    if (!is_index(count) || count < 3) return values_.error(record_of(element, k) + " has fewer than 3 corners");
    const auto corners = static_cast<std::uint32_t>(count);
    std::uint32_t first = 0, last = 0;
    for (std::uint32_t c = 0; c < corners; ++c) {
      double value = 0;
      if (!values_.take(property.type, value)) return values_.failure(record_of(element, k));
      if (!is_index(value)) return values_.error(record_of(element, k) + " has a corner that is no index");
      const auto index = static_cast<std::uint32_t>(value);
      if (c == 0) first = index;
      if (c >= 2) mesh_.indices.insert(mesh_.indices.end(), {first, last, index});
      last = index;
    }
    if (corners == 4 && options_.keep_quads) join_last_quad(mesh_);
    return {};
  }

  bool skip_list(const PlyProperty& property) {
    double count = 0, ignored = 0;
    if (!values_.take(property.count_type, count) || !is_index(count)) return false;
    const auto values = static_cast<std::uint32_t>(count);
    for (std::uint32_t k = 0; k < values; ++k) {
      if (!values_.take(property.type, ignored)) return false;
    }
    return true;
  }

  Status skip(const PlyElement& element) {
    double ignored = 0;
    if (element.properties.empty()) return {};
    for (std::uint64_t k = 0; k < element.count; ++k) {
      for (const PlyProperty& property : element.properties) {
        if (!(property.is_list ? skip_list(property) : values_.take(property.type, ignored))) {
          return values_.failure(record_of(element, k));
        }
      }
    }
    return {};
  }

  Values values_;
  MeshReadOptions options_;
  Mesh mesh_;
};

}  // namespace

Result<Mesh> parse_ply(std::string_view bytes, std::string_view name, const MeshReadOptions& options) {
  const Result<PlyHeader> header = parse_ply_header(bytes, name);
  if (!header) return header.status();
  if (header->binary) return BodyReader(BinaryValues(bytes, header->bytes, name), options).read(*header);
  return BodyReader(AsciiValues(bytes, header->bytes, name), options).read(*header);
}

}}  // namespace tessera::abi_0_1
