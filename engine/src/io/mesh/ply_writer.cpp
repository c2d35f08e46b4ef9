// PLY, binary little endian: the header, then a record for each vertex, triangle and quad.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <string>

#include "io/mesh/file_rounding.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/mesh_pieces.h"
#include "io/mesh/packed_records.h"
#include "io/mesh/valid_mesh.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written in the machine's own byte order");

constexpr MeshRecord record_kinds[] = {MeshRecord::vertex, MeshRecord::triangle, MeshRecord::quad};

template <class T>
char* put(char* to, const T* values, std::size_t count) {
  std::memcpy(to, values, count * sizeof(T));
  return to + count * sizeof(T);
}

void put_doubles(const Vec3& v, char* to) {
  const double values[] = {v.x, v.y, v.z};
  put(to, values, 3);
}

std::string header_text(const MeshTotals& totals) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment Tessera\nelement vertex ";
  text += std::to_string(totals.vertices) + "\n";
  const auto add = [&text](const char* type, std::initializer_list<const char*> names) {
    for (const char* const name : names) text += std::string("property ") + type + name + "\n";
  };
  add(totals.double_positions ? "double " : "float ", {"x", "y", "z"});
  if (totals.normals) add("float ", {"nx", "ny", "nz"});
  if (totals.parameters) add("float ", {"u", "v"});
  text +=
      "element face " + std::to_string(totals.triangles + totals.quads) + "\nproperty list uchar int vertex_indices\n";
  if (totals.patches) add("int ", {"patch"});
  return text + "end_header\n";
}

std::uint64_t count_of(const MeshTotals& totals, MeshRecord kind) {
  return kind == MeshRecord::vertex ? totals.vertices : kind == MeshRecord::triangle ? totals.triangles : totals.quads;
}
std::uint64_t count_of(const Mesh& mesh, MeshRecord kind) { return count_of(MeshTotals::of(mesh), kind); }
std::uint64_t first_of(const PiecePlace& place, MeshRecord kind) {
  return kind == MeshRecord::vertex     ? place.first_vertex
         : kind == MeshRecord::triangle ? place.first_triangle
                                        : place.first_quad;
}

/// Stores positions as doubles if `doubles` is set, else as floats.
void pack_vertices(const Mesh& mesh, bool doubles, std::size_t first, std::size_t last, char* to) {
  const bool own_doubles = !mesh.model_positions.empty(), normals = !mesh.normals.empty(),
             parameters = !mesh.parameters.empty();
  for (std::size_t k = first; k < last; ++k) {
    if (own_doubles) {
      to = put(to, mesh.model_positions.data() + 3 * k, 3);
    } else {
      const float* const p = mesh.positions.data() + 3 * k;
      const Vec3 sum = mesh.origin + Vec3{p[0], p[1], p[2]};
      doubles ? put_doubles(sum, to) : put_floats(sum, to);
      to += 3 * (doubles ? sizeof(double) : sizeof(float));
    }
    if (normals) to = put(to, mesh.normals.data() + 3 * k, 3);
    if (parameters) to = put(to, mesh.parameters.data() + 2 * k, 2);
  }
}

/// Faces of `Corners` corners, with their patches if there are any.
template <std::size_t Corners>
void pack_faces(const PiecePlace& place, const std::vector<std::uint32_t>& indices,
                const std::vector<std::uint32_t>* patches, std::size_t first, std::size_t last, char* to) {
  const auto first_vertex = static_cast<std::uint32_t>(place.first_vertex),
             first_patch = static_cast<std::uint32_t>(place.first_patch);
  for (std::size_t k = first; k < last; ++k) {
    std::array<std::uint32_t, Corners + 1> numbers{};
    for (std::size_t c = 0; c < Corners; ++c) numbers[c] = first_vertex + indices[Corners * k + c];
    if (patches) numbers[Corners] = first_patch + (*patches)[k];
    *to++ = static_cast<char>(Corners);
    to = put(to, numbers.data(), Corners + (patches ? 1 : 0));
  }
}

}  // namespace

MeshTotals MeshTotals::of(const Mesh& mesh) {
  return {.vertices = mesh.vertex_count(),
          .triangles = mesh.triangle_count(),
          .quads = mesh.quad_count(),
          .normals = !mesh.normals.empty(),
          .parameters = !mesh.parameters.empty(),
          .patches = mesh.has_patches(),
          .double_positions = !mesh.model_positions.empty()};
}

PlyLayout::PlyLayout(const MeshTotals& totals) : totals_(totals), header_(header_text(totals)) {}

Result<PlyLayout> PlyLayout::make(const MeshTotals& totals) {
  return guarded([&]() -> Result<PlyLayout> {
    constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
    if (totals.vertices == 0) return Status(StatusCode::invalid_argument, "the mesh has no vertices");
    if (totals.vertices > most)
      return Status(StatusCode::unsupported, "the mesh has " + std::to_string(totals.vertices) +
                                                 " vertices, a .ply file can index " + std::to_string(most) +
                                                 ": write it in pieces, as .pvtp");
    return PlyLayout(totals);
  });
}

std::uint64_t PlyLayout::file_bytes() const {
  std::uint64_t bytes = header_.size();
  for (const MeshRecord kind : record_kinds) bytes += count_of(totals_, kind) * record_bytes(kind);
  return bytes;
}

std::size_t PlyLayout::record_bytes(MeshRecord kind) const {
  if (kind == MeshRecord::vertex)
    return 3 * (totals_.double_positions ? sizeof(double) : sizeof(float)) +
           sizeof(float) * ((totals_.normals ? 3 : 0) + (totals_.parameters ? 2 : 0));
  const std::size_t corners = kind == MeshRecord::triangle ? 3 : 4;
  return 1 + sizeof(std::uint32_t) * (corners + (totals_.patches ? 1 : 0));
}

ByteRange PlyLayout::range(const Mesh& piece, const PiecePlace& place, MeshRecord kind) const {
  ByteRange range{header_.size() + first_of(place, kind) * record_bytes(kind),
                  count_of(piece, kind) * record_bytes(kind)};
  for (const MeshRecord before : record_kinds)
    if (before < kind) range.offset += count_of(totals_, before) * record_bytes(before);
  return range;
}

Status PlyLayout::check(const Mesh& piece, const PiecePlace& place) const {
  return guarded([&]() -> Status {
    const MeshTotals own = MeshTotals::of(piece);
    if (Status status = validate_piece(piece, totals_); !status.ok()) return status;
    for (const MeshRecord kind : record_kinds)
      if (first_of(place, kind) > count_of(totals_, kind) ||
          count_of(own, kind) > count_of(totals_, kind) - first_of(place, kind))
        return {StatusCode::count_mismatch, "a piece of the mesh is not within the whole"};
    return check_patches(piece, place.first_patch);
  });
}

void PlyLayout::pack(const Mesh& piece, const PiecePlace& place, MeshRecord kind, std::size_t first, std::size_t last,
                     char* to) const {
  if (kind == MeshRecord::vertex) return pack_vertices(piece, totals_.double_positions, first, last, to);
  if (kind == MeshRecord::triangle)
    return pack_faces<3>(place, piece.indices, totals_.patches ? &piece.patches : nullptr, first, last, to);
  pack_faces<4>(place, piece.quads, totals_.patches ? &piece.quad_patches : nullptr, first, last, to);
}

Status write_ply(const Mesh& mesh, OutputFile& out, const MeshWriteOptions&) {
  MeshTotals totals = MeshTotals::of(mesh);
  totals.double_positions |= needs_double_sums(PositionRange::of(mesh));
  const Result<PlyLayout> layout = PlyLayout::make(totals);
  if (!layout) return layout.status();
  out.write(layout->header());
  for (const MeshRecord kind : record_kinds) {
    const auto pack = [&](std::size_t first, std::size_t last, char* to) {
      layout->pack(mesh, {}, kind, first, last, to);
    };
    const auto count = static_cast<std::size_t>(count_of(mesh, kind));
    Status status = write_packed(out, count, layout->record_bytes(kind), pack);
    if (!status.ok()) return status;
  }
  return {};
}

}}  // namespace tessera::abi_0_1
