#include "tessera/sections_file.h"

#include <cmath>
#include <limits>
#include <string>

#include "io/format/output_formats.h"
#include "io/section/section_formats.h"
#include "tessera/guard.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

constexpr const char* section_formats[] = {".dxf", ".ply", ".svg"};

Status check_ranges(const Sections& sections) {
  const auto fits = [](std::size_t first, std::size_t count, std::size_t size) {
    return first <= size && count <= size - first;
  };
  for (std::size_t k = 0; k < sections.polylines.size(); ++k)
    if (const SectionPolyline& of = sections.polylines[k]; !fits(of.first, of.count, sections.points.size()))
      return Status(StatusCode::invalid_argument, "polyline " + std::to_string(k) + " has points beyond the list",
                    static_cast<std::ptrdiff_t>(k));
  for (std::size_t k = 0; k < sections.planes.size(); ++k)
    if (const PlaneSection& of = sections.planes[k];
        !fits(of.first_polyline, of.polyline_count, sections.polylines.size()))
      return Status(StatusCode::invalid_argument, "plane " + std::to_string(k) + " has polylines beyond the list",
                    static_cast<std::ptrdiff_t>(k));
  return {};
}

}  // namespace

PlaneFrame plane_frame(const Vec3& normal) {
  const double x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
  const Vec3 axis = z >= x && z >= y ? Vec3{1, 0, 0} : x >= y ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 right = normalized(axis - dot(axis, normal) * normal);
  return {right, cross(normal, right)};
}

Status check_sections_format(const fs::path& path) {
  return guarded([&]() -> Status {
    const std::string extension = lower_extension(path);
    std::string all;
    for (const char* const format : section_formats) {
      if (extension == format) return {};
      all += (all.empty() ? "" : ", ") + std::string(format);
    }
    return Status(StatusCode::unsupported,
                  path.string() + ": unsupported format \"" + extension + "\": sections are written as " + all);
  });
}

Status write_sections(const Sections& sections, const fs::path& path, OutputFile& out,
                      const SectionsFileOptions& options) {
  return guarded([&]() -> Status {
    if (Status status = check_sections_format(path); !status.ok()) return status;
    if (Status status = check_ranges(sections); !status.ok()) return status;
    const std::string extension = lower_extension(path);
    if (extension == ".ply" && sections.points.size() > std::numeric_limits<std::int32_t>::max())
      return Status(StatusCode::unsupported, path.string() + ": .ply holds at most 2147483647 points, found " +
                                                 std::to_string(sections.points.size()));
    if (extension == ".svg") write_svg(sections, out, options);
    if (extension == ".dxf") write_dxf(sections, out);
    if (extension == ".ply") write_section_ply(sections, out);
    return {};
  });
}

Status write_sections(const Sections& sections, const fs::path& path, const SectionsFileOptions& options) {
  return guarded([&]() -> Status {
    if (Status status = check_sections_format(path); !status.ok()) return status;
    Result<OutputFile> out = OutputFile::make(path);
    if (!out) return out.status();
    const Status status = write_sections(sections, path, *out, options);
    return status.ok() ? out->commit() : status;
  });
}

}}  // namespace tessera::abi_0_1
