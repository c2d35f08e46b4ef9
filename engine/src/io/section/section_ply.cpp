// PLY of vertices and edges, binary little endian. Edges are as in MeshLab and Blender: vertex1, vertex2.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "io/section/section_formats.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written in the machine's own byte order");

template <class T, std::size_t count>
void write_record(OutputFile& out, const std::array<T, count>& values) {
  std::array<char, sizeof values> bytes;
  std::memcpy(bytes.data(), values.data(), sizeof values);
  out.write(std::string_view(bytes.data(), bytes.size()));
}

}  // namespace

void write_section_ply(const Sections& sections, OutputFile& out) {
  std::size_t edges = 0;
  for (const SectionPolyline& polyline : sections.polylines)
    edges += polyline.count == 0 ? 0 : polyline.count - (polyline.closed ? 0 : 1);
  out.write("ply\nformat binary_little_endian 1.0\ncomment Tessera\nelement vertex " +
            std::to_string(sections.points.size()) +
            "\nproperty double x\nproperty double y\nproperty double z\nelement edge " + std::to_string(edges) +
            "\nproperty int vertex1\nproperty int vertex2\nproperty int plane\nend_header\n");
  for (const SectionPoint& point : sections.points)
    write_record(out, std::array{point.position.x, point.position.y, point.position.z});
  for (std::size_t k = 0; k < sections.planes.size(); ++k) {
    const PlaneSection& plane = sections.planes[k];
    for (std::size_t line = plane.first_polyline; line < plane.first_polyline + plane.polyline_count; ++line) {
      const SectionPolyline& polyline = sections.polylines[line];
      const auto write_edge = [&](std::size_t from, std::size_t to) {
        write_record(out, std::array{static_cast<std::int32_t>(polyline.first + from),
                                     static_cast<std::int32_t>(polyline.first + to), static_cast<std::int32_t>(k)});
      };
      for (std::size_t point = 0; point + 1 < polyline.count; ++point) write_edge(point, point + 1);
      if (polyline.closed && polyline.count > 0) write_edge(polyline.count - 1, 0);
    }
  }
}

}}  // namespace tessera::abi_0_1
