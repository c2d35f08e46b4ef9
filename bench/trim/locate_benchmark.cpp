// Regions of trimmed faces: trim.make, the loops of a face to a region (rate: pieces per second), and trim.locate,
// points of the parameter plane (rate: points per second) in cells without a curve, over the face at random, and next
// to its curves. Answers are compared with closed forms: the face is a plate with round holes.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/trim_region.h"
#include "timing.h"

namespace tessera::bench { namespace {

using test::value_of;

constexpr std::size_t point_count = 65536;

struct Circle {
  double u, v, radius;
};

/// The unit square with `side` x `side` holes, over 3 x 3 patches.
class Plate {
 public:
  explicit Plate(std::size_t side) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    const double step = 1.0 / static_cast<double>(side);
    for (std::size_t k = 0; k < side * side; ++k) {
      const double column = static_cast<double>(k % side) + 0.5, row = static_cast<double>(k / side) + 0.5;
      circles_.push_back({step * (column + 0.1 * uniform(random)), step * (row + 0.1 * uniform(random)),
                          step * (0.2 + 0.15 * uniform(random))});
      loops_.push_back(loop_of(circles_.back()));
    }
  }

  const std::vector<Circle>& circles() const { return circles_; }
  const std::vector<TrimLoop>& loops() const { return loops_; }
  Result<TrimRegion> region() const { return TrimRegion::make(loops_, breaks_, breaks_); }

  /// The distance from the nearest hole's rim, negative inside of a hole.
  double distance(double u, double v) const {
    double nearest = 2;
    for (const Circle& c : circles_) nearest = std::min(nearest, std::hypot(u - c.u, v - c.v) - c.radius);
    return nearest;
  }

 private:
  /// Four arcs as rational quadratics.
  static TrimLoop loop_of(const Circle& c) {
    constexpr double x[] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (int k = 0; k < 9; ++k) {
      points.push_back({c.u + c.radius * x[k], c.v + c.radius * y[k], 0});
      weights.push_back(k % 2 == 0 ? 1 : std::sqrt(0.5));
    }
    const double knots[] = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    return {{value_of(Curve::nurbs(2, points, weights, knots))}, true};
  }

  std::vector<Circle> circles_;
  std::vector<TrimLoop> loops_;
  std::vector<double> breaks_{0, 0.3, 0.7, 1};
};

struct Points {
  std::vector<double> u, v;
  void add(double a, double b) {
    u.push_back(a);
    v.push_back(b);
  }
};

/// Points farther from every rim than two cells are wide.
Points clean_points(const Plate& plate) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  Points points;
  while (points.u.size() < point_count) {
    const double u = uniform(random), v = uniform(random);
    if (std::abs(plate.distance(u, v)) > 0.1 / std::sqrt(static_cast<double>(plate.circles().size()))) points.add(u, v);
  }
  return points;
}

Points random_points() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  Points points;
  while (points.u.size() < point_count) points.add(uniform(random), uniform(random));
  return points;
}

/// Points at one distance from the rims, on both sides.
Points points_near(const Plate& plate, double distance) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 2 * std::numbers::pi);
  Points points;
  while (points.u.size() < point_count) {
    const Circle& c = plate.circles()[points.u.size() % plate.circles().size()];
    const double angle = uniform(random), r = c.radius + (points.u.size() % 2 == 0 ? distance : -distance);
    points.add(c.u + r * std::cos(angle), c.v + r * std::sin(angle));
  }
  return points;
}

void locate(benchmark::State& state, const Plate& plate, const Points& points) {
  const Result<TrimRegion> region = plate.region();
  if (!region) return state.SkipWithError(region.status().message().c_str());
  std::vector<TrimSide> sides(points.u.size());
  const auto best = time_calls(state, 1, [&] { return region->locate(points.u, points.v, sides); });
  if (!best) return;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const double distance = plate.distance(points.u[k], points.v[k]);
    if (std::abs(distance) < 1e-14) continue;
    if (sides[k] != (distance > 0 ? TrimSide::inside : TrimSide::outside))
      return state.SkipWithError("a point is on the wrong side of a hole");
  }
  report_rates(state, *best, static_cast<double>(points.u.size()));
}

void make(benchmark::State& state) {
  const Plate plate(10);
  Result<TrimRegion> region = plate.region();
  const auto best = time_calls(state, 1, [&] {
    region = plate.region();
    return region.status();
  });
  if (!best) return;
  if (!region->remarks().empty() || region->locate(0.999, 0.001) != TrimSide::inside ||
      region->locate(plate.circles()[7].u, plate.circles()[7].v) != TrimSide::outside)
    return state.SkipWithError("the region is wrong");
  report_rates(state, *best, static_cast<double>(region->piece_count()));
}

const bool registered = [] {
  const std::string size = std::to_string(point_count);
  add_case({"trim.make", "plate100", "2r", "4"}, Part::quick, make);
  add_case({"trim.locate.clean", "plate16", "2r", size}, Part::quick, [](benchmark::State& state) {
    const Plate plate(4);
    locate(state, plate, clean_points(plate));
  });
  add_case({"trim.locate.random", "plate16", "2r", size}, Part::quick,
           [](benchmark::State& state) { locate(state, Plate(4), random_points()); });
  add_case({"trim.locate.random", "plate900", "2r", size}, Part::full,
           [](benchmark::State& state) { locate(state, Plate(30), random_points()); });
  add_case({"trim.locate.near", "plate16", "2r", size}, Part::full, [](benchmark::State& state) {
    const Plate plate(4);
    locate(state, plate, points_near(plate, 1e-9));
  });
  return true;
}();

}}  // namespace tessera::bench
