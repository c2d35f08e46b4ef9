// STL, the triangles of stereolithography (3D Systems, StereoLithography Interface Specification, 1988). Binary: 80
// bytes that should not begin with "solid", the number of triangles, and for each its normal, three corners and two
// bytes. Ascii: the same as text.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "io/file/output_file.h"
#include "io/file/text_cursor.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/packed_records.h"
#include "tess/edges/position_bits.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Numbers distinct positions in the order in which they come. Positions are equal if their bits are, with -0 taken as
/// 0. Memory: 4 to 16 bytes per vertex besides the positions.
class VertexWelder {
 public:
  /// New positions are appended to `positions`: three floats per vertex, at most 2^32 - 1 vertices.
  explicit VertexWelder(std::vector<float>& positions) : positions_(positions), table_(min_size, no_id) {}

  std::uint32_t index_of(const std::array<float, 3>& position);

 private:
  static constexpr std::size_t min_size = 64;  // a power of two, like all sizes

  std::size_t slot_of(const std::array<float, 3>& position) const;
  void grow();

  std::vector<float>& positions_;
  std::vector<std::uint32_t> table_;  // open hash table of vertices
};

std::size_t VertexWelder::slot_of(const std::array<float, 3>& position) const {
  const PositionBits bits = position_bits(position.data());
  std::size_t slot = hash(bits) & (table_.size() - 1);
  while (table_[slot] != no_id && position_bits(&positions_[3 * std::size_t{table_[slot]}]) != bits)
    slot = (slot + 1) & (table_.size() - 1);
  return slot;
}

std::uint32_t VertexWelder::index_of(const std::array<float, 3>& position) {
  const std::size_t slot = slot_of(position);
  if (table_[slot] != no_id) return table_[slot];
  const std::size_t index = positions_.size() / 3;
  table_[slot] = static_cast<std::uint32_t>(index);
  positions_.insert(positions_.end(), position.begin(), position.end());
  if (2 * (index + 1) > table_.size()) grow();
  return static_cast<std::uint32_t>(index);
}

void VertexWelder::grow() {
  const std::size_t vertices = positions_.size() / 3;
  table_.assign(2 * table_.size(), no_id);
  for (std::size_t k = 0; k < vertices; ++k) {
    const float* const p = &positions_[3 * k];
    table_[slot_of({p[0], p[1], p[2]})] = static_cast<std::uint32_t>(k);
  }
}

static_assert(std::endian::native == std::endian::little, "STL is read and written in the machine's own byte order");

constexpr std::size_t title_bytes = 80, header_bytes = title_bytes + 4, triangle_bytes = 50;
constexpr std::size_t max_vertices = std::numeric_limits<std::uint32_t>::max();

/// Stores the normal, which points to where the corners run counter-clockwise (zero if there is no area), the corners,
/// and two bytes of 0.
void put_triangle(const Mesh& mesh, std::size_t triangle, char* to) {
  std::array<Vec3, 3> corner;
  for (std::size_t c = 0; c < 3; ++c) {
    const float* const p = &mesh.positions[3 * std::size_t{mesh.indices[3 * triangle + c]}];
    corner[c] = {p[0], p[1], p[2]};
    put_floats(mesh.origin + corner[c], to + 12 * (c + 1));
  }
  const Vec3 area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double size = length(area);
  put_floats((size > 0 ? 1 / size : 0) * area, to);
  to[48] = to[49] = 0;
}

bool begins_with_solid(std::string_view bytes, std::string_view name) {
  TextCursor cursor(bytes.substr(0, std::min<std::size_t>(bytes.size(), 1000)), name, {.comment = 0});
  cursor.skip_space();
  const std::string_view word = cursor.peek_token();
  return word == "solid" || word == "SOLID";
}

class StlMesh {
 public:
  explicit StlMesh(std::size_t triangles) { mesh_.indices.reserve(3 * triangles); }

  void add(const std::array<float, 3>& corner) { mesh_.indices.push_back(welder_.index_of(corner)); }
  bool full() const { return mesh_.vertex_count() > max_vertices - 3; }
  std::size_t triangles() const { return mesh_.triangle_count(); }
  Mesh take() { return std::move(mesh_); }

 private:
  Mesh mesh_;
  VertexWelder welder_{mesh_.positions};
};

Status stl_error(std::string_view name, const std::string& sentence) {
  return Status(StatusCode::parse_error, std::string(name) + ": " + sentence);
}

Status too_many(std::string_view name) {
  return Status(StatusCode::unsupported,
                std::string(name) + ": there are more vertices than 32-bit indices can tell apart");
}

/// The number of triangles that a binary file states.
std::size_t stated_triangles(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + title_bytes, sizeof count);
  return count;
}

Result<Mesh> parse_binary(std::string_view bytes, std::string_view name) {
  const std::size_t triangles = stated_triangles(bytes);
  if (triangles == 0) return stl_error(name, "there are no triangles");
  StlMesh mesh(triangles);
  const char* at = bytes.data() + header_bytes;
  for (std::size_t k = 0; k < triangles; ++k, at += triangle_bytes) {
    if (mesh.full()) return too_many(name);
    std::array<std::array<float, 3>, 4> facet;  // normal and corners
    std::memcpy(facet.data(), at, sizeof facet);
    for (std::size_t c = 1; c < 4; ++c) mesh.add(facet[c]);
  }
  return mesh.take();
}

/// Reads solid, facets, endsolid; some files hold several solids in a row. Words are in small letters or in capitals.
class AsciiReader {
 public:
  AsciiReader(std::string_view text, std::string_view name)
      : cursor_(text, name, {.comment = 0}), mesh_(text.size() / min_facet) {}

  Result<Mesh> read() {
    for (cursor_.skip_space(); !cursor_.at_end(); cursor_.skip_space())
      if (Status status = read_solid(); !status.ok()) return status;
    if (mesh_.triangles() == 0) return cursor_.failure("there are no triangles");
    return mesh_.take();
  }

 private:
  static constexpr std::size_t min_facet = 84;  // bytes of the shortest facet

  bool take(std::string_view word) {
    cursor_.skip_space();
    const std::string_view token = cursor_.peek_token();
    const auto same = [](char a, char b) { return a == b || (a >= 'A' && a <= 'Z' && a - 'A' + 'a' == b); };
    if (!std::equal(token.begin(), token.end(), word.begin(), word.end(), same)) return false;
    cursor_.skip(token);
    return true;
  }

  Status read_solid() {
    if (!take("solid")) return cursor_.expected("solid");
    cursor_.skip_line();  // skips its name
    while (!take("endsolid")) {
      if (!take("facet")) return cursor_.expected("facet or endsolid");
      if (Status status = read_facet(); !status.ok()) return status;
    }
    cursor_.skip_line();
    return {};
  }

  Status read_facet() {
    if (mesh_.full()) return too_many(cursor_.name());
    std::array<float, 3> values;
    if (!take("normal")) return cursor_.expected("normal");
    if (!take_values(values)) return cursor_.expected("3 numbers after normal");
    if (!take("outer") || !take("loop")) return cursor_.expected("outer loop");
    for (int corner = 0; corner < 3; ++corner) {
      if (!take("vertex")) return cursor_.expected("3 lines of vertex");
      if (!take_values(values)) return cursor_.expected("3 numbers after vertex");
      mesh_.add(values);
    }
    if (!take("endloop")) return cursor_.expected("endloop, after 3 vertices");
    return take("endfacet") ? Status() : cursor_.expected("endfacet");
  }

  bool take_values(std::array<float, 3>& values) {
    for (float& value : values) {
      cursor_.skip_blanks();
      double number = 0;
      if (!cursor_.take_number(number)) return false;
      value = static_cast<float>(number);
    }
    return true;
  }

  TextCursor cursor_;
  StlMesh mesh_;
};

}  // namespace

Status write_stl(const Mesh& mesh, OutputFile& out, const MeshWriteOptions&) {
  if (!mesh.quads.empty()) {
    const Result<Mesh> split = split_quads(mesh);
    return split ? write_stl(*split, out) : split.status();
  }
  const std::size_t triangles = mesh.triangle_count();
  if (triangles == 0 || triangles > max_vertices)
    return {StatusCode::invalid_argument, "the mesh has " + std::to_string(triangles) +
                                              " triangles, STL files hold 1 to " + std::to_string(max_vertices)};
  std::array<char, header_bytes> header{};
  constexpr std::string_view title = "Tessera";
  std::copy(title.begin(), title.end(), header.begin());
  const auto count = static_cast<std::uint32_t>(triangles);
  std::memcpy(header.data() + title_bytes, &count, sizeof count);
  out.write({header.data(), header.size()});
  return write_packed(out, triangles, triangle_bytes, [&](std::size_t first, std::size_t last, char* to) {
    for (std::size_t k = first; k < last; ++k, to += triangle_bytes) put_triangle(mesh, k, to);
  });
}

Result<Mesh> parse_stl(std::string_view bytes, std::string_view name, const MeshReadOptions&) {
  const bool has_header = bytes.size() >= header_bytes;
  // The size decides, because some binary files begin with "solid".
  if (has_header && (bytes.size() - header_bytes) == stated_triangles(bytes) * triangle_bytes)
    return parse_binary(bytes, name);
  if (begins_with_solid(bytes, name)) return AsciiReader(bytes, name).read();
  if (!has_header)
    return stl_error(name, "the file does not begin with solid, and with " + std::to_string(bytes.size()) +
                               " bytes it is too short for a binary STL file");
  return stl_error(name, "the header states " + std::to_string(stated_triangles(bytes)) +
                             " triangles; the file has room for " +
                             std::to_string((bytes.size() - header_bytes) / triangle_bytes) + " and " +
                             std::to_string((bytes.size() - header_bytes) % triangle_bytes) + " bytes more");
}

}}  // namespace tessera::abi_0_1
