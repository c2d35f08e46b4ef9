// VTK's XML files of polygons (The VTK User's Guide, 11th edition, chapter 19.3): a piece of a mesh as PolyData, with
// its numbers appended as raw bytes, each array after its length; and the index of all pieces, which holds no numbers.

#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh/mesh_pieces.h"
#include "io/mesh/packed_records.h"
#include "io/mesh/valid_mesh.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "files are written in the machine's own byte order");

constexpr const char* file_begin = "<?xml version=\"1.0\"?>\n<VTKFile type=\"";
constexpr const char* file_kind = "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n";

/// An array of a piece. `count` elements of `bytes` each, which `pack` stores.
struct VtpArray {
  std::string_view name, type;
  std::size_t components, count, bytes;
  std::function<void(std::size_t first, std::size_t last, char* to)> pack;
};

/// An array's type, name and width as attributes.
std::string described(std::string_view type, std::string_view name, std::size_t components) {
  return "type=\"" + std::string(type) + "\" Name=\"" + std::string(name) + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\"";
}

/// The lines of a piece's description, and its arrays in the order of their bytes.
class VtpPiece {
 public:
  explicit VtpPiece(const MeshTotals& size) {
    text_ = file_begin + std::string("PolyData") + file_kind + "<PolyData>\n<Piece NumberOfPoints=\"" +
            std::to_string(size.vertices) + "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\"" +
            " NumberOfPolys=\"" + std::to_string(size.triangles + size.quads) + "\">\n";
  }

  void open(const char* element) { text_ += std::string("<") + element + ">\n"; }
  void close(const char* element) { text_ += std::string("</") + element + ">\n"; }
  void add(const VtpArray& array) {
    text_ += "<DataArray " + described(array.type, array.name, array.components) + " format=\"appended\" offset=\"" +
             std::to_string(offset_) + "\"/>\n";
    offset_ += sizeof(std::uint64_t) + array.count * array.bytes;
    arrays_.push_back(array);
  }

  Status write(OutputFile& out) const {
    out.write(text_ + "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    for (const VtpArray& array : arrays_) {
      const std::uint64_t bytes = array.count * array.bytes;
      out.write({reinterpret_cast<const char*>(&bytes), sizeof bytes});
      if (Status status = write_packed(out, array.count, array.bytes, array.pack); !status.ok()) return status;
    }
    out.write("\n</AppendedData>\n</VTKFile>\n");
    return {};
  }

 private:
  std::string text_;
  std::uint64_t offset_ = 0;
  std::vector<VtpArray> arrays_;
};

/// Stores elements of `bytes` bytes from memory.
auto copied(const void* from, std::size_t bytes) {
  return [from, bytes](std::size_t first, std::size_t last, char* to) {
    std::memcpy(to, static_cast<const char*>(from) + first * bytes, (last - first) * bytes);
  };
}

template <class T>
void put(char*& to, T value) {
  std::memcpy(to, &value, sizeof value);
  to += sizeof value;
}

void add_point_data(VtpPiece& piece, const Mesh& mesh, const MeshTotals& totals) {
  piece.open(totals.normals ? "PointData Normals=\"Normals\"" : "PointData");
  if (totals.normals) piece.add({"Normals", "Float32", 3, mesh.vertex_count(), 12, copied(mesh.normals.data(), 12)});
  if (totals.parameters)
    piece.add({"TCoords", "Float32", 2, mesh.vertex_count(), 8, copied(mesh.parameters.data(), 8)});
  piece.close("PointData");
}

void add_cell_data(VtpPiece& piece, const Mesh& mesh, const MeshTotals& totals, std::uint32_t first_patch) {
  piece.open("CellData");
  const std::size_t triangles = mesh.triangle_count();
  if (totals.patches)
    piece.add({"patch", "UInt32", 1, triangles + mesh.quad_count(), 4,
               [&mesh, triangles, first_patch](std::size_t first, std::size_t last, char* to) {
                 for (; first < last; ++first)
                   put(to,
                       first_patch + (first < triangles ? mesh.patches[first] : mesh.quad_patches[first - triangles]));
               }});
  piece.close("CellData");
}

void add_points(VtpPiece& piece, const Mesh& mesh, const MeshTotals& totals) {
  piece.open("Points");
  if (totals.double_positions)
    piece.add({"Points", "Float64", 3, mesh.vertex_count(), 24, copied(mesh.model_positions.data(), 24)});
  else
    piece.add({"Points", "Float32", 3, mesh.vertex_count(), 12, [&mesh](std::size_t first, std::size_t last, char* to) {
                 for (const float* p = mesh.positions.data() + 3 * first; first < last; ++first, p += 3, to += 12)
                   put_floats(mesh.origin + Vec3{p[0], p[1], p[2]}, to);
               }});
  piece.close("Points");
}

void add_faces(VtpPiece& piece, const Mesh& mesh) {
  const std::size_t of_triangles = mesh.indices.size(), triangles = mesh.triangle_count();
  piece.open("Polys");
  piece.add({"connectivity", "Int32", 1, of_triangles + mesh.quads.size(), 4,
             [&mesh, of_triangles](std::size_t first, std::size_t last, char* to) {
               for (; first < last; ++first)
                 put(to, first < of_triangles ? mesh.indices[first] : mesh.quads[first - of_triangles]);
             }});
  piece.add({"offsets", "Int64", 1, triangles + mesh.quad_count(), 8,
             [triangles](std::size_t first, std::size_t last, char* to) {
               for (; first < last; ++first)
                 put(to, static_cast<std::int64_t>(3 * (first + 1) + (first < triangles ? 0 : first + 1 - triangles)));
             }});
  piece.close("Polys");
}

/// The index as text: what the pieces have, and their names beside the index.
std::string index_text(const MeshTotals& totals, const fs::path& index, std::size_t pieces) {
  const auto array = [](std::string_view type, std::string_view name, std::size_t components) {
    return "<PDataArray " + described(type, name, components) + "/>\n";
  };
  std::string text = file_begin + std::string("PPolyData") + file_kind + "<PPolyData GhostLevel=\"0\">\n";
  text += totals.normals ? "<PPointData Normals=\"Normals\">\n" + array("Float32", "Normals", 3) : "<PPointData>\n";
  if (totals.parameters) text += array("Float32", "TCoords", 2);
  text += "</PPointData>\n<PCellData>\n";
  if (totals.patches) text += array("UInt32", "patch", 1);
  text += "</PCellData>\n<PPoints>\n" + array(totals.double_positions ? "Float64" : "Float32", "Points", 3) +
          "</PPoints>\n";
  for (std::size_t k = 0; k < pieces; ++k) {
    std::string name;
    for (const char c : vtp_piece_path(index, k).filename().string())
      name += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    text += "<Piece Source=\"" + name + "\"/>\n";
  }
  return text + "</PPolyData>\n</VTKFile>\n";
}

}  // namespace

fs::path vtp_piece_path(const fs::path& index, std::size_t piece) {
  char number[32];
  std::snprintf(number, sizeof number, "_%04zu.vtp", piece);
  return index.parent_path() / (index.stem().string() + number);
}

Status write_vtp_piece(const Mesh& piece, const MeshTotals& totals, const fs::path& index, std::size_t number,
                       std::uint64_t first_patch) {
  return guarded([&]() -> Status {
    const fs::path path = vtp_piece_path(index, number);
    Status status = validate_piece(piece, totals);
    if (status.ok()) status = check_patches(piece, first_patch);
    if (!status.ok()) return {status.code(), path.string() + ": " + status.message(), status.index()};
    Result<OutputFile> out = OutputFile::make(path);
    if (!out) return out.status();
    VtpPiece file(MeshTotals::of(piece));
    add_point_data(file, piece, totals);
    add_cell_data(file, piece, totals, static_cast<std::uint32_t>(first_patch));
    add_points(file, piece, totals);
    add_faces(file, piece);
    status = file.write(*out);
    return status.ok() ? out->commit() : status;
  });
}

Status write_pvtp(const MeshTotals& totals, const fs::path& index, std::size_t pieces) {
  return guarded([&]() -> Status {
    if (pieces == 0) return {StatusCode::invalid_argument, index.string() + ": there are no pieces"};
    Result<OutputFile> out = OutputFile::make(index);
    if (!out) return out.status();
    out->write(index_text(totals, index, pieces));
    return out->commit();
  });
}

}}  // namespace tessera::abi_0_1
