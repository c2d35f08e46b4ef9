#pragma once
// Meshes as text and as binary files, one source file a format. Called by read_mesh and write_mesh, which validate.

#include <string_view>

#include "io/output_file.h"
#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera {

/// Wavefront OBJ. Writes v, vt, vn and f; patches of triangles are not kept.
void write_obj(const Mesh& mesh, OutputFile& out);
/// Polygons as fans, negative indices; groups, objects, smoothing and materials are ignored. Normals and parameters are
/// kept where they are one a vertex, as write_obj writes them, and left out otherwise.
Result<Mesh> parse_obj(std::string_view text, std::string_view name);

/// PLY, binary little endian: x y z nx ny nz u v; vertex_indices, patch.
void write_ply(const Mesh& mesh, OutputFile& out);
/// Binary little endian or ascii, properties of any number type in any order, unknown ones skipped, polygons as fans.
Result<Mesh> parse_ply(std::string_view bytes, std::string_view name);

/// A coordinate of the model's space, as files hold it: the origin is added in double, the sum rounded to float.
inline float file_coordinate(double origin, float relative) {
  return static_cast<float>(origin + static_cast<double>(relative));
}

}  // namespace tessera
