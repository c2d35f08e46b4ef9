#include "ray/leaf/kept_part.h"

#include <cmath>
#include <limits>

#include "base/impl_access.h"
#include "base/infinity.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int parts_per_piece = 16;

/// How far a side of a rectangle may be off.
double off_of(double from, double to) {
  return 1e-9 * (to - from) + 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(from), std::abs(to));
}

/// The hull of the parts of pieces within a rectangle.
class HullOfPieces {
 public:
  explicit HullOfPieces(const Domain& rectangle)
      : rectangle_(rectangle),
        off_{off_of(rectangle.u0, rectangle.u1), off_of(rectangle.v0, rectangle.v1)},
        middle_{0.5 * rectangle.u0 + 0.5 * rectangle.u1, 0.5 * rectangle.v0 + 0.5 * rectangle.v1} {}

  const Domain& hull() const { return hull_; }

  /// Adds a piece, and returns whether it may pass through the rectangle. It is monotone, so that each part of it lies
  /// in the box of its ends.
  bool add(const TrimPiece& piece) {
    const ParameterPoint size = distance(piece.start(), piece.end());
    const ParameterPoint off = off_ + 2 * piece.error + 1e-13 * (size + distance(piece.start(), middle_));
    if (!meets({piece.lower_u(), piece.upper_u(), piece.lower_v(), piece.upper_v()}, off)) return false;
    ParameterPoint from = piece.start();
    bool passes = false;
    for (int k = 1; k <= parts_per_piece; ++k) {
      const ParameterPoint to = k == parts_per_piece ? piece.end() : point(piece, k);
      const Domain box{std::min(from.u, to.u), std::max(from.u, to.u), std::min(from.v, to.v), std::max(from.v, to.v)};
      from = to;
      if (!meets(box, off)) continue;
      add(box.u0 - off.u, box.u1 + off.u, box.v0 - off.v, box.v1 + off.v);
      passes = true;
    }
    return passes;
  }
  void add(double u, double v) { add(u, u, v, v); }

 private:
  ParameterPoint point(const TrimPiece& piece, int part) const {
    return middle_ + relative_point(piece.curve, middle_, static_cast<double>(part) / parts_per_piece);
  }
  bool meets(const Domain& box, const ParameterPoint& off) const {
    return box.u0 - off.u <= rectangle_.u1 && box.u1 + off.u >= rectangle_.u0 && box.v0 - off.v <= rectangle_.v1 &&
           box.v1 + off.v >= rectangle_.v0;
  }
  void add(double u0, double u1, double v0, double v1) {
    hull_.u0 = std::min(hull_.u0, std::max(u0, rectangle_.u0)),
    hull_.u1 = std::max(hull_.u1, std::min(u1, rectangle_.u1));
    hull_.v0 = std::min(hull_.v0, std::max(v0, rectangle_.v0)),
    hull_.v1 = std::max(hull_.v1, std::min(v1, rectangle_.v1));
  }

  const Domain rectangle_;
  const ParameterPoint off_, middle_;
  Domain hull_{infinity, -infinity, infinity, -infinity};
};

}  // namespace

KeptPart kept_part(const TrimRegion& region, std::span<const std::uint32_t> pieces, const Domain& rectangle) {
  HullOfPieces found(rectangle);
  KeptPart kept{PatchUse::cut, rectangle, {}};
  for (const std::uint32_t piece : pieces)
    if (found.add(impl_of(region).pieces[piece])) kept.pieces.push_back(piece);
  if (kept.pieces.empty()) {
    const TrimSide side = region.locate((rectangle.u0 + rectangle.u1) / 2, (rectangle.v0 + rectangle.v1) / 2);
    if (side != TrimSide::border) kept.use = side == TrimSide::inside ? PatchUse::whole : PatchUse::out;
    return kept;
  }
  for (const double u : {rectangle.u0, rectangle.u1})
    for (const double v : {rectangle.v0, rectangle.v1})
      if (region.locate(u, v) != TrimSide::outside) found.add(u, v);
  kept.hull = found.hull();
  return kept;
}

}}  // namespace tessera::abi_0_1
