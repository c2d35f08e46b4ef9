#pragma once
// Uniform patches of the RenderMan Interface and their bases, as B-spline surfaces.

#include <array>
#include <vector>

#include "surface/net/homogeneous.h"
#include "tessera/status.h"
#include "tessera/surface.h"

namespace tessera { inline namespace abi_0_1 {

/// A basis of cubics as the Interface writes it: [t^3 t^2 t 1] M G, and the step from one patch of a mesh to the next.
struct RibBasis {
  std::array<double, 16> matrix;
  int step;
  friend bool operator==(const RibBasis&, const RibBasis&) = default;
};
/// The basis "bezier", "b-spline", "catmull-rom", "hermite" (point, vector, point, vector) or "power" with its usual
/// step; null for any other name.
const RibBasis* find_rib_basis(std::string_view name);
/// The matrix of a named basis whose entries all equal these to 1e-5 (files print about six digits); otherwise
/// `matrix`.
std::array<double, 16> recognised_matrix(const std::array<double, 16>& matrix);

/// One direction of a mesh: cubic with a basis, or linear without.
struct RibDirection {
  const RibBasis* basis = nullptr;
  std::int64_t points = 0;
  bool periodic = false;

  /// The number of patches. The error says which numbers of points fit.
  Result<std::int64_t> patches() const;
};

/// Control points [i][j], i along u, as (w x, w y, w z, w). Polynomial surfaces have (x, y, z, 0): a tangent has no
/// weight either.
struct RibNet {
  std::vector<Homogeneous> points;
  bool rational = false;
};

/// The parameters from 0 to 1 of a height field's control points, so that x = u. Error: unsupported (a basis whose
/// geometry is not made of points).
Result<std::vector<double>> height_field_parameters(const RibDirection& direction);

/// Makes the mesh over [0,1]^2, with patches of equal size. Exact to rounding. The usual result is one B-spline
/// surface: for linear meshes, and for Bezier, B-spline, Catmull-Rom and Hermite meshes of their usual steps; its inner
/// knots are as smooth as the basis (multiplicity 3, 1, 2, 2). A single patch, unless it is a B-spline, is a Bezier
/// patch. Any other basis gives one surface per patch. Errors: count_mismatch, invalid_weight, and those of the
/// surfaces.
Result<std::vector<Surface>> mesh_surfaces(const RibDirection& u, const RibDirection& v, RibNet net);

/// The B-spline surface of a net, in the parameters of its knots. Errors: invalid_weight, and those of the surface.
Result<BSplineSurface> spline_surface(int degree_u, std::span<const double> knots_u, int degree_v,
                                      std::span<const double> knots_v, RibNet net, std::optional<Domain> domain = {});

}}  // namespace tessera::abi_0_1
