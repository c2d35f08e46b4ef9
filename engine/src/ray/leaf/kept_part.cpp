#include "ray/leaf/kept_part.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/impl_access.h"
#include "trim/trim_region_impl.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
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

  bool is_empty() const { return !(hull_.u0 <= hull_.u1); }
  const Domain& hull() const { return hull_; }

  /// A piece is monotone, so that each part of it lies in the box of its ends.
  void add(const TrimPiece& piece) {
    const ParameterPoint size = distance(piece.start(), piece.end());
    const ParameterPoint off = off_ + 2 * piece.error + 1e-13 * (size + distance(piece.start(), middle_));
    if (!meets({piece.lower_u(), piece.upper_u(), piece.lower_v(), piece.upper_v()}, off)) return;
    ParameterPoint from = piece.start();
    for (int k = 1; k <= parts_per_piece; ++k) {
      const ParameterPoint to = k == parts_per_piece ? piece.end() : point(piece, k);
      const Domain box{std::min(from.u, to.u), std::max(from.u, to.u), std::min(from.v, to.v), std::max(from.v, to.v)};
      if (meets(box, off)) add(box.u0 - off.u, box.u1 + off.u, box.v0 - off.v, box.v1 + off.v);
      from = to;
    }
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
  for (const std::uint32_t piece : pieces) found.add(impl_of(region).pieces[piece]);
  if (found.is_empty()) {
    switch (region.locate((rectangle.u0 + rectangle.u1) / 2, (rectangle.v0 + rectangle.v1) / 2)) {
      case TrimSide::inside:
        return {PatchUse::whole, rectangle};
      case TrimSide::outside:
        return {PatchUse::out, rectangle};
      default:
        return {PatchUse::cut, rectangle};
    }
  }
  for (const double u : {rectangle.u0, rectangle.u1})
    for (const double v : {rectangle.v0, rectangle.v1})
      if (region.locate(u, v) != TrimSide::outside) found.add(u, v);
  return {PatchUse::cut, found.hull()};
}

}  // namespace tessera::inline abi_0_1
