#pragma once
// Properties of every section.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"
#include "tessera/sections.h"

namespace tessera::test {

inline constexpr double pi = std::numbers::pi;

inline std::span<const SectionPoint> points_of(const Sections& sections, const SectionPolyline& polyline) {
  return std::span(sections.points).subspan(polyline.first, polyline.count);
}

/// The patch's point at a point's parameters, by the reference evaluator.
inline Vec3 on_patch(const PatchSet& set, const SectionPoint& point) {
  const Domain& domain = set.source(point.patch).domain;
  return de_casteljau(set.patch(point.patch), domain.local_u(point.u), domain.local_v(point.v));
}

/// Checks the lists, the points and the bounds of sections. `in_plane`: how far points may be from the plane, as a
/// share of the size; `scale`: the length of the caller's normal.
inline void expect_sound(const PatchSet& set, const Sections& sections, double in_plane = 1e-14, double scale = 1) {
  const double size = set.box().diagonal() + max_abs(set.box().lower) + max_abs(set.box().upper);
  std::size_t next_point = 0, next_polyline = 0;
  for (const PlaneSection& plane : sections.planes) {
    EXPECT_EQ(plane.first_polyline, next_polyline);
    next_polyline += plane.polyline_count;
    EXPECT_LE(plane.bound, sections.tolerance);
    double length_of_all = 0;
    std::size_t open = 0;
    for (std::size_t k = plane.first_polyline; k < next_polyline; ++k) {
      const SectionPolyline& polyline = sections.polylines[k];
      EXPECT_EQ(polyline.first, next_point);
      next_point += polyline.count;
      EXPECT_GE(polyline.count, 2u);
      open += polyline.closed ? 0 : 1;
      const std::span<const SectionPoint> points = points_of(sections, polyline);
      double sum = polyline.closed ? length(points.back().position - points.front().position) : 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(dot(sections.normal, points[i].position), plane.offset / scale, in_plane * size);
        EXPECT_LE(length(points[i].position - on_patch(set, points[i])), 1e-14 * size);
        if (i > 0) sum += length(points[i].position - points[i - 1].position);
      }
      EXPECT_NEAR(polyline.length, sum, 1e-12 * size * double(points.size()));
      length_of_all += polyline.length;
    }
    EXPECT_EQ(plane.open_count, open);
    EXPECT_NEAR(plane.length, length_of_all, 1e-12 * (1 + length_of_all));
  }
  EXPECT_EQ(next_point, sections.points.size());
  EXPECT_EQ(next_polyline, sections.polylines.size());
  EXPECT_TRUE(sections.unproven.empty());
}

inline PatchSet set_of(const Result<BSplineSurface>& surface) {
  return value_of(make_patch_set(value_of(to_bezier(value_of(surface)))));
}
/// The set of a curve in the plane y = 0 that turns about z once.
inline PatchSet turned(const Curve& profile) { return set_of(make_surface_of_revolution(profile, {})); }
inline Curve line(const Vec3& from, const Vec3& to) { return value_of(Curve::bezier(std::vector<Vec3>{from, to})); }

}  // namespace tessera::test
