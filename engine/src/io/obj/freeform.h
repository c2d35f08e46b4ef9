#pragma once
// Curves and surfaces as lists of control points, a type and global parameters, which is how OBJ files state free-form
// geometry. Makes curves and surfaces of the engine from them ("Object Files (.obj)", Appendix B1 of the Advanced
// Visualizer manual, "Mathematics for free-form curves/surfaces").

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "surface/net/homogeneous.h"
#include "tessera/curve.h"
#include "tessera/status.h"
#include "tessera/surface.h"

namespace tessera { inline namespace abi_0_1 {

enum class FreeformType : std::uint8_t { none, bezier, bspline, cardinal, taylor, bmatrix };

/// One direction of a surface, or the only one of a curve. Values are finite.
struct FreeformLine {
  std::optional<std::int64_t> degree,
      step;                    ///< bmatrix: the step in points from one piece to the next
  std::vector<double> matrix;  ///< bmatrix: N_i(t) = sum_j b_ij t^j, entries b_ij with j running fastest
  std::vector<double> parm;    ///< bspline: the knots; all others: where the pieces begin and end
};

/// Type and directions. A curve has u only.
struct FreeformState {
  FreeformType type = FreeformType::none;
  bool rational = false;  ///< if false, weights are ignored
  FreeformLine u, v;
};

/// Points x y z of weight w, not premultiplied: those at `indices` of a list.
struct ControlPoints {
  std::span<const Homogeneous> vertices;
  std::span<const std::uint32_t> indices;

  std::size_t size() const { return indices.size(); }
  const Homogeneous& operator[](std::size_t k) const { return vertices[indices[k]]; }
};

/// Makes the surface over the part `range` of its parameters; its points run along u first. The result is a Bezier
/// patch or one B-spline surface; for taylor and bmatrix, whose pieces need not meet, it is one surface per piece,
/// along v first. Errors name parm, deg, step and bmat, or are those of the surface kinds.
Result<std::vector<Surface>> freeform_surfaces(const FreeformState& state, const ControlPoints& points,
                                               const Domain& range);

/// Makes the curve over all of its parameters, with results and errors as for surfaces.
Result<std::vector<Curve>> freeform_curves(const FreeformState& state, const ControlPoints& points);

}}  // namespace tessera::abi_0_1
