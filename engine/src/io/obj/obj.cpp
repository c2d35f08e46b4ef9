// Polygons of Wavefront OBJ ("Object Files (.obj)", Appendix B1 of the Advanced Visualizer manual).

#include <array>
#include <string>

#include "io/file/output_file.h"
#include "io/file/text_cursor.h"
#include "io/mesh/file_rounding.h"
#include "io/mesh/mesh_formats.h"
#include "io/mesh/polygon.h"
#include "io/obj/obj_index.h"
#include "io/obj/obj_name.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

template <class T>
void write_record(OutputFile& out, std::string_view keyword, std::span<const T> values) {
  out.write(keyword);
  for (const T value : values) {
    out.write(' ');
    out.write_number(value);
  }
  out.write('\n');
}

/// Writes "a", "a/a", "a//a" or "a/a/a", one-based.
void write_corner(OutputFile& out, std::uint64_t index, bool parameters, bool normals) {
  out.write(' ');
  out.write_number(index + 1);
  if (parameters || normals) out.write('/');
  if (parameters) out.write_number(index + 1);
  if (normals) {
    out.write('/');
    out.write_number(index + 1);
  }
}

/// Stands for "no such index" in a corner.

/// Position, parameter and normal of one corner of a polygon, zero-based.
using Corner = std::array<std::uint32_t, 3>;

/// Writes a face with these corners.
void write_face(OutputFile& out, std::span<const std::uint32_t> corners, bool parameters, bool normals) {
  out.write('f');
  for (const std::uint32_t corner : corners) write_corner(out, corner, parameters, normals);
  out.write('\n');
}

/// Writes a vertex in the model's coordinates.
void write_position(OutputFile& out, const Mesh& mesh, std::size_t k, bool has_double_sums) {
  if (!mesh.model_positions.empty()) {
    write_record<double>(out, "v", std::span(mesh.model_positions).subspan(3 * k, 3));
    return;
  }
  const float* const p = mesh.positions.data() + 3 * k;
  const Vec3 sum = mesh.origin + Vec3{p[0], p[1], p[2]};
  if (has_double_sums) {
    write_record<double>(out, "v", std::array{sum.x, sum.y, sum.z});
  } else {
    write_record<float>(out, "v",
                        std::array{static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)});
  }
}

class ObjReader {
 public:
  ObjReader(std::string_view text, std::string_view name, const MeshReadOptions& options)
      : cursor_(text, name, {.separators = "/", .continuation = '\\'}), options_(options) {}

  Result<Mesh> read() {
    for (cursor_.skip_space(); !cursor_.at_end(); cursor_.skip_space()) {
      const Status status = read_line();
      if (!status.ok()) return status;
      if (!cursor_.take_line_end()) return cursor_.expected("the end of the line");
    }
    if (mesh_.positions.empty()) return cursor_.expected("vertices (v x y z)");
    if (mesh_.vertex_count() >= no_id)
      return cursor_.failure("there are more vertices than 32-bit indices can tell apart");
    if (!one_normal_a_vertex_ || mesh_.normals.size() != mesh_.positions.size()) mesh_.normals.clear();
    if (!one_parameter_a_vertex_ || mesh_.parameters.size() / 2 != mesh_.vertex_count()) mesh_.parameters.clear();
    return std::move(mesh_);
  }

 private:
  Status read_line() {
    const std::string_view keyword = cursor_.peek_token();
    if (keyword == "v") return read_values(keyword, 3, 6, mesh_.positions);  // a weight or a colour may follow
    if (keyword == "vt") return read_values(keyword, 2, 3, mesh_.parameters);
    if (keyword == "vn") return read_values(keyword, 3, 3, mesh_.normals);
    if (keyword == "f") return read_face();
    for (const std::string_view ignored : {"g", "o", "s", "usemtl", "mtllib", "p", "l"}) {
      if (keyword == ignored) {
        cursor_.skip_line();
        return {};
      }
    }
    return cursor_.expected("a line of a mesh (v, vt, vn, f, g, o, s, usemtl, mtllib)");
  }

  /// Reads `kept` to `most` numbers and appends the first `kept`.
  Status read_values(std::string_view keyword, int kept, int most, std::vector<float>& values) {
    cursor_.skip(keyword);
    for (int k = 0; k < most; ++k) {
      cursor_.skip_blanks();
      if (k >= kept && cursor_.at_line_end()) break;
      double value = 0;
      if (!cursor_.take_number(value)) {
        return cursor_.expected(std::to_string(kept) + " numbers after " + std::string(keyword));
      }
      if (k < kept) values.push_back(static_cast<float>(value));
    }
    return {};
  }

  Status read_face() {
    cursor_.skip("f");
    Corner first{}, last{}, corner{};
    int corners = 0;
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) {
      Status status = read_corner(corner);
      if (!status.ok()) return status;
      if (corners == 0) first = corner;
      if (corners >= 2) {
        for (const Corner& c : {first, last, corner}) mesh_.indices.push_back(c[0]);
      }
      last = corner;
      ++corners;
    }
    if (corners < 3) return cursor_.expected("at least 3 corners after f");
    if (corners == 4 && options_.keep_quads) join_last_quad(mesh_);
    return {};
  }

  Status read_corner(Corner& corner) {
    const std::array<std::size_t, 3> counts{mesh_.positions.size() / 3, mesh_.parameters.size() / 2,
                                            mesh_.normals.size() / 3};
    constexpr std::array<std::string_view, 3> kinds{"vertices", "vt lines", "vn lines"};
    corner = {no_id, no_id, no_id};
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0 && !cursor_.take('/')) break;
      if (k == 1 && !cursor_.at_end() && *cursor_.position() == '/') continue;  // the form a//c
      Status status = read_obj_index(cursor_, "an index of a corner", kinds[k], counts[k], corner[k]);
      if (!status.ok()) return status;
    }
    one_parameter_a_vertex_ &= corner[1] == corner[0];
    one_normal_a_vertex_ &= corner[2] == corner[0];
    return {};
  }

  TextCursor cursor_;
  MeshReadOptions options_;
  Mesh mesh_;
  bool one_parameter_a_vertex_ = true, one_normal_a_vertex_ = true;
};

}  // namespace

Status write_obj(const Mesh& mesh, OutputFile& out, const MeshWriteOptions&) {
  const bool normals = !mesh.normals.empty(), parameters = !mesh.parameters.empty();
  const bool has_double_sums = needs_double_sums(PositionRange::of(mesh));
  const std::string quads = mesh.quads.empty() ? "" : ", " + std::to_string(mesh.quad_count()) + " quads";
  out.write("# Tessera: " + std::to_string(mesh.vertex_count()) + " vertices, " +
            std::to_string(mesh.triangle_count()) + " triangles" + quads + "\n");
  for (std::size_t k = 0; k < mesh.vertex_count() && !out.failed(); ++k) {
    write_position(out, mesh, k, has_double_sums);
    if (parameters) write_record<float>(out, "vt", std::span(mesh.parameters).subspan(2 * k, 2));
    if (normals) write_record<float>(out, "vn", std::span(mesh.normals).subspan(3 * k, 3));
  }
  const auto write_part = [&](const MeshPart& part) {
    for (std::size_t k = 0; k < part.triangle_count && !out.failed(); ++k)
      write_face(out, std::span(mesh.indices).subspan(3 * (part.first_triangle + k), 3), parameters, normals);
    for (std::size_t k = 0; k < part.quad_count && !out.failed(); ++k)
      write_face(out, std::span(mesh.quads).subspan(4 * (part.first_quad + k), 4), parameters, normals);
  };
  if (mesh.parts.empty()) write_part({{}, 0, mesh.triangle_count(), 0, mesh.quad_count()});
  for (const MeshPart& part : mesh.parts) {
    if (part.triangle_count + part.quad_count > 0) out.write("g " + obj_name(part.name) + "\n");
    write_part(part);
  }
  return {};
}

Result<Mesh> parse_obj(std::string_view text, std::string_view name, const MeshReadOptions& options) {
  return ObjReader(text, name, options).read();
}

}}  // namespace tessera::abi_0_1
