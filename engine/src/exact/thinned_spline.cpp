#include "exact/thinned_spline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t many_spans = 32, fewest_spans = 4, most_lines = 8;

/// The control points of a spline surface, `[k][line]`: k along the direction that may get fewer.
struct Lines {
  SplineDirection along, across;
  std::size_t count = 0, lines = 0;
  std::vector<Vec3> points;

  const Vec3& at(std::size_t k, std::size_t line) const { return points[k * lines + line]; }
};

std::size_t count_of(const SplineDirection& of) { return of.knots.size() - static_cast<std::size_t>(of.degree) - 1; }

Lines lines_of(const StraightenedNet& net, bool along_u) {
  Lines made{along_u ? net.u : net.v, along_u ? net.v : net.u, 0, 0, {}};
  made.count = count_of(made.along), made.lines = count_of(made.across);
  for (std::size_t k = 0; k < made.count; ++k)
    for (std::size_t line = 0; line < made.lines; ++line)
      made.points.push_back(net.points[along_u ? k * made.lines + line : line * made.count + k]);
  return made;
}

void put(const Lines& lines, bool along_u, StraightenedNet& net) {
  (along_u ? net.u : net.v) = lines.along;
  net.points.resize(lines.points.size());
  for (std::size_t k = 0; k < lines.count; ++k)
    for (std::size_t line = 0; line < lines.lines; ++line)
      net.points[along_u ? k * lines.lines + line : line * lines.count + k] = lines.at(k, line);
}

/// The knots between the ends of the interval on which the splines add up to 1, each once.
std::vector<double> inner_knots(const SplineDirection& of) {
  const auto p = static_cast<std::size_t>(of.degree);
  std::vector<double> made;
  for (std::size_t k = p + 1; k < count_of(of); ++k)
    if (of.knots[k] > of.knots[p] && of.knots[k] < of.knots[count_of(of)] && of.knots[k] != of.knots[k - 1])
      made.push_back(of.knots[k]);
  return made;
}

/// Every `step`-th inner knot, and those that are there several times: the surface may have a crease there.
std::vector<double> every(const SplineDirection& of, std::size_t step) {
  const auto p = static_cast<std::size_t>(of.degree);
  std::vector<double> made(of.knots.begin(), of.knots.begin() + std::ptrdiff_t(p + 1));
  std::size_t number = 0;
  for (std::size_t k = p + 1; k < of.knots.size(); ++k) {
    const double knot = of.knots[k];
    const bool is_inner = knot > of.knots[p] && knot < of.knots[count_of(of)];
    const bool is_first = knot != of.knots[k - 1], is_single = is_first && of.knots[k + is_inner] != knot;
    if (is_inner && is_first) ++number;
    if (!is_inner || !is_single || number % step == 0) made.push_back(knot);
  }
  return made;
}

/// The B-splines of few knots as sums of those of many, among which the few are. Row j, for a control point of the
/// many, has the factors of degree + 1 control points of the few, from first[j] on (Lyche and Morken, Spline Methods,
/// sec. 4.2).
struct Insertion {
  Insertion(const SplineDirection& few, const std::vector<double>& many)
      : order(static_cast<std::size_t>(few.degree) + 1) {
    const std::vector<double>& t = few.knots;
    const std::size_t count = count_of(few), rows = many.size() - order;
    std::size_t span = order - 1;
    for (std::size_t j = 0; j < rows; ++j) {
      while (span + 1 < count && t[span + 1] <= many[j]) ++span;
      first.push_back(span + 1 - order);
      std::vector<double> row(order, 0);
      row[order - 1] = 1;  // of degree 0
      for (std::size_t k = 1; k < order; ++k) {
        const double x = many[j + k];
        for (std::size_t i = order - 1 - k; i < order; ++i) {
          const std::size_t at = first[j] + i;
          const double rise = t[at + k] - t[at], fall = t[at + k + 1] - t[at + 1];
          row[i] = (rise > 0 ? (x - t[at]) / rise * row[i] : 0) +
                   (i + 1 < order && fall > 0 ? (t[at + k + 1] - x) / fall * row[i + 1] : 0);
        }
      }
      factors.insert(factors.end(), row.begin(), row.end());
    }
  }
  double factor(std::size_t j, std::size_t k) const { return factors[j * order + k]; }
  std::size_t rows() const { return first.size(); }

  std::size_t order;
  std::vector<std::size_t> first;
  std::vector<double> factors;
};

/// Solves the normal equations of the insertion, whose matrix has `order` diagonals from the main one on, by Cholesky's
/// method (Golub and Van Loan, Matrix Computations, 4th ed., sec. 4.3). Returns whether they are solved.
bool solve(const Insertion& insertion, const Lines& many, Lines& few) {
  const std::size_t n = few.count, w = insertion.order;
  std::vector<double> band(n * w, 0);  // [row][column - row], the upper half
  few.points.assign(n * few.lines, {});
  for (std::size_t j = 0; j < insertion.rows(); ++j)
    for (std::size_t a = 0; a < w; ++a) {
      const std::size_t row = insertion.first[j] + a;
      for (std::size_t b = a; b < w; ++b) band[row * w + b - a] += insertion.factor(j, a) * insertion.factor(j, b);
      for (std::size_t line = 0; line < few.lines; ++line)
        few.points[row * few.lines + line] += insertion.factor(j, a) * many.at(j, line);
    }
  for (std::size_t k = 0; k < n; ++k) {
    const double pivot = band[k * w];
    if (!(pivot > 0)) return false;
    for (std::size_t i = 1; i < w && k + i < n; ++i) {
      const double factor = band[k * w + i] / pivot;
      for (std::size_t j = i; j < w; ++j) band[(k + i) * w + j - i] -= factor * band[k * w + j];
      for (std::size_t line = 0; line < few.lines; ++line)
        few.points[(k + i) * few.lines + line] = few.at(k + i, line) - factor * few.at(k, line);
    }
  }
  for (std::size_t k = n; k-- > 0;)
    for (std::size_t line = 0; line < few.lines; ++line) {
      Vec3 sum = few.at(k, line);
      for (std::size_t i = 1; i < w && k + i < n; ++i) sum = sum - band[k * w + i] * few.at(k + i, line);
      few.points[k * few.lines + line] = (1 / band[k * w]) * sum;
    }
  return true;
}

/// The difference of the two surfaces, on the knots of `many`.
Lines difference(const Insertion& insertion, const Lines& many, const Lines& few) {
  Lines made = many;
  for (std::size_t j = 0; j < made.count; ++j)
    for (std::size_t line = 0; line < made.lines; ++line) {
      Vec3 sum;
      for (std::size_t k = 0; k < insertion.order; ++k)
        sum += insertion.factor(j, k) * few.at(insertion.first[j] + k, line);
      made.points[j * made.lines + line] = sum - many.at(j, line);
    }
  return made;
}

/// The control points of a surface's derivatives that act between two parameters of `along`: vectors whose convex hull
/// holds the derivatives there.
struct Derivatives {
  std::vector<Vec3> along, across;

  Derivatives(const Lines& of, double from, double to) {
    const auto p = static_cast<std::size_t>(of.along.degree), q = static_cast<std::size_t>(of.across.degree);
    const std::vector<double>&t = of.along.knots, &s = of.across.knots;
    for (std::size_t k = 0; k < of.count; ++k) {
      if (!(t[k] < to && t[k + p + 1] > from)) continue;
      for (std::size_t line = 0; line < of.lines; ++line) {
        if (k + 1 < of.count && t[k + 1] < to && t[k + p + 1] > from && t[k + 1] < t[k + p + 1])
          along.push_back((of.along.degree / (t[k + p + 1] - t[k + 1])) * (of.at(k + 1, line) - of.at(k, line)));
        if (line + 1 < of.lines && s[line + 1] < s[line + q + 1])
          across.push_back((of.across.degree / (s[line + q + 1] - s[line + 1])) *
                           (of.at(k, line + 1) - of.at(k, line)));
      }
    }
  }
};

double longest(const std::vector<Vec3>& vectors) {
  double most = 0;
  for (const Vec3& vector : vectors) most = std::max(most, length(vector));
  return most;
}

/// Bounds the angle of the normals over a span of `few`: with derivatives U, V of `few` and u, v of the difference,
///   |(U + u) x (V + v) - U x V| <= |U| |v| + |u| |V| + |u| |v|,
/// and U x V is no shorter than the least component, along any axis, of products of their control points.
double turn_over(const Lines& few, const Lines& shift, double from, double to) {
  const Derivatives of_few(few, from, to), of_shift(shift, from, to);
  Vec3 axis;
  for (const Vec3& u : of_few.along)
    for (const Vec3& v : of_few.across) axis += cross(u, v);
  axis = normalized(axis);
  double least = HUGE_VAL;
  for (const Vec3& u : of_few.along)
    for (const Vec3& v : of_few.across) least = std::min(least, dot(axis, cross(u, v)));
  const double u = longest(of_shift.along), v = longest(of_shift.across);
  const double moved = longest(of_few.along) * v + u * longest(of_few.across) + u * v;
  return moved < least ? std::asin(moved / least) : HUGE_VAL;
}

SplineShift shift_of(const Lines& many, const Lines& few, const Insertion& insertion) {
  const Lines shift = difference(insertion, many, few);
  double size = 0;
  for (const Vec3& point : many.points) size = std::max(size, max_abs(point));
  SplineShift made{longest(shift.points) + 0x1p-44 * size, 0};
  double from = few.along.part.from;
  for (const double knot : inner_knots(few.along)) {
    if (knot <= from) continue;
    made.angle = std::max(made.angle, turn_over(few, shift, from, std::min(knot, few.along.part.to)));
    from = knot;
    if (from >= few.along.part.to) return made;
  }
  made.angle = std::max(made.angle, turn_over(few, shift, from, few.along.part.to));
  return made;
}

}  // namespace

std::optional<SplineShift> thin(StraightenedNet& net, const SplineShift& most) {
  if (!net.weights.empty()) return {};
  const std::size_t spans_u = inner_knots(net.u).size() + 1, spans_v = inner_knots(net.v).size() + 1;
  const bool along_u = spans_u >= spans_v;
  const std::size_t spans = std::max(spans_u, spans_v);
  if (spans < many_spans) return {};
  const Lines many = lines_of(net, along_u);
  if (many.lines > most_lines) return {};
  std::optional<SplineShift> kept;
  for (std::size_t step = 2; spans / step >= fewest_spans; step *= 2) {
    Lines few{{many.along.degree, every(many.along, step), many.along.part}, many.across, 0, many.lines, {}};
    few.count = count_of(few.along);
    const Insertion insertion(few.along, many.along.knots);
    if (few.count >= many.count || !solve(insertion, many, few)) break;
    const SplineShift shift = shift_of(many, few, insertion);
    if (!(shift.distance <= most.distance && shift.angle <= most.angle)) break;
    put(few, along_u, net);
    kept = shift;
  }
  return kept;
}

}}  // namespace tessera::abi_0_1
