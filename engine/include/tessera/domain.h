#pragma once
// Parameter rectangles and their edges.

#include <cstdint>

#pragma GCC visibility push(default)
namespace tessera {

/// The rectangle [u0, u1] x [v0, v1] of parameters, u0 < u1 and v0 < v1.
struct Domain {
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;  ///< u0 < u1, v0 < v1

  /// From local parameters in [0,1]^2 to this rectangle; exact at 0 and 1.
  double u_at(double s) const { return s == 1 ? u1 : u0 + s * (u1 - u0); }
  double v_at(double t) const { return t == 1 ? v1 : v0 + t * (v1 - v0); }  ///< as u_at
  /// From this rectangle to local parameters; exact at the ends.
  double local_u(double u) const { return u == u1 ? 1 : (u - u0) / (u1 - u0); }
  double local_v(double v) const { return v == v1 ? 1 : (v - v0) / (v1 - v0); }                 ///< as local_u
  bool contains(double u, double v) const { return u >= u0 && u <= u1 && v >= v0 && v <= v1; }  ///< borders included

  friend bool operator==(const Domain&, const Domain&) = default;  ///< by all four
};

/// The four edges of a patch, as bits of a mask.
enum class Edge : std::uint8_t { u0 = 1, u1 = 2, v0 = 4, v1 = 8 };

/// A set of edges.
struct EdgeMask {
  std::uint8_t bits = 0;  ///< one an edge, as Edge numbers them
  /// Whether the edge is in the set.
  bool has(Edge edge) const { return (bits & static_cast<std::uint8_t>(edge)) != 0; }
  /// Puts the edge into the set.
  void add(Edge edge) { bits = static_cast<std::uint8_t>(bits | static_cast<std::uint8_t>(edge)); }
  bool any() const { return bits != 0; }  ///< whether an edge is in the set
};

}  // namespace tessera
#pragma GCC visibility pop
