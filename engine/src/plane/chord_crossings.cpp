#include "plane/chord_crossings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "basis/exact_sign.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct Segment {
  ParameterPoint a, b;

  double lower_u() const { return std::min(a.u, b.u); }
  double upper_u() const { return std::max(a.u, b.u); }
  double lower_v() const { return std::min(a.v, b.v); }
  double upper_v() const { return std::max(a.v, b.v); }
};

/// Returns where two segments cross inside both; nothing if they only touch, or lie on one line.
std::optional<ParameterPoint> crossing(const Segment& p, const Segment& q) {
  if (p.lower_v() > q.upper_v() || q.lower_v() > p.upper_v()) return {};
  if (orientation(p.a, p.b, q.a) * orientation(p.a, p.b, q.b) >= 0) return {};
  if (orientation(q.a, q.b, p.a) * orientation(q.a, q.b, p.b) >= 0) return {};
  const double pu = p.b.u - p.a.u, pv = p.b.v - p.a.v, qu = q.b.u - q.a.u, qv = q.b.v - q.a.v;
  const double along = ((q.a.u - p.a.u) * qv - (q.a.v - p.a.v) * qu) / (pu * qv - pv * qu);
  const double share = std::isfinite(along) ? std::clamp(along, 0.0, 1.0) : 0.5;
  return ParameterPoint{
      std::clamp(p.a.u + share * pu, std::max(p.lower_u(), q.lower_u()), std::min(p.upper_u(), q.upper_u())),
      std::clamp(p.a.v + share * pv, std::max(p.lower_v(), q.lower_v()), std::min(p.upper_v(), q.upper_v()))};
}

}  // namespace

bool ChordCrossings::divide(std::vector<ParameterPoint>& points, std::vector<PlaneSegment>& chords,
                            std::vector<std::uint32_t>& marks) {
  constexpr int most = 16;
  for (int pass = 0; pass < most; ++pass)
    if (!divide_once(points, chords, marks)) return true;
  return false;
}

bool ChordCrossings::divide_once(std::vector<ParameterPoint>& points, std::vector<PlaneSegment>& chords,
                                 std::vector<std::uint32_t>& marks) {
  const auto segment = [&](std::uint32_t k) { return Segment{points[chords[k].start], points[chords[k].end]}; };
  order_.resize(chords.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::ranges::sort(order_, {}, [&](std::uint32_t k) { return std::pair(segment(k).lower_u(), k); });
  divided_.clear();
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Segment first = segment(order_[i]);
    for (std::size_t j = i + 1; j < order_.size(); ++j) {
      const Segment second = segment(order_[j]);
      if (second.lower_u() > first.upper_u()) break;
      const std::optional<ParameterPoint> at = crossing(first, second);
      if (!at) continue;
      points.push_back(*at);
      for (const std::size_t k : {i, j})
        divided_.emplace_back(order_[k], static_cast<std::uint32_t>(points.size() - 1));
    }
  }
  if (divided_.empty()) return false;
  // Points of one chord, from its start to its end.
  std::ranges::sort(divided_, [&](const auto& x, const auto& y) {
    if (x.first != y.first) return x.first < y.first;
    const Segment along = segment(x.first);
    const auto place = [&](std::uint32_t k) {
      return (points[k].u - along.a.u) * (along.b.u - along.a.u) + (points[k].v - along.a.v) * (along.b.v - along.a.v);
    };
    const double a = place(x.second), b = place(y.second);
    return a != b ? a < b : x.second < y.second;
  });
  next_.clear(), next_marks_.clear();
  auto cut = divided_.begin();
  for (std::uint32_t k = 0; k < chords.size(); ++k) {
    std::uint32_t last = chords[k].start;
    const auto add = [&](std::uint32_t end) {
      if (!(points[last] == points[end])) next_.push_back({last, end}), next_marks_.push_back(marks[k]);
      last = end;
    };
    for (; cut != divided_.end() && cut->first == k; ++cut) add(cut->second);
    add(chords[k].end);
  }
  chords = next_;
  marks = next_marks_;
  return true;
}

}}  // namespace tessera::abi_0_1
