#pragma once
// Writes sections to files. The extension, in any case of letters, decides the format.
//
// Memory: arguments are not kept. Threads: any number of calls at once, for different files.

#include <filesystem>
#include <string>

#include "tessera/geometry.h"
#include "tessera/sections.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Coordinates within planes of one normal: x along `right`, y along `up`; right x up is the normal.
struct PlaneFrame {
  Vec3 right;  ///< of length 1
  Vec3 up;     ///< of length 1
};
/// Returns the frame of planes with this normal, of length 1: (x, y) for z, (y, z) for x, (z, x) for y; for others,
/// `right` is the axis after the one that the normal follows most, turned into the plane. Errors: none.
PlaneFrame plane_frame(const Vec3& normal);

/// How sections are written.
struct SectionsFileOptions {
  /// The unit of all lengths, as Model::unit: "mm", "cm", "in", "inch". SVG states it, so that the drawing prints at
  /// its size. Others, or none: SVG has no unit.
  std::string unit = {};
};

/// Writes the polylines of sections. The file appears whole or not at all.
///
/// - .svg: one drawing with one group per plane that has polylines, in the coordinates of plane_frame(), with y upwards
///   as drawn. Groups are layers in Inkscape; data-offset states the plane. Closed polylines are filled by the rule
///   evenodd.
/// - .dxf: R12 as text, 3D polylines in the model's coordinates, one layer per plane: SECTION_0 and so on.
/// - .ply: binary, little endian, vertices in double in the model's coordinates, and edges that state their plane.
///
/// Errors: io_error, unsupported (the extension; for .ply, more than 2^31 - 1 points), invalid_argument (a polyline or
/// a plane beyond its list; index = the polyline or plane).
Status write_sections(const Sections& sections, const std::filesystem::path& path,
                      const SectionsFileOptions& options = {});
/// Checks that write_sections() writes the format of `path`'s extension. Errors: unsupported, with a list of those.
Status check_sections_format(const std::filesystem::path& path);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
