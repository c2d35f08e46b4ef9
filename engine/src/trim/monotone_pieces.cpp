#include "trim/monotone_pieces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double ulp = 0x1p-52;

/// The largest absolute u, and the largest absolute v.
ParameterPoint largest_coordinates(const PlaneBezier& curve) {
  ParameterPoint largest;
  for (const ParameterPoint& p : curve.points) largest = larger(largest, distance(p, {}));
  return largest;
}

/// Makes one coordinate of the control polygon monotone between its ends, and returns how far a point moved.
double make_monotone(std::span<ParameterPoint> points, double ParameterPoint::*x) {
  const double first = points.front().*x, last = points.back().*x;
  const bool increases = first <= last;
  double before = first, moved = 0;
  for (ParameterPoint& p : points) {
    const double value = increases ? std::clamp(p.*x, before, last) : std::clamp(p.*x, last, before);
    moved = std::max(moved, std::abs(value - p.*x));
    before = p.*x = value;
  }
  return moved;
}
ParameterPoint make_monotone(PlaneBezier& curve) {
  return {make_monotone(curve.points, &ParameterPoint::u), make_monotone(curve.points, &ParameterPoint::v)};
}

/// Where a curve is cut.
struct Cut {
  double t = 0;
  ParameterPoint at = {};
  ParameterPoint moved = {};  ///< the distance of `at` from the curve

  bool is_exact() const { return moved == ParameterPoint{}; }
};

class Cutter {
 public:
  Cutter(const PlaneBezier& curve, const ParameterPoint& error, const TrimPiece& like, const CutLines& lines,
         std::vector<TrimPiece>& pieces)
      : curve_(curve),
        error_(error),
        like_(like),
        lines_(lines),
        pieces_(pieces),
        rounding_((curve.weights.empty() ? 1 : 2) * ulp * largest_coordinates(curve)) {
    is_line_ = curve.degree() == 1 && error == ParameterPoint{};
  }

  void run() {
    const Cut start = cut_at(0), end = cut_at(1);
    const bool crosses_line = crosses(lines_.u, start.at.u, end.at.u) || crosses(lines_.v, start.at.v, end.at.v);
    if (!crosses_line && append_monotone(start, end)) return;
    std::vector<double> parameters{0, 1};
    append_extrema(curve_, 0, parameters);
    append_extrema(curve_, 1, parameters);
    std::sort(parameters.begin(), parameters.end());
    parameters.erase(std::unique(parameters.begin(), parameters.end()), parameters.end());
    std::vector<Cut> cuts;
    for (const double t : parameters) {
      const Cut next = cut_at(t);
      if (!cuts.empty()) append_crossings(cuts.back(), next, cuts);
      cuts.push_back(next);
    }
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) append_piece(cuts[k], cuts[k + 1], max_depth);
  }

 private:
  static constexpr int max_depth = 30;

  /// Whether a line lies strictly between two coordinates.
  static bool crosses(const CutAxis& axis, double a, double b) {
    const auto line = std::upper_bound(axis.lines.begin(), axis.lines.end(), std::min(a, b));
    return line != axis.lines.end() && *line < std::max(a, b);
  }

  Cut cut_at(double t) const {
    const ParameterPoint exact = t == 0   ? curve_.points.front()
                                 : t == 1 ? curve_.points.back()
                                          : precise_point(curve_, t).rounded();
    const ParameterPoint at = lines_.snapped(exact);
    return {t, at, distance(exact, at)};
  }

  /// Appends the cuts at lines strictly between two cuts with a monotone curve in between.
  void append_crossings(const Cut first, const Cut last, std::vector<Cut>& cuts) const {
    const std::size_t begin = cuts.size();
    append_crossings(lines_.u, &ParameterPoint::u, first, last, cuts);
    append_crossings(lines_.v, &ParameterPoint::v, first, last, cuts);
    const auto by_parameter = [](const Cut& a, const Cut& b) { return a.t < b.t; };
    std::sort(cuts.begin() + static_cast<std::ptrdiff_t>(begin), cuts.end(), by_parameter);
  }
  void append_crossings(const CutAxis& axis, double ParameterPoint::*x, const Cut& first, const Cut& last,
                        std::vector<Cut>& cuts) const {
    const double from = std::min(first.at.*x, last.at.*x), to = std::max(first.at.*x, last.at.*x);
    const auto begin = std::upper_bound(axis.lines.begin(), axis.lines.end(), from);
    const auto end = std::lower_bound(begin, axis.lines.end(), to);
    for (auto line = begin; line < end; ++line) {
      const double t = crossing(x, *line, first, last);
      if (!(t > first.t && t < last.t)) continue;
      const ParameterPoint exact = precise_point(curve_, t).rounded();
      ParameterPoint at = lines_.snapped(exact);
      at.*x = *line;
      cuts.push_back({t, at, distance(exact, at)});
    }
  }

  /// The parameter where the coordinate has a value that lies strictly between those at the two cuts.
  double crossing(double ParameterPoint::*x, double value, const Cut& first, const Cut& last) const {
    double lower = first.t, upper = last.t;
    double f_lower = first.at.*x - value, f_upper = last.at.*x - value;
    const bool increases = f_lower < f_upper;
    const ParameterPoint origin{value, value};
    for (int k = 0; k < 100 && upper - lower > 0x1p-54 * upper; ++k) {
      double t = 0.5 * lower + 0.5 * upper;
      if (k % 3 != 2) t = lower + (upper - lower) * (f_lower / (f_lower - f_upper));
      if (!(t > lower && t < upper)) t = 0.5 * lower + 0.5 * upper;
      if (!(t > lower && t < upper)) break;
      const double f = relative_point(curve_, origin, t).*x;
      if (f == 0) return t;
      const bool below = (f < 0) == increases;
      (below ? lower : upper) = t;
      (below ? f_lower : f_upper) = f;
    }
    return std::abs(f_lower) < std::abs(f_upper) && lower > first.t ? lower : upper;
  }

  /// Appends the piece between two cuts; halves it while its control polygon is not monotone.
  void append_piece(const Cut& first, const Cut& last, int depth) {
    if (!(first.t < last.t) || append_monotone(first, last, depth == 0)) return;
    const Cut between = cut_at(0.5 * first.t + 0.5 * last.t);
    append_piece(first, between, depth - 1);
    append_piece(between, last, depth - 1);
  }

  /// Appends the piece between two cuts if its control polygon is monotone up to rounding, or `always`. Returns whether
  /// it did, or the piece is a point.
  bool append_monotone(const Cut& first, const Cut& last, bool always = false) {
    TrimPiece& piece = pieces_.emplace_back(like_);
    piece.curve = part(curve_, first.t, last.t);
    piece.curve.points.front() = first.at;
    piece.curve.points.back() = last.at;
    const ParameterPoint moved = larger(make_monotone(piece.curve), larger(first.moved, last.moved));
    const ParameterPoint most = 8 * rounding_ + (first.moved + last.moved);
    const bool is_monotone = (moved.u <= most.u && moved.v <= most.v) || always;
    if (!is_monotone || first.at == last.at) {
      pieces_.pop_back();
      return is_monotone;
    }
    const bool whole = first.t == 0 && last.t == 1;
    piece.error = error_ + moved + (whole ? ParameterPoint{} : rounding_);
    const double width = like_.range.to - like_.range.from;
    piece.range = {first.t == 0 ? like_.range.from : like_.range.from + first.t * width,
                   last.t == 1 ? like_.range.to : like_.range.from + last.t * width};
    set_line(piece, first, last);
    return true;
  }

  void set_line(TrimPiece& piece, const Cut& first, const Cut& last) const {
    const auto is_on_line = [&](const Cut& cut) {
      if (cut.t == 0 || cut.t == 1) return cut.is_exact();
      return cut.moved.u <= 4 * rounding_.u && cut.moved.v <= 4 * rounding_.v;
    };
    if (is_line_ && is_on_line(first) && is_on_line(last)) {
      piece.line_from = curve_.points.front();
      piece.line_to = curve_.points.back();
      piece.exact_line = true;
      piece.error = {};
    } else if (piece.error == ParameterPoint{} && (first.at.u == last.at.u || first.at.v == last.at.v)) {
      piece.line_from = first.at;
      piece.line_to = last.at;
      piece.exact_line = true;
    }
  }

  const PlaneBezier& curve_;
  ParameterPoint error_;
  const TrimPiece& like_;
  const CutLines& lines_;
  std::vector<TrimPiece>& pieces_;
  ParameterPoint rounding_;  ///< what rounding the points and weights of a part once moves it, at most
  bool is_line_;
};

/// Moves a curve that runs along a line of the axis onto it. Returns the displacement.
double settle_on_line(PlaneBezier& curve, const CutAxis& axis, double ParameterPoint::*x) {
  if (std::abs(curve.points.back().*x - curve.points.front().*x) > 2 * axis.snap) return 0;
  const double line = axis.snapped(curve.points.front().*x);
  if (!axis.is_line(line)) return 0;
  double moved = 0;
  for (const ParameterPoint& p : curve.points) moved = std::max(moved, std::abs(p.*x - line));
  if (moved > axis.snap) return 0;
  for (ParameterPoint& p : curve.points) p.*x = line;
  return moved;
}

}  // namespace

void append_monotone_pieces(PlaneBezier curve, const ParameterPoint& error, const TrimPiece& like,
                            const CutLines& lines, std::vector<TrimPiece>& pieces) {
  const double moved_u = settle_on_line(curve, lines.u, &ParameterPoint::u);
  const double moved_v = settle_on_line(curve, lines.v, &ParameterPoint::v);
  Cutter(curve, error + ParameterPoint{moved_u, moved_v}, like, lines, pieces).run();
}

void move_ends(TrimPiece& piece, const ParameterPoint& start, const ParameterPoint& end) {
  const ParameterPoint moved = larger(distance(piece.start(), start), distance(piece.end(), end));
  if (moved == ParameterPoint{}) return;
  piece.curve.points.front() = start;
  piece.curve.points.back() = end;
  piece.error = piece.error + larger(moved, make_monotone(piece.curve));
  piece.exact_line = false;
}

}}  // namespace tessera::abi_0_1
