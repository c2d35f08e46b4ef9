// SVG 1.1 (W3C): a path for each plane, in the plane's own coordinates. The axis y of SVG points down, so y is negated.

#include <algorithm>
#include <limits>
#include <span>
#include <string>

#include "io/section/section_formats.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct PlanePoint {
  double x, y;
};

PlanePoint drawn(const PlaneFrame& frame, const Vec3& p) { return {dot(frame.right, p), -dot(frame.up, p)}; }

/// The name of a unit in SVG; empty if it has none.
std::string svg_unit(const std::string& unit) {
  if (unit == "mm" || unit == "cm" || unit == "in") return unit;
  return unit == "inch" ? "in" : "";
}

void write_numbers(OutputFile& out, std::initializer_list<double> numbers) {
  bool is_first = true;
  for (const double number : numbers) {
    if (!is_first) out.write(' ');
    is_first = false;
    out.write_number(number + 0.0);
  }
}

void write_path(const Sections& sections, const SectionPolyline& polyline, const PlaneFrame& frame, OutputFile& out) {
  out.write("M");
  for (std::size_t k = 0; k < polyline.count; ++k) {
    const PlanePoint at = drawn(frame, sections.points[polyline.first + k].position);
    if (k > 0) out.write(k == 1 ? "L" : " ");
    write_numbers(out, {at.x, at.y});
  }
  if (polyline.closed) out.write("Z");
  out.write('\n');
}

/// Writes the closed polylines of a plane as one path, which is filled, or the open ones.
void write_paths(const Sections& sections, const PlaneSection& plane, bool closed, const PlaneFrame& frame,
                 OutputFile& out) {
  const auto polylines = std::span(sections.polylines).subspan(plane.first_polyline, plane.polyline_count);
  if (std::ranges::none_of(polylines, [&](const SectionPolyline& of) { return of.closed == closed; })) return;
  out.write(closed ? "<path fill-rule=\"evenodd\" d=\"" : "<path fill=\"none\" d=\"");
  for (const SectionPolyline& polyline : polylines)
    if (polyline.closed == closed) write_path(sections, polyline, frame, out);
  out.write("\"/>\n");
}

}  // namespace

void write_svg(const Sections& sections, OutputFile& out, const SectionsFileOptions& options) {
  const PlaneFrame frame = plane_frame(sections.normal);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double left = infinity, right = -infinity, top = infinity, bottom = -infinity;
  for (const SectionPoint& point : sections.points) {
    const PlanePoint at = drawn(frame, point.position);
    left = std::min(left, at.x), right = std::max(right, at.x);
    top = std::min(top, at.y), bottom = std::max(bottom, at.y);
  }
  if (!(left <= right)) left = right = top = bottom = 0;
  const double size = std::max({right - left, bottom - top, std::numeric_limits<double>::min()});
  const double margin = size / 50, width = right - left + 2 * margin, height = bottom - top + 2 * margin;
  const std::string unit = svg_unit(options.unit);
  out.write(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\""
      " xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\" width=\"");
  out.write_number(width);
  out.write(unit + "\" height=\"");
  out.write_number(height);
  out.write(unit + "\" viewBox=\"");
  write_numbers(out, {left - margin, top - margin, width, height});
  out.write("\">\n<g fill=\"#9db8d2\" fill-opacity=\"0.35\" stroke=\"#1b2a38\" stroke-width=\"");
  out.write_number(size / 500);
  out.write("\" stroke-linejoin=\"round\">\n");
  for (std::size_t k = 0; k < sections.planes.size() && !out.failed(); ++k) {
    const PlaneSection& plane = sections.planes[k];
    if (plane.polyline_count == 0) continue;
    const std::string name = "section-" + std::to_string(k);
    out.write("<g id=\"" + name + "\" inkscape:groupmode=\"layer\" inkscape:label=\"" + name + "\" data-offset=\"");
    out.write_number(plane.offset);
    out.write("\">\n");
    write_paths(sections, plane, true, frame, out);
    write_paths(sections, plane, false, frame, out);
    out.write("</g>\n");
  }
  out.write("</g>\n</svg>\n");
}

}}  // namespace tessera::abi_0_1
