#pragma once
// Files: surfaces in, meshes in and out. The format follows from the name's extension, in any case of letters.
// Errors name the file and, for text, the line: "teapot.bpt:17: expected 3 numbers for a control point, found \"a b\"".

#include <filesystem>
#include <string_view>

#include "tessera/mesh.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera {

/// Reads surfaces: .bpt (Bezier patches; `#` begins a comment), .json (surfaces of every kind; tools/models/FORMAT.md
/// tells the format), .obj (free-form surfaces; polygons are counted in a warning, and a file without surfaces is
/// unsupported). A file with an element that is wrong gives no model. Errors: io_error, parse_error, unsupported (no
/// reader for it); of .json and .obj also those of the surfaces.
/// Memory stays proportional to the file, whatever counts it states.
Result<Model> read_model(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in messages.
Result<Model> parse_bpt(std::string_view text, std::string_view name);
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
