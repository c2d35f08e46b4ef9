#include "io/rib/rib_mesh.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double sixth = 1.0 / 6;
// The Interface's own bases (The RenderMan Interface Specification 3.2, sec. 5.2), rows from t^3 down to 1.
constexpr RibBasis bezier_basis{{-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}, 3};
constexpr RibBasis b_spline_basis{
    {-sixth, 0.5, -0.5, sixth, 0.5, -1, 0.5, 0, -0.5, 0, 0.5, 0, sixth, 4 * sixth, sixth, 0}, 1};
constexpr RibBasis catmull_rom_basis{{-0.5, 1.5, -1.5, 0.5, 1, -2.5, 2, -0.5, -0.5, 0, 0.5, 0, 0, 1, 0, 0}, 1};
constexpr RibBasis hermite_basis{{2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0}, 2};
constexpr RibBasis power_basis{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 4};

/// How a direction becomes a B-spline. The points are kept over simple or 3-fold knots; Catmull-Rom and Hermite cubics
/// have double knots; other bases go patch by patch.
enum class Form { linear, bezier, b_spline, catmull_rom, hermite, separate };

Form form_of(const RibDirection& direction) {
  if (!direction.basis) return Form::linear;
  const RibBasis& basis = *direction.basis;
  if (basis == bezier_basis) return Form::bezier;
  if (basis == b_spline_basis) return Form::b_spline;
  if (basis == catmull_rom_basis) return Form::catmull_rom;
  return basis == hermite_basis ? Form::hermite : Form::separate;
}

/// Maps the geometry of one patch to its Bezier points.
class PatchMatrix {
 public:
  static Result<PatchMatrix> make(const RibBasis& basis) {
    std::array<double, 16> rows;  // from 1 up to t^3
    for (std::size_t k = 0; k < 16; ++k) rows[k] = basis.matrix[(3 - k / 4) * 4 + k % 4];
    Result<BasisMatrix> matrix = BasisMatrix::custom(3, rows);
    if (!matrix) return matrix.status();
    return PatchMatrix(*std::move(matrix));
  }
  Homogeneous point(int k, const std::array<Homogeneous, 4>& geometry) const {
    Homogeneous sum{0, 0, 0, 0};
    for (int i = 0; i < 4; ++i) {
      sum = sum + matrix_.bernstein_coefficient(k, i) * geometry[static_cast<std::size_t>(i)];
    }
    return sum;
  }

 private:
  explicit PatchMatrix(BasisMatrix matrix) : matrix_(std::move(matrix)) {}
  BasisMatrix matrix_;
};

/// One direction of the result: lines of the mesh's points in, lines of control points out.
struct SplineDirection {
  Form form;
  int step = 1;
  std::size_t points, patches;
  std::optional<PatchMatrix> matrix = {};  // only of separate patches
  std::vector<double> knots = {};          // empty for separate patches

  int degree() const { return form == Form::linear ? 1 : 3; }
};

/// Knots on [0,1] clamped at the ends, inner ones of multiplicity `times`.
std::vector<double> clamped_knots(int degree, std::size_t patches, int times) {
  std::vector<double> knots(static_cast<std::size_t>(degree + 1), 0.0);
  for (std::size_t k = 1; k < patches; ++k) {
    knots.insert(knots.end(), static_cast<std::size_t>(times), static_cast<double>(k) / static_cast<double>(patches));
  }
  knots.insert(knots.end(), static_cast<std::size_t>(degree + 1), 1.0);
  return knots;
}

std::vector<double> make_knots(Form form, std::size_t patches) {
  switch (form) {
    case Form::linear:
      return clamped_knots(1, patches, 1);
    case Form::bezier:
      return clamped_knots(3, patches, 3);
    case Form::b_spline: {
      std::vector<double> knots(patches + 7);
      for (std::size_t k = 0; k < knots.size(); ++k) {
        knots[k] = (static_cast<double>(k) - 3) / static_cast<double>(patches);
      }
      return knots;
    }
    case Form::catmull_rom:
    case Form::hermite:
      return clamped_knots(3, patches, 2);
    case Form::separate:
      break;
  }
  return {};
}

Result<SplineDirection> make_direction(const RibDirection& direction, bool separate) {
  const Result<std::int64_t> patches = direction.patches();
  if (!patches) return patches.status();
  SplineDirection spline{.form = separate ? Form::separate : form_of(direction),
                         .step = direction.basis ? direction.basis->step : 1,
                         .points = static_cast<std::size_t>(direction.points),
                         .patches = static_cast<std::size_t>(*patches)};
  spline.knots = make_knots(spline.form, spline.patches);
  if (separate) {
    Result<PatchMatrix> matrix = PatchMatrix::make(*direction.basis);
    if (!matrix) return matrix.status();
    spline.matrix = *std::move(matrix);
  }
  return spline;
}

using Line = std::vector<Homogeneous>;

/// Makes a line of control points from a line of the mesh; wraps around if the end lies beyond its last point.
Line spline_line(const SplineDirection& direction, const Line& line) {
  const auto at = [&](std::size_t k) { return line[k % line.size()]; };
  const std::size_t n = direction.patches;
  Line out;
  if (direction.form == Form::linear || direction.form == Form::bezier || direction.form == Form::b_spline) {
    const std::size_t count = direction.knots.size() - static_cast<std::size_t>(direction.degree()) - 1;
    for (std::size_t k = 0; k < count; ++k) out.push_back(at(k));
    return out;
  }
  const auto third = [](const Homogeneous& p, double sign, const Homogeneous& tangent) {
    return p + (sign / 3) * tangent;
  };
  if (direction.form == Form::catmull_rom) {
    const auto tangent = [&](std::size_t k) { return 0.5 * (at(k + 1) - at(k - 1)); };  // at points 1 to n + 1
    out.push_back(at(1));
    for (std::size_t k = 1; k <= n; ++k) {
      out.push_back(third(at(k), 1, tangent(k)));
      out.push_back(third(at(k + 1), -1, tangent(k + 1)));
    }
    out.push_back(at(n + 1));
  } else if (direction.form == Form::hermite) {
    out.push_back(at(0));
    for (std::size_t k = 0; k < n; ++k) {
      out.push_back(third(at(2 * k), 1, at(2 * k + 1)));
      out.push_back(third(at(2 * k + 2), -1, at(2 * k + 3)));
    }
    out.push_back(at(2 * n));
  } else {
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t first = k * static_cast<std::size_t>(direction.step);
      const std::array<Homogeneous, 4> geometry{at(first), at(first + 1), at(first + 2), at(first + 3)};
      for (int i = 0; i < 4; ++i) out.push_back(direction.matrix->point(i, geometry));
    }
  }
  return out;
}

/// Whether the mesh's points are, in order, the control points along this direction.
bool keeps_points(const SplineDirection& d) {
  const bool same = d.form == Form::linear || d.form == Form::bezier || d.form == Form::b_spline;
  return same && d.knots.size() == d.points + static_cast<std::size_t>(d.degree()) + 1;
}

/// Control points [i][j] and their weights (none for a polynomial net), filled one by one in any order.
class Weighted {
 public:
  Weighted(std::size_t count, bool rational) : points(count), weights(rational ? count : 0) {}

  void set(std::size_t k, const Homogeneous& p) {
    if (weights.empty()) {
      points[k] = p.vector();
    } else if (p.w > 0) {
      points[k] = p.project();
      weights[k] = p.w;
    } else {
      if (k < bad_) bad_weight_ = p.w;
      bad_ = std::min(bad_, k);
    }
  }
  Status status() const {
    if (bad_ >= points.size()) return {};
    return {StatusCode::invalid_weight,
            "weight " + text(bad_weight_) + " of control point " + std::to_string(bad_) + " is not above 0",
            static_cast<std::ptrdiff_t>(bad_)};
  }

  std::vector<Vec3> points;
  std::vector<double> weights;

 private:
  std::size_t bad_ = static_cast<std::size_t>(-1);  // the first one whose weight is not above 0
  double bad_weight_ = 0;
};

/// The net divided by its weights. Error: invalid_weight.
Result<Weighted> divided(RibNet net) {
  Weighted weighted(net.points.size(), net.rational);
  for (std::size_t k = 0; k < net.points.size(); ++k) weighted.set(k, net.points[k]);
  if (Status status = weighted.status(); !status.ok()) return status;
  return weighted;
}

/// The control points [i][j] of a mesh [i][j]: along v, then along u. Error: invalid_weight.
Result<Weighted> spline_points(const SplineDirection& u, const SplineDirection& v, RibNet mesh) {
  if (keeps_points(u) && keeps_points(v)) return divided(std::move(mesh));
  std::vector<Homogeneous> rows;
  std::size_t columns = 0;
  for (std::size_t i = 0; i < u.points; ++i) {
    const auto begin = mesh.points.begin() + static_cast<std::ptrdiff_t>(i * v.points);
    const Line line = spline_line(v, Line(begin, begin + static_cast<std::ptrdiff_t>(v.points)));
    columns = line.size();
    rows.reserve(u.points * columns);
    rows.insert(rows.end(), line.begin(), line.end());
  }
  mesh.points = std::vector<Homogeneous>();  // {} would keep the memory
  std::optional<Weighted> out;
  Line column(u.points);
  for (std::size_t j = 0; j < columns; ++j) {
    for (std::size_t i = 0; i < u.points; ++i) column[i] = rows[i * columns + j];
    const Line line = spline_line(u, column);
    if (!out) out.emplace(line.size() * columns, mesh.rational);
    for (std::size_t i = 0; i < line.size(); ++i) out->set(i * columns + j, line[i]);
  }
  if (Status status = out->status(); !status.ok()) return status;
  return *std::move(out);
}

Result<BSplineSurface> spline_surface(int degree_u, std::span<const double> knots_u, int degree_v,
                                      std::span<const double> knots_v, Weighted net,
                                      std::optional<Domain> domain = {}) {
  if (net.weights.empty())
    return BSplineSurface::polynomial(degree_u, knots_u, degree_v, knots_v, std::move(net.points), domain);
  return BSplineSurface::rational(degree_u, knots_u, degree_v, knots_v, std::move(net.points), std::move(net.weights),
                                  domain);
}

Result<std::vector<Surface>> separate_patches(const SplineDirection& u, const SplineDirection& v, const Weighted& net) {
  const std::size_t columns = 4 * v.patches;
  const auto knots = [](std::size_t k, std::size_t n) {
    const double begin = static_cast<double>(k) / static_cast<double>(n),
                 end = static_cast<double>(k + 1) / static_cast<double>(n);
    return std::array<double, 8>{begin, begin, begin, begin, end, end, end, end};
  };
  std::vector<Surface> surfaces;
  for (std::size_t a = 0; a < u.patches; ++a) {
    for (std::size_t b = 0; b < v.patches; ++b) {
      Weighted patch(16, !net.weights.empty());
      for (std::size_t k = 0; k < 16; ++k) {
        const std::size_t at = (4 * a + k / 4) * columns + 4 * b + k % 4;
        patch.points[k] = net.points[at];
        if (!net.weights.empty()) patch.weights[k] = net.weights[at];
      }
      Result<BSplineSurface> surface = spline_surface(3, knots(a, u.patches), 3, knots(b, v.patches), std::move(patch));
      if (!surface) return surface.status();
      surfaces.push_back(*std::move(surface));
    }
  }
  return surfaces;
}

Result<Surface> single_patch(int degree_u, int degree_v, const Weighted& net) {
  Result<BezierPatch> patch = net.weights.empty() ? BezierPatch::polynomial(degree_u, degree_v, net.points)
                                                  : BezierPatch::rational(degree_u, degree_v, net.points, net.weights);
  if (!patch) return patch.status();
  return Surface(*std::move(patch));
}

}  // namespace

const RibBasis* find_rib_basis(std::string_view name) {
  if (name == "bezier") return &bezier_basis;
  if (name == "b-spline") return &b_spline_basis;
  if (name == "catmull-rom") return &catmull_rom_basis;
  if (name == "hermite") return &hermite_basis;
  return name == "power" ? &power_basis : nullptr;
}

std::array<double, 16> recognised_matrix(const std::array<double, 16>& matrix) {
  constexpr double printed = 1e-5;
  for (const RibBasis* const known :
       {&bezier_basis, &b_spline_basis, &catmull_rom_basis, &hermite_basis, &power_basis}) {
    const bool same = std::equal(matrix.begin(), matrix.end(), known->matrix.begin(),
                                 [](double x, double y) { return std::abs(x - y) <= printed; });
    if (same) return known->matrix;
  }
  return matrix;
}

Result<std::int64_t> RibDirection::patches() const {
  const std::int64_t least = basis ? 4 : 2, step = basis ? basis->step : 1;
  if (periodic && points >= step && points % step == 0) return points / step;
  if (!periodic && points >= least && (points - least) % step == 0) return (points - least) / step + 1;
  const std::string wanted = periodic ? "a multiple of " + std::to_string(step)
                                      : std::to_string(least) + " plus a multiple of " + std::to_string(step);
  return Status(StatusCode::count_mismatch, std::to_string(points) + " points along one direction make no " +
                                                (periodic ? "closed " : "") + "mesh with this basis, which needs " +
                                                wanted);
}

Result<std::vector<double>> height_field_parameters(const RibDirection& direction) {
  const Form form = form_of(direction);
  const Result<std::int64_t> patches = direction.patches();
  if (!patches) return patches.status();
  if (form == Form::hermite || form == Form::separate) {
    return Status(StatusCode::unsupported, "a height field needs a basis of points (bezier, b-spline, catmull-rom)");
  }
  // Control points at the averages of the knots (Greville) reproduce the parameter itself.
  const double n = static_cast<double>(*patches), first = form == Form::b_spline || form == Form::catmull_rom ? -1 : 0;
  const double spacing = form == Form::bezier ? 1 / (3 * n) : 1 / n;
  std::vector<double> parameters(static_cast<std::size_t>(direction.points));
  for (std::size_t k = 0; k < parameters.size(); ++k) parameters[k] = (static_cast<double>(k) + first) * spacing;
  return parameters;
}

Result<BSplineSurface> spline_surface(int degree_u, std::span<const double> knots_u, int degree_v,
                                      std::span<const double> knots_v, RibNet net, std::optional<Domain> domain) {
  Result<Weighted> weighted = divided(std::move(net));
  if (!weighted) return weighted.status();
  return spline_surface(degree_u, knots_u, degree_v, knots_v, *std::move(weighted), domain);
}

Result<std::vector<Surface>> mesh_surfaces(const RibDirection& u, const RibDirection& v, RibNet net) {
  const bool separate = form_of(u) == Form::separate || form_of(v) == Form::separate;
  const Result<SplineDirection> along_u = make_direction(u, separate), along_v = make_direction(v, separate);
  if (!along_u) return along_u.status();
  if (!along_v) return along_v.status();
  Result<Weighted> points = spline_points(*along_u, *along_v, std::move(net));
  if (!points) return points.status();
  if (separate) return separate_patches(*along_u, *along_v, *points);
  const auto is_single = [](const SplineDirection& d) { return d.patches == 1 && d.form != Form::b_spline; };
  Result<Surface> surface = [&]() -> Result<Surface> {
    if (is_single(*along_u) && is_single(*along_v)) return single_patch(along_u->degree(), along_v->degree(), *points);
    Result<BSplineSurface> spline =
        spline_surface(along_u->degree(), along_u->knots, along_v->degree(), along_v->knots, *std::move(points));
    if (!spline) return spline.status();
    return Surface(*std::move(spline));
  }();
  if (!surface) return surface.status();
  std::vector<Surface> surfaces;
  surfaces.push_back(*std::move(surface));
  return surfaces;
}

}}  // namespace tessera::abi_0_1
