// .g2, the files of GoTools (SINTEF): objects one after the other. A spline surface (class 200) holds the dimension and
// whether it is rational; for u and v the number of points, the order and the knots; then the points, u running
// fastest, rational ones as w x, w y, w z, w. A trimmed surface (class 210) is a surface and its loops. An object of a
// class that is not read ends at the next line that is a header.

#include "io/spline/g2.h"

#include <algorithm>

#include "base/saturated.h"
#include "base/text.h"
#include "io/spline/item_reader.h"
#include "tessera/guard.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::pair<std::int64_t, PartName> unread_classes[] = {
    {100, {"spline curve", "spline curves"}},
    {110, {"curve on a surface", "curves on surfaces"}},
    {120, {"line", "lines"}},
    {130, {"circle", "circles"}},
    {140, {"ellipse", "ellipses"}},
    {150, {"bounded curve", "bounded curves"}},
    {160, {"hyperbola", "hyperbolas"}},
    {170, {"parabola", "parabolas"}},
    {261, {"surface of linear extrusion", "surfaces of linear extrusion"}},
    {291, {"surface of revolution", "surfaces of revolution"}},
    {292, {"disc", "discs"}},
    {293, {"LR spline surface", "LR spline surfaces"}},
    {294, {"T-spline surface", "T-spline surfaces"}},
    {400, {"cloud of points", "clouds of points"}},
    {410, {"cloud of lines", "clouds of lines"}},
    {700, {"spline volume", "spline volumes"}}};
constexpr PartName others{"object of another class", "objects of other classes"},
    unbounded{"unbounded surface", "unbounded surfaces"},
    flat{"surface that is not in space", "surfaces that are not in space"},
    trimmed_others{"trimmed torus or surface of another class", "trimmed tori or surfaces of other classes"},
    trimmed_otherwise{"trimmed surface without splines or lines in its parameters",
                      "trimmed surfaces without splines or lines in their parameters"};

PartName unread_name(std::int64_t kind) {
  const auto known = std::find_if(std::begin(unread_classes), std::end(unread_classes),
                                  [&](const auto& entry) { return entry.first == kind; });
  return known == std::end(unread_classes) ? others : known->second;
}

/// Takes a header and returns its class, or returns 0 with the cursor anywhere in it. `alone`: the header must fill its
/// line.
std::int64_t take_header(TextCursor& cursor, bool alone) {
  const auto take = [&](std::int64_t& value) {
    alone ? cursor.skip_blanks() : cursor.skip_space();
    return cursor.take_number(value);
  };
  std::int64_t kind = 0, major = 0, minor = 0, auxiliary = 0, ignored = 0;
  if (!take(kind) || !take(major) || !take(minor) || !take(auxiliary)) return 0;
  if (kind < 100 || kind > 999 || major < 0 || major > 9 || minor < 0 || minor > 9) return 0;
  if (auxiliary < 0 || auxiliary > 16) return 0;
  for (std::int64_t k = 0; k < auxiliary; ++k) {  // usually a colour
    if (!take(ignored)) return 0;
  }
  return !alone || cursor.take_line_end() ? kind : 0;
}

/// Reads one object.
class G2ObjectReader {
 public:
  /// `number` counts from 1. `beyond`: the bytes of the file after the text.
  G2ObjectReader(TextCursor& cursor, std::size_t number, std::uint64_t beyond)
      : cursor_(cursor), number_(number), beyond_(beyond), header_(cursor) {}

  Result<ReadItem> read() {
    const std::int64_t kind = take_header(cursor_, false);
    if (kind == 0) return header_.expected("the header of an object (class, version 1 0, auxiliary numbers)");
    const Status status = read_object(kind);
    if (!status.ok()) return status;
    return std::move(item_);
  }

 private:
  Status read_object(std::int64_t kind) {
    G2Numbers numbers(cursor_, header_, "object " + std::to_string(number_) + " (class " + std::to_string(kind) + ")");
    switch (kind) {
      case g2_spline_surface:
        return read_spline(numbers);
      case g2_trimmed_surface:
        return read_trimmed(numbers);
      case g2_plane:
      case g2_cylinder:
      case g2_sphere:
      case g2_cone:
      case g2_torus:
        return read_elementary(kind, numbers);
      default:
        pass_over(unread_name(kind));
        return {};
    }
  }

  /// Skips to the next line that is a header.
  void pass_over(const PartName& name) {
    item_.passed_over = PassedItem{name, header_};
    for (cursor_.skip_space(); !cursor_.at_end(); cursor_.skip_space()) {
      TextCursor ahead = cursor_;
      if (take_header(ahead, true) != 0) return;
      for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) cursor_.skip(cursor_.peek_token());
    }
  }

  Status read_elementary(std::int64_t kind, G2Numbers& numbers) {
    const G2Elementary record = read_g2_elementary(kind, numbers, false);
    if (!numbers.ok()) return numbers.status();
    if (!record.bounded) {
      pass_over(unbounded);
      return {};
    }
    Result<G2Object> object = make_g2_elementary(kind, record, numbers);
    if (!object) return object.status();
    item_.swapped = record.swapped;
    add({{}, std::move(object->surface), object->placement});
    return {};
  }

  void add(ModelSurface surface) { item_.surface = std::move(surface); }

  /// Reads a spline surface after its class; none if it is not in space.
  Result<std::optional<BSplineSurface>> take_spline(G2Numbers& numbers) {
    const std::int64_t dimension = numbers.integer("the dimension", 1, 3);
    const bool rational = numbers.integer("the flag of a rational surface", 0, 1) == 1;
    const G2Line u = read_g2_line(numbers), v = read_g2_line(numbers);
    if (!numbers.ok()) return numbers.status();
    if (dimension < 2) return std::optional<BSplineSurface>();
    const auto count_u = static_cast<std::size_t>(u.points), count_v = static_cast<std::size_t>(v.points);
    const auto bytes = static_cast<std::size_t>(2 * (dimension + rational));  // the least that a point takes
    if (saturated_product(count_u, count_v) > (cursor_.remaining() + beyond_) / bytes + 1) {
      return numbers.failure("the file is shorter than its " + std::to_string(count_u) + " x " +
                             std::to_string(count_v) + " points");
    }
    std::vector<Vec3> points(count_u * count_v);
    std::vector<double> weights(rational ? points.size() : 0);
    for (std::size_t j = 0; j < count_v && numbers.ok(); ++j)  // u runs fastest in the file, v here
      for (std::size_t i = 0; i < count_u && numbers.ok(); ++i) {
        const std::size_t at = i * count_v + j;
        points[at] = read_point(numbers, dimension, rational ? &weights[at] : nullptr);
      }
    if (!numbers.ok()) return numbers.status();
    Result<BSplineSurface> surface =
        rational
            ? BSplineSurface::rational(u.degree(), u.knots, v.degree(), v.knots, std::move(points), std::move(weights))
            : BSplineSurface::polynomial(u.degree(), u.knots, v.degree(), v.knots, std::move(points));
    if (!surface) return refused_element(numbers, surface.status());
    return std::optional(*std::move(surface));
  }

  Status read_spline(G2Numbers& numbers) {
    Result<std::optional<BSplineSurface>> surface = take_spline(numbers);
    if (!surface) return surface.status();
    if (*surface)
      add({{}, **std::move(surface)});
    else
      pass_over(flat);
    return {};
  }

  Status read_trimmed(G2Numbers& numbers) {
    const std::int64_t kind = numbers.integer("the class of the trimmed surface", 100, 999);
    switch (kind) {
      case g2_spline_surface:
        return read_trimmed_spline(numbers);
      case g2_plane:
      case g2_cylinder:
      case g2_sphere:
      case g2_cone:
        return read_trimmed_elementary(kind, numbers);
      case g2_extrusion:
        return read_trimmed_extrusion(numbers);
      default:
        if (numbers.ok()) pass_over(trimmed_others);
        return numbers.status();
    }
  }

  Status read_trimmed_spline(G2Numbers& numbers) {
    Result<std::optional<BSplineSurface>> surface = take_spline(numbers);
    if (!surface) return surface.status();
    if (!*surface) {
      pass_over(flat);
      return {};
    }
    Result<G2Loops> loops = read_g2_loops(numbers);
    if (!loops) return loops.status();
    if (loops->unread)
      pass_over(trimmed_otherwise);
    else
      add({{}, **std::move(surface), {}, std::move(loops->loops)});
    return {};
  }

  /// Reads an elementary surface. Bounds along straight lines are often as good as infinite, if there are any: there
  /// the surface ends where its loops do.
  Status read_trimmed_elementary(std::int64_t kind, G2Numbers& numbers) {
    G2Elementary record = read_g2_elementary(kind, numbers, true);
    if (!numbers.ok()) return numbers.status();
    Result<G2Loops> loops = take_loops(numbers, record.swapped);
    if (!loops || loops->unread) return loops.status();
    const Box3 box = box_of(loops->loops);
    if (kind == g2_plane) record.range.u0 = box.lower.x, record.range.u1 = box.upper.x;
    if (kind != g2_sphere) record.range.v0 = box.lower.y, record.range.v1 = box.upper.y;
    Result<G2Object> object = make_g2_elementary(kind, record, numbers);
    if (!object) return object.status();
    const double shift = object->shift_v;
    if (shift != 0) {
      const Status status = map_points(loops->loops, [shift](const Vec3& p) { return Vec3{p.x, p.y + shift, 0}; });
      if (!status.ok()) return status;
    }
    add({{}, std::move(object->surface), object->placement, std::move(loops->loops)});
    return {};
  }

  Status read_trimmed_extrusion(G2Numbers& numbers) {
    const Result<G2Extrusion> extrusion = read_g2_extrusion(numbers);
    if (!extrusion) return extrusion.status();
    Result<G2Loops> loops = take_loops(numbers, extrusion->swapped);
    if (!loops || loops->unread) return loops.status();
    const Box3 box = box_of(loops->loops);
    Result<Surface> surface = make_g2_extrusion(*extrusion, {box.lower.y, box.upper.y});
    if (!surface) return refused_element(numbers, surface.status());
    add({{}, *std::move(surface), {}, std::move(loops->loops)});
    return {};
  }

  /// Reads the loops of a surface whose u and v are not swapped here. Passes over the object if they are unread.
  Result<G2Loops> take_loops(G2Numbers& numbers, bool swapped) {
    Result<G2Loops> loops = read_g2_loops(numbers);
    if (!loops) return loops;
    if (loops->unread) {
      pass_over(trimmed_otherwise);
      return loops;
    }
    const Box3 box = box_of(loops->loops);
    if (!(box.lower.x < box.upper.x && box.lower.y < box.upper.y)) return numbers.failure("its loops enclose nothing");
    if (!swapped) return loops;
    if (Status status = map_points(loops->loops, [](const Vec3& p) { return Vec3{p.y, p.x, 0}; }); !status.ok())
      return status;
    return loops;
  }

  static Box3 box_of(const std::vector<TrimLoop>& loops) {
    Box3 box;
    for (const TrimLoop& loop : loops)
      for (const Curve& curve : loop.curves)
        for (const Vec3& p : curve.points()) box.extend(p);
    return box;
  }

  /// Maps the control points of all curves: right for an affine map.
  template <class Map>
  static Status map_points(std::vector<TrimLoop>& loops, const Map& map) {
    for (TrimLoop& loop : loops)
      for (Curve& curve : loop.curves) {
        std::vector<Vec3> points;
        for (const Vec3& p : curve.points()) points.push_back(map(p));
        Result<Curve> mapped = curve.is_rational()
                                   ? Curve::nurbs(curve.degree(), points, curve.weights(), curve.knots())
                                   : Curve::b_spline(curve.degree(), points, curve.knots());
        if (!mapped) return mapped.status();
        curve = *std::move(mapped);
      }
    return {};
  }

  /// Divides by the weight. Surfaces of the plane lie in z = 0.
  static Vec3 read_point(G2Numbers& numbers, std::int64_t dimension, double* weight) {
    Vec3 point;
    point.x = numbers.number("a coordinate");
    point.y = numbers.number("a coordinate");
    if (dimension == 3) point.z = numbers.number("a coordinate");
    if (!weight) return point;
    *weight = numbers.positive("a weight");
    return {point.x / *weight, point.y / *weight, point.z / *weight};
  }

  TextCursor& cursor_;
  std::size_t number_;
  std::uint64_t beyond_;
  TextCursor header_;
  ReadItem item_;
};

class G2Reader : public ItemReader {
 public:
  // A header may fill its line, and what follows tells whether it does.
  std::string_view cuts() const override { return "\n"; }

  bool more(TextCursor& cursor, std::size_t) const override {
    cursor.skip_space();
    return !cursor.at_end();
  }

  Result<ReadItem> read(TextCursor& cursor, std::size_t item, std::uint64_t beyond) override {
    return G2ObjectReader(cursor, item + 1, beyond).read();
  }

  Status end(TextCursor& cursor, const PassedOver* nothing) const override {
    if (!nothing) return {};
    return nothing->empty() ? cursor.expected("an object") : nothing->nothing_else();
  }

  std::size_t expected(std::uint64_t) const override { return 0; }
  std::unique_ptr<ItemReader> for_rest() const override { return std::make_unique<G2Reader>(); }
  bool seems_item(TextCursor& line) const override { return take_header(line, true) != 0; }
};

}  // namespace

void G2Numbers::fail(std::string_view what) { status_ = cursor_.expected(std::string(what) + " of " + object_); }

double G2Numbers::positive(std::string_view what) {
  if (!ok()) return 1;
  cursor_.skip_space();
  const TextCursor before = cursor_;
  double value = 0;
  if (cursor_.take_finite(value) && value > 0) return value;
  status_ = before.expected(std::string(what) + " above 0 of " + object_);
  return 1;
}

std::int64_t G2Numbers::integer(std::string_view what, std::int64_t low, std::int64_t high) {
  std::int64_t value = low;
  if (!ok()) return value;
  cursor_.skip_space();
  const TextCursor before = cursor_;
  if (cursor_.take_number(value) && value >= low && value <= high) return value;
  const std::string range = low == high ? "" : ", from " + std::to_string(low) + " to " + std::to_string(high);
  status_ = before.expected(std::string(what) + " of " + object_ + range);
  return low;
}

Vec3 G2Numbers::vector(std::string_view what) {
  Vec3 v;
  for (double* const coordinate : {&v.x, &v.y, &v.z}) *coordinate = number(what);
  return v;
}

Result<Model> parse_g2(std::string_view text, std::string_view name) {
  return guarded([&] {
    G2Reader reader;
    return read_items(reader, text, name);
  });
}

std::unique_ptr<ItemReader> make_g2_reader() { return std::make_unique<G2Reader>(); }

}}  // namespace tessera::abi_0_1
