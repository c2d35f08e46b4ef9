// Loops of trimmed surfaces in .g2 files. GoTools writes their number; for each loop the number of curves and a
// tolerance; for each curve whether its parameter curve is the better one, the classes of the parameter curve and of
// the space curve (0: there is none), and these curves.

#include <algorithm>
#include <array>
#include <optional>

#include "io/spline/g2.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::int64_t limit = std::int64_t{1} << 30;
constexpr std::int64_t old_spline_curve = 1;  // the class that old versions write

/// A curve in the parameters; none in space.
using ReadCurve = std::optional<Curve>;

/// The numbers of a spline curve after its class.
struct SplineNumbers {
  SplineNumbers(G2Numbers& numbers, std::int64_t dimension) {
    numbers.integer("the dimension " + std::to_string(dimension) + " of a curve", dimension, dimension);
    const bool rational = numbers.integer("the flag of a rational curve", 0, 1) == 1;
    line = read_g2_line(numbers);
    for (std::int64_t k = 0; k < line.points && numbers.ok(); ++k) {
      Vec3 p;
      p.x = numbers.number("a coordinate of a curve");
      p.y = numbers.number("a coordinate of a curve");
      if (dimension == 3) p.z = numbers.number("a coordinate of a curve");
      const double w = rational ? numbers.positive("a weight of a curve") : 1;
      if (rational) weights.push_back(w);
      points.push_back({p.x / w, p.y / w, p.z / w});
    }
  }

  G2Line line;
  std::vector<Vec3> points;
  std::vector<double> weights;
};

Result<Curve> made(Result<Curve> curve, const G2Numbers& numbers) {
  return curve ? std::move(curve) : refused_element(numbers, curve.status(), "a curve of its loops: ");
}

class LoopReader {
 public:
  explicit LoopReader(G2Numbers& numbers) : numbers_(numbers) {}

  Result<G2Loops> read() {
    G2Loops result;
    const std::int64_t count = numbers_.integer("the number of loops", 1, limit);
    for (std::int64_t k = 0; k < count && numbers_.ok(); ++k) {
      TrimLoop loop{{}, k > 0};
      const std::int64_t curves = numbers_.integer("the number of curves of a loop", 1, limit);
      numbers_.number("the tolerance of a loop");
      for (std::int64_t c = 0; c < curves && numbers_.ok(); ++c) {
        Result<ReadCurve> curve = read_curve();
        if (!curve) return curve.status();
        if (unread_) return G2Loops{.loops = {}, .unread = true};
        if (*curve) loop.curves.push_back(**std::move(curve));
      }
      result.loops.push_back(std::move(loop));
    }
    if (!numbers_.ok()) return numbers_.status();
    return result;
  }

 private:
  /// Reads a curve on the surface. Sets unread_ if its curves are of other classes.
  Result<ReadCurve> read_curve() {
    numbers_.integer("the flag of the better curve", 0, 1);
    const std::int64_t kind = numbers_.integer("the class of a curve in the parameters", 0, 999);
    const std::int64_t spatial = numbers_.integer("the class of a curve in space", 0, 999);
    Result<ReadCurve> curve = read_flat(kind);
    if (curve && !unread_ && spatial != 0) skip_spatial(spatial);
    if (!numbers_.ok()) return numbers_.status();
    return curve;
  }

  Result<ReadCurve> read_flat(std::int64_t kind) {
    if (kind == g2_spline_curve || kind == old_spline_curve) return read_spline();
    if (kind == g2_line) return read_line();
    unread_ = numbers_.ok();
    return ReadCurve();
  }

  void skip_spatial(std::int64_t kind) {
    if (kind == g2_spline_curve || kind == old_spline_curve) {
      skip_spline();
    } else if (kind == g2_line || kind == g2_circle) {
      numbers_.integer("the dimension 3 of a curve in space", 3, 3);
      if (kind == g2_circle) numbers_.number("the radius of a circle");
      const int vectors = kind == g2_circle ? 3 : 2;  // centre, normal, first axis; or a point and the direction
      for (int k = 0; k < vectors; ++k) numbers_.vector("a coordinate of a curve in space");
      if (kind == g2_circle) skip_range();
      if (kind == g2_line) take_range();
    } else {
      unread_ = numbers_.ok();
    }
  }

  /// Skips a spline in space, which need not be one that can be made.
  void skip_spline() { const SplineNumbers ignored(numbers_, 3); }

  void skip_range() {
    numbers_.number("a limit of a curve");
    numbers_.number("a limit of a curve");
    numbers_.integer("the flag of a reversed curve", 0, 1);
  }

  struct Range {
    double from = 0, to = 0;
    bool bounded = false, reversed = false;
  };
  Range take_range() {
    Range range{.bounded = numbers_.integer("the flag of a bounded line", 0, 1) == 1};
    if (range.bounded) {
      range.from = numbers_.number("a limit of a line");
      range.to = numbers_.number("a limit of a line");
    }
    range.reversed = numbers_.integer("the flag of a reversed curve", 0, 1) == 1;
    return range;
  }

  /// Reads a line in the parameters: a point, the direction, its range.
  Result<ReadCurve> read_line() {
    numbers_.integer("the dimension 2 of a curve in the parameters", 2, 2);
    Vec3 point, direction;
    for (Vec3* const v : {&point, &direction})
      for (double* const coordinate : {&v->x, &v->y}) *coordinate = numbers_.number("a coordinate of a line");
    const Range range = take_range();
    if (!numbers_.ok()) return numbers_.status();
    if (!range.bounded) {
      unread_ = true;
      return ReadCurve();
    }
    std::array ends{point + range.from * direction, point + range.to * direction};
    if (range.reversed) std::swap(ends[0], ends[1]);
    Result<Curve> line = made(Curve::bezier(ends), numbers_);
    if (!line) return line.status();
    return ReadCurve(*std::move(line));
  }

  Result<ReadCurve> read_spline() {
    Result<Curve> curve = read_g2_curve(numbers_, 2);
    if (!curve) return curve.status();
    return ReadCurve(*std::move(curve));
  }

  G2Numbers& numbers_;
  bool unread_ = false;
};

}  // namespace

G2Line read_g2_line(G2Numbers& numbers) {
  G2Line line;
  line.points = numbers.integer("the number of points along a direction", 1, limit);
  line.order = numbers.integer("the order along a direction", 2, max_degree + 1);
  const std::int64_t count = line.points + line.order;
  // Bounded by the text that is left, whatever count the file states: a number takes two bytes.
  line.knots.reserve(std::min(static_cast<std::size_t>(count), numbers.cursor().remaining() / 2 + 1));
  for (std::int64_t k = 0; k < count && numbers.ok(); ++k) line.knots.push_back(numbers.number("a knot"));
  return line;
}

Result<Curve> read_g2_curve(G2Numbers& numbers, std::int64_t dimension) {
  const SplineNumbers spline(numbers, dimension);
  if (!numbers.ok()) return numbers.status();
  const int degree = spline.line.degree();
  Result<Curve> curve = spline.weights.empty() ? Curve::b_spline(degree, spline.points, spline.line.knots)
                                               : Curve::nurbs(degree, spline.points, spline.weights, spline.line.knots);
  if (!curve)
    return refused_element(numbers, curve.status(), dimension == 2 ? "a curve of its loops: " : "its curve: ");
  return curve;
}

Result<G2Loops> read_g2_loops(G2Numbers& numbers) { return LoopReader(numbers).read(); }

}}  // namespace tessera::abi_0_1
