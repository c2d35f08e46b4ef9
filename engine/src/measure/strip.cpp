#include "measure/strip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "basis/double_double.h"
#include "measure/strip_cell.h"

namespace tessera { inline namespace abi_0_1 {

void ExactSums::add(const Integrals& terms, double sign) {
  for (std::size_t k = 0; k < high_.size(); ++k) {
    const DoubleDouble sum = two_sum(high_[k], sign * terms.value[k]);
    high_[k] = sum.high, low_[k] += sum.low, error_[k] += terms.error[k];
  }
}

void ExactSums::add(const ExactSums& other) {
  for (std::size_t k = 0; k < high_.size(); ++k) {
    const DoubleDouble sum = two_sum(high_[k], other.high_[k]);
    high_[k] = sum.high, low_[k] += sum.low + other.low_[k], error_[k] += other.error_[k];
  }
}

Integrals ExactSums::sums() const {
  Integrals all;
  for (std::size_t k = 0; k < high_.size(); ++k) {
    all.value[k] = high_[k] + low_[k];
    all.error[k] = error_[k] * (1 + 1e-9) + 0x1p-52 * std::abs(all.value[k]);
  }
  return all;
}

namespace {

/// A square that is to be halved while there is anything worse.
struct Unresolved {
  Integrals known;
  double magnitude;
  std::size_t number;  ///< in the order of making, so that the order of halving is the same for equal errors
  std::pair<StripSquare, StripSquare> halves;

  bool operator<(const Unresolved& other) const {
    return known.error[0] != other.known.error[0] ? known.error[0] < other.known.error[0] : number > other.number;
  }
};

/// Halves the squares of a strip until the bound of what is not resolved is small.
class StripSearch {
 public:
  StripSearch(const StripPatch& patch, const CurveStrip& strip, Integrand integrand, const StripLimits& limits,
              ExactSums& sums)
      : patch_(patch), strip_(strip), integrand_(integrand), limits_(limits), sums_(sums) {}

  void run() {
    add({strip_.curve}, std::numeric_limits<double>::infinity());
    std::size_t cells = 1;
    while (!open_.empty() && open_error() > limits_.accuracy * magnitude_ && cells < limits_.max_cells) {
      std::pop_heap(open_.begin(), open_.end());
      const Unresolved worst = std::move(open_.back());
      open_.pop_back();
      magnitude_ -= worst.magnitude;
      add(worst.halves.first, worst.known.error[0]);
      add(worst.halves.second, worst.known.error[0]);
      cells += 2;
    }
    for (const Unresolved& left : open_) sums_.add(left.known, strip_.sign);
  }

 private:
  /// `before`: the error of the square that this one is half of.
  void add(const StripSquare& square, double before) {
    StripCell cell(patch_, strip_, square, integrand_);
    if (cell.is_empty()) return;
    const double enough = std::max(limits_.accuracy * std::min(cell.magnitude(), magnitude_ + cell.magnitude()),
                                   limits_.accuracy * magnitude_ / 64);
    std::optional<StripCell::Found> found = cell.integrate(enough);
    // The bound of the size may be far too large: then the rule must be better.
    const auto is_exact = [&](double share) {
      return found->integrals.error[0] <=
             std::max(share * limits_.accuracy * found->magnitude, limits_.accuracy * magnitude_ / 64);
    };
    if (found && !is_exact(4)) {
      std::optional<StripCell::Found> better = cell.integrate(limits_.accuracy * found->magnitude);
      if (better) found = better;
    }
    const double magnitude = found ? found->magnitude : cell.magnitude();
    magnitude_ += magnitude;
    // Where halving no longer helps, what is left is the rounding of the data.
    if (found && (is_exact(4) || found->integrals.error[0] > 0.4 * before)) {
      sums_.add(found->integrals, strip_.sign);
      return;
    }
    open_.push_back({found ? found->integrals : cell.crude(), magnitude, made_++, cell.halves()});
    std::push_heap(open_.begin(), open_.end());
  }

  double open_error() const {
    double sum = 0;
    for (const Unresolved& one : open_) sum += one.known.error[0];
    return sum;
  }

  const StripPatch& patch_;
  const CurveStrip& strip_;
  const Integrand integrand_;
  const StripLimits& limits_;
  ExactSums& sums_;
  double magnitude_ = 0;  ///< of all squares, as far as is known
  std::size_t made_ = 0;
  std::vector<Unresolved> open_;  ///< a heap
};

}  // namespace

void add_strip(const StripPatch& patch, const CurveStrip& strip, Integrand integrand, const StripLimits& limits,
               ExactSums& sums) {
  StripSearch(patch, strip, integrand, limits, sums).run();
}

}}  // namespace tessera::abi_0_1
