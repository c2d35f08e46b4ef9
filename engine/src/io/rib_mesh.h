#pragma once
// Uniform patches of the RenderMan Interface and their bases, as B-spline surfaces.

#include <array>
#include <vector>

#include "surface/homogeneous.h"
#include "tessera/status.h"
#include "tessera/surface.h"

namespace tessera::inline abi_0_1 {

/// A basis of cubics as the Interface writes it: [t^3 t^2 t 1] M G, and the step from one patch of a mesh to the next.
struct RibBasis {
  std::array<double, 16> matrix;
  int step;
  friend bool operator==(const RibBasis&, const RibBasis&) = default;
};
/// "bezier", "b-spline", "catmull-rom", "hermite" (point, vector, point, vector) or "power" with its usual step, or
/// null.
const RibBasis* find_rib_basis(std::string_view name);
/// The matrix of one of these, if all entries are the same to 1e-5 (files print them with six digits or so); else as
/// it is.
std::array<double, 16> recognised_matrix(const std::array<double, 16>& matrix);

/// One direction of a mesh: cubic with a basis, or linear without.
struct RibDirection {
  const RibBasis* basis = nullptr;
  std::int64_t points = 0;
  bool periodic = false;

  /// How many patches, or an error that says which counts would do.
  Result<std::int64_t> patches() const;
};

/// Control points [i][j], i along u, as (w x, w y, w z, w), or (x, y, z, 0) for polynomial surfaces: a tangent has no
/// weight either.
struct RibNet {
  std::vector<Homogeneous> points;
  bool rational = false;
};

/// Where the control points of a height field stand between 0 and 1, so that x = u. Error: unsupported (a basis whose
/// geometry is not made of points).
Result<std::vector<double>> height_field_parameters(const RibDirection& direction);

/// The mesh over [0,1]^2, all patches alike in size. Bezier, B-spline, Catmull-Rom and Hermite meshes of their usual
/// steps, and linear ones, are one B-spline surface each, whose knots are as smooth as the basis (3-fold, simple,
/// double, double); a single patch that is no B-spline is a Bezier patch; any other basis gives a surface a patch.
/// Exact to rounding. Errors: count_mismatch, invalid_weight, and those of the surfaces.
Result<std::vector<Surface>> mesh_surfaces(const RibDirection& u, const RibDirection& v, RibNet net);

/// A B-spline surface of a net, with the knots' own parameters. Errors: invalid_weight, and those of the surface.
Result<BSplineSurface> spline_surface(int degree_u, std::span<const double> knots_u, int degree_v,
                                      std::span<const double> knots_v, RibNet net, std::optional<Domain> domain = {});

}  // namespace tessera::inline abi_0_1
