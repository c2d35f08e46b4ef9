#pragma once
// The parts of a JSON model, one reader each. All throw JsonFailure. What each reads is told in tools/models/FORMAT.md.

#include "io/json_reader.h"
#include "tessera/geometry.h"
#include "tessera/nurbs_surface.h"
#include "tessera/parametric_surface.h"
#include "tessera/surface.h"

namespace tessera::inline abi_0_1 {

/// The fields of a surface: those that all have, and its own.
class SurfaceFields : public Fields {
 public:
  SurfaceFields(const JsonValue& value, std::initializer_list<std::string_view> own);
};

/// By its "kind".
Surface read_surface(const JsonValue& value);
/// A list of maps, the first applied first.
Affine read_placement(const JsonValue& value);

// Surfaces, by kind.
Surface read_bezier_patch(const JsonValue& value);
Surface read_tensor_patch(const JsonValue& value);
Surface read_b_spline_surface(const JsonValue& value);
Surface read_nurbs_surface(const JsonValue& value);
Surface read_sphere(const JsonValue& value);
Surface read_torus(const JsonValue& value);
Surface read_cylinder(const JsonValue& value);
Surface read_cone(const JsonValue& value);
Surface read_revolution(const JsonValue& value);
Surface read_hermite_patch(const JsonValue& value);
Surface read_ferguson_patch(const JsonValue& value);
Surface read_adini_patch(const JsonValue& value);
Surface read_algebraic_patch(const JsonValue& value);
Surface read_patch_through_points(const JsonValue& value);
Surface read_hermite_network(const JsonValue& value);
Surface read_ruled_surface(const JsonValue& value);
Surface read_coons_patch(const JsonValue& value);
Surface read_explicit_polynomial(const JsonValue& value);
Surface read_quadric(const JsonValue& value);
Surface read_parametric_surface(const JsonValue& value);

// Curves, by kind: Bezier, B-spline, NURBS, circles; as borders also functions.
Curve read_curve(const JsonValue& value);
BorderCurve read_border(const JsonValue& value);
/// The parametric curve of three expressions in t.
ParametricCurve read_parametric_curve(const JsonValue& value);

Axis read_axis(const JsonValue& value);
CircleArcs read_arcs(const JsonValue& value);

/// Knots as given, or by a word: "clamped", "uniform" and "periodic" knots are the integers, a span from one to the
/// next, and the domain begins at 0.
struct Knots {
  std::vector<double> values;
  bool periodic = false;  ///< the first degree points stand again at the end
};
/// `count`: of the points.
Knots read_knots(const JsonValue& value, int degree, std::size_t count);

}  // namespace tessera::inline abi_0_1
