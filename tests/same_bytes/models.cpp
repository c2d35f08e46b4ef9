#include "models.h"

#include <array>
#include <cmath>
#include <numbers>

#include <tessera/generic_callable.h>
#include <tessera/nurbs_surface.h>

#include "hash.h"

using tessera::BezierPatch;
using tessera::Vec3;

namespace {

/// A bumpy sheet over a unit square beside those of the others.
std::vector<Vec3> net(Seeded& seeded, int rows, int columns, double x, double y) {
  std::vector<Vec3> points;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      points.push_back({x + (i + seeded.between(-0.2, 0.2)) / (rows - 1),
                        y + (j + seeded.between(-0.2, 0.2)) / (columns - 1), seeded.between(-0.3, 0.3)});
  return points;
}

std::vector<double> weights(Seeded& seeded, std::size_t count) {
  std::vector<double> all(count);
  for (double& weight : all) weight = seeded.between(0.4, 2.5);
  return all;
}

tessera::Surface coons_patch(Seeded& seeded) {
  const Vec3 a{0, 0, 0}, b{0, 1, 0.2}, c{1, 0, -0.1}, d{1, 1, 0};
  const auto curve = [&](const Vec3& from, const Vec3& to) {
    std::vector<Vec3> points{from};
    for (int k = 1; k < 3; ++k) points.push_back(from + k / 3.0 * (to - from) + Vec3{0, 0, seeded.between(-0.2, 0.2)});
    points.push_back(to);
    return value_of(tessera::Curve::bezier(points));
  };
  tessera::CoonsOptions options;
  options.f = tessera::Blend::cubic();
  return value_of(tessera::CoonsPatch::make({curve(a, c), curve(b, d), curve(a, b), curve(c, d)}, options));
}

tessera::Surface b_spline(Seeded& seeded) {
  const std::vector<double> u{0, 0, 0, 0, 0.2, 0.5, 0.5, 1, 1, 1, 1}, v{-1, 0, 0.3, 1, 1.5, 2, 4};
  const std::vector<Vec3> points = net(seeded, 7, 4, 0, 0);
  return value_of(tessera::BSplineSurface::rational(3, u, 2, v, points, weights(seeded, points.size())));
}

}  // namespace

std::vector<BezierPatch> some_patches() {
  Seeded seeded(41);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 48; ++k) {
    const int m = 1 + k % 6, n = 1 + (k / 6 + k) % 6;
    std::vector<Vec3> points = net(seeded, m + 1, n + 1, k % 7, k / 7);
    if (k == 20)
      for (int j = 0; j <= n; ++j) points[static_cast<std::size_t>(j)] = points[0];
    patches.push_back(k % 3 == 2 ? value_of(BezierPatch::rational(m, n, points, weights(seeded, points.size())))
                                 : value_of(BezierPatch::polynomial(m, n, points)));
  }
  for (int k = 0; k < 24; ++k)  // whole blocks of one kind
    patches.push_back(value_of(BezierPatch::polynomial(3, 3, net(seeded, 4, 4, k % 7, 7 + k / 7))));
  return patches;
}

std::vector<tessera::Surface> some_surfaces() {
  Seeded seeded(42);
  std::vector<tessera::Surface> surfaces;
  surfaces.push_back(b_spline(seeded));
  surfaces.push_back(coons_patch(seeded));
  tessera::Axis axis;
  axis.direction = {0.3, -0.2, 0.9};
  surfaces.push_back(value_of(tessera::make_nurbs_torus(axis, 2, 0.7)));
  surfaces.push_back(value_of(tessera::make_nurbs_sphere(axis, 1.3, tessera::CircleArcs::three)));
  const auto quadric = value_of(tessera::Quadric::make({2, 3, 1.5, 0.3, -0.2, 0.1, 0.4, 0.1, -0.3, -2}));
  surfaces.push_back(value_of(tessera::QuadricPiece::make(quadric, {0, 2 * std::numbers::pi, -1.2, 1.5})));
  const auto hyperboloid = value_of(tessera::Quadric::make({1, 1.7, -1, 0.1, 0, 0.2, 0, 0, 0, -1}));
  surfaces.push_back(value_of(tessera::QuadricPiece::make(hyperboloid, {0.5, 4, -1.5, 1})));
  surfaces.push_back(value_of(tessera::generic_surface(
      [](auto u, auto v) {
        using std::cos, std::exp, std::sin, std::sqrt;
        return std::array{u + 0.1 * sin(3 * v), v + 0.2 * cos(u * v), exp(-(u * u)) * sqrt(2 + v)};
      },
      {-1, 1, -1, 1})));
  return surfaces;
}

tessera::PatchSet some_set() {
  tessera::PatchSetOptions options;
  options.blocks = {true, true, true, true, true, true};
  return value_of(tessera::PatchSet::make(some_patches(), options));
}
