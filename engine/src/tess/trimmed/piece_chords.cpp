#include "tess/trimmed/piece_chords.h"

#include <algorithm>
#include <cmath>

namespace tessera::inline abi_0_1 {

double PieceChords::append(const TrimPiece& piece, const ChordLimits& limits, std::vector<ParameterPoint>& points) {
  piece_ = &piece;
  limits_ = &limits;
  points_ = &points;
  degree_ = piece.curve.degree();
  error_ = piece.error.u * limits.speed.u + piece.error.v * limits.speed.v;
  most_ = error_;
  Net net;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(degree_); ++k) {
    const double weight = piece.curve.weight(k);
    const ParameterPoint& point = piece.curve.points[k];
    net[k] = {weight * (point.u - piece.start().u), weight * (point.v - piece.start().v), weight};
  }
  divide(net, 0);
  return most_;
}

// Points are kept within the box of the piece, which rounding could leave, so they never pass a line between patches.
void PieceChords::divide(const Net& net, int depth) {
  const std::size_t last = static_cast<std::size_t>(degree_);
  const ParameterPoint a = net[0].point(), b = net[last].point();
  const double du = std::abs(b.u - a.u), dv = std::abs(b.v - a.v);
  double cross = 0;
  for (std::size_t k = 1; k < last; ++k) {
    const ParameterPoint q = net[k].point();
    cross = std::max(cross, std::abs((b.u - a.u) * (q.v - a.v) - (b.v - a.v) * (q.u - a.u)));
  }
  const double along_v = limits_->speed.v * cross / du, along_u = limits_->speed.u * cross / dv;
  const double sliver = cross == 0 ? 0 : std::min(du > 0 ? along_v : along_u, dv > 0 ? along_u : along_v);
  const bool is_straight = sliver <= limits_->bend * std::hypot(limits_->speed.u * du, limits_->speed.v * dv);
  const double room = std::max(limits_->sliver - error_, limits_->sliver / 8);  // an error cannot be divided
  const bool is_fine = is_straight && sliver <= room && du <= limits_->box.u && dv <= limits_->box.v;
  if (is_fine || depth == 20) {
    most_ = std::max(most_, sliver + error_);
    const TrimPiece& piece = *piece_;
    const ParameterPoint at{std::clamp(piece.start().u + b.u, piece.lower_u(), piece.upper_u()),
                            std::clamp(piece.start().v + b.v, piece.lower_v(), piece.upper_v())};
    points_->push_back(at);
    return;
  }
  Net low = net, high = net;
  for (std::size_t level = 1; level <= last; ++level) {  // de Casteljau at 1/2
    for (std::size_t k = 0; k + level <= last; ++k) {
      const Control &p = high[k], &q = high[k + 1];
      high[k] = {(p.u + q.u) / 2, (p.v + q.v) / 2, (p.w + q.w) / 2};
    }
    low[level] = high[0];
  }
  divide(low, depth + 1);
  divide(high, depth + 1);
}

}  // namespace tessera::inline abi_0_1
