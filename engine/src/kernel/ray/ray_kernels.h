#pragma once
// Jobs and kernels for rays against pieces of patches, in float with every rounding bounded, for exact rays.

#include <cstddef>

#include "kernel/ray/nearest_kernels.h"
#include "kernel/ray/tree_kernels.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// A piece of a patch in coordinates of its own: x -> axis[.] (x - centre), in which the piece is nearly (u, v, 0),
/// with u and v in [-1/2, 1/2]. The coefficients of u^i v^j, i and j up to 3, follow it in memory, `[i][j]`: three per
/// point, or four, homogeneous, if it is rational. A piece of higher degree differs from them by at most the noise. All
/// bounds below hold for |u|, |v| <= reach, for homogeneous values, and for the piece as it is in double.
struct alignas(32) RayLeaf {
  static constexpr float reach = 0.5f + 1.0f / 32;

  float centre[3];
  float noise;        ///< error bound of a coordinate less that of the ray; infinite: kernels decide nothing
  float axis_x[3];    ///< the share of x in each coordinate
  float slope_noise;  ///< error bound of such derivatives
  float axis_y[3];
  float lightest;  ///< a lower bound of the weight
  float axis_z[3];
  float spread;              ///< bounds |coordinate - u| and |coordinate - v|
  float lower[4], upper[4];  ///< the box in these coordinates, padded by the noise; the last are ignored
  float bend_uu[4], bend_uv[4], bend_vv[4];  ///< bounds of the coefficients' second derivatives, the weight's last

  const float* coefficients() const { return reinterpret_cast<const float*>(this + 1); }
  float* coefficients() { return reinterpret_cast<float*>(this + 1); }
};

/// A ray of the points origin + s direction with s in [near, far]. The direction is a unit vector and the origin within
/// 2 of zero; both are off by rounding to float, by which near and far are widened.
struct alignas(16) RayProbe {
  float origin[4], direction[4];
  float near, far;
  bool any;  ///< the first proven root is enough
};

/// The rays of several probes, lanes = rays, and the result of each.
struct alignas(64) RayPacket {
  static constexpr int size = 16;
  static constexpr float nothing = 0, root = 1, undecided = 2;
  float origin[3][size], direction[3][size];
  float near[size], far[size];
  float state[size];  ///< `nothing`, `root` (the one root below, as in RayRoot) or `undecided`
  float u[size], v[size], s[size], radius_u[size], radius_v[size], s_error[size];
};

/// Exactly one root in u +- radius_u, v +- radius_v; s has the error s_error. It lies inside the piece unless
/// `at_border`: then it may lie beyond the border, and in that case the piece has no root nearby.
struct RayRoot {
  float u, v, s, radius_u, radius_v, s_error;
  bool at_border = false;
};

struct RayRoots {
  static constexpr int most = 3;
  int count = 0;
  RayRoot root[most];
};

/// Returns the bytes from one piece to the next: one more float than there are coefficients is read.
constexpr std::size_t ray_leaf_bytes(bool rational) {
  const std::size_t bytes = sizeof(RayLeaf) + (rational ? 64 : 49) * sizeof(float);
  return (bytes + alignof(RayLeaf) - 1) / alignof(RayLeaf) * alignof(RayLeaf);
}

/// A position and its derivatives, three numbers each.
struct RayPoint {
  double position[4], du[4], dv[4];
};

/// Rays, lanes = rays.
struct alignas(64) RayBundle {
  static constexpr int size = 16;
  static constexpr double max_component = 1.844e18;  ///< limit for a valid ray
  double origin[3][size], direction[3][size];
  double near[size], far[size];  ///< range of t
};

/// The box in which rays' lines begin and end, in the coordinates scale (p - centre).
struct RayRoom {
  double centre[3], scale;
  double lower[3], upper[3];
};

/// The results of line_of (ray/line/ray_line.h) for these rays. If `plain` is 0 the ray is invalid or has numbers that
/// this kernel does not handle, and the other values are meaningless.
struct alignas(64) RayLines {
  static constexpr int size = RayBundle::size;
  double start[3][size], direction[3][size], across[2][3][size];
  double near[size], far[size], enter[size], leave[size], slack[size];
  double base[size], shift[size], speed[size];
  double plain[size];
};

/// Roots of a patch to be polished on rays, lanes = rays: control points x y z x y z .., `[i][j]`; lines and points in
/// the coordinates scale (p - centre). Roots are searched inside [u0, u1] x [v0, v1].
struct PolishJob {
  static constexpr int max_steps = 6;
  const double *points, *weights;  ///< no weights for a polynomial patch
  int degree_u, degree_v;
  double centre[3], scale;
  double u0, u1, v0, v1;
  double linear;  ///< limit of the last step, which leaves an error of its square
};
struct alignas(64) PolishedRays {
  static constexpr int size = RayPacket::size;
  static constexpr double idle = 0, asked = 1, found = 2, failed = 3;
  double start[3][size], direction[3][size], across[2][3][size];  ///< lines of the rays
  double state[size];                                             ///< `asked`, then `found` or `failed`; others are
                                                                  ///< unchanged
  double u[size], v[size], reach_u[size], reach_v[size];          ///< the start, and how far a root may be from it
  double root_u[size], root_v[size], s[size];                     ///< only where found
  double position[3][size], du[3][size], dv[3][size];
};

/// Kernels for several rays, lanes = rays. Each ray gets the same numbers as alone.
struct RayPacketKernels {
  void (*lines)(const RayBundle& rays, const RayRoom& room, RayLines& lines);
  /// Trace like RayKernels, for the rays whose bits are set in `lanes`, as far as one rectangle decides. For other rays
  /// `state` is meaningless.
  void (*trace_polynomial_leaf)(const RayLeaf& leaf, RayPacket& rays, unsigned lanes);
  void (*trace_rational_leaf)(const RayLeaf& leaf, RayPacket& rays, unsigned lanes);
  /// Polish roots of bicubic patches, and of rational ones of degrees up to three.
  void (*polish_cubic)(const PolishJob& job, PolishedRays& rays, unsigned lanes);
  void (*polish_low_rational)(const PolishJob& job, PolishedRays& rays, unsigned lanes);
  /// Goes on to the next leaf that some rays of the packet may meet. Returns the bits of these rays; 0 at the end.
  unsigned (*next_packet_leaf)(const TreeNode* nodes, TreePacket& packet, std::uint32_t& leaf);
};

struct RayKernels {
  /// Null where vectors are too short to pay, or have no fused multiply-add.
  const RayPacketKernels* packets;
  /// Find all roots of the piece on the ray with s in [near, far], and perhaps others a rounding outside of that. If
  /// `any` is set and a root is met inside, it becomes the first, and others may be missing. Return false if undecided;
  /// `roots` is then meaningless.
  bool (*trace_polynomial_leaf)(const RayLeaf& leaf, const RayProbe& ray, RayRoots& roots);
  bool (*trace_rational_leaf)(const RayLeaf& leaf, const RayProbe& ray, RayRoots& roots);
  /// Computes the position less `origin` and both derivatives of a bicubic patch at (u,v) in [0,1]^2, by convex
  /// combinations of its control points x y z x y z .., `[i][j]`.
  void (*cubic_point)(const double* points, const double* origin, double u, double v, RayPoint& out);
  /// Does this for a rational patch of degrees m, n up to 3.
  void (*low_rational_point)(const double* points, const double* weights, int m, int n, const double* origin, double u,
                             double v, RayPoint& out);
  NearestKernels nearest;
  /// Goes on to the next leaf whose box the ray may meet, roughly from near to far. Returns TreeNode::none at the end.
  std::uint32_t (*next_leaf)(const TreeNode* nodes, TreeWalk& walk);
};

}}}  // namespace tessera::abi_0_1::kernel
