#pragma once
// Points along a monotone piece, from which the parts of it within strips follow.

#include <cstddef>
#include <optional>
#include <vector>

#include "tessera/geometry.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// A closed interval of samples.
struct SampleRange {
  std::size_t first = 0, last = 0;
};

/// Points C(t) of a piece in order, from end to end, and closer to each other within a rectangle. Rounded as
/// relative_point() is.
class PieceSamples {
 public:
  /// Samples a piece so that within a rectangle, neighbours are about `step` apart in u and in v.
  void set(const TrimPiece& piece, const Domain& rectangle, const ParameterPoint& step);

  const ParameterPoint& operator[](std::size_t k) const { return points_[k]; }
  double parameter(std::size_t k) const { return parameters_[k]; }

  /// The smallest range that contains all of the curve with the coordinate within [lower, upper]; empty if none is.
  std::optional<SampleRange> within(double ParameterPoint::*x, double lower, double upper) const {
    return within(x, lower, upper, {0, points_.size() - 1});
  }
  /// Does so for the part of the curve within `among`.
  std::optional<SampleRange> within(double ParameterPoint::*x, double lower, double upper,
                                    const SampleRange& among) const;

 private:
  /// Puts further samples between those of a range.
  void refine(const TrimPiece& piece, const SampleRange& range, std::size_t parts);

  std::vector<double> parameters_;
  std::vector<ParameterPoint> points_;
};

}}  // namespace tessera::abi_0_1
