#pragma once
// Rays against pieces of patches, in float with every rounding bounded: what the kernels of exact rays are given.

#include <cstddef>

namespace tessera::inline abi_0_1::kernel {

/// A piece of a patch in coordinates of its own: x -> axis[.] (x - centre), in which the piece is nearly (u, v, 0), with
/// u and v in [-1/2, 1/2]. Its coefficients follow it in memory, those of u^i v^j for i and j up to 3, `[i][j]`: three
/// a point, or four where it is rational, homogeneous; a piece of higher degree is off from them by no more than the noise.
/// All bounds below hold for |u|, |v| <= reach, of homogeneous values, and for the piece as it is in double.
struct alignas(32) RayLeaf {
  static constexpr float reach = 0.5f + 1.0f / 32;

  float centre[3];
  float noise;        ///< how far a coordinate less that of the ray may be off; infinite: kernels decide nothing
  float axis_x[3];    ///< what x adds to each coordinate
  float slope_noise;  ///< the same of derivatives
  float axis_y[3];
  float lightest;  ///< a lower bound of the weight
  float axis_z[3];
  float spread;              ///< bounds |coordinate - u| and |coordinate - v|
  float lower[4], upper[4];  ///< the box in these coordinates, padded by the noise; the last mean nothing
  float bend_uu[4], bend_uv[4], bend_vv[4];  ///< bounds of the coefficients' second derivatives, the weight's last

  const float* coefficients() const { return reinterpret_cast<const float*>(this + 1); }
  float* coefficients() { return reinterpret_cast<float*>(this + 1); }
};

/// Points origin + s direction with s in [near, far]. The direction is a unit vector, the origin within 2 of zero, and
/// both are off by rounding to float; near and far are widened by that.
struct alignas(16) RayProbe {
  float origin[4], direction[4];
  float near, far;
  bool any;  ///< the first root that is proven will do
};

/// The rays of several probes side by side, and what is found of each.
struct alignas(64) RayPacket {
  static constexpr int size = 16;
  static constexpr float nothing = 0, root = 1, undecided = 2;
  float origin[3][size], direction[3][size];
  float near[size], far[size];
  float state[size];  ///< nothing; the one root that follows, as RayRoot has it; or not known
  float u[size], v[size], s[size], radius_u[size], radius_v[size], s_error[size];
};

/// One root and no other in u +- radius_u, v +- radius_v; s to s_error. Inside the piece, but for one that is `at_border`:
/// that may lie beyond the border, and the piece then has none thereabouts.
struct RayRoot {
  float u, v, s, radius_u, radius_v, s_error;
  bool at_border = false;
};

struct RayRoots {
  static constexpr int most = 3;
  int count = 0;
  RayRoot root[most];
};

/// Bytes from one piece to the next: one more float than there are coefficients is read.
constexpr std::size_t ray_leaf_bytes(bool rational) {
  const std::size_t bytes = sizeof(RayLeaf) + (rational ? 64 : 49) * sizeof(float);
  return (bytes + alignof(RayLeaf) - 1) / alignof(RayLeaf) * alignof(RayLeaf);
}

/// Three numbers each.
struct RayPoint {
  double position[4], du[4], dv[4];
};

/// Rays side by side.
struct alignas(64) RayBundle {
  static constexpr int size = 16;
  static constexpr double max_component = 1.844e18;  ///< of a valid ray
  double origin[3][size], direction[3][size];
  double near[size], far[size];  ///< of t
};

/// Where their lines begin and end: a box in the coordinates scale (p - centre).
struct RayRoom {
  double centre[3], scale;
  double lower[3], upper[3];
};

/// What line_of (ray/line/ray_line.h) makes of them. Where `plain` is 0 the ray is not valid or has numbers that this does not
/// take, and nothing else is said.
struct alignas(64) RayLines {
  static constexpr int size = RayBundle::size;
  double start[3][size], direction[3][size], across[2][3][size];
  double near[size], far[size], enter[size], leave[size], slack[size];
  double base[size], shift[size], speed[size];
  double plain[size];
};

/// Roots of a patch to be polished on rays side by side: control points x y z x y z .., `[i][j]`; lines and points in the
/// coordinates scale (p - centre). Roots are looked for inside [u0, u1] x [v0, v1].
struct PolishJob {
  static constexpr int max_steps = 6;
  const double *points, *weights;  ///< no weights of a polynomial patch
  int degree_u, degree_v;
  double centre[3], scale;
  double u0, u1, v0, v1;
  double linear;  ///< the last step is at most that: it leaves a square of it
};
struct alignas(64) PolishedRays {
  static constexpr int size = RayPacket::size;
  static constexpr double idle = 0, asked = 1, found = 2, failed = 3;
  double start[3][size], direction[3][size], across[2][3][size];  ///< of the lines
  double state[size];                                             ///< `asked`, then `found` or `failed`; others stay
  double u[size], v[size], reach_u[size], reach_v[size];          ///< begin, and leave it by no more
  double root_u[size], root_v[size], s[size];                     ///< where found
  double position[3][size], du[3][size], dv[3][size];
};

/// Rays side by side. Each has the numbers that it has alone.
struct RayPacketKernels {
  void (*lines)(const RayBundle& rays, const RayRoom& room, RayLines& lines);
  /// As those of RayKernels, for the rays whose bits are set in `lanes`, as far as one rectangle decides; of other rays
  /// `state` means nothing.
  void (*trace_polynomial_leaf)(const RayLeaf& leaf, RayPacket& rays, unsigned lanes);
  void (*trace_rational_leaf)(const RayLeaf& leaf, RayPacket& rays, unsigned lanes);
  /// Of bicubic patches, and of rational ones of degrees up to three.
  void (*polish_cubic)(const PolishJob& job, PolishedRays& rays, unsigned lanes);
  void (*polish_low_rational)(const PolishJob& job, PolishedRays& rays, unsigned lanes);
};

struct RayKernels {
  /// Null where vectors are too short to pay, or have no fused multiply-add.
  const RayPacketKernels* packets;
  /// All roots of the piece on the ray with s in [near, far] (and perhaps others a rounding outside of that). Where any will
  /// do and one is met inside, that is the first, and others may be left out. False: undecided, whatever `roots` holds.
  bool (*trace_polynomial_leaf)(const RayLeaf& leaf, const RayProbe& ray, RayRoots& roots);
  bool (*trace_rational_leaf)(const RayLeaf& leaf, const RayProbe& ray, RayRoots& roots);
  /// Position less `origin` and both derivatives of a bicubic patch at (u,v) in [0,1]^2, from its control points x y z
  /// x y z .., `[i][j]`, by convex combinations.
  void (*cubic_point)(const double* points, const double* origin, double u, double v, RayPoint& out);
  /// The same of a rational patch of degrees m, n up to 3.
  void (*low_rational_point)(const double* points, const double* weights, int m, int n, const double* origin, double u,
                             double v, RayPoint& out);
};

}  // namespace tessera::inline abi_0_1::kernel
