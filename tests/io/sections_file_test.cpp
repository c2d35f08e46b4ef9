// Files of sections: SVG, DXF and PLY, read back by small readers of their own.

#include "tessera/sections_file.h"

#include <bit>
#include <cstring>
#include <sstream>

#include "section/section_checks.h"
#include "support/errors.h"
#include "support/scratch_folder.h"
#include "support/torus.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

Sections ring_layers() {
  const PatchSet set = value_of(PatchSet::make(Torus(8).patches(false)));
  const std::vector<double> offsets{-0.2, 5, 0.1};
  return value_of(make_sections(set, {0, 0, 1}, offsets, {.tolerance = 1e-2}));
}

std::vector<std::pair<int, std::string>> dxf_pairs(const std::string& text) {
  std::vector<std::pair<int, std::string>> pairs;
  std::istringstream lines(text);
  for (std::string code, value; std::getline(lines, code) && std::getline(lines, value);)
    pairs.emplace_back(std::stoi(code), value);
  return pairs;
}

TEST(SectionsFile, DxfHoldsEveryPointOnItsLayer) {
  const ScratchFolder folder;
  const Sections sections = ring_layers();
  ASSERT_TRUE(write_sections(sections, folder / "a.DXF").ok());
  const std::string text = content_of(folder / "a.DXF");
  EXPECT_EQ(text.rfind("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n", 0), 0u);
  EXPECT_TRUE(text.ends_with("0\nENDSEC\n0\nEOF\n"));
  std::size_t polylines = 0, closed = 0, ends = 0;
  std::vector<Vec3> points;
  std::string entity, layer;
  for (const auto& [code, value] : dxf_pairs(text)) {
    if (code == 0) entity = value;
    if (code == 0 && value == "POLYLINE") ++polylines;
    if (code == 0 && value == "SEQEND") ++ends;
    if (code == 70 && entity == "POLYLINE") closed += (std::stoi(value) & 1) != 0;
    if (entity == "VERTEX" && code == 8) layer = value, points.emplace_back();
    if (entity == "VERTEX" && code == 10) points.back().x = std::stod(value);
    if (entity == "VERTEX" && code == 20) points.back().y = std::stod(value);
    if (entity == "VERTEX" && code == 30) {
      points.back().z = std::stod(value);
      EXPECT_NEAR(points.back().z, layer == "SECTION_0" ? -0.2 : 0.1, 1e-12);
    }
  }
  EXPECT_EQ(polylines, sections.polylines.size());
  EXPECT_EQ(ends, polylines);
  EXPECT_EQ(closed, polylines);
  ASSERT_EQ(points.size(), sections.points.size());
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_EQ(points[k], sections.points[k].position);
}

TEST(SectionsFile, SvgIsTheDrawingInThePlane) {
  const ScratchFolder folder;
  const PatchSet set = value_of(PatchSet::make(Torus(8).patches(false)));
  const Sections sections = value_of(make_section(set, {{1, 0, 0}, 0.05}, {.tolerance = 1e-2}));
  ASSERT_EQ(sections.polylines.size(), 2u);
  ASSERT_TRUE(write_sections(sections, folder / "a.svg", {.unit = "mm"}).ok());
  const std::string text = content_of(folder / "a.svg");
  EXPECT_NE(text.find("<g id=\"section-0\" inkscape:groupmode=\"layer\""), std::string::npos);
  EXPECT_NE(text.find("data-offset=\"0.05\""), std::string::npos);
  // The plane's axes are y and z; z points up, so it is negated.
  const std::size_t begin = text.find(" d=\"M") + 4;
  std::string path = text.substr(begin, text.find('"', begin) - begin);
  for (char& c : path)
    if (c == 'M' || c == 'L' || c == 'Z') c = ' ';
  std::istringstream stream(path);
  std::vector<double> numbers;
  for (double number; stream >> number;) numbers.push_back(number);
  ASSERT_EQ(numbers.size(), 2 * sections.points.size());
  for (std::size_t k = 0; k < sections.points.size(); ++k) {
    EXPECT_EQ(numbers[2 * k], sections.points[k].position.y);
    EXPECT_EQ(numbers[2 * k + 1], -sections.points[k].position.z);
  }
  // The drawing is as large as the section, and its units are those of the model.
  double width = 0, left = 0, top = 0, box_width = 0, box_height = 0;
  ASSERT_EQ(std::sscanf(text.c_str() + text.find(" width=\""), " width=\"%lfmm\"", &width), 1);
  ASSERT_EQ(std::sscanf(text.c_str() + text.find("viewBox=\""), "viewBox=\"%lf %lf %lf %lf\"", &left, &top, &box_width,
                        &box_height),
            4);
  EXPECT_EQ(width, box_width);
  for (std::size_t k = 0; k < sections.points.size(); ++k) {
    EXPECT_GT(numbers[2 * k], left);
    EXPECT_LT(numbers[2 * k], left + box_width);
    EXPECT_GT(numbers[2 * k + 1], top);
    EXPECT_LT(numbers[2 * k + 1], top + box_height);
  }
}

TEST(SectionsFile, PlyHoldsVerticesAndEdges) {
  const ScratchFolder folder;
  const Sections sections = ring_layers();
  ASSERT_TRUE(write_sections(sections, folder / "a.ply").ok());
  const std::string text = content_of(folder / "a.ply");
  const std::size_t begin = text.find("end_header\n") + 11, count = sections.points.size();
  EXPECT_NE(text.find("element vertex " + std::to_string(count) + "\n"), std::string::npos);
  EXPECT_NE(text.find("element edge " + std::to_string(count) + "\n"), std::string::npos);  // all are closed
  ASSERT_EQ(text.size(), begin + count * (24 + 12));
  double length_of_edges = 0;
  for (std::size_t k = 0; k < count; ++k) {
    std::array<double, 3> p;
    std::memcpy(p.data(), text.data() + begin + 24 * k, 24);
    EXPECT_EQ(
        p, (std::array{sections.points[k].position.x, sections.points[k].position.y, sections.points[k].position.z}));
    std::array<std::int32_t, 3> edge;
    std::memcpy(edge.data(), text.data() + begin + 24 * count + 12 * k, 12);
    const Vec3 a = sections.points.at(edge[0]).position, b = sections.points.at(edge[1]).position;
    EXPECT_NEAR(a.z, sections.planes.at(edge[2]).offset, 1e-12);
    length_of_edges += length(b - a);
  }
  EXPECT_NEAR(length_of_edges, sections.planes[0].length + sections.planes[2].length, 1e-9);
}

TEST(SectionsFile, FramesAreRightHanded) {
  for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}, normalized(Vec3{1, 2, 3}),
                             normalized(Vec3{-3, 2, 2.9}), normalized(Vec3{1, 1, 1})}) {
    const PlaneFrame frame = plane_frame(normal);
    EXPECT_NEAR(length(frame.right), 1, 1e-15);
    EXPECT_NEAR(length(frame.up), 1, 1e-15);
    EXPECT_LT(length(cross(frame.right, frame.up) - normal), 1e-15);
  }
  EXPECT_EQ(plane_frame({1, 0, 0}).right, (Vec3{0, 1, 0}));
  EXPECT_EQ(plane_frame({0, 1, 0}).up, (Vec3{1, 0, 0}));
}

TEST(SectionsFile, BadListsAndPlacesAreErrors) {
  const ScratchFolder folder;
  Sections sections = ring_layers();
  const auto expect_error = [&](const std::string& name, StatusCode code, const std::string& words) {
    const Status status = write_sections(sections, folder / name);
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_NE(status.message().find(words), std::string::npos) << status.message();
    EXPECT_TRUE(folder.names().empty());
  };
  expect_error("a.stl", StatusCode::unsupported, "sections are written as .dxf, .ply, .svg");
  expect_error("none/a.svg", StatusCode::io_error, "a.svg");
  sections.planes[2].polyline_count += 1;
  expect_error("a.svg", StatusCode::invalid_argument, "plane 2 has polylines beyond the list");
  sections.planes[2].polyline_count -= 1;
  sections.polylines[1].first = sections.points.size();
  expect_error("a.ply", StatusCode::invalid_argument, "polyline 1 has points beyond the list");
  const Sections none{
      .normal = {0, 0, 1}, .planes = {}, .polylines = {}, .points = {}, .contacts = {}, .coplanar = {}, .unproven = {}};
  for (const char* const name : {"a.svg", "a.dxf", "a.ply"}) EXPECT_TRUE(write_sections(none, folder / name).ok());
}

}}  // namespace tessera::test
