#include "io/rib/rib_trims.h"

#include <array>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

enum Part { counts, orders, knots, minima, maxima, lengths, us, vs, ws, part_count };
constexpr std::array<std::string_view, part_count> part_names{"the curves of each trimming loop",
                                                              "the orders of trimming curves",
                                                              "knots of trimming curves",
                                                              "minima of trimming curves",
                                                              "maxima of trimming curves",
                                                              "the numbers of points of trimming curves",
                                                              "u of trimming curves",
                                                              "v of trimming curves",
                                                              "w of trimming curves"};
using Parts = std::array<std::vector<double>, part_count>;

/// `value` as a whole number from 1 to `limit`, or 0 if it is none.
std::size_t count_of(double value, std::size_t limit) {
  return value >= 1 && value <= static_cast<double>(limit) && value == std::floor(value)
             ? static_cast<std::size_t>(value)
             : 0;
}

class LoopMaker {
 public:
  LoopMaker(const TextCursor& begin, const Parts& parts) : begin_(begin), parts_(parts) {}

  Result<std::vector<TrimLoop>> loops() {
    std::vector<TrimLoop> loops;
    for (const double stated : parts_[counts]) {
      const std::size_t count = count_of(stated, parts_[orders].size() - curve_);
      if (count == 0) return failure("the numbers of curves per loop do not fit the number of orders");
      TrimLoop& loop = loops.emplace_back();
      for (std::size_t k = 0; k < count; ++k) {
        Result<Curve> curve = next_curve();
        if (!curve) return curve.status();
        loop.curves.push_back(*std::move(curve));
      }
    }
    const bool all = curve_ == parts_[orders].size() && knot_ == parts_[knots].size() && point_ == parts_[us].size();
    return all ? Result<std::vector<TrimLoop>>(std::move(loops))
               : failure("numbers are left over after the last curve");
  }

 private:
  Result<Curve> next_curve() {
    const std::size_t points_left = parts_[us].size() - point_;
    const std::size_t order = count_of(parts_[orders][curve_], max_degree + 1),
                      count = count_of(parts_[lengths][curve_], points_left);
    if (order == 0 || count == 0 || count + order > parts_[knots].size() - knot_) {
      return failure("curve " + std::to_string(curve_) +
                     " has an order, a number of points and knots that do not fit each other");
    }
    std::vector<Vec3> points;
    std::vector<double> weights;
    for (std::size_t k = point_; k < point_ + count; ++k) {
      const double w = parts_[ws][k];
      if (!(w > 0)) return failure("weight " + std::to_string(k) + " is not above 0");
      points.push_back({parts_[us][k] / w, parts_[vs][k] / w, 0});
      weights.push_back(w);
    }
    Result<Curve> curve = Curve::nurbs(static_cast<int>(order) - 1, points, weights,
                                       std::span(parts_[knots]).subspan(knot_, count + order),
                                       Interval{parts_[minima][curve_], parts_[maxima][curve_]});
    if (curve.status().code() == StatusCode::out_of_memory) return curve;
    if (!curve) return failure("curve " + std::to_string(curve_) + ": " + curve.status().message());
    ++curve_;
    knot_ += count + order;
    point_ += count;
    return curve;
  }

  Status failure(const std::string& sentence) const { return begin_.failure("TrimCurve: " + sentence); }

  TextCursor begin_;
  const Parts& parts_;
  std::size_t curve_ = 0, knot_ = 0, point_ = 0;
};

}  // namespace

Result<std::vector<TrimLoop>> read_trim_loops(RibLexer& lexer) {
  const TextCursor begin = lexer.place();
  Parts parts;
  for (std::size_t k = 0; k < part_count; ++k) {
    Status status = lexer.take_array(part_names[k], parts[k]);
    if (!status.ok()) return status;
  }
  const std::size_t curves = parts[orders].size(), points = parts[us].size();
  if (parts[minima].size() != curves || parts[maxima].size() != curves || parts[lengths].size() != curves ||
      parts[vs].size() != points || parts[ws].size() != points) {
    return begin.failure("TrimCurve: its arrays have lengths that do not fit each other");
  }
  return LoopMaker(begin, parts).loops();
}

}}  // namespace tessera::abi_0_1
