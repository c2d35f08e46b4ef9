#pragma once
// Curves and surfaces as lists of control points, a type and global parameters: what OBJ files state of free-form
// geometry, made into curves and surfaces of the engine ("Object Files (.obj)", Appendix B1 of the Advanced
// Visualizer manual, "Mathematics for free-form curves/surfaces").

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "surface/homogeneous.h"
#include "tessera/curve.h"
#include "tessera/status.h"
#include "tessera/surface.h"

namespace tessera::inline abi_0_1 {

enum class FreeformType : std::uint8_t { none, bezier, bspline, cardinal, taylor, bmatrix };

/// One direction of a surface, or the one of a curve. Values are finite.
struct FreeformLine {
  std::optional<std::int64_t> degree,
      step;                    ///< step: by how many points a piece of a bmatrix lies after the one before it
  std::vector<double> matrix;  ///< bmatrix: N_i(t) = sum_j b_ij t^j, entries b_ij with j running fastest
  std::vector<double> parm;    ///< bspline: the knots; all others: where the pieces begin and end
};

/// Type and directions. A curve has u alone.
struct FreeformState {
  FreeformType type = FreeformType::none;
  bool rational = false;  ///< otherwise weights do not count
  FreeformLine u, v;
};

/// Points x y z of weight w, not premultiplied, out of a list of such.
struct ControlPoints {
  std::span<const Homogeneous> vertices;
  std::span<const std::uint32_t> indices;

  std::size_t size() const { return indices.size(); }
  const Homogeneous& operator[](std::size_t k) const { return vertices[indices[k]]; }
};

/// The surface on the part `range` of its parameters; its points run along u first. A Bezier patch or one B-spline
/// surface; of taylor and bmatrix, whose pieces need not meet, a surface a piece, those along v first. Errors speak of
/// parm, deg, step and bmat, or are those of the kinds of surfaces.
Result<std::vector<Surface>> freeform_surfaces(const FreeformState& state, const ControlPoints& points,
                                               const Domain& range);

/// The same for a curve, on all of its parameters.
Result<std::vector<Curve>> freeform_curves(const FreeformState& state, const ControlPoints& points);

}  // namespace tessera::inline abi_0_1
