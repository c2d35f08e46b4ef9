#include "join/curve_pieces.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "base/point_tree.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t max_neighbours = 16;

double mixed(const Interval& range, double x) { return (1 - x) * range.from + x * range.to; }

/// Numbers by which pieces are ordered.
std::array<double, 20> order_of(const CurvePiece& piece, const FreeCurve& free) {
  const Curve& curve = free.curve.curve();
  std::array<double, 20> key{static_cast<double>(curve.degree()), static_cast<double>(curve.points().size()),
                             curve.is_rational() ? 1.0 : 0.0};
  std::size_t next = 3;
  for (const Vec3& p : piece.points)
    for (const double x : {p.x, p.y, p.z}) key[next++] = x;
  for (const double x : {0.0, 0.5, 1.0}) {
    const Vec3 uv = position(curve, mixed(piece.range, x));
    key[next++] = uv.x;
    key[next++] = uv.y;
  }
  key[next++] = piece.range.from;
  key[next] = piece.range.to;
  return key;
}

void rank_pieces(const FreeCurves& free, std::vector<CurvePiece>& pieces) {
  std::vector<std::pair<std::array<double, 20>, std::uint32_t>> keys;
  for (std::uint32_t k = 0; k < pieces.size(); ++k)
    keys.push_back({order_of(pieces[k], free.curves[pieces[k].curve]), k});
  std::sort(keys.begin(), keys.end());
  for (std::uint32_t rank = 0; rank < keys.size(); ++rank) pieces[keys[rank].second].rank = rank;
}

/// Measures how far two pieces are apart.
class PairMeasure {
 public:
  PairMeasure(const FreeCurves& free, const CurvePiece& a, const CurvePiece& b, bool turned)
      : a_{&a, &free.curves[a.curve].curve},
        b_{&b, &free.curves[b.curve].curve},
        turned_(turned),
        is_one_face_(free.curves[a.curve].use.face == free.curves[b.curve].use.face),
        reach_(std::min(a.reach, b.reach)) {}

  /// Empty if they are out of reach, or run otherwise.
  std::optional<double> distance() const {
    const std::optional<double> forth = one_way(a_, b_);
    if (!forth) return {};
    const std::optional<double> back = one_way(b_, a_);
    if (!back) return {};
    return std::max(*forth, *back);
  }
  /// Whether their face lies between them, if they are within reach.
  bool is_strip() const {
    const double middle = mixed(a_.piece->range, 0.5);
    return is_one_face_ &&
           a_.curve->has_strip(middle, *b_.curve, b_.curve->nearest(a_.piece->points[1], b_.piece->range).t, reach_);
  }

 private:
  struct Part {
    const CurvePiece* piece;
    const SpaceCurve* curve;
  };

  std::optional<double> one_way(const Part& from, const Part& to) const {
    constexpr int max_samples = 64;
    const auto after = [](double t, const SpaceCurve::Sample& sample) { return t < sample.t; };
    const auto samples = from.curve->samples();
    const auto begin = std::upper_bound(samples.begin(), samples.end(), from.piece->range.from, after),
               end = std::upper_bound(samples.begin(), samples.end(), from.piece->range.to, after);
    const int count = std::clamp(static_cast<int>(end - begin), 8, max_samples);
    double largest = 0, before = turned_ ? to.piece->range.to : to.piece->range.from;
    const bool beyond = to.piece->curve != from.piece->curve;
    for (int k = 1; k < count; ++k) {
      const Vec3 p = from.curve->at(mixed(from.piece->range, static_cast<double>(k) / count));
      SpaceCurve::Nearest nearest = to.curve->nearest(p, to.piece->range);
      if (turned_ ? nearest.t > before : nearest.t < before) return {};
      before = nearest.t;
      const bool at_end = nearest.t == to.piece->range.from || nearest.t == to.piece->range.to;
      if (at_end && beyond) nearest = to.curve->nearest_from(p, nearest.t, to.curve->domain());
      if (!(nearest.distance <= reach_)) return {};
      largest = std::max(largest, nearest.distance);
    }
    return largest;
  }

  Part a_, b_;
  bool turned_, is_one_face_;
  double reach_;
};

/// A piece whose ends are near those of another.
struct Neighbour {
  double distance;  ///< of both ends, summed
  std::uint32_t rank, piece;
  bool turned;
  friend auto operator<=>(const Neighbour&, const Neighbour&) = default;
};

/// The nearest neighbours of a piece by their ends.
std::vector<Neighbour> neighbours_of(std::uint32_t k, std::span<const CurvePiece> pieces, const PointTree& ends) {
  const CurvePiece& piece = pieces[k];
  const double wide = end_reach * piece.reach;
  const Box3 box{piece.start() - Vec3{wide, wide, wide}, piece.start() + Vec3{wide, wide, wide}};
  std::vector<Neighbour> found;
  ends.visit_box(box, [&](std::uint32_t id) {
    const std::uint32_t other = id / 2;
    const bool turned = id % 2 == 1;
    if (other == k) return;
    const CurvePiece& o = pieces[other];
    const double at_start = length(piece.start() - (turned ? o.end() : o.start())),
                 at_end = length(piece.end() - (turned ? o.start() : o.end()));
    if (std::max(at_start, at_end) <= end_reach * std::min(piece.reach, o.reach))
      found.push_back({at_start + at_end, o.rank, other, turned});
  });
  const std::size_t kept = std::min(found.size(), max_neighbours);
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end());
  found.resize(kept);
  return found;
}

}  // namespace

std::vector<CurvePiece> list_pieces(const FreeCurves& free) {
  std::vector<CurvePiece> pieces;
  for (std::uint32_t k = 0; k < free.curves.size(); ++k) {
    const FreeCurve& curve = free.curves[k];
    for (std::uint32_t node = 0; node + 1 < curve.nodes.size(); ++node) {
      const CurveNode &a = curve.nodes[node], &b = curve.nodes[node + 1];
      const Interval range{a.t, b.t};
      CurvePiece piece{k, node, range, {a.point, curve.curve.at(mixed(range, 0.5)), b.point}, 0, 0, 0};
      for (const SpaceCurve::Sample& sample : curve.curve.samples())
        if (sample.t > a.t && sample.t < b.t) piece.extent = std::max(piece.extent, length(sample.point - a.point));
      for (const Vec3& p : piece.points) piece.extent = std::max(piece.extent, length(p - a.point));
      piece.reach = std::min(free.distance, 0.5 * piece.extent);
      pieces.push_back(piece);
    }
  }
  rank_pieces(free, pieces);
  return pieces;
}

std::vector<PiecePair> list_pairs(const FreeCurves& free, std::span<const CurvePiece> pieces) {
  std::vector<Vec3> ends;
  for (const CurvePiece& piece : pieces) {
    ends.push_back(piece.start());
    ends.push_back(piece.end());
  }
  const PointTree tree(std::move(ends));
  std::vector<std::tuple<std::uint32_t, std::uint32_t, bool>> candidates;
  for (std::uint32_t k = 0; k < pieces.size(); ++k)
    for (const Neighbour& other : neighbours_of(k, pieces, tree))
      candidates.push_back({std::min(k, other.piece), std::max(k, other.piece), other.turned});
  std::sort(candidates.begin(), candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  std::vector<PiecePair> pairs;
  for (const auto& [a, b, turned] : candidates) {
    const PairMeasure measure(free, pieces[a], pieces[b], turned);
    if (const std::optional<double> distance = measure.distance())
      pairs.push_back({a, b, turned, *distance, measure.is_strip()});
  }
  return pairs;
}

}}  // namespace tessera::abi_0_1
