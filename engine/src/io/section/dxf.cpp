// DXF of release 12 (Autodesk, DXF Reference, AC1009): pairs of lines, a code and a value. Polylines have the flag 8
// (3D), and 1 if they are closed; their vertices have the flag 32.

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "io/section/section_formats.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

class DxfWriter {
 public:
  explicit DxfWriter(OutputFile& out) : out_(out) {}

  void pair(int code, std::string_view value) {
    out_.write_number(code);
    out_.write('\n');
    out_.write(value);
    out_.write('\n');
  }
  void number(int code, double value) {
    out_.write_number(code);
    out_.write('\n');
    out_.write_number(value + 0.0);
    out_.write('\n');
  }
  void point(int code, const Vec3& p) {
    number(code, p.x);
    number(code + 10, p.y);
    number(code + 20, p.z);
  }

 private:
  OutputFile& out_;
};

std::string layer_name(std::size_t plane) { return "SECTION_" + std::to_string(plane); }

/// A table of layers, each white and with continuous lines.
void write_layers(const Sections& sections, DxfWriter& dxf) {
  dxf.pair(0, "SECTION");
  dxf.pair(2, "TABLES");
  dxf.pair(0, "TABLE");
  dxf.pair(2, "LAYER");
  dxf.pair(70, std::to_string(sections.planes.size()));
  for (std::size_t k = 0; k < sections.planes.size(); ++k) {
    dxf.pair(0, "LAYER");
    dxf.pair(2, layer_name(k));
    dxf.pair(70, "0");
    dxf.pair(62, "7");
    dxf.pair(6, "CONTINUOUS");
  }
  dxf.pair(0, "ENDTAB");
  dxf.pair(0, "ENDSEC");
}

void write_polyline(std::span<const SectionPoint> points, bool closed, const std::string& layer, DxfWriter& dxf) {
  dxf.pair(0, "POLYLINE");
  dxf.pair(8, layer);
  dxf.pair(66, "1");
  dxf.point(10, {});
  dxf.pair(70, closed ? "9" : "8");
  for (const SectionPoint& point : points) {
    dxf.pair(0, "VERTEX");
    dxf.pair(8, layer);
    dxf.point(10, point.position);
    dxf.pair(70, "32");
  }
  dxf.pair(0, "SEQEND");
  dxf.pair(8, layer);
}

}  // namespace

void write_dxf(const Sections& sections, OutputFile& out) {
  DxfWriter dxf(out);
  Box3 box;
  for (const SectionPoint& point : sections.points) box.extend(point.position);
  if (box.empty()) box.extend(Vec3{});
  dxf.pair(0, "SECTION");
  dxf.pair(2, "HEADER");
  dxf.pair(9, "$ACADVER");
  dxf.pair(1, "AC1009");
  dxf.pair(9, "$EXTMIN");
  dxf.point(10, box.lower);
  dxf.pair(9, "$EXTMAX");
  dxf.point(10, box.upper);
  dxf.pair(0, "ENDSEC");
  write_layers(sections, dxf);
  dxf.pair(0, "SECTION");
  dxf.pair(2, "ENTITIES");
  for (std::size_t k = 0; k < sections.planes.size() && !out.failed(); ++k) {
    const PlaneSection& plane = sections.planes[k];
    for (std::size_t line = plane.first_polyline; line < plane.first_polyline + plane.polyline_count; ++line) {
      const SectionPolyline& polyline = sections.polylines[line];
      write_polyline(std::span(sections.points).subspan(polyline.first, polyline.count), polyline.closed, layer_name(k),
                     dxf);
    }
  }
  dxf.pair(0, "ENDSEC");
  dxf.pair(0, "EOF");
}

}}  // namespace tessera::abi_0_1
