#pragma once
// The parts of a JSON model, one reader each. All throw JsonFailure. tools/models/FORMAT.md describes what each reads.

#include <vector>

#include "io/json/json_reader.h"
#include "tessera/geometry.h"
#include "tessera/nurbs_surface.h"
#include "tessera/parametric_surface.h"
#include "tessera/surface.h"
#include "tessera/trim_loop.h"

namespace tessera { inline namespace abi_0_1 {

/// The fields of a surface: those common to all kinds, and its own.
class SurfaceFields : public Fields {
 public:
  SurfaceFields(const JsonValue& value, std::initializer_list<std::string_view> own);
};

/// Reads a surface by its "kind".
Surface read_surface(const JsonValue& value);
/// Reads a list of maps, the first applied first.
Affine read_placement(const JsonValue& value);
/// Reads a list of trimming loops.
std::vector<TrimLoop> read_trims(const JsonValue& value);

// Readers of surfaces, by kind.
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

// Reads a curve by kind: Bezier, B-spline, NURBS, circle; as a border also a function.
Curve read_curve(const JsonValue& value);
BorderCurve read_border(const JsonValue& value);
/// Reads a curve in a surface's parameters: points are [u, v].
Curve read_parameter_curve(const JsonValue& value);
/// Reads a parametric curve of three expressions in t.
ParametricCurve read_parametric_curve(const JsonValue& value);

Axis read_axis(const JsonValue& value);
CircleArcs read_arcs(const JsonValue& value);

/// Knots from the file, or by a word: "clamped", "uniform" and "periodic" knots are integers, each span has length 1,
/// and the domain begins at 0.
struct Knots {
  std::vector<double> values;
  bool periodic = false;  ///< the first `degree` points repeat at the end
};
/// `count` is the number of points.
Knots read_knots(const JsonValue& value, int degree, std::size_t count);

}}  // namespace tessera::abi_0_1
