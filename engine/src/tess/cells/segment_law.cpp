#include "tess/cells/segment_law.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::int64_t ceil_of(std::int64_t numerator, std::int64_t denominator) {
  return (numerator + denominator - 1) / denominator;
}

/// For each whole number the place of the least weight that is not below.
constexpr auto grade_of_weight = [] {
  std::array<std::uint8_t, Segments::max_weight + 1> grades{};
  std::uint8_t grade = 0;
  for (std::size_t weight = 0; weight < grades.size(); ++weight) {
    if (Segments::weights[grade] < weight) ++grade;
    grades[weight] = grade;
  }
  return grades;
}();

/// Divisions into fewer segments than this are not graded: all segments of a half have one length. There are few such
/// divisions, so patches share their tables of weights (MeshTables). A table for one patch would take more memory than
/// its triangles.
constexpr std::int64_t min_graded = 12;

/// The segments of some eighths that are divided together.
struct Run {
  std::int64_t count = 0;     ///< as graded segments
  std::int64_t if_equal = 0;  ///< as segments of one length
};

/// The segments of one length that some eighths take.
std::int64_t count_if_equal(const RateNeeds& needs, std::size_t begin, std::size_t end) {
  const Segments::Fraction most = *std::max_element(needs.begin() + static_cast<std::ptrdiff_t>(begin),
                                                    needs.begin() + static_cast<std::ptrdiff_t>(end));
  return ceil_of(static_cast<std::int64_t>(end - begin) * most.numerator, Segments::parts * most.denominator);
}

/// Finds the grades of the eighths from `begin` to `end`.
Run grade(const RateNeeds& needs, std::size_t begin, std::size_t end, Segments::Grades& grades) {
  const Segments::Fraction most = *std::max_element(needs.begin() + static_cast<std::ptrdiff_t>(begin),
                                                    needs.begin() + static_cast<std::ptrdiff_t>(end));
  Run run{.if_equal = count_if_equal(needs, begin, end)};
  // The largest need gets one of the larger weights, and the others weights that are not too small beside it: the
  // fewest segments have the least sum of weights in units of the largest weight.
  constexpr std::size_t tries = 8;
  std::int64_t least = 0, unit = 0;
  for (std::size_t place = Segments::weight_count - tries; place < Segments::weight_count; ++place) {
    const std::int64_t largest = Segments::weights[place];
    Segments::Grades found{};
    std::int64_t sum = 0;
    for (std::size_t e = begin; e < end; ++e) {
      const std::int64_t weight =
          ceil_of(largest * needs[e].numerator * most.denominator, std::int64_t{needs[e].denominator} * most.numerator);
      found[e] = grade_of_weight[static_cast<std::size_t>(std::max<std::int64_t>(weight, 1))];
      sum += Segments::weights[found[e]];
    }
    if (unit != 0 && sum * unit >= least * largest) continue;
    least = sum, unit = largest;
    std::copy(found.begin() + static_cast<std::ptrdiff_t>(begin), found.begin() + static_cast<std::ptrdiff_t>(end),
              grades.begin() + static_cast<std::ptrdiff_t>(begin));
  }
  run.count = ceil_of(most.numerator * least, Segments::parts * unit * most.denominator);
  return run;
}

}  // namespace

Segments segments_for(const RateNeeds& needs, bool parts_halves) {
  constexpr std::size_t middle = Segments::parts / 2;
  if (const std::int64_t equal = count_if_equal(needs, 0, Segments::parts); equal <= min_graded) {
    const std::int64_t lower = count_if_equal(needs, 0, middle), upper = count_if_equal(needs, middle, Segments::parts);
    if (!parts_halves && lower + upper >= equal) return static_cast<int>(equal);
    return Segments::halves(static_cast<int>(lower), static_cast<int>(upper));
  }
  Segments::Grades grades{};
  const Run all = grade(needs, 0, Segments::parts, grades);
  const bool is_graded = all.count >= min_graded && all.count < all.if_equal && all.count < Segments::max_graded;
  if (!parts_halves && is_graded) return Segments::graded(static_cast<int>(all.count), 0, grades);
  Run lower = grade(needs, 0, middle, grades), upper = grade(needs, middle, Segments::parts, grades);
  const auto level = [&](Run& run, std::size_t begin) {
    if (is_graded && run.count < run.if_equal) return;
    run.count = run.if_equal;
    std::fill_n(grades.begin() + static_cast<std::ptrdiff_t>(begin), middle, std::uint8_t{0});
  };
  level(lower, 0);
  level(upper, middle);
  const std::int64_t in_halves = lower.count + upper.count;
  if (!parts_halves && in_halves >= all.if_equal) return static_cast<int>(all.if_equal);
  if (!is_graded) return Segments::halves(static_cast<int>(lower.count), static_cast<int>(upper.count));
  return Segments::graded(static_cast<int>(in_halves), static_cast<int>(lower.count), grades);
}

}}  // namespace tessera::abi_0_1
