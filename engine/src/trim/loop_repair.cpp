#include "trim/loop_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "base/text.h"
#include "trim/loop_pieces.h"
#include "trim/monotone_pieces.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Parts of a loop that run back over themselves.

class RetracedPairs {
 public:
  RetracedPairs(std::vector<TrimPiece>& pieces, double snap_u, double snap_v)
      : pieces_(pieces), snap_u_(snap_u), snap_v_(snap_v), dropped_(pieces.size(), false) {}

  std::size_t drop() {
    // Both directions of a curve have nearly one sum of ends. Its coordinates are mixed by an irrational number, so
    // that neither curves with their middles at one u nor those at one v share a key.
    const double mix = 0.7548776662466927 * (snap_u_ > 0 && snap_v_ > 0 ? snap_u_ / snap_v_ : 1);
    const double window = 4 * (snap_u_ + mix * snap_v_);
    std::vector<std::pair<double, std::uint32_t>> order;  // key, piece
    order.reserve(pieces_.size());
    for (const TrimPiece& piece : pieces_) {
      const ParameterPoint &a = piece.start(), &b = piece.end();
      order.emplace_back((a.u + b.u) + mix * (a.v + b.v), static_cast<std::uint32_t>(order.size()));
    }
    std::ranges::sort(order);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto [key, first] = order[i];
      if (dropped_[first]) continue;
      for (std::size_t j = i + 1; j < order.size() && order[j].first - key <= window; ++j) {
        const std::uint32_t second = order[j].second;
        if (dropped_[second]) continue;
        const TrimPiece &a = pieces_[first], &b = pieces_[second];
        const bool forward = same(a, b, false);
        if (!forward && !same(a, b, true)) continue;
        dropped_[first] = dropped_[second] = true;
        join(a.start(), forward ? b.start() : b.end(), a.loop);
        join(a.end(), forward ? b.end() : b.start(), a.loop);
        break;
      }
    }
    const auto count = static_cast<std::size_t>(std::count(dropped_.begin(), dropped_.end(), true));
    if (count == 0) return 0;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < dropped_.size(); ++k) {
      if (dropped_[k]) continue;
      if (kept != k) pieces_[kept] = std::move(pieces_[k]);
      ++kept;
    }
    pieces_.resize(kept);
    pieces_.insert(pieces_.end(), joints_.begin(), joints_.end());
    return count;
  }

 private:
  bool same(const TrimPiece& a, const TrimPiece& b, bool reversed) const {
    const std::size_t count = a.curve.points.size();
    if (b.curve.points.size() != count) return false;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t j = reversed ? count - 1 - i : i;
      const ParameterPoint &p = a.curve.points[i], &q = b.curve.points[j];
      if (!(std::abs(p.u - q.u) <= snap_u_ && std::abs(p.v - q.v) <= snap_v_)) return false;
    }
    // Weights up to a common factor.
    const double wa = a.curve.weight(0), wb = b.curve.weight(reversed ? count - 1 : 0);
    for (std::size_t i = 1; i < count; ++i) {
      const double x = a.curve.weight(i) * wb, y = b.curve.weight(reversed ? count - 1 - i : i) * wa;
      if (!(std::abs(x - y) <= 1e-14 * (x + y))) return false;
    }
    return true;
  }

  /// Adds the line from a to b, or takes it away where it was added before.
  void join(const ParameterPoint& a, const ParameterPoint& b, std::uint32_t loop) {
    if (a == b) return;
    const auto same_line = [&](const TrimPiece& joint) {
      return (joint.start() == a && joint.end() == b) || (joint.start() == b && joint.end() == a);
    };
    const auto found = std::find_if(joints_.begin(), joints_.end(), same_line);
    if (found != joints_.end())
      joints_.erase(found);
    else
      joints_.push_back(line_piece(a, b, loop));
  }

  std::vector<TrimPiece>& pieces_;
  double snap_u_, snap_v_;
  std::vector<bool> dropped_;
  std::vector<TrimPiece> joints_;
};

/// Drops pairs of pieces that are the same curve within `snap_u` and `snap_v`, in the same direction or in opposite
/// ones: no point lies between them. Lines as short as that join what is left. Returns how many pieces were dropped.
std::size_t drop_retraced(std::vector<TrimPiece>& pieces, double snap_u, double snap_v) {
  return RetracedPairs(pieces, snap_u, snap_v).drop();
}

using Coordinate = double ParameterPoint::*;

bool is_less(const ParameterPoint& a, const ParameterPoint& b) { return a.u != b.u ? a.u < b.u : a.v < b.v; }

/// The points in which an odd number of ends meet, in order.
std::vector<ParameterPoint> odd_ends(const std::vector<TrimPiece>& pieces) {
  std::vector<ParameterPoint> ends;
  ends.reserve(8);
  for (const TrimPiece& piece : pieces) {
    if (!ends.empty() && ends.back() == piece.start())  // most pieces follow each other
      ends.pop_back();
    else
      ends.push_back(piece.start());
    ends.push_back(piece.end());
  }
  std::sort(ends.begin(), ends.end(), is_less);
  std::size_t count = 0;
  for (const ParameterPoint& end : ends)
    if (count > 0 && ends[count - 1] == end)
      --count;
    else
      ends[count++] = ParameterPoint(end);
  ends.resize(count);
  return ends;
}

/// One direction of the domain, and the other one.
struct Direction {
  const CutAxis& axis;
  const CutAxis& other;
  Coordinate x, y;

  ParameterPoint point(double along, double across) const {
    ParameterPoint p;
    p.*x = along;
    p.*y = across;
    return p;
  }
};

class LoopRepair {
 public:
  LoopRepair(std::span<const TrimLoop> loops, const CutLines& lines, CurveExtractions& extractions)
      : loops_(loops), lines_(lines), extractions_(extractions) {}

  Result<RepairedLoops> repair() {
    bool all_holes = true;
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      Result<LoopPieces> loop = loop_pieces(loops_[k], static_cast<std::uint32_t>(k), lines_, extractions_);
      if (!loop) return named(loop.status(), k);
      tell_gaps(k, *loop);
      std::erase_if(loop->pieces, [](const TrimPiece& piece) { return piece.start() == piece.end(); });
      if (!encloses(k, *loop)) continue;
      all_holes = all_holes && loops_[k].hole;
      tell_excursion(k, loop->pieces);
      move_inside(loop->pieces, lines_.u, &ParameterPoint::u);
      move_inside(loop->pieces, lines_.v, &ParameterPoint::v);
      if ((loop->turns_u != 0 || loop->turns_v != 0) && turning_loop_ == none) turning_loop_ = k;
      turns_u_ += loop->turns_u;
      turns_v_ += loop->turns_v;
      holds_corner_[0] ^= loop->holds_left;
      holds_corner_[1] ^= loop->holds_right;
      if (made_.pieces.empty())
        made_.pieces = std::move(loop->pieces);
      else
        std::move(loop->pieces.begin(), loop->pieces.end(), std::back_inserter(made_.pieces));
    }
    made_.starts_inside = all_holes;
    const Direction u{lines_.u, lines_.v, &ParameterPoint::u, &ParameterPoint::v};
    const Direction v{lines_.v, lines_.u, &ParameterPoint::v, &ParameterPoint::u};
    // Left of a loop that runs towards larger u is larger v; left of one towards larger v is smaller u.
    clip(u, turns_u_ > 0, lines_.u.periodic && lines_.v.periodic ? &holds_corner_ : nullptr);
    clip(v, turns_v_ < 0, nullptr);  // the sides of u end in the corners already
    if (!odd_ends(made_.pieces).empty())
      return Status(StatusCode::internal, "the trimming loops could not be closed within the surface's domain");
    return std::move(made_);
  }

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  static Status named(const Status& status, std::size_t k) {
    if (status.index() == static_cast<std::ptrdiff_t>(k)) return status;
    return Status(status.code(), "loop " + std::to_string(k) + ": " + status.message(), static_cast<std::ptrdiff_t>(k));
  }

  void tell(std::size_t k, LoopFault fault, double size, const std::string& what) {
    made_.remarks.push_back({k, fault, size, "loop " + std::to_string(k) + ": " + what});
  }

  void tell_gaps(std::size_t k, const LoopPieces& loop) {
    if (loop.gaps == 0) return;
    const std::size_t next = (loop.gap_curve + 1) % loops_[k].curves.size();
    const std::string where = " between curves " + std::to_string(loop.gap_curve) + " and " + std::to_string(next);
    tell(k, LoopFault::gap, loop.largest_gap,
         loop.gaps == 1 ? "a straight line closes a gap of " + text(loop.largest_gap) + where
                        : "straight lines close " + std::to_string(loop.gaps) + " gaps, the largest of " +
                              text(loop.largest_gap) + where);
  }

  /// Drops what bounds nothing. Whether anything is left.
  bool encloses(std::size_t k, LoopPieces& loop) {
    if (loop.pieces.empty()) {
      tell(k, LoopFault::empty, 0, loops_[k].curves.empty() ? "it has no curves" : "all of its curves are points");
      return false;
    }
    const std::size_t dropped = drop_retraced(loop.pieces, lines_.u.snap, lines_.v.snap);
    drop_seams(loop, lines_.u, &ParameterPoint::u);
    drop_seams(loop, lines_.v, &ParameterPoint::v);
    if (loop.pieces.empty()) {
      tell(k, LoopFault::retraced, 0, "it runs back over itself and encloses nothing, so it is ignored");
      return false;
    }
    if (dropped > 0)
      tell(k, LoopFault::retraced, 0,
           counted(dropped, "piece") + " of it that run over each other bound nothing and are dropped");
    return true;
  }

  static bool on_side(const TrimPiece& piece, const CutAxis& axis, Coordinate x) {
    return piece.start().*x == piece.end().*x && (piece.start().*x == axis.from() || piece.start().*x == axis.to());
  }

  /// Empties a loop that runs along a seam alone.
  static void drop_seams(LoopPieces& loop, const CutAxis& axis, Coordinate x) {
    if (!axis.periodic) return;
    if (std::all_of(loop.pieces.begin(), loop.pieces.end(), [&](const TrimPiece& p) { return on_side(p, axis, x); }))
      loop.pieces.clear();
  }

  void tell_excursion(std::size_t k, const std::vector<TrimPiece>& pieces) {
    double size = 0;
    for (const TrimPiece& piece : pieces) {
      if (!lines_.u.periodic)
        size = std::max({size, lines_.u.from() - piece.lower_u(), piece.upper_u() - lines_.u.to()});
      if (!lines_.v.periodic)
        size = std::max({size, lines_.v.from() - piece.lower_v(), piece.upper_v() - lines_.v.to()});
    }
    if (size > std::max(lines_.u.snap, lines_.v.snap))
      tell(k, LoopFault::outside, size, "it leaves the surface's domain by " + text(size) + " and is cut off there");
  }

  /// Moves pieces that lie hardly outside onto the side there: domains are often the boxes of loops, up to the digits
  /// of a file. So they remain parts of their curves.
  static void move_inside(std::vector<TrimPiece>& pieces, const CutAxis& axis, Coordinate x) {
    if (axis.periodic) return;
    const double most = 0x1p-13 * axis.period();
    for (TrimPiece& piece : pieces) {
      const auto [lower, upper] = std::minmax({piece.start().*x, piece.end().*x});
      if (lower >= axis.from() && upper <= axis.to()) continue;
      if (lower < axis.from() - most || upper > axis.to() + most) continue;
      double moved = 0;
      for (ParameterPoint& point : piece.curve.points) {
        const double inside = std::clamp(point.*x, axis.from(), axis.to());
        moved = std::max(moved, std::abs(point.*x - inside));
        point.*x = inside;
      }
      piece.error.*x += moved;
      piece.exact_line = false;
    }
  }

  /// Cuts off what lies beyond the sides of one direction, or on the seam of a periodic one, and closes the rest along
  /// the sides. `towards_upper`: where a loop runs around the surface alone, the part towards the upper side of the
  /// other direction is kept. `from_corners`: whether each side begins within the loops, if that
  /// does not follow from their ends.
  void clip(const Direction& d, bool towards_upper, const std::array<bool, 2>* from_corners) {
    const auto is_outside = [&](const TrimPiece& piece) {
      return std::min(piece.start().*d.x, piece.end().*d.x) < d.axis.from() ||
             std::max(piece.start().*d.x, piece.end().*d.x) > d.axis.to();
    };
    std::vector<TrimPiece>& pieces = made_.pieces;
    if (!d.axis.periodic && std::none_of(pieces.begin(), pieces.end(), is_outside)) return;
    std::array<std::vector<TrimPiece>, 2> along;  // pieces on the sides, which close the rest where they can
    for (const TrimPiece& piece : pieces)
      if (on_side(piece, d.axis, d.x)) along[piece.start().*d.x == d.axis.to()].push_back(piece);
    std::erase_if(pieces, [&](const TrimPiece& piece) { return is_outside(piece) || on_side(piece, d.axis, d.x); });
    const std::vector<ParameterPoint> odd = odd_ends(pieces);
    const double sides[] = {d.axis.from(), d.axis.to()};
    std::array<std::vector<double>, 2> heights;
    for (const ParameterPoint& p : odd)
      for (std::size_t side = 0; side < 2; ++side)
        if (p.*d.x == sides[side]) heights[side].push_back(p.*d.y);
    for (std::vector<double>& list : heights) std::sort(list.begin(), list.end());
    for (std::size_t side = 0; from_corners && side < 2; ++side) add_corners(d, (*from_corners)[side], heights[side]);
    if (heights[0].size() % 2 != 0 && heights[1].size() % 2 != 0) close_at_far_side(d, towards_upper, heights);
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t k = 0; k + 1 < heights[side].size(); k += 2)
        close_along(d, sides[side], heights[side][k], heights[side][k + 1], along[side]);
  }

  /// Closes a part of a side: by the pieces that lie there, and by lines between them.
  void close_along(const Direction& d, double side, double from, double to, std::vector<TrimPiece>& along) {
    const auto lower = [&](const TrimPiece& piece) { return std::min(piece.start().*d.y, piece.end().*d.y); };
    std::ranges::sort(along, {}, lower);
    double at = from;
    for (const TrimPiece& piece : along) {
      const double end = std::max(piece.start().*d.y, piece.end().*d.y);
      if (lower(piece) < at || end > to) continue;
      append_line(d.point(side, at), d.point(side, lower(piece)));
      made_.pieces.push_back(piece);
      at = end;
    }
    append_line(d.point(side, at), d.point(side, to));
  }

  /// Adds the ends of a side to the heights at which it enters and leaves the loops, where it begins or ends within.
  void add_corners(const Direction& d, bool begins_within, std::vector<double>& heights) const {
    const bool turns = turning_loop_ != none;  // then a side may stay within, or end elsewhere
    const bool enters_at_corner = !turns && !heights.empty() && heights.front() == d.other.from();
    if (begins_within != enters_at_corner) heights.insert(heights.begin(), d.other.from());
    if (turns ? begins_within : heights.size() % 2 != 0) heights.push_back(d.other.to());
  }

  /// A loop that runs around the surface alone: one of the domain's sides across closes it.
  void close_at_far_side(const Direction& d, bool towards_upper, std::array<std::vector<double>, 2>& heights) {
    for (const std::vector<double>& list : heights) {  // not where the loop itself runs along that side
      if (list.front() == d.other.from()) towards_upper = true;
      if (list.back() == d.other.to()) towards_upper = false;
    }
    const double far = towards_upper ? d.other.to() : d.other.from();
    for (std::vector<double>& list : heights) list.insert(towards_upper ? list.end() : list.begin(), far);
    append_line(d.point(d.axis.from(), far), d.point(d.axis.to(), far));
    if (turning_loop_ != none)
      tell(turning_loop_, LoopFault::open, 0,
           "it runs around the surface and no other loop closes it, so the part on its left is kept");
  }

  void append_line(const ParameterPoint& from, const ParameterPoint& to) {
    if (from == to) return;
    CutLines exact = lines_;  // the ends stay as they are
    exact.u.snap = exact.v.snap = 0;
    append_monotone_pieces({{from, to}, {}}, {}, {}, exact, made_.pieces);
  }

  std::span<const TrimLoop> loops_;
  const CutLines& lines_;
  CurveExtractions& extractions_;
  RepairedLoops made_;
  int turns_u_ = 0, turns_v_ = 0;
  std::array<bool, 2> holds_corner_{};  ///< whether loops enclose the corner where both seams meet, on either side
  std::size_t turning_loop_ = none;
};

}  // namespace

Result<RepairedLoops> repair_loops(std::span<const TrimLoop> loops, const CutLines& lines, CurveExtractions* shared) {
  CurveExtractions own;
  return LoopRepair(loops, lines, shared ? *shared : own).repair();
}

}}  // namespace tessera::abi_0_1
