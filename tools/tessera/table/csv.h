#pragma once
// Tables of numbers as text: a header with the columns' names, then one row of numbers per line of text. Skips blank
// lines and comments, which begin with #.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/output_file.h"
#include "io/file/text_cursor.h"
#include "tessera/model.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"

namespace tessera::cli {

using ColumnNames = std::vector<std::string_view>;

/// Calls `row` for each row, with its numbers and its place in the file. The header must name `required`, or these and
/// then `optional`, in this order. Numbers may be inf or nan: `row` decides. Errors: io_error, parse_error, and what
/// `row` returns.
Status read_csv(const std::filesystem::path& path, const ColumnNames& required, const ColumnNames& optional,
                const std::function<Status(std::span<const double>, const TextCursor&)>& row);

/// Writes a text as a field: in quotes if it needs them, each of its own quotes twice (RFC 4180).
void write_field(OutputFile& out, std::string_view text);

/// A place where a surface is evaluated.
struct SurfacePlace {
  std::uint32_t surface = 0;
  double u = 0, v = 0;
};
/// Reads `surface,u,v`: surfaces of the model counted from 0, u and v in the domain of each.
Result<std::vector<SurfacePlace>> read_places(const std::filesystem::path& path, const Model& model);

/// Reads `x,y,z`: finite points in the model's coordinates.
Result<std::vector<Vec3>> read_points(const std::filesystem::path& path);

/// Reads `ox,oy,oz,dx,dy,dz[,tnear,tfar]`, valid as tessera::Ray requires; tfar may be inf.
Result<std::vector<Ray>> read_rays(const std::filesystem::path& path);

}  // namespace tessera::cli
