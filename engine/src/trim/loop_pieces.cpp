#include "trim/loop_pieces.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/text.h"
#include "convert/spline/curve_pieces.h"
#include "trim/monotone_pieces.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double max_coordinate = 1e100;
constexpr double max_periods = 64;

using Coordinate = double ParameterPoint::*;

/// Whether the lines of a periodic axis must be repeated to cover [from, to].
bool repeats(const CutAxis& axis, double from, double to) {
  return axis.periodic && !(from >= axis.from() && to <= axis.to());
}

/// The lines of an axis repeated by its period over [from, to].
CutAxis repeated(const CutAxis& axis, double from, double to) {
  if (!repeats(axis, from, to)) return axis;
  CutAxis all = axis;
  all.lines.clear();
  const double first = std::floor((from - axis.from()) / axis.period()) - 1;
  const double last = std::ceil((to - axis.from()) / axis.period()) + 1;
  for (double k = first; k < last; ++k)
    for (std::size_t i = 0; i + 1 < axis.lines.size(); ++i)
      all.lines.push_back(k == 0 ? axis.lines[i] : k == 1 && i == 0 ? axis.to() : axis.lines[i] + k * axis.period());
  return all;
}

/// Moves a piece by whole periods into the domain; `turns` is their number. Returns the rounding.
double shift_into_domain(TrimPiece& piece, const CutAxis& axis, const CutAxis& all, Coordinate x, double& turns) {
  turns = 0;
  const double lower = std::min(piece.start().*x, piece.end().*x), upper = std::max(piece.start().*x, piece.end().*x);
  if (!axis.periodic || (lower >= axis.from() && upper <= axis.to())) return 0;
  // The copy of the domain: the cell of lines that the piece lies in tells it without rounding.
  const double middle = 0.5 * lower + 0.5 * upper;
  const auto above = std::upper_bound(all.lines.begin(), all.lines.end(), middle) - all.lines.begin();
  const auto cells = static_cast<std::ptrdiff_t>(axis.lines.size()) - 1;
  turns =
      std::floor((all.lines.front() - axis.from()) / axis.period() + 0.5) + static_cast<double>((above - 1) / cells);
  double largest = 0;
  for (ParameterPoint& p : piece.curve.points) {
    largest = std::max(largest, std::abs(p.*x));
    const auto line = std::lower_bound(all.lines.begin(), all.lines.end(), p.*x);
    if (line != all.lines.end() && *line == p.*x) {
      const auto cell = (line - all.lines.begin()) - (above - 1) / cells * cells;
      p.*x = axis.lines[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(cell, 0, cells))];
    } else {
      p.*x = std::clamp(p.*x - turns * axis.period(), axis.from(), axis.to());
    }
  }
  piece.exact_line = false;
  return 0x1p-52 * (largest + std::max(std::abs(axis.from()), std::abs(axis.to())));
}

class LoopBuilder {
 public:
  LoopBuilder(const TrimLoop& loop, std::uint32_t index, const CutLines& lines, CurveExtractions& extractions)
      : loop_(loop), index_(index), lines_(lines), extractions_(extractions) {
    like_.loop = index;
  }

  Result<LoopPieces> build() {
    std::size_t spans = 0;
    for (const Curve& curve : loop_.curves) {
      const auto degree = static_cast<std::size_t>(curve.degree());
      spans += is_bezier(curve) ? curve.points().size() / degree : curve.points().size() - degree;
    }
    made_.pieces.reserve(spans);
    for (std::size_t k = 0; k < loop_.curves.size(); ++k)
      if (Status status = append_curve(k); !status.ok()) return status;
    join();
    find_corners();
    return std::move(made_);
  }

 private:
  Status append_curve(std::size_t k) {
    const Curve& curve = loop_.curves[k];
    if (Status status = set_lines(curve); !status.ok()) return status;
    if (is_bezier(curve)) {
      append_spans(curve, static_cast<std::uint32_t>(k));
      return {};
    }
    const BezierPieces spans = bezier_pieces(curve, extractions_.of(curve));
    const auto degree = static_cast<std::size_t>(spans.degree);
    ParameterPoint largest;
    for (const Vec3& p : curve.points()) largest = larger(largest, distance({p.x, p.y}, {}));
    // Knot insertion takes convex combinations, in `degree` levels of at most 4 roundings each. Weights that are off by
    // as much move a rational curve by twice that share of its size.
    const double roundings = (curve.is_rational() ? 12 : 4) * static_cast<double>(degree + 1);
    const ParameterPoint inserted = roundings * 0x1p-53 * largest;
    for (std::size_t span = 0; span + 1 < spans.breaks.size(); ++span) {
      PlaneBezier bezier;
      for (std::size_t i = span * degree; i <= (span + 1) * degree; ++i) {
        bezier.points.push_back({spans.points[i].x, spans.points[i].y});
        if (!spans.weights.empty()) bezier.weights.push_back(spans.weights[i]);
      }
      const Interval range{spans.breaks[span], spans.breaks[span + 1]};
      const ParameterPoint error = keeps_points(curve, range) ? ParameterPoint{} : inserted;
      append(std::move(bezier), error, static_cast<std::uint32_t>(k), range);
    }
    return {};
  }

  /// Whether the control points of all spans are the curve's own: its domain is that of the knots, and each knot there
  /// has full multiplicity.
  static bool is_bezier(const Curve& curve) {
    const auto knots = curve.knots();
    const auto degree = static_cast<std::size_t>(curve.degree()), count = curve.points().size();
    if ((count - 1) % degree != 0 || curve.domain().from != knots[1] || curve.domain().to != knots[count]) return false;
    for (std::size_t k = 1; k <= count; k += degree)
      if (knots[k] != knots[k + degree - 1] || !(knots[k] < knots[k + degree] || k == count)) return false;
    return true;
  }

  /// Appends the spans of a curve for which is_bezier() holds.
  void append_spans(const Curve& curve, std::uint32_t index) {
    const auto degree = static_cast<std::size_t>(curve.degree());
    for (std::size_t first = 0; first + 1 < curve.points().size(); first += degree) {
      PlaneBezier bezier;
      for (std::size_t i = first; i <= first + degree; ++i) {
        bezier.points.push_back({curve.points()[i].x, curve.points()[i].y});
        if (curve.is_rational()) bezier.weights.push_back(curve.weight(i));
      }
      append(std::move(bezier), {}, index, {curve.knots()[first + 1], curve.knots()[first + degree + 1]});
    }
  }

  /// Whether the span's control points are the curve's own, so that they were not computed: both knots have full
  /// multiplicity.
  static bool keeps_points(const Curve& curve, const Interval& span) {
    const auto knots = curve.knots();
    const auto degree = static_cast<std::ptrdiff_t>(curve.degree());
    const auto above = std::upper_bound(knots.begin(), knots.end(), span.from);
    return above - knots.begin() >= degree && knots.end() - above >= degree && *(above - degree) == span.from &&
           *(above + degree - 1) == span.to;
  }

  /// Sets the lines that the curve may cross.
  Status set_lines(const Curve& curve) {
    double u0 = lines_.u.from(), u1 = lines_.u.to(), v0 = lines_.v.from(), v1 = lines_.v.to();
    for (const Vec3& p : curve.points()) {
      u0 = std::min(u0, p.x), u1 = std::max(u1, p.x);
      v0 = std::min(v0, p.y), v1 = std::max(v1, p.y);
    }
    const double largest = std::max({std::abs(u0), std::abs(u1), std::abs(v0), std::abs(v1)});
    if (!(largest <= max_coordinate))
      return unsupported("has a coordinate of " + text(largest) + "; the largest is limited to " +
                         text(max_coordinate));
    if ((lines_.u.periodic && u1 - u0 > max_periods * lines_.u.period()) ||
        (lines_.v.periodic && v1 - v0 > max_periods * lines_.v.period()))
      return unsupported("runs over more than 64 periods of the surface");
    set_lines(u0, u1, v0, v1);
    return {};
  }
  void set_lines(double u0, double u1, double v0, double v1) {
    all_ = &lines_;
    if (!repeats(lines_.u, u0, u1) && !repeats(lines_.v, v0, v1)) return;
    repeated_ = {repeated(lines_.u, u0, u1), repeated(lines_.v, v0, v1)};
    all_ = &repeated_;
  }

  Status unsupported(const std::string& what) const {
    return Status(StatusCode::unsupported, "loop " + std::to_string(index_) + " " + what, index_);
  }

  void append(PlaneBezier bezier, const ParameterPoint& error, std::uint32_t curve, const Interval& range) {
    like_.curve_index = curve;
    like_.range = range;
    const std::size_t begin = made_.pieces.size();
    append_monotone_pieces(std::move(bezier), error, like_, *all_, made_.pieces);
    for (std::size_t k = begin; k < made_.pieces.size(); ++k) {
      TrimPiece& piece = made_.pieces[k];
      double turns_u = 0, turns_v = 0;
      piece.error.u += shift_into_domain(piece, lines_.u, all_->u, &ParameterPoint::u, turns_u);
      piece.error.v += shift_into_domain(piece, lines_.v, all_->v, &ParameterPoint::v, turns_v);
      is_odd_copy_.push_back(turns_u != 0 && std::fmod(turns_u, 2) != 0);
    }
  }

  /// One coordinate of the way from the end of a piece to the start of the next, without whole periods.
  static double gap(const CutAxis& axis, double from, double to) {
    const double distance = to - from;
    if (!axis.periodic || std::abs(distance) <= 0.5 * axis.period()) return distance;
    const double sides =
        distance > 0 ? (to - axis.to()) - (from - axis.from()) : (to - axis.from()) - (from - axis.to());
    return sides;
  }

  /// Where two coordinates that differ by rounding meet: on a line, if one of them lies there.
  static void meet(const CutAxis& axis, double& from, double& to) {
    if (axis.periodic && std::abs(to - from) > 0.5 * axis.period()) {
      const bool up = to > from;
      from = up ? axis.from() : axis.to();
      to = up ? axis.to() : axis.from();
    } else {
      from = to = axis.is_line(to) ? to : from;
    }
  }

  void join() {
    std::vector<std::pair<std::size_t, ParameterPoint>> gaps;  // the piece before, and the way to the next
    double way_u = 0, way_v = 0;
    for (std::size_t k = 0; k < made_.pieces.size(); ++k) {
      TrimPiece& piece = made_.pieces[k];
      TrimPiece& next = made_.pieces[k + 1 < made_.pieces.size() ? k + 1 : 0];
      const ParameterPoint begin = piece.start(), end = piece.end(), start = next.start();
      const double du = gap(lines_.u, end.u, start.u), dv = gap(lines_.v, end.v, start.v);
      way_u += end.u - begin.u + du;
      way_v += end.v - begin.v + dv;
      if (du == 0 && dv == 0) continue;
      if (std::abs(du) <= lines_.u.snap && std::abs(dv) <= lines_.v.snap) {
        ParameterPoint from = end, to = start;
        if (du != 0) meet(lines_.u, from.u, to.u);
        if (dv != 0) meet(lines_.v, from.v, to.v);
        move_ends(piece, begin, from);
        move_ends(next, to, next.end());
      } else {
        gaps.push_back({k, {du, dv}});
      }
    }
    if (lines_.u.periodic) made_.turns_u = static_cast<int>(std::lround(way_u / lines_.u.period()));
    if (lines_.v.periodic) made_.turns_v = static_cast<int>(std::lround(way_v / lines_.v.period()));
    if (!gaps.empty()) close_gaps(gaps);
  }

  void close_gaps(const std::vector<std::pair<std::size_t, ParameterPoint>>& gaps) {
    std::vector<TrimPiece> given;
    given.swap(made_.pieces);
    std::vector<bool> is_odd_copy;
    is_odd_copy.swap(is_odd_copy_);
    const ParameterPoint start = given.front().start();
    auto next_gap = gaps.begin();
    for (std::size_t k = 0; k < given.size(); ++k) {
      made_.pieces.push_back(std::move(given[k]));
      is_odd_copy_.push_back(is_odd_copy[k]);
      if (next_gap == gaps.end() || next_gap->first != k) continue;
      close_gap(made_.pieces.back(), k + 1 < given.size() ? given[k + 1].start() : start, next_gap->second);
      ++next_gap;
    }
  }

  /// Closes the gap from a piece to the point `to`, `du` and `dv` away.
  void close_gap(const TrimPiece& before, const ParameterPoint& to, const ParameterPoint& way) {
    const ParameterPoint from = before.end();
    const double du = way.u, dv = way.v;
    const double size = std::max(std::abs(du), std::abs(dv));
    ++made_.gaps;
    if (size > made_.largest_gap) {
      made_.largest_gap = size;
      made_.gap_curve = before.curve_index;
    }
    const bool wraps = du != to.u - from.u || dv != to.v - from.v;
    const ParameterPoint target = wraps ? ParameterPoint{from.u + du, from.v + dv} : to;
    set_lines(std::min(from.u, target.u), std::max(from.u, target.u), std::min(from.v, target.v),
              std::max(from.v, target.v));
    const bool was_odd = is_odd_copy_.back();  // `from` lies in that copy
    const std::size_t begin = is_odd_copy_.size();
    append({{from, target}, {}}, {}, no_id, {0, 1});
    for (std::size_t k = begin; k < is_odd_copy_.size(); ++k) is_odd_copy_[k] = is_odd_copy_[k] != was_odd;
    if (!wraps) return;
    TrimPiece& last = made_.pieces.back();
    move_ends(last, last.start(), {beside(lines_.u, last.end().u, to.u), beside(lines_.v, last.end().v, to.v)});
  }

  /// The copy of `to` next to `from`: a line that ends on a seam may lie on the other side than the piece after it.
  static double beside(const CutAxis& axis, double from, double to) {
    if (!axis.periodic || std::abs(to - from) <= 0.5 * axis.period()) return to;
    if (to == axis.from()) return axis.to();
    if (to == axis.to()) return axis.from();
    return to < from ? to + axis.period() : to - axis.period();
  }

  /// Counts corners by the crossings to their right: the loop crosses a line v = v.from() + periods an even number of
  /// times, and a crossing lies to the right of as many corners as there are copies of the domain to its left. A piece
  /// along a seam lies between the two places beside a corner.
  void find_corners() {
    if (!lines_.u.periodic || !lines_.v.periodic || made_.turns_u != 0 || made_.turns_v != 0) return;
    for (std::size_t k = 0; k < made_.pieces.size(); ++k) {
      const TrimPiece& piece = made_.pieces[k];
      if (piece.lower_v() != lines_.v.from() || piece.upper_v() == piece.lower_v()) continue;
      const bool along = piece.lower_u() == piece.upper_u();
      const bool at_from = along && piece.lower_u() == lines_.u.from();
      const bool at_to = along && piece.lower_u() == lines_.u.to();
      made_.holds_left ^= is_odd_copy_[k] != at_from;
      made_.holds_right ^= is_odd_copy_[k] != at_to;
    }
  }

  const TrimLoop& loop_;
  std::uint32_t index_;
  const CutLines& lines_;
  CurveExtractions& extractions_;
  TrimPiece like_;  ///< loop, curve and range of the pieces to append
  CutLines repeated_;
  const CutLines* all_ = &lines_;  ///< the lines of all copies of the domain that the curve meets
  LoopPieces made_;
  std::vector<bool> is_odd_copy_;  ///< of each piece: whether it came from a copy of the domain of odd number along u
};

}  // namespace

Result<LoopPieces> loop_pieces(const TrimLoop& loop, std::uint32_t index, const CutLines& lines,
                               CurveExtractions& extractions) {
  return LoopBuilder(loop, index, lines, extractions).build();
}

}}  // namespace tessera::abi_0_1
