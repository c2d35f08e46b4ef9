#pragma once
// Heights along a curve: of a border, a line inside a patch, or a piece of a loop.

#include <cstddef>
#include <span>
#include <vector>

#include "section/levels.h"

namespace tessera { inline namespace abi_0_1 {

/// Heights along a curve over [0, 1] as a fraction of Bernstein polynomials, divided so that no plane is met twice by
/// one interval. All that meet at the curve find the same points of it.
class HeightLine {
 public:
  /// `weighted`: weight times height; `weights`: none if all are 1, else positive.
  HeightLine(std::vector<double> weighted, std::vector<double> weights)
      : weighted_(std::move(weighted)), weights_(std::move(weights)) {}

  /// Divides the line. An interval is not divided further if no plane is near, or if each plane that is meets it at
  /// most once: the derivative of weight * (height - plane) has coefficients of one sign for the lowest and the highest
  /// of them, so for all between. Nor if it is as short as max_depth halvings make it.
  void divide(const Levels& levels);
  /// States the heights of the ends; lines that meet must agree on them.
  void set_ends(double first, double last) { heights_.front() = first, heights_.back() = last; }

  std::size_t interval_count() const { return places_.size() - 1; }
  std::span<const double> places() const { return places_; }    ///< growing, from 0 to 1
  std::span<const double> heights() const { return heights_; }  ///< at the places
  /// The interval that holds a place.
  std::size_t interval_at(double place) const;
  /// Where an interval has this height; an end of it if it has none there.
  double root(std::size_t interval, double height) const;
  /// Whether the division was ended by its depth.
  bool is_shallow() const { return is_shallow_; }

  static constexpr int max_depth = 40;
  static constexpr std::size_t max_intervals = 4096;

 private:
  struct Part;
  bool is_simple(const Part& part, const Levels& levels) const;
  double value(double t, double height, double& slope) const;

  std::vector<double> weighted_, weights_;
  std::vector<double> places_, heights_;
  bool is_shallow_ = false;
};

}}  // namespace tessera::abi_0_1
