#pragma once
// Reads and writes files of surfaces and meshes. The extension, in any case of letters, decides the format. Messages of
// errors name the file and, for text, the line: "teapot.bpt:17: expected 3 numbers for a control point, found \"a b\"".
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once, for different files where
// they write; parts that run on threads do so in the caller's TBB arena.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/cad.h"
#include "tessera/mesh.h"
#include "tessera/mesh_assembly.h"
#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// How read_model() and parse_model() read.
struct ModelReadOptions {
  /// The extension that decides, with or without its dot, such as "step" or "bpt.gz". If empty: that of the name.
  std::string format = {};
  CadOptions cad = {};  ///< for files of read_cad(); CadOptions::format is left out
};

/// Reads the surfaces of a file.
///
/// - .bpt: Bezier patches; `#` begins a comment
/// - .bv: BezierView, tensor and rational patches
/// - .g2: GoTools, spline and elementary surfaces
/// - .json: surfaces of every kind; share/doc/tessera/FORMAT.md describes the format
/// - .obj: free-form surfaces
/// - .rib: RenderMan, Patch, PatchMesh, NuPatch and quadrics, and the archives that it reads
/// - .step, .stp, .p21, .stpz, .iges, .igs, .brep, .brp: as read_cad() of cad.h
///
/// Files of all formats may be gzip files, such as teapot.bpt.gz. A gzip .rib and gzip files of read_cad() need no
/// extension .gz. The unpacked size is limited to 200 times the file plus 1 MiB, and to 1 GiB.
///
/// Model::warnings reports each part of the file that is skipped. A file with a wrong element gives no model.
///
/// Errors: io_error, parse_error, unsupported (no reader for the extension; nothing in the file that it reads; a
/// packed file beyond the limits, or a build without zlib); for .json and .obj also those of the surfaces.
///
/// Memory, including the file's bytes (of a packed file the unpacked ones, and its own): at most 8 times the file plus
/// 64 KiB for numbers of a few digits, commonly 2 to 4 times. Counts that a file states never make it more. Files of
/// numbers with one digit and a blank take more:
///
/// - .json: 13 times the file
/// - .g2: 9 times
/// - .rib: 11 times for a mesh, 28 times for a Catmull-Rom mesh
/// - .obj: up to 20 times, because an index becomes a point. A point that several pieces of a bmatrix share counts once
///   per piece.
Result<Model> read_model(const std::filesystem::path& path, const ModelReadOptions& options = {});
/// Reads the bytes of a file of any format of read_model(). `name` stands for the file in messages, and its extension
/// states the format if the options leave it open. A .rib finds its archives beside `name`. Errors: as
/// read_model(), without io_error but for archives and read_cad(). Memory: as read_model().
Result<Model> parse_model(std::string_view bytes, const std::filesystem::path& name,
                          const ModelReadOptions& options = {});
/// Parses the text of a .bpt file; `name` stands for the file in messages. Errors: as read_model(), without io_error.
Result<Model> parse_bpt(std::string_view text, std::string_view name);
/// Parses the text of a .bv file: kinds 4, 5 and 8 (weights above 0). Triangles, polyhedra and PN patches are skipped.
/// Group lines name surfaces. Errors: as parse_bpt().
Result<Model> parse_bv(std::string_view text, std::string_view name);
/// Parses the text of a .g2 file: spline surfaces and planes, also trimmed ones, and bounded cylinders, spheres, cones
/// and tori. Plane splines lie in z = 0. Parameters are the file's, except a cone's v (counted from the apex) and a
/// torus' (rational arcs within [0,1]^2). A trimmed plane ends where its loops do. Errors: as parse_bpt().
Result<Model> parse_g2(std::string_view text, std::string_view name);
/// Parses the text of a .rib file, which must not be packed.
///
/// - A patch or mesh has RenderMan's parameters over [0,1]^2, a NuPatch those of its knots.
/// - A mesh is one B-spline surface if its bases are bezier, b-spline, catmull-rom or hermite with their usual steps.
///   Other bases give one surface per patch.
/// - Placements lead to world space as at WorldBegin; coordinates are unchanged (left-handed).
/// - Attribute "identifier" "name" names surfaces. TrimCurves are kept as trims.
/// - A moving surface is read at its first moment.
/// - Quadrics (Sphere, Cone, Cylinder, Hyperboloid, Paraboloid, Disk, Torus) are exact. u runs with the angle and v as
///   RenderMan's, so normals point to the same side; on rational arcs and on a paraboloid they keep another pace.
/// - ReadArchive reads files beside the file that names them, beside the first file, or below; `name` as a path finds
///   them. An absolute path, a part "..", a symbolic link out of the first file's folder, an archive that reads itself
///   and more than 32 levels are errors; a file that is missing is a warning.
/// - Copies by ObjectInstance are limited to 4 times the files plus 1 MiB, and archives that are read again to 64 times
///   the files plus 1 MiB.
///
/// Errors: as parse_bpt(); from archives also io_error.
Result<Model> parse_rib(std::string_view text, std::string_view name);
/// Parses the text of a .json file. Messages have a line, and the place as a JSON pointer (RFC 6901): "m.json:17:
/// /surfaces/3/points/2/1: expected 3 numbers [x, y, z], found an array of 2". Errors: as parse_bpt(), and those of the
/// surfaces. Threads: the expressions of its surfaces may be evaluated from any number of threads.
Result<Model> parse_json_model(std::string_view text, std::string_view name);
/// Parses the text of a free-form Wavefront OBJ file: bezier, bspline, cardinal, taylor and bmatrix, rational or not,
/// and the patches of release 2.11. Trims and holes are kept as ModelSurface::trims. Object and group name surfaces.
/// Errors: as parse_bpt(), and those of the surfaces.
Result<Model> parse_obj_freeform(std::string_view text, std::string_view name);

/// A summary of the file that write_model() has written.
struct WrittenModel {
  std::size_t surfaces = 0, patches = 0;   ///< how many the file holds
  FitError fit_error = {};                 ///< the largest of all; 0 where every surface is a patch or made of patches
  std::vector<std::string> warnings = {};  ///< one sentence for each part of the model that the file does not hold
};

/// Writes surfaces as their Bezier patches, in the model's space, and numbers in the shortest form that reads back as
/// the same. The file appears whole or not at all.
///
/// - .obj: free-form surfaces with weights, trims, and names as groups. The patches of a surface are one `surf` over
///   its own ranges of parameters, which keeps (u,v).
/// - .json: names, weights and trims. A surface is one `b_spline` or `nurbs` over its own ranges of parameters, and a
///   patch on [0,1]^2 is a `bezier`. Bytes of a name that are not UTF-8 become U+FFFD.
/// - .bpt: only polynomial patches; names and ranges are not kept.
///
/// Polynomial surfaces read back with the same control points. The parameters of a quadric become those of its patches,
/// and its trims are left out with a warning. So are the trims of a surface whose patches do not share their borders;
/// it becomes one surface of the file per patch.
///
/// Errors: io_error, unsupported (the extension; a rational surface for .bpt, index = the surface), invalid_argument
/// (no surfaces), those of to_bezier().
Result<WrittenModel> write_model(const Model& model, const std::filesystem::path& path, const FitOptions& fit = {});
/// Writes what write_model() writes to `bytes`, which it replaces. `name`: its extension states the format, and it
/// stands for the file in messages. Errors: as write_model(), but for io_error; `bytes` is then undefined.
Result<WrittenModel> write_model_bytes(const Model& model, const std::filesystem::path& name, std::string& bytes,
                                       const FitOptions& fit = {});

/// The axis of a model that points up: z in CAD, y in glTF and in many programs that draw.
enum class UpAxis : std::uint8_t { z, y };

/// How meshes are written.
struct MeshWriteOptions {
  /// .glb and .gltf, whose viewers show +Y upwards: the axis of the mesh that is to point there. With z, the node above
  /// all others turns the model; with y, nothing is turned.
  UpAxis up = UpAxis::z;
  /// .glb and .gltf: whether the numbers are packed by the extension EXT_meshopt_compression, which viewers must know.
  /// All numbers are kept to the bit, and the order of vertices and triangles; a triangle may begin at another of its
  /// corners. Other formats ignore it.
  bool packed = false;
};

/// Writes a mesh in the model's coordinates; only glTF turns them, by a node. The file appears whole or not at all: it
/// is written beside its place, then renamed.
///
/// - .obj: text, floats in shortest round-trip form, parts as groups. Quads are faces of four corners, after the
///   triangles of their part.
/// - .ply: binary, little endian. Quads are faces of four corners, after all triangles.
/// - .stl: binary, little endian, only the corners of triangles.
/// - .glb and .gltf: glTF 2.0, one file with all in it. One mesh for each of Mesh::parts; positions are unchanged, and
///   their node adds the origin and turns up what is up (MeshWriteOptions). Normals are made unit; parameters are
///   texture coordinates. Colours of parts become materials.
///
/// .obj, .ply and .stl add the origin in double. .stl rounds the sums to float. So do .obj and .ply where that moves
/// vertices by at most 2^-16 of the mesh's size, the largest |x|, |y| or |z| of its positions; they hold the sums as
/// doubles otherwise, as for a mesh far from zero. file_rounding() bounds what this adds to Tessellation::bound().
///
/// .stl and glTF have no faces of four corners and get two triangles per quad, see split_quads().
///
/// Errors: io_error, unsupported (the extension; a glTF file beyond 2 GiB; one to be packed, in a build without
/// meshoptimizer); for a mesh that no file can hold
/// invalid_argument (no vertices; for .stl, .glb and .gltf no triangles; an index or a part out of range),
/// count_mismatch, non_finite.
Status write_mesh(const Mesh& mesh, const std::filesystem::path& path, const MeshWriteOptions& options = {});

/// Returns the bytes of the file that write_mesh() writes. `name`: its extension states the format, and it stands for
/// the file in messages. Errors: as write_mesh(), but for io_error. Memory: the result, and at most as much again while
/// it grows.
Result<std::string> mesh_bytes(const Mesh& mesh, const std::filesystem::path& name,
                               const MeshWriteOptions& options = {});

/// Returns a bound of the distance between a vertex of the mesh (in double, if it has positions in double) and that of
/// the file that write_mesh() makes of it: the mesh of the file keeps Tessellation::bound() plus this. It is 0 for
/// glTF, whose positions are relative to the origin, if they are in float. 2^-24 of the largest coordinate comes from
/// rounding to float. Errors: none. Other extensions count as files of floats.
double file_rounding(const Mesh& mesh, const std::filesystem::path& path);
/// Returns file_rounding() of any mesh with this origin, whose positions relative to it have |x|, |y| and |z| of at
/// most `reach`. `has_doubles`: whether it has positions in double.
double file_rounding(const std::filesystem::path& path, const Vec3& origin, const Vec3& reach, bool has_doubles);

/// Writes the meshes of an assembly in a format of write_mesh(). The file appears whole or not at all.
///
/// - .glb and .gltf: each shape is stored once, and each instance is a node with its name and placement. Colours become
///   materials: a mesh has one primitive per colour of its parts. Positions are relative to each mesh's origin, which
///   the node adds. The node above all others turns up what is up. The unit of glTF is the metre: that node scales by
///   0.001 if the assembly's unit is
///   "mm"; "um", "cm", "m", "km", "in", "inch" and "ft" are known too, and no unit counts as metres. Instances that are
///   sheared have a mesh of their own, because nodes cannot shear.
/// - other formats: one mesh, as flatten() makes it, in the assembly's unit; colours are not kept.
///
/// Errors: those of write_mesh() (index = the shape); invalid_argument (an instance of no shape, a colour beyond 0 to
/// 1; index = the instance), non_finite (a placement that is not finite, or beyond the range of float), unsupported
/// (glTF in any other unit).
Status write_assembly(const MeshAssembly& assembly, const std::filesystem::path& path,
                      const MeshWriteOptions& options = {});
/// Returns the bytes of the file that write_assembly() writes. `name` and memory: as mesh_bytes(). Errors: as
/// write_assembly(), but for io_error.
Result<std::string> assembly_bytes(const MeshAssembly& assembly, const std::filesystem::path& name,
                                   const MeshWriteOptions& options = {});

/// How read_mesh() treats polygons, and where it reports what it skips.
struct MeshReadOptions {
  bool keep_quads = false;                       ///< polygons of four corners become Mesh::quads
  UpAxis up = UpAxis::z;                         ///< .glb and .gltf: the axis of the mesh that the file's +Y becomes
  std::vector<std::string>* warnings = nullptr;  ///< gets one sentence for each kind of thing that is skipped
};
/// Reads a mesh from a file, which may be packed by gzip as for read_model().
///
/// - .obj, .ply and .stl (binary or ascii). Polygons are split as fans. Corners of triangles in .stl become one vertex
///   where their bits are equal.
/// - .glb and .gltf: glTF 2.0, all triangles of the default scene, placed by its nodes; the first mesh's translation is
///   the origin. Normals and texture coordinates are kept if all triangles have them. Buffers may lie beside the file
///   or below, but not behind links out of its folder. EXT_meshopt_compression is read, sparse accessors are errors;
///   points, lines, skins, morph targets and animations are skipped with a warning.
///
/// Errors: io_error, parse_error, unsupported. Memory: for glTF at most 64 times the file and its buffers plus 16 MiB,
/// however often nodes place a mesh, and as much for packed numbers.
Result<Mesh> read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});

/// @name Parts of reading and writing
/// For programs that check their output before they compute its content.
/// @{

/// Returns the extension of `path` with letters from A to Z made small: ".obj", or nothing if there is none. Errors:
/// none; throws std::bad_alloc if memory runs out. Memory: the result.
std::string lower_extension(const std::filesystem::path& path);
/// Returns the micrometres in a unit of length: "um", "mm", "cm", "m", "km", "in", "inch" or "ft"; 0 for other words.
/// They are whole numbers, so the quotient of two units is rounded once. Errors: none.
double micrometres_in(std::string_view unit);
/// Checks that write_mesh() writes the format of `path`'s extension. Errors: unsupported, with a list of those.
Status check_mesh_format(const std::filesystem::path& path);
/// Checks that write_model() writes the format of `path`'s extension. Errors: unsupported, with a list of those.
Status check_model_format(const std::filesystem::path& path);
/// Reads the bytes of a file; of a pipe or a terminal up to its end, at most 1 GiB. Errors: io_error (missing, a
/// directory, no permission, a failed read), parse_error (no bytes), out_of_memory (a file larger than the machine's
/// memory). Messages begin with the path.
Result<std::string> read_file(const std::filesystem::path& path);

/// @}

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
