#pragma once
// Trimming loops of a face, and how they are repaired.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tessera/brep.h"
#include "tessera/curve.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A closed chain of curves in the surface's parameters (x = u, y = v; z is ignored). The inside of a hole is cut away,
/// and so is the outside of all other loops.
struct TrimLoop {
  std::vector<Curve> curves;                                           ///< each begins where the one before it ends
  bool hole = false;                                                   ///< if false, the outside is cut away
  std::vector<Coedge> coedges = {};                                    ///< of a Shape's face: the edge of each curve
  friend bool operator==(const TrimLoop&, const TrimLoop&) = default;  ///< by the curves, in order, and the rest
};

/// A fault of a loop, and how it was repaired.
enum class LoopFault : std::uint8_t {
  empty,     ///< it has no curves, or all of them are points; it is ignored
  gap,       ///< the ends of curves differ; a straight line joins them
  retraced,  ///< parts run back over themselves; they bound nothing and are dropped
  outside,   ///< parts lie outside of the domain; they are cut off along its sides
  open,      ///< it runs around a periodic surface, and no other loop closes it; the part on its left is kept
};

/// A remark about a loop, at most one per loop and kind.
struct LoopRemark {
  std::size_t loop = 0;              ///< index into the loops
  LoopFault fault = LoopFault::gap;  ///< the kind
  double size = 0;                   ///< the largest gap or the farthest excursion, in parameters; 0 for other kinds
  std::string text = {};             ///< a sentence that names the loop: "loop 2: ..."
};

/// How loops are repaired.
struct TrimOptions {
  /// Whether u of both ends of the domain is the same line of the surface, as on a cylinder. A loop may then cross this
  /// seam, and run around the surface.
  bool periodic_u = false;
  bool periodic_v = false;  ///< like periodic_u, for v
  /// Ends of curves, and curves along a line between patches, move by at most this share of the domain's width and
  /// height to meet. From 0 to 1e-3. Each such displacement widens band().
  double snap = 0x1p-44;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
