#pragma once
// Tables of numbers as text: a header line with the columns' names, then a row of numbers a line. Blank lines and what
// follows # are skipped.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/model.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"
#include "tessera/text_cursor.h"

namespace tessera::cli {

using ColumnNames = std::vector<std::string_view>;

/// Calls `row` for each row, with its numbers and its place in the file. The header must name `required`, or these and
/// then `optional`, in this order. Numbers may be inf or nan: that is for `row` to judge. Errors: io_error,
/// parse_error, and what `row` returns.
Status read_csv(const std::filesystem::path& path, const ColumnNames& required, const ColumnNames& optional,
                const std::function<Status(std::span<const double>, const TextCursor&)>& row);

/// Where a surface is to be evaluated.
struct SurfacePlace {
  std::uint32_t surface = 0;
  double u = 0, v = 0;
};
/// `surface,u,v`: surfaces of the model counted from 0, u and v in the domain of each.
Result<std::vector<SurfacePlace>> read_places(const std::filesystem::path& path, const Model& model);

/// `ox,oy,oz,dx,dy,dz[,tnear,tfar]`, each of them valid as tessera::Ray says; tfar may be inf.
Result<std::vector<Ray>> read_rays(const std::filesystem::path& path);

}  // namespace tessera::cli
