#include "tess/trimmed/piece_chords.h"

#include <algorithm>
#include <cmath>

namespace tessera::inline abi_0_1 {

double PieceChords::append(std::span<const TrimPiece> chain, const ChordLimits& limits,
                           std::vector<ParameterPoint>& points) {
  limits_ = &limits;
  points_ = &points;
  most_ = 0;
  while (!chain.empty()) {
    const std::size_t count = reach(chain);
    if (count == 1) {
      append_one(chain.front());
    } else {
      most_ = std::max(most_, sliver_over(chain.first(count)).size);
      points.push_back(chain[count - 1].end());
    }
    chain = chain.subspan(count);
  }
  return most_;
}

std::size_t PieceChords::reach(std::span<const TrimPiece> chain) const {
  std::size_t fine = 1, next = 2;
  for (; next <= chain.size() && sliver_over(chain.first(next)).is_fine; next *= 2) fine = next;
  for (std::size_t most = std::min(next - 1, chain.size()); fine < most;) {
    const std::size_t middle = fine + (most - fine + 1) / 2;
    if (sliver_over(chain.first(middle)).is_fine)
      fine = middle;
    else
      most = middle - 1;
  }
  return fine;
}

PieceChords::Sliver PieceChords::sliver_over(std::span<const TrimPiece> chain) const {
  const ParameterPoint start = chain.front().start(), end = chain.back().end();
  const ParameterPoint chord{end.u - start.u, end.v - start.v};
  double cross = 0, error = 0;
  for (const TrimPiece& piece : chain) {
    error = std::max(error, error_of(piece));
    for (const ParameterPoint& q : piece.curve.points)
      cross = std::max(cross, std::abs(chord.u * (q.v - start.v) - chord.v * (q.u - start.u)));
  }
  return sliver_of(chord, cross, error);
}

PieceChords::Sliver PieceChords::sliver_of(const ParameterPoint& chord, double cross, double error) const {
  const double du = std::abs(chord.u), dv = std::abs(chord.v);
  const double along_v = limits_->speed.v * cross / du, along_u = limits_->speed.u * cross / dv;
  const double sliver = cross == 0 ? 0 : std::min(du > 0 ? along_v : along_u, dv > 0 ? along_u : along_v);
  const bool is_straight = sliver <= limits_->bend * std::hypot(limits_->speed.u * du, limits_->speed.v * dv);
  const double room = std::max(limits_->sliver - error, limits_->sliver / 8);  // an error cannot be divided
  return {sliver + error, is_straight && sliver <= room && du <= limits_->box.u && dv <= limits_->box.v};
}

double PieceChords::error_of(const TrimPiece& piece) const {
  return piece.error.u * limits_->speed.u + piece.error.v * limits_->speed.v;
}

void PieceChords::append_one(const TrimPiece& piece) {
  piece_ = &piece;
  degree_ = piece.curve.degree();
  error_ = error_of(piece);
  most_ = std::max(most_, error_);
  Net net;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(degree_); ++k) {
    const double weight = piece.curve.weight(k);
    const ParameterPoint& point = piece.curve.points[k];
    net[k] = {weight * (point.u - piece.start().u), weight * (point.v - piece.start().v), weight};
  }
  divide(net, 0);
  points_->back() = piece.end();
}

// Points are kept within the box of the piece, which rounding could leave, so they never pass a line between patches.
void PieceChords::divide(const Net& net, int depth) {
  const std::size_t last = static_cast<std::size_t>(degree_);
  const ParameterPoint a = net[0].point(), b = net[last].point();
  const ParameterPoint chord{b.u - a.u, b.v - a.v};
  double cross = 0;
  for (std::size_t k = 1; k < last; ++k) {
    const ParameterPoint q = net[k].point();
    cross = std::max(cross, std::abs(chord.u * (q.v - a.v) - chord.v * (q.u - a.u)));
  }
  const Sliver sliver = sliver_of(chord, cross, error_);
  if (sliver.is_fine || depth == 20) {
    most_ = std::max(most_, sliver.size);
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
