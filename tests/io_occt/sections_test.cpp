// Sections of CAD parts: closed where shells are, and as long as OpenCASCADE's.

#include "tessera/sections.h"

#include <gtest/gtest.h>
#include <opencascade/BRepAlgoAPI_Section.hxx>
#include <opencascade/BRepGProp.hxx>
#include <opencascade/GProp_GProps.hxx>
#include <opencascade/Standard_Failure.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/gp_Pln.hxx>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "io_occt/cad_shapes.h"
#include "support/synthetic_sets.h"
#include "tessera/cad.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

/// A part whose shells are all closed, each edge with two uses, and the largest gap between its faces.
struct ClosedPart {
  Model model;
  PatchSet set;
  double gap = 0;
};

std::optional<ClosedPart> closed_part(const std::filesystem::path& path) {
  Result<Model> model = read_by_opencascade(path);
  if (!model || model->shapes.empty() || model->surfaces.size() > 2000) return {};
  double gap = 0;
  for (const Shape& shape : model->shapes) {
    const Result<std::vector<bool>> closed = closed_shells(shape);
    if (!closed || closed->empty() || std::ranges::find(*closed, false) != closed->end()) return {};
    const EdgeUses uses = value_of(edge_uses(shape));
    for (std::size_t edge = 0; edge < shape.edges.size(); ++edge)
      if (!shape.edges[edge].degenerate && uses[edge].size() != 2) return {};
    for (const double of : value_of(edge_gaps(shape, 17))) gap = std::max(gap, of);
  }
  Result<PatchSet> set = make_patch_set(*model);
  if (!set || !set->trim_faults().empty()) return {};
  return ClosedPart{*std::move(model), *std::move(set), gap};
}

struct CutAxis3 {
  Vec3 normal;
  double low, high;
};
std::array<CutAxis3, 3> axes_of(const Box3& box) {
  return {{{{1, 0, 0}, box.lower.x, box.upper.x},
           {{0, 1, 0}, box.lower.y, box.upper.y},
           {{0, 0, 1}, box.lower.z, box.upper.z}}};
}

TEST(SectionOfParts, ClosedShellsHaveClosedSections) {
  std::size_t parts = 0, planes = 0, open = 0, polylines = 0, open_planes = 0;
  for (const std::filesystem::path& path : real_cad_files()) {
    const std::optional<ClosedPart> part = closed_part(path);
    if (!part) continue;
    ++parts;
    const double size = part->set.box().diagonal();
    for (const CutAxis3& axis : axes_of(part->set.box())) {
      std::vector<double> offsets;
      for (int k = 0; k < 25; ++k) offsets.push_back(axis.low + (axis.high - axis.low) * (k + 0.4731) / 25);
      const Result<Sections> made = make_sections(part->set, axis.normal, offsets);
      ASSERT_TRUE(made.ok()) << path << ": " << made.status().message();
      for (const PlaneSection& plane : made->planes) {
        ++planes;
        polylines += plane.polyline_count;
        open += plane.open_count;
        open_planes += plane.open_count > 0;
        EXPECT_LE(plane.bound, made->tolerance) << path;
        EXPECT_TRUE(plane.open_count == 0 || part->gap > 1e-4 * size)
            << path << ": " << plane.open_count << " open at " << plane.offset << " across " << axis.normal.x << ' '
            << axis.normal.y << ' ' << axis.normal.z << "; the largest gap of its faces is " << part->gap / size;
      }
    }
  }
  std::printf("%zu parts, %zu planes, %zu polylines, %zu open in %zu planes\n", parts, planes, polylines, open,
              open_planes);
  EXPECT_LE(open_planes * 500, planes);
}

/// The length of OpenCASCADE's sections of all solids, and the seconds that they take; nothing if one fails. Solids go
/// one by one, because OpenCASCADE counts curves once where solids touch.
std::optional<double> length_by_opencascade(const TopoDS_Shape& shape, const Vec3& n, double offset, double& seconds) {
  const gp_Pln plane(gp_Pnt(n.x * offset, n.y * offset, n.z * offset), gp_Dir(n.x, n.y, n.z));
  const auto begin = std::chrono::steady_clock::now();
  double sum = 0;
  try {
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
      BRepAlgoAPI_Section section(solid.Current(), plane, false);
      section.ComputePCurveOn1(false);
      section.Approximation(false);
      section.Build();
      if (!section.IsDone()) return {};
      GProp_GProps properties;
      BRepGProp::LinearProperties(section.Shape(), properties);
      sum += properties.Mass();
    }
  } catch (const Standard_Failure&) {
    return {};
  }
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return sum;
}

TEST(SectionOfParts, LengthsAreThoseOfOpenCascade) {
  std::size_t agree = 0, differ = 0, failed = 0, parts = 0;
  double own_seconds = 0, peer_seconds = 0;
  for (const std::filesystem::path& path : real_cad_files()) {
    const std::optional<ClosedPart> part = closed_part(path);
    if (!part || part->model.surfaces.size() > 300) continue;
    const Result<DescribedShape> file = load_cad(path);
    if (!file) continue;
    ++parts;
    const double size = part->set.box().diagonal();
    for (const CutAxis3& axis : axes_of(part->set.box())) {
      const double offset = axis.low + 0.381966 * (axis.high - axis.low);
      const auto begin = std::chrono::steady_clock::now();
      const Sections made = value_of(make_section(part->set, {axis.normal, offset}, {.tolerance = 1e-6 * size}));
      own_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      const std::optional<double> peer = length_by_opencascade(file->shape, axis.normal, offset, peer_seconds);
      if (!peer) {
        ++failed;
        continue;
      }
      const double allowed = 1e-4 * size + 1e-4 * *peer + 4 * part->gap;
      const bool is_same = std::abs(made.planes[0].length - *peer) <= allowed;
      ++(is_same ? agree : differ);
      if (!is_same)
        std::printf("%s axis %g %g %g: %.9g, OpenCASCADE %.9g, open %zu\n", path.c_str(), axis.normal.x, axis.normal.y,
                    axis.normal.z, made.planes[0].length, *peer, made.planes[0].open_count);
    }
  }
  std::printf("%zu parts: %zu agree, %zu differ, %zu fail; %.3g s, OpenCASCADE %.3g s\n", parts, agree, differ, failed,
              own_seconds, peer_seconds);
  EXPECT_LE(differ * 20, agree);
}

}}  // namespace tessera::test
