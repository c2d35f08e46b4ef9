#pragma once
// Meshes as text and as binary files, one source file a format. Called by read_mesh and write_mesh, which validate.
// Writers report what their format cannot hold; whether a write has failed is known to the file. Those of STL and glTF copy
// a mesh that has quads, to split them.

#include <string_view>

#include "tessera/io.h"
#include "tessera/mesh.h"
#include "tessera/output_file.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// Wavefront OBJ. Writes v, vt, vn, f, and g for parts; patches of faces are not kept. Positions in double, where there are
/// any, are written so that they read back as the same doubles.
Status write_obj(const Mesh& mesh, OutputFile& out);
/// Polygons as fans, negative indices; groups, objects, smoothing and materials are ignored. Normals and parameters are
/// kept where they are one a vertex, as write_obj writes them, and left out otherwise.
Result<Mesh> parse_obj(std::string_view text, std::string_view name, const MeshReadOptions& options = {});

/// PLY, binary little endian: x y z nx ny nz u v; vertex_indices, patch. Quads come after all triangles. Positions in double,
/// where there are any, are properties of type double.
Status write_ply(const Mesh& mesh, OutputFile& out);
/// Binary little endian or ascii, properties of any number type in any order, unknown ones skipped, polygons as fans.
Result<Mesh> parse_ply(std::string_view bytes, std::string_view name, const MeshReadOptions& options = {});

/// STL, binary: the triangles alone, with their own normals. Errors: invalid_argument (no triangles; 2^32 or more).
Status write_stl(const Mesh& mesh, OutputFile& out);
/// Binary or ascii. Corners at one place (the same bits, -0 taken as 0) become one vertex; normals, names of solids and
/// the two bytes of attributes are left aside.
Result<Mesh> parse_stl(std::string_view bytes, std::string_view name, const MeshReadOptions& options = {});

/// glTF 2.0, whole in one file: as .glb, or as JSON with its numbers in base64. A mesh a part, in the order of parts,
/// positions relative to the origin, which is the translation of the node that holds them all. Normals are of unit
/// length, as the format wants: undefined ones become the mean of the triangles around. Parameters are TEXCOORD_0.
/// Errors: invalid_argument (no triangles), unsupported (more than 2 GiB). Memory: three times the file.
Status write_glb(const Mesh& mesh, OutputFile& out);
Status write_gltf(const Mesh& mesh, OutputFile& out);

/// A coordinate of the model's space, as files hold it: the origin is added in double, the sum rounded to float.
inline float file_coordinate(double origin, float relative) {
  return static_cast<float>(origin + static_cast<double>(relative));
}

}  // namespace tessera::inline abi_0_1
