// On which side of their pieces regions are kept.

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#include "measure/kept_strips.h"
#include "trim/piece_side.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The parity of the pieces that a ray towards larger u meets, from a point of a piece.
class Sweep {
 public:
  explicit Sweep(const std::vector<TrimPiece>& pieces) : pieces_(pieces), by_start_(pieces.size()) {
    std::iota(by_start_.begin(), by_start_.end(), std::size_t{0});
    std::ranges::sort(by_start_, {}, [&](std::size_t k) { return std::pair(pieces[k].lower_v(), k); });
  }

  /// `starts_inside`: whether points that no piece encloses are kept. `t`: the parameter of the points.
  PieceSigns run(bool starts_inside, double t) {
    PieceSigns found;
    found.signs.assign(pieces_.size(), 0);
    std::vector<ParameterPoint> middles;
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      middles.push_back(relative_point(pieces_[k].curve, {0, 0}, t));
      if (pieces_[k].lower_v() < pieces_[k].upper_v()) order.push_back(k);
    }
    std::ranges::sort(order, {}, [&](std::size_t k) { return std::pair(middles[k].v, k); });
    for (const std::size_t k : order) {
      advance(middles[k].v);
      bool is_kept_right = starts_inside;
      for (const std::size_t other : active_) {
        if (other == k) continue;
        const PieceSide side = side_of(pieces_[other], middles[k]);
        if (side == PieceSide::near) found.is_certain = false;
        is_kept_right ^= side == PieceSide::left || (side == PieceSide::near && other > k);
      }
      found.signs[k] = is_kept_right ? -1 : 1;
    }
    return found;
  }

 private:
  /// Lists the pieces that have a point at this height, and perhaps others.
  void advance(double v) {
    for (; next_ < by_start_.size() && pieces_[by_start_[next_]].lower_v() <= v; ++next_)
      active_.push_back(by_start_[next_]);
    std::erase_if(active_, [&](std::size_t k) { return pieces_[k].upper_v() < v; });
  }

  const std::vector<TrimPiece>& pieces_;
  std::vector<std::size_t> by_start_, active_;
  std::size_t next_ = 0;
};

ParameterPoint exchanged(const ParameterPoint& p) { return {p.v, p.u}; }

/// Pieces with u and v exchanged.
std::vector<TrimPiece> exchanged(std::vector<TrimPiece> pieces) {
  for (TrimPiece& piece : pieces) {
    for (ParameterPoint& point : piece.curve.points) point = exchanged(point);
    piece.line_from = exchanged(piece.line_from), piece.line_to = exchanged(piece.line_to);
    piece.error = exchanged(piece.error);
  }
  return pieces;
}

/// Adds what pieces tell of their loops. `left`: on which side of a piece with growing v smaller u lies, 1 or -1.
void vote(const std::vector<TrimPiece>& pieces, bool starts_inside, int left, std::vector<int>& votes) {
  const PieceSigns found = piece_signs(pieces, starts_inside);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (pieces[k].loop >= votes.size()) continue;
    votes[pieces[k].loop] += left * found.signs[k] * (pieces[k].start().v < pieces[k].end().v ? 1 : -1);
  }
}

/// Gives all pieces of a loop the direction that nearly all have, by length: where a loop crosses itself in a kink no
/// larger than its gaps, the border remains a closed curve.
void follow_loops(const TrimRegion::Impl& region, std::vector<std::int8_t>& directions) {
  std::map<std::uint32_t, std::array<double, 2>> lengths;  // of pieces with the kept part on their right and left
  const double wide = region.lines.u.period(), high = region.lines.v.period();
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const TrimPiece& piece = region.pieces[k];
    if (piece.loop == no_id || directions[k] == 0) continue;
    const ParameterPoint size = distance(piece.start(), piece.end());
    lengths[piece.loop][directions[k] > 0 ? 1 : 0] += size.u / wide + size.v / high;
  }
  constexpr double small = 0.02;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const auto found = lengths.find(region.pieces[k].loop);
    if (found == lengths.end()) continue;
    const auto [right, left] = found->second;
    if (std::min(right, left) <= small * std::max(right, left)) directions[k] = left > right ? 1 : -1;
  }
}

}  // namespace

PieceSigns piece_signs(const std::vector<TrimPiece>& pieces, bool starts_inside) {
  PieceSigns found = Sweep(pieces).run(starts_inside, 0.5);
  // Where pieces cross, the kept side changes along a piece, or from one piece of a loop to the next.
  found.is_crossed.assign(pieces.size(), false);
  for (const double t : {0.0625, 0.9375}) {
    const PieceSigns other = Sweep(pieces).run(starts_inside, t);
    for (std::size_t k = 0; k < pieces.size(); ++k)
      if (other.signs[k] != found.signs[k]) found.is_crossed[k] = true, found.is_certain = false;
  }
  std::uint32_t loops = 0;
  for (const TrimPiece& piece : pieces)
    if (piece.loop != no_id) loops = std::max(loops, piece.loop + 1);
  std::vector<int> directions(loops, 0);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (pieces[k].loop == no_id || found.signs[k] == 0) continue;
    const int direction = found.signs[k] * (pieces[k].start().v < pieces[k].end().v ? 1 : -1);
    int& of_loop = directions[pieces[k].loop];
    if (of_loop == -direction) found.is_certain = false;
    if (of_loop == 0) of_loop = direction;
  }
  return found;
}

std::vector<std::int8_t> piece_directions(const TrimRegion::Impl& region) {
  const std::vector<TrimPiece>& pieces = region.pieces;
  std::vector<std::int8_t> directions = Sweep(pieces).run(region.starts_inside, 0.5).signs;
  bool is_all = true;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (pieces[k].start().v > pieces[k].end().v) directions[k] = static_cast<std::int8_t>(-directions[k]);
    is_all = is_all && directions[k] != 0;
  }
  if (!is_all) {
    const std::vector<TrimPiece> turned = exchanged(pieces);
    const std::vector<std::int8_t> by_u = Sweep(turned).run(region.starts_inside, 0.5).signs;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const int sign = pieces[k].start().u < pieces[k].end().u ? -1 : 1;
      if (directions[k] == 0) directions[k] = static_cast<std::int8_t>(sign * by_u[k]);
    }
  }
  follow_loops(region, directions);
  return directions;
}

std::vector<std::int8_t> loop_directions(const TrimRegion::Impl& region, std::size_t loops) {
  std::vector<int> votes(loops, 0);
  vote(region.pieces, region.starts_inside, 1, votes);
  vote(exchanged(region.pieces), region.starts_inside, -1, votes);
  std::vector<std::int8_t> directions;
  for (const int sum : votes) directions.push_back(static_cast<std::int8_t>(sum > 0 ? 1 : sum < 0 ? -1 : 0));
  return directions;
}

}}  // namespace tessera::abi_0_1
