#pragma once
// Meshes as text and as binary files, one source file per format. Called by read_mesh and write_mesh, which validate.
// Writers report what their format cannot hold; the file itself knows whether a write has failed. The writers of STL
// and glTF copy a mesh that has quads, to split them.

#include <string_view>

#include "io/file/output_file.h"
#include "tessera/io.h"
#include "tessera/mesh.h"
#include "tessera/mesh_assembly.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Writes Wavefront OBJ: v, vt, vn, f, and g for parts. Patches of faces are not kept. If the mesh has positions in
/// double, or needs_double_sums(), doubles are written so that they read back as the same.
Status write_obj(const Mesh& mesh, OutputFile& out, const MeshWriteOptions& options = {});
/// Reads polygons as fans, and negative indices; ignores groups, objects, smoothing and materials. Keeps normals and
/// parameters if there is one per vertex, as write_obj writes them; drops them otherwise.
Result<Mesh> parse_obj(std::string_view text, std::string_view name, const MeshReadOptions& options = {});

/// Writes PLY, binary little endian: x y z nx ny nz u v; vertex_indices, patch. Quads come after all triangles. If the
/// mesh has positions in double, or needs_double_sums(), they are properties of type double.
Status write_ply(const Mesh& mesh, OutputFile& out, const MeshWriteOptions& options = {});
/// Reads binary little endian or ascii, with properties of any number type in any order; skips unknown ones and reads
/// polygons as fans.
Result<Mesh> parse_ply(std::string_view bytes, std::string_view name, const MeshReadOptions& options = {});

/// Writes STL, binary: the triangles only, with their own normals. Errors: invalid_argument (no triangles; 2^32 or
/// more).
Status write_stl(const Mesh& mesh, OutputFile& out, const MeshWriteOptions& options = {});
/// Reads binary or ascii. Corners at one place (same bits, -0 taken as 0) become one vertex. Ignores normals, names of
/// solids and the two attribute bytes.
Result<Mesh> parse_stl(std::string_view bytes, std::string_view name, const MeshReadOptions& options = {});

/// Writes glTF 2.0 in one file: as .glb, or as JSON with its numbers in base64. One mesh per part, in the order of
/// parts. Positions are relative to the origin, which the node that holds them all adds, and turns so that
/// MeshWriteOptions::up points up. Normals have
/// unit length, as the format requires: undefined ones become the mean of the triangles around. Parameters are
/// TEXCOORD_0. Errors: invalid_argument (no triangles), unsupported (more than 2 GiB; to be packed, in a build without
/// meshoptimizer). Memory: the JSON, and the packed numbers where they are packed.
Status write_glb(const Mesh& mesh, OutputFile& out, const MeshWriteOptions& options = {});
Status write_gltf(const Mesh& mesh, OutputFile& out, const MeshWriteOptions& options = {});
/// Writes an assembly as glTF 2.0: each shape's numbers once, and one node per instance below a node that turns it up
/// and scales it to metres. Errors: as above.
Status write_glb_assembly(const MeshAssembly& assembly, OutputFile& out, const MeshWriteOptions& options = {});
Status write_gltf_assembly(const MeshAssembly& assembly, OutputFile& out, const MeshWriteOptions& options = {});
/// Reads glTF 2.0 in either form: the meshes of the default scene, each placed by its nodes, with triangles, strips and
/// fans. One part per placed mesh. The first mesh's translation is the origin. Keeps normals and TEXCOORD_0 if every
/// primitive has them. Buffers lie in the file, or in files beside it or below, which `name` as a path finds. Memory:
/// the buffers, three times data within JSON, and at most 64 times the file and its buffers plus 16 MiB for the mesh.
Result<Mesh> parse_gltf(std::string_view bytes, std::string_view name, const MeshReadOptions& options = {});

/// Returns the turn from a model with this axis up to glTF, whose +Y is up, and back.
inline Affine up_from(UpAxis up) {
  return up == UpAxis::y ? Affine{} : Affine{.columns = {Vec3{1, 0, 0}, Vec3{0, 0, -1}, Vec3{0, 1, 0}}};
}
inline Affine model_from(UpAxis up) {
  return up == UpAxis::y ? Affine{} : Affine{.columns = {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}}};
}

/// A coordinate in the model's space, as files hold it: adds the origin in double and rounds the sum to float.
inline float file_coordinate(double origin, float relative) {
  return static_cast<float>(origin + static_cast<double>(relative));
}

}}  // namespace tessera::abi_0_1
