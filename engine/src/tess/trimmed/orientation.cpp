#include "tess/trimmed/orientation.h"

#include <array>
#include <cstddef>

#include "basis/double_double.h"

namespace tessera::inline abi_0_1 {
namespace {

/// A sum of doubles without rounding, as an expansion: parts that do not overlap, by growing size (Shewchuk 1997,
/// Grow-Expansion). Its sign is that of its largest part.
class ExactSum {
 public:
  void add(double term) {
    for (std::size_t k = 0; k < count_; ++k) {
      const DoubleDouble sum = two_sum(term, parts_[k]);
      parts_[k] = sum.low;
      term = sum.high;
    }
    parts_[count_++] = term;
  }
  void add(const DoubleDouble& term) {
    add(term.low);
    add(term.high);
  }
  double leading() const {
    for (std::size_t k = count_; k-- > 0;)
      if (parts_[k] != 0) return parts_[k];
    return 0;
  }

 private:
  std::array<double, 12> parts_;
  std::size_t count_ = 0;
};

}  // namespace

double orientation_exactly(const ParameterPoint& a, const ParameterPoint& b, const ParameterPoint& c) {
  ExactSum area;
  area.add(two_product(a.u, b.v));
  area.add(two_product(-a.v, b.u));
  area.add(two_product(b.u, c.v));
  area.add(two_product(-b.v, c.u));
  area.add(two_product(c.u, a.v));
  area.add(two_product(-c.v, a.u));
  return area.leading();
}

}  // namespace tessera::inline abi_0_1
