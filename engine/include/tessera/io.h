#pragma once
// Files: surfaces and meshes, in and out. The format follows from the name's extension, in any case of letters.
// Errors name the file and, for text, the line: "teapot.bpt:17: expected 3 numbers for a control point, found \"a b\"".

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/mesh.h"
#include "tessera/model.h"
#include "tessera/output_file.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// Reads surfaces: .bpt (Bezier patches; `#` begins a comment), .bv (BezierView: tensor and rational patches), .g2
/// (GoTools: spline and elementary surfaces), .json (surfaces of every kind; tools/models/FORMAT.md tells the format), .obj
/// (free-form surfaces), .rib (RenderMan: Patch, PatchMesh, NuPatch). What else a file holds is told in Model::warnings. A
/// file with an element that is wrong gives no model. Errors: io_error, parse_error, unsupported (no reader for it, or
/// nothing in the file that it reads); of .json and .obj also those of the surfaces.
/// Memory, the file's own bytes among it: at most 8 times the file (and 64 KiB) for numbers of a few digits, commonly 2
/// to 4 times. Where each has one digit and a blank, .json takes 13 times the file, .g2 9, a mesh of .rib 11, one of its
/// Catmull-Rom meshes 28. An index of .obj becomes a point: up to 20 times if it has one digit, and as often as pieces of a
/// bmatrix share it, which are a surface each. Whatever counts a file states, it gets no more.
Result<Model> read_model(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in messages.
Result<Model> parse_bpt(std::string_view text, std::string_view name);
/// Kinds 4, 5 and 8 (weights above 0); triangles, polyhedra and PN patches are passed over. Group lines name surfaces.
Result<Model> parse_bv(std::string_view text, std::string_view name);
/// Spline surfaces, planes, cylinders, spheres, cones and tori that are bounded, by the file's parameters, but for a
/// cone's v (counted from the apex) and a torus' (rational arcs within [0,1]^2). Plane surfaces lie in z = 0.
Result<Model> parse_g2(std::string_view text, std::string_view name);
/// Text, not compressed. A patch or mesh has RenderMan's parameters over [0,1]^2, a NuPatch its knots'. A mesh is one
/// B-spline surface, but for bases other than bezier, b-spline, catmull-rom and hermite with their usual steps: those
/// give a surface a patch. Placements lead to world space as at WorldBegin, coordinates unchanged (left-handed);
/// Attribute "identifier" "name" names surfaces; TrimCurves are kept as trims. Of a moving surface the first moment is
/// read. Copies by ObjectInstance may take 4 times the file and 1 MiB, not more.
Result<Model> parse_rib(std::string_view text, std::string_view name);
/// "m.json:17: /surfaces/3/points/2/1: expected 3 numbers [x, y, z], found an array of 2": a line, and the place as a JSON
/// pointer (RFC 6901). Expressions may be evaluated from any number of threads.
Result<Model> parse_json_model(std::string_view text, std::string_view name);
/// Free-form Wavefront OBJ: bezier, bspline, cardinal, taylor and bmatrix, rational or not, and the patches of release
/// 2.11; trims and holes are kept as ModelSurface::trims. Surfaces are named by object and group.
Result<Model> parse_obj_freeform(std::string_view text, std::string_view name);

/// What write_model has written.
struct WrittenModel {
  std::size_t surfaces = 0, patches = 0;   ///< written
  FitError fit_error = {};                 ///< the largest of all; 0 where every surface is a patch or made of such
  std::vector<std::string> warnings = {};  ///< what of the model the file does not hold, a sentence each
};

/// Writes surfaces as their Bezier patches, in the model's space, numbers in the shortest form that reads back as the
/// same: .obj (free-form: weights, names as groups, trims; a surface's patches are one `surf` over its own ranges of
/// parameters, so that (u,v) stay) or .bpt (polynomial patches alone; names and ranges are not kept). A quadric's
/// parameters become those of its patches, and its trims are left out with a warning; so are those of a surface whose
/// patches do not share their borders, which becomes a `surf` a patch. Polynomial surfaces read back with the same control
/// points. The file appears whole or not at all. Errors: io_error, unsupported (the extension; a rational surface for
/// .bpt, index = the surface), invalid_argument (no surfaces), those of to_bezier.
Result<WrittenModel> write_model(const Model& model, const std::filesystem::path& path, const FitOptions& fit = {});
/// The patches of a set, each over its rectangle of its surface's parameters; in .obj the group "surface 3" says of which.
/// Errors: io_error, unsupported (index = the patch).
Status write_model(const PatchSet& set, const std::filesystem::path& path);

/// Writes the mesh in the model's coordinates, which are not turned: viewers take y or z as up. The file appears whole or
/// not at all: it is written beside its place, then renamed.
/// .obj (text, floats in shortest round-trip form; parts as groups), .ply and .stl (binary, little endian; .stl holds the
/// triangles' corners alone): the origin is added in double, what does not fit float exactly is rounded. .glb and .gltf
/// (glTF 2.0, one file with all in it): a mesh for each of Mesh::parts, positions as they are, and the origin as the
/// translation of their node; normals are made unit, parameters are texture coordinates. Quads are faces of four corners
/// in .obj, after a part's triangles, and in .ply, after all triangles; .stl and glTF have no such faces and get two
/// triangles a quad, see split_quads().
/// Errors: io_error, unsupported (the extension; a glTF file beyond 2 GiB), and of a mesh that no file can hold:
/// invalid_argument (no vertices; for .stl, .glb and .gltf no triangles; an index or a part out of range), count_mismatch,
/// non_finite.
Status write_mesh(const Mesh& mesh, const std::filesystem::path& path);

/// What read_mesh makes of polygons.
struct MeshReadOptions {
  bool keep_quads = false;  ///< those of four corners become Mesh::quads
};
/// Reads .obj, .ply and .stl (binary or ascii), polygons split as fans; the corners of .stl's triangles become one vertex
/// where their bits are equal. Errors: io_error, parse_error, unsupported.
Result<Mesh> read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

// For programs that open their output before the work is done whose result it shall hold.

/// The extension of `path`, in small letters: ".obj".
std::string lower_extension(const std::filesystem::path& path);
/// Checks that write_mesh() writes the format of `path`'s extension. Errors: unsupported, with a list of those.
Status check_mesh_format(const std::filesystem::path& path);
/// Checks that write_model() writes the format of `path`'s extension. Errors: unsupported, with a list of those.
Status check_model_format(const std::filesystem::path& path);
/// Writes the mesh to a file that was created for `path`, and leaves commit() to the caller, which reports failed writes.
/// Errors: unsupported, and those of a mesh that no file can hold.
Status write_mesh(const Mesh& mesh, const std::filesystem::path& path, OutputFile& out);
/// Writes the model to a file that was created for `path`, and leaves commit() to the caller, which reports failed
/// writes. Errors: as write_model(), but for io_error.
Result<WrittenModel> write_model(const Model& model, const std::filesystem::path& path, const FitOptions& fit,
                                 OutputFile& out);
/// Reads the bytes of a file; of a pipe or a terminal up to its end, at most 1 GiB. Errors: io_error (missing, a
/// directory, no permission, a failed read), parse_error (no bytes). Messages begin with the path.
Result<std::string> read_file(const std::filesystem::path& path);

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
