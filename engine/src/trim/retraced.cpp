#include "trim/retraced.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

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

}  // namespace

std::size_t drop_retraced(std::vector<TrimPiece>& pieces, double snap_u, double snap_v) {
  return RetracedPairs(pieces, snap_u, snap_v).drop();
}

}}  // namespace tessera::abi_0_1
