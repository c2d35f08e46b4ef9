#pragma once
// Finds the points of curves that are nearest to given ones.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "tessera/curve.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/nearest_points.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The point of several curves that is nearest to a given one.
struct NearestCurvePoint {
  NearestKind kind = NearestKind::none;                       ///< whether the other members are meaningful
  NearestFlags flags;                                         ///< certified, ambiguous, and border: an end or a corner
  std::uint32_t curve = 0;                                    ///< index of the curve
  double t = 0;                                               ///< in the curve's domain
  Vec3 position;                                              ///< on the curve at t
  double distance = std::numeric_limits<double>::infinity();  ///< from the point that was asked for
  double rounding = 0;                                        ///< bounds the rounding of the distance
};

/// Curves prepared for queries by points: edges, p-curves (whose z is 0), wires.
///
/// Method: Bezier pieces are cut until they are nearly straight, and lie in a tree of boxes. Within a piece, bounds of
/// the second derivative prove that the distance is convex, then false position finds its one minimum; other pieces are
/// halved.
///
/// Memory: the scene copies the curves; about 300 bytes for each piece. Threads: const calls from any number of
/// threads, with the same results.
class CurveScene {
 public:
  /// Prepares curves, at least one. Errors: invalid_argument (no curve), unsupported (the box of the control points has
  /// a diagonal outside of 1e-140 to 1e140), isa_unavailable, cancelled, out_of_memory.
  static Result<CurveScene> make(std::span<const Curve> curves, const Execution& execution = {});

  CurveScene(CurveScene&&) noexcept;
  CurveScene& operator=(CurveScene&&) noexcept;
  ~CurveScene();

  /// Finds the nearest point of the curves to each point.
  ///
  /// - `nearest`: at least as many as there are points. A point that is not finite is NearestKind::invalid_point.
  /// - `max_distance`: curves farther away count as none; at least 0.
  ///
  /// If several points are equally near, the one of the first curve is returned.
  ///
  /// Errors: buffer_too_small, invalid_argument (max_distance), cancelled, out_of_memory.
  Status nearest(std::span<const Vec3> points, std::span<NearestCurvePoint> nearest,
                 double max_distance = std::numeric_limits<double>::infinity(), const Execution& execution = {}) const;
  /// Finds the nearest point to one point. An error returns NearestKind::invalid_point.
  NearestCurvePoint nearest(const Vec3& point, double max_distance = std::numeric_limits<double>::infinity()) const;

  std::size_t memory_bytes() const;  ///< of pieces and tree

  class [[gnu::visibility("hidden")]] Impl;

 private:
  explicit CurveScene(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
