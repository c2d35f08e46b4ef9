// The classic shapes of occt_lean_mesh.

#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "peers/lean_cases.h"
#include "peers/occt_shape.h"
#include "support/synthetic_sets.h"
#include "tessera/convert.h"
#include "tessera/model.h"
#include "tessera/nurbs_surface.h"

namespace tessera::bench {
namespace {

using test::value_of;
constexpr double pi = std::numbers::pi;

PatchSet set_of(const BSplineSurface& surface) { return value_of(make_patch_set(value_of(to_bezier(surface)))); }

/// Converts tolerances from shares of a size to lengths.
std::vector<double> times(std::vector<double> tolerances, double size) {
  for (double& tolerance : tolerances) tolerance *= size;
  return tolerances;
}

class Shapes {
 public:
  explicit Shapes(const std::string& only) : only_(only) {}

  void add(const std::string& name, const BSplineSurface& surface, const std::vector<double>& tolerances) {
    add(name + ", NURBS", surface, occt_surface(surface), tolerances);
  }
  void add(const std::string& name, const BSplineSurface& surface, const Handle(Geom_Surface) & occt,
           const std::vector<double>& tolerances) {
    if (name.find(only_) != std::string::npos) cases_.push_back({name, set_of(surface), {occt}, tolerances});
  }
  /// Tolerances are shares of the size.
  void add_relative(const std::string& name, const BSplineSurface& surface) {
    if (name.find(only_) == std::string::npos) return;
    PatchSet set = set_of(surface);
    const double size = set.box().diagonal();
    cases_.push_back({name, std::move(set), {occt_surface(surface)}, times({3e-2, 1e-2, 1e-3, 1e-4}, size)});
  }
  std::vector<LeanCase> take() { return std::move(cases_); }

 private:
  std::string only_;
  std::vector<LeanCase> cases_;
};

void add_cylinders(Shapes& shapes) {
  for (const double height : {1.0, 4.0, 10.0, 100.0, 1000.0}) {
    const BSplineSurface nurbs = value_of(make_nurbs_cylinder({}, 1, height));
    const std::string name = "cylinder, height " + std::to_string(static_cast<int>(height));
    shapes.add(name, nurbs, {1e-2, 1e-3});
    shapes.add(name + ", analytic", nurbs,
               new Geom_RectangularTrimmedSurface(new Geom_CylindricalSurface(gp_Ax3(), 1), 0, 2 * pi, 0, height),
               {1e-2, 1e-3});
  }
}

void add_round_shapes(Shapes& shapes) {
  const std::vector<double> tolerances{1e-2, 1e-3, 1e-4};
  const BSplineSurface cone = value_of(make_nurbs_cone({}, 1, 0, 2)), sphere = value_of(make_nurbs_sphere({}, 1)),
                       torus = value_of(make_nurbs_torus({}, 2, 0.5));
  shapes.add("cone", cone, tolerances);
  const double half_angle = std::atan2(1, 2), side = std::hypot(1, 2);
  shapes.add("cone, analytic", cone,
             new Geom_RectangularTrimmedSurface(new Geom_ConicalSurface(gp_Ax3(), -half_angle, 1), 0, 2 * pi, 0, side),
             tolerances);
  shapes.add("sphere", sphere, tolerances);
  shapes.add("sphere, analytic", sphere, new Geom_SphericalSurface(gp_Ax3(), 1), tolerances);
  shapes.add("torus", torus, tolerances);
  shapes.add("torus, analytic", torus, new Geom_ToroidalSurface(gp_Ax3(), 2, 0.5), tolerances);
}

/// A quarter of a torus's tube, a quarter of the way around: it rounds the edge of a cylinder's end.
BSplineSurface fillet() {
  const double s = std::sqrt(0.5), weights[] = {1, s, 1};
  const double profile[3][2] = {{2, 0}, {2, 0.5}, {1.5, 0.5}};  // radius, height
  const double turn[3][2] = {{1, 0}, {1, 1}, {0, 1}};
  std::vector<Vec3> points;
  std::vector<double> all;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      points.push_back({profile[j][0] * turn[i][0], profile[j][0] * turn[i][1], profile[j][1]});
      all.push_back(weights[i] * weights[j]);
    }
  const double knots[] = {0, 0, 0, 1, 1, 1};
  return value_of(BSplineSurface::rational(2, knots, 2, knots, points, all));
}

BSplineSurface revolved() {
  const std::vector<Vec3> points{{1, 0, 0}, {1.6, 0, 0.5}, {0.4, 0, 1.2}, {0.7, 0, 2}, {1.2, 0, 2.4}, {0.9, 0, 3}};
  const std::vector<double> weights{1, 0.7, 2, 1, 0.5, 1}, knots{0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
  return value_of(make_surface_of_revolution(value_of(Curve::nurbs(3, points, weights, knots)), {}));
}

/// Ruled between an arc and a flatter conic, whose weights differ.
BSplineSurface ruled() {
  const std::vector<Vec3> points{{1, 0, 0}, {1.5, 0.3, 2}, {1, 1, 0}, {1, 1.2, 2}, {0, 1, 0}, {-0.5, 0.8, 2}};
  const std::vector<double> weights{1, 1, std::sqrt(0.5), 3, 1, 1};
  const double u[] = {0, 0, 0, 1, 1, 1}, v[] = {0, 0, 1, 1};
  return value_of(BSplineSurface::rational(2, u, 1, v, points, weights));
}

}  // namespace

std::vector<LeanCase> shape_cases(const std::string& only) {
  Shapes shapes(only);
  add_cylinders(shapes);
  add_round_shapes(shapes);
  shapes.add_relative("fillet, one patch", fillet());
  shapes.add_relative("revolved NURBS", revolved());
  shapes.add_relative("ruled NURBS, uneven weights", ruled());
  return shapes.take();
}

}  // namespace tessera::bench
