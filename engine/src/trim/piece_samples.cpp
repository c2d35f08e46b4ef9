#include "trim/piece_samples.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {

void PieceSamples::set(const TrimPiece& piece, const Domain& rectangle, const ParameterPoint& step) {
  constexpr std::size_t most = 1024;
  parameters_ = {0, 1};
  points_ = {piece.start(), piece.end()};
  SampleRange range{0, 1};
  while (points_.size() < most) {
    const ParameterPoint size = distance(points_[range.first], points_[range.last]);
    const double segments = static_cast<double>(range.last - range.first);
    const double wanted = std::min(std::max(size.u / step.u, size.v / step.v) / segments, 8.0);
    if (wanted <= 1) return;
    refine(piece, range, static_cast<std::size_t>(std::ceil(wanted)));
    const auto in_v = within(&ParameterPoint::v, rectangle.v0, rectangle.v1);
    const auto in_both = in_v ? within(&ParameterPoint::u, rectangle.u0, rectangle.u1, *in_v) : in_v;
    if (!in_both) return;
    range = *in_both;
    if (range.first == range.last) return;
  }
}

void PieceSamples::refine(const TrimPiece& piece, const SampleRange& range, std::size_t parts) {
  std::vector<double> parameters;
  std::vector<ParameterPoint> points;
  for (std::size_t k = range.first; k < range.last; ++k) {
    parameters.push_back(parameters_[k]);
    points.push_back(points_[k]);
    for (std::size_t part = 1; part < parts; ++part) {
      const double share = static_cast<double>(part) / static_cast<double>(parts);
      const double t = parameters_[k] + share * (parameters_[k + 1] - parameters_[k]);
      const ParameterPoint p = relative_point(piece.curve, piece.start(), t);
      parameters.push_back(t);
      points.push_back(piece.start() + p);
    }
  }
  const auto replace = [&range](auto& all, const auto& finer) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(range.first);
    all.insert(all.erase(first, first + static_cast<std::ptrdiff_t>(range.last - range.first)), finer.begin(),
               finer.end());
  };
  replace(parameters_, parameters);
  replace(points_, points);
}

std::optional<SampleRange> PieceSamples::within(double ParameterPoint::*x, double lower, double upper,
                                                const SampleRange& among) const {
  const auto begin = points_.begin() + static_cast<std::ptrdiff_t>(among.first);
  const auto end = points_.begin() + static_cast<std::ptrdiff_t>(among.last) + 1;
  const bool increases = points_.front().*x <= points_.back().*x;
  const auto before = [&](const ParameterPoint& p) { return increases ? p.*x < lower : p.*x > upper; };
  const auto reached = [&](const ParameterPoint& p) { return increases ? p.*x <= upper : p.*x >= lower; };
  auto first = std::partition_point(begin, end, before);
  auto last = std::partition_point(first, end, reached);
  if (first == end || last == begin) return {};  // all before, or all beyond
  if (first != begin) --first;
  if (last == end) --last;
  return SampleRange{among.first + static_cast<std::size_t>(first - begin),
                     among.first + static_cast<std::size_t>(last - begin)};
}

}}  // namespace tessera::abi_0_1
