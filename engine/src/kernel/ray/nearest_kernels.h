#pragma once
// Jobs and kernels for the nearest points of patches.

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// Boxes along the axes of the coordinates.
struct alignas(64) NodeBoxes {
  static constexpr int size = 8;
  float lower[3][size], upper[3][size];
};

/// Boxes along orthonormal axes of their own, `[axis][coordinate][box]`, from centre - half to centre + half.
struct alignas(64) BlockBoxes {
  static constexpr int size = NodeBoxes::size;
  float centre[3][size], axes[3][3][size], half[3][size];
};

/// A point of a patch and its derivatives by the patch's parameters, three numbers each.
struct SecondOrder {
  double position[3], du[3], dv[3], duu[3], duv[3], dvv[3];
  double unused;  ///< kernels may write here
};

/// Half the squared distance of a point of a patch from another point: the value, the gradient, the Hessian, and the
/// squares of the lengths of du and dv.
struct HalfSquare {
  double value, gu, gv, uu, uv, vv, du_du, dv_dv;
};

struct NearestKernels {
  /// Write the squared distances of a point from boxes, and return the bits of the boxes for which they are at most
  /// `limit`.
  unsigned (*node_squares)(const NodeBoxes& boxes, const float* point, float limit, float* squares);
  unsigned (*block_squares)(const BlockBoxes& boxes, const float* point, float limit, float* squares);
  /// Computes the position less `origin` and all derivatives up to the second of a bicubic patch at (u,v) in [0,1]^2,
  /// from its control points x y z x y z .., `[i][j]`.
  void (*cubic_second_order)(const double* points, const double* origin, double u, double v, SecondOrder& out);
  /// Does this for a rational patch of degrees m, n up to 3, by the quotient rule.
  void (*low_rational_second_order)(const double* points, const double* weights, int m, int n, const double* origin,
                                    double u, double v, SecondOrder& out);
  /// Computes half the squared distance for a point in the same coordinates.
  void (*half_square)(const SecondOrder& at, const double* point, HalfSquare& out);
};

}}}  // namespace tessera::abi_0_1::kernel
