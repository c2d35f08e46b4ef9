#pragma once
// Files: surfaces in, meshes in and out. The format follows from the name's extension, in any case of letters.
// Errors name the file and, for text, the line: "teapot.bpt:17: expected 3 numbers for a control point, found \"a b\"".

#include <filesystem>
#include <string_view>

#include "tessera/mesh.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera {

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

/// Writes .obj (text, floats in shortest round-trip form) or .ply (binary, little endian), in the model's coordinates
/// (the origin is added in double; what does not fit float exactly is rounded). The file appears whole or not at all:
/// it is written beside its place, then renamed. Errors: io_error, unsupported.
Status write_mesh(const Mesh& mesh, const std::filesystem::path& path);
/// Reads the meshes that write_mesh writes, polygons split as fans. Errors: io_error, parse_error, unsupported.
Result<Mesh> read_mesh(const std::filesystem::path& path);

}  // namespace tessera
