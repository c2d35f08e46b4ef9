// Triangles of trimmed faces in the parameter plane: polygons with round holes, and grids that round holes cut. Their
// areas and edges are checked after they were timed.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "plane/cut_cells.h"
#include "suite.h"
#include "timing.h"

namespace tessera::bench { namespace {

using Triangle = PolygonTriangles::Triangle;

/// A square with `holes` x `holes` round holes of `corners` points; its sides have `division` segments each.
struct Plate {
  std::vector<ParameterPoint> points;
  std::vector<std::uint32_t> ends;
  std::vector<PlaneSegment> chords;
  double area = 0;

  Plate(int holes, int corners, int division) {
    for (int side = 0; side < 4; ++side) {
      for (int k = 0; k < division; ++k) {
        const double t = double(k) / division;
        points.push_back(side == 0   ? ParameterPoint{t, 0}
                         : side == 1 ? ParameterPoint{1, t}
                         : side == 2 ? ParameterPoint{1 - t, 1}
                                     : ParameterPoint{0, 1 - t});
      }
    }
    close();
    for (int hole = 0; hole < holes * holes; ++hole) {
      // No two holes are cut alike.
      const double radius = (0.3 + 0.001 * (hole % 37)) / holes;
      const double u = (hole % holes + 0.5 + 0.003 * (hole % 11)) / holes, v = (hole / holes + 0.49) / holes;
      for (int k = 0; k < corners; ++k) {
        const double angle = -2 * std::numbers::pi * k / corners + hole;
        points.push_back({u + radius * std::cos(angle), v + radius * std::sin(angle)});
      }
      close();
    }
  }

 private:
  void close() {
    const auto first = static_cast<std::uint32_t>(chords.size()), end = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t k = first; k < end; ++k) {
      chords.push_back({k, k + 1 < end ? k + 1 : first});
      const ParameterPoint &a = points[k], &b = points[chords.back().end];
      area += (a.u * b.v - a.v * b.u) / 2;
    }
    ends.push_back(end);
  }
};

/// The fault of triangles; null if each has an area, these sum up to `area`, and edges with no partner are `open` in
/// number.
const char* fault_of(const std::vector<Triangle>& triangles, const std::vector<ParameterPoint>& points, double area,
                     std::size_t open) {
  double sum = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, partners;
  for (const Triangle& t : triangles) {
    const ParameterPoint &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
    if (orientation(a, b, c) <= 0) return "a triangle has no area";
    sum += ((b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u)) / 2;
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace_back(t[k], t[(k + 1) % 3]);
      partners.emplace_back(t[(k + 1) % 3], t[k]);
    }
  }
  if (!(std::abs(sum - area) <= 1e-12 * area)) return "the areas have another sum than the polygon's";
  std::ranges::sort(edges);
  std::ranges::sort(partners);
  if (std::ranges::adjacent_find(edges) != edges.end()) return "an edge is used twice";
  std::vector<std::pair<std::uint32_t, std::uint32_t>> single;
  std::ranges::set_difference(edges, partners, std::back_inserter(single));
  return single.size() == open ? nullptr : "the open edges are not the borders";
}

void triangulate_polygon(benchmark::State& state, int holes, int corners) {
  const Plate plate(holes, corners, 1);
  PolygonTriangles polygon;
  const auto best = time_calls(state, 1, [&] {
    return polygon.run_rings(plate.points, plate.ends) ? Status{} : Status{StatusCode::internal, "Borders cross."};
  });
  if (!best) return;
  const std::vector<Triangle> triangles(polygon.triangles().begin(), polygon.triangles().end());
  if (const char* fault = fault_of(triangles, plate.points, plate.area, plate.points.size()))
    return state.SkipWithError(fault);
  report_rates(state, *best, static_cast<double>(triangles.size()));
}

void cut_cells(benchmark::State& state, int holes, int corners, int rate) {
  const Plate plate(holes, corners, rate);
  std::vector<double> lines;
  for (int k = 0; k <= rate; ++k) lines.push_back(double(k) / rate);
  const GridLines grid(lines, lines);
  CutCells cells;
  const auto best = time_calls(state, 1, [&] {
    return cells.run(grid, plate.points, plate.chords) ? Status{} : Status{StatusCode::internal, "Chords cross."};
  });
  if (!best) return;
  std::vector<ParameterPoint> points = plate.points;
  for (const std::uint32_t vertex : cells.grid_vertices()) points.push_back(grid.point(grid.place_of_vertex(vertex)));
  std::vector<Triangle> triangles(cells.band().begin(), cells.band().end());
  cells.for_whole(
      [&](std::uint32_t, std::uint32_t, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
      });
  if (const char* fault = fault_of(triangles, points, plate.area, plate.points.size()))
    return state.SkipWithError(fault);
  report_rates(state, *best, static_cast<double>(cells.band().size()));
  state.counters["triangles_per_second"] = static_cast<double>(triangles.size()) / *best;
}

const bool registered = [] {
  for (const auto& [holes, corners] : {std::pair{1, 16}, {8, 8}, {8, 32}, {32, 32}, {100, 32}}) {
    add_case({"trimmed.polygon", "plate" + square(static_cast<std::size_t>(holes)), "-", std::to_string(corners)},
             holes == 8 && corners == 32 ? Part::quick : Part::full,
             [=, h = holes, c = corners](benchmark::State& state) { triangulate_polygon(state, h, c); });
  }
  for (const auto& [holes, corners, rate] : {std::tuple{1, 40, 12}, {1, 200, 64}, {4, 64, 64}, {8, 32, 64}}) {
    add_case({"trimmed.cells", "plate" + square(static_cast<std::size_t>(holes)), "-", "rate" + std::to_string(rate)},
             holes == 4 ? Part::quick : Part::full,
             [=, h = holes, c = corners, r = rate](benchmark::State& state) { cut_cells(state, h, c, r); });
  }
  return true;
}();

}}  // namespace tessera::bench
