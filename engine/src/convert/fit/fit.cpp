#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/safe_length.h"
#include "base/text.h"
#include "basis/chebyshev_lobatto.h"
#include "convert/fit/tensor_refinement.h"
#include "surface/net/patch_pieces.h"
#include "tessera/convert.h"
#include "tessera/guard.h"
#include "tessera/parametric_surface.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Error of tensor-product interpolation at Chebyshev-Lobatto parameters on a cell of a surface: proven by bounds of
// derivatives, or sampled.
//
// Iu and Iv are the interpolation in u and v, eu bounds |f - Iu f|, ev bounds |f - Iv f|, and L is the Lebesgue
// constant.
// 1. f - Iu Iv f = (f - Iu f) + Iu (f - Iv f), so |f - Iu Iv f| <= eu + L ev.
// 2. With u and v exchanged, |f - Iu Iv f| <= ev + L eu.
// 3. Together: |f - Iu Iv f| <= eu + ev + (L - 1) min(eu, ev).

/// The proven error, by bounds of the derivatives of order n + 1. Without such a bound, the cell should be halved while
/// it is longer than a 64th of the domain; then the error is `unsupported`.
class ProvenError {
 public:
  ProvenError(const ParametricSurface& surface, int degree) : surface_(surface), degree_(degree) {}
  Result<CellError> operator()(const Domain& cell) const;
  /// Bounds what the rounding of the nodes' parameters adds, by bounds of the first derivatives.
  double rounding(const Domain& cell) const;

 private:
  const ParametricSurface& surface_;
  int degree_;
};

/// The error found at the (3 n + 1)^2 points of a grid: the nodes, and two parameters in each gap between them, one
/// near the largest error of a smooth function and one off it.
class SampledError {
 public:
  SampledError(const ParametricSurface& surface, int degree);
  Result<CellError> operator()(const Domain& cell);

 private:
  using Grid = std::vector<Vec3>;
  std::size_t size() const { return parameters_.size(); }
  Status sample(const Domain& cell);
  void interpolate_along_u();
  const Vec3& value(std::size_t a, std::size_t b) const { return values_[a * size() + b]; }

  const ParametricSurface& surface_;
  std::size_t nodes_;               // n + 1; node i is parameter 3 i
  std::vector<double> parameters_;  // in [0,1]
  std::vector<double> basis_;       // [parameter][node]: Lagrange's polynomials
  Grid values_, along_u_;           // f and Iu f, [a][b]
};

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns factor h^(n+1) bound, and 0 for a bound of 0. The bound is multiplied first, because powers of a short h
/// underflow.
double interpolation_error(int degree, double h, double bound) {
  if (bound == 0) return 0;
  double error = lobatto_error_factor(degree) * bound;
  for (int i = 0; i <= degree; ++i) error *= h;
  return std::max(error, std::numeric_limits<double>::min());
}

Result<CellError> ProvenError::operator()(const Domain& cell) const {
  constexpr double longest_without = 1.0 / 64;
  const auto bounds = surface_.derivative_bounds(cell, degree_ + 1);
  const double u = interpolation_error(degree_, cell.u1 - cell.u0, bounds[0]);
  const double v = interpolation_error(degree_, cell.v1 - cell.v0, bounds[1]);
  const double total = u + v + (lobatto_lebesgue_constant(degree_) - 1) * std::min(u, v);
  if (total < infinity) return CellError{total, u, v};
  const Domain& domain = surface_.domain();
  const bool long_u = cell.u1 - cell.u0 > longest_without * (domain.u1 - domain.u0);
  const bool long_v = cell.v1 - cell.v0 > longest_without * (domain.v1 - domain.v0);
  if (!long_u && !long_v) return Status(StatusCode::unsupported, "there is no bound of the surface's derivatives");
  return CellError{infinity, long_u ? infinity : 0, long_v ? infinity : 0};
}

double ProvenError::rounding(const Domain& cell) const {
  // A node's parameter is a + t (b - a). The difference and the product each round by at most 2^-52 of the largest
  // parameter, since they may be twice as large as it; the sum rounds by 2^-53.
  const double u = 0x1p-50 * std::max(std::abs(cell.u0), std::abs(cell.u1));
  const double v = 0x1p-50 * std::max(std::abs(cell.v0), std::abs(cell.v1));
  const auto bounds = surface_.derivative_bounds(cell, 1);
  const double lebesgue = lobatto_lebesgue_constant(degree_);
  return lebesgue * lebesgue * ((bounds[0] == 0 ? 0 : u * bounds[0]) + (bounds[1] == 0 ? 0 : v * bounds[1]));
}

SampledError::SampledError(const ParametricSurface& surface, int degree)
    : surface_(surface), nodes_(static_cast<std::size_t>(degree) + 1) {
  // In a gap the error of a smooth function is like sin(pi part), with `part` measured in the angle of the nodes.
  const std::vector<double> nodes = lobatto_parameters(degree);
  for (std::size_t i = 0; i + 1 < nodes_; ++i) {
    parameters_.push_back(nodes[i]);
    for (const double part : {0.46, 0.79}) {
      const double sine = std::sin(std::numbers::pi / 2 * (static_cast<double>(i) + part) / degree);
      parameters_.push_back(sine * sine);
    }
  }
  parameters_.push_back(1);
  const Matrix basis = lobatto_evaluation(degree, parameters_);
  for (int a = 0; a < basis.rows(); ++a)
    for (int i = 0; i < basis.columns(); ++i) basis_.push_back(static_cast<double>(basis(a, i)));
  values_.resize(size() * size());
  along_u_.resize(size() * size());
}

Status SampledError::sample(const Domain& cell) {
  for (std::size_t a = 0; a < size(); ++a)
    for (std::size_t b = 0; b < size(); ++b) {
      const auto point = surface_.position(lobatto_parameter(parameters_, a, cell.u0, cell.u1),
                                           lobatto_parameter(parameters_, b, cell.v0, cell.v1));
      if (!point) return point.status();
      values_[a * size() + b] = *point;
    }
  return {};
}

void SampledError::interpolate_along_u() {
  std::fill(along_u_.begin(), along_u_.end(), Vec3{});
  for (std::size_t a = 0; a < size(); ++a)
    for (std::size_t i = 0; i < nodes_; ++i)
      for (std::size_t b = 0; b < size(); ++b) along_u_[a * size() + b] += basis_[a * nodes_ + i] * value(3 * i, b);
}

Result<CellError> SampledError::operator()(const Domain& cell) {
  if (Status status = sample(cell); !status.ok()) return status;
  interpolate_along_u();
  CellError error;
  for (std::size_t a = 0; a < size(); ++a)
    for (std::size_t b = 0; b < size(); ++b) {
      Vec3 along_v, both;
      for (std::size_t j = 0; j < nodes_; ++j) {
        along_v += basis_[b * nodes_ + j] * value(a, 3 * j);
        both += basis_[b * nodes_ + j] * along_u_[a * size() + 3 * j];
      }
      error.along_u = std::max(error.along_u, safe_length(value(a, b) - along_u_[a * size() + b]));
      error.along_v = std::max(error.along_v, safe_length(value(a, b) - along_v));
      error.total = std::max(error.total, safe_length(value(a, b) - both));
    }
  return error;
}

/// The share of the tolerance for interpolation. The rest is for rounding and for errors between samples.
constexpr double accepted_share = 0.8;

/// Returns the range's ends and, between them, the requested breakpoints.
Result<std::vector<double>> first_breaks(double from, std::span<const double> inner, double to, const char* direction) {
  std::vector<double> breaks{from};
  breaks.insert(breaks.end(), inner.begin(), inner.end());
  breaks.push_back(to);
  for (std::size_t k = 0; k < inner.size(); ++k)
    if (!(inner[k] > breaks[k] && inner[k] < to))
      return Status(StatusCode::invalid_argument,
                    std::string("breakpoint ") + direction + "[" + std::to_string(k) + "] = " + text(inner[k]) +
                        " must be above the one before it and inside the domain",
                    static_cast<std::ptrdiff_t>(k));
  return breaks;
}

Status check_options(const FitOptions& options) {
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance))
    return {StatusCode::invalid_argument,
            "the tolerance is " + text(options.tolerance) + ", it must be finite and not negative"};
  if (options.degree < 2 || options.degree > max_degree)
    return {StatusCode::invalid_argument, "the degree of the patches is " + std::to_string(options.degree) +
                                              ", it must be 2 to " + std::to_string(max_degree)};
  const std::size_t along_u = options.breaks_u.size() + 1, along_v = options.breaks_v.size() + 1;
  if (options.max_patches / along_u < along_v)
    return {StatusCode::invalid_argument, "max_patches is " + std::to_string(options.max_patches) +
                                              ", the breakpoints alone make " +
                                              counted(along_u * along_v, "patch", "patches")};
  return {};
}

/// Returns the box of 17 x 17 points.
Result<Box3> coarse_box(const ParametricSurface& surface) {
  Box3 box;
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; j <= 16; ++j) {
      const auto point = surface.position(surface.domain().u_at(i / 16.0), surface.domain().v_at(j / 16.0));
      if (!point) return point.status();
      box.extend(*point);
    }
  if (!std::isfinite(box.diagonal()))
    return Status(StatusCode::non_finite, "the surface's box is too large for distances in double");
  return box;
}

/// Returns the tolerance to use, or why it cannot be met.
Result<double> tolerance_of(const Box3& box, double wanted) {
  const double size = std::max(max_abs(box.lower), max_abs(box.upper));
  const double least = std::max(0x1p-48 * size, std::numeric_limits<double>::min());
  if (wanted == 0) return std::max(1e-6 * safe_length(box.upper - box.lower), least);
  if (wanted < least)
    return Status(StatusCode::invalid_argument, "the tolerance " + text(wanted) + " is below " + text(least) +
                                                    ", the rounding of coordinates as large as " + text(size));
  return wanted;
}

/// Returns the parameters of all nodes of one direction; adjacent intervals share their end.
std::vector<double> lattice(std::span<const double> breaks, std::span<const double> parameters) {
  std::vector<double> lattice{breaks.front()};
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
    for (std::size_t i = 1; i < parameters.size(); ++i)
      lattice.push_back(lobatto_parameter(parameters, i, breaks[k], breaks[k + 1]));
  return lattice;
}

/// Makes patches from values on the lattice of nodes, and evaluates each node once.
class Interpolation {
 public:
  Interpolation(const ParametricSurface& surface, int degree, const TensorBreaks& breaks)
      : surface_(surface),
        degree_(degree),
        to_bernstein_(lobatto_to_bernstein(degree)),
        u_(lattice(breaks.u, lobatto_parameters(degree))),
        v_(lattice(breaks.v, lobatto_parameters(degree))),
        pieces_(degree, degree, (breaks.u.size() - 1) * (breaks.v.size() - 1), false),
        values_(static_cast<std::size_t>(degree + 1) * v_.size()) {}

  Result<std::vector<BezierPatch>> run() {
    const std::size_t n = static_cast<std::size_t>(degree_), columns = (u_.size() - 1) / n, rows = (v_.size() - 1) / n;
    if (Status status = sample_line(0, 0); !status.ok()) return status;
    for (std::size_t a = 0; a < columns; ++a) {
      for (std::size_t i = 1; i <= n; ++i)
        if (Status status = sample_line(i, a * n + i); !status.ok()) return status;
      for (std::size_t b = 0; b < rows; ++b)
        if (Status status = make_patch(a * rows + b, b * n); !status.ok()) return status;
      std::copy_n(values_.end() - static_cast<std::ptrdiff_t>(v_.size()), v_.size(), values_.begin());
    }
    return pieces_.take();
  }

  /// Bounds how far rounding may have moved a point of a patch; the factor 2 covers the three coordinates together.
  double rounding() const { return 2 * lobatto_to_bernstein_rounding(degree_, largest_value_, largest_point_); }

 private:
  /// Samples line i of the current column of patches.
  Status sample_line(std::size_t i, std::size_t u_index) {
    for (std::size_t j = 0; j < v_.size(); ++j) {
      const auto point = surface_.position(u_[u_index], v_[j]);
      if (!point) return point.status();
      values_[i * v_.size() + j] = *point;
      largest_value_ = std::max(largest_value_, max_abs(*point));
    }
    return {};
  }

  Status make_patch(std::size_t patch, std::size_t first_row) {
    const std::size_t count = static_cast<std::size_t>(degree_) + 1;
    net_.clear();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < count; ++j) net_.push_back(values_[i * v_.size() + first_row + j]);
    std::vector<Vec3> points = tensor_product(to_bernstein_, net_, to_bernstein_);
    collapse_edges(points);
    for (const Vec3& p : points) {
      if (!is_finite(p)) return {StatusCode::non_finite, "the surface is too large for control points in double"};
      largest_point_ = std::max(largest_point_, max_abs(p));
    }
    std::copy(points.begin(), points.end(), pieces_.points(patch));
    return {};
  }

  /// Sets each edge on which all values are one point to that point, so that rounding keeps poles.
  void collapse_edges(std::vector<Vec3>& points) const {
    const std::size_t count = static_cast<std::size_t>(degree_) + 1, last = count - 1;
    const auto collapse = [&](std::size_t first, std::size_t step) {
      const Vec3 pole = net_[first];
      for (std::size_t k = 1; k < count; ++k)
        if (!(net_[first + k * step] == pole)) return;
      for (std::size_t k = 0; k < count; ++k) points[first + k * step] = pole;
    };
    collapse(0, 1);
    collapse(last * count, 1);
    collapse(0, count);
    collapse(last, count);
  }

  const ParametricSurface& surface_;
  int degree_;
  Matrix to_bernstein_;
  std::vector<double> u_, v_;
  PatchPieces pieces_;
  std::vector<Vec3> values_;  // n + 1 lines along v
  std::vector<Vec3> net_;     // of one patch
  double largest_value_ = 0, largest_point_ = 0;
};

/// Bounds what rounding adds to a proven error.
double rounding_bound(const ProvenError& proven, const TensorBreaks& breaks, const Interpolation& interpolation) {
  double largest = 0;
  for (std::size_t a = 0; a + 1 < breaks.u.size(); ++a)
    for (std::size_t b = 0; b + 1 < breaks.v.size(); ++b)
      largest = std::max(largest, proven.rounding({breaks.u[a], breaks.u[a + 1], breaks.v[b], breaks.v[b + 1]}));
  return largest + interpolation.rounding();
}

Result<PatchGrid> grid_of(TensorBreaks breaks, Result<std::vector<BezierPatch>> patches, const FitError& error) {
  if (!patches) return patches.status();
  return PatchGrid::make(std::move(breaks.u), std::move(breaks.v), *std::move(patches), error);
}

/// Returns nothing where bounds do not suffice.
std::optional<Result<PatchGrid>> certified_fit(const ParametricSurface& surface, int degree, const TensorBreaks& first,
                                               const RefinementLimits& limits) {
  const ProvenError proven(surface, degree);
  auto breaks = refine(first.u, first.v, limits, proven);
  if (!breaks) return std::nullopt;
  Interpolation interpolation(surface, degree, *breaks);
  auto patches = interpolation.run();
  const double distance = breaks->error + rounding_bound(proven, *breaks, interpolation);
  if (!(distance <= limits.tolerance)) return std::nullopt;
  return grid_of(*std::move(breaks), std::move(patches), {distance, true});
}

Result<PatchGrid> sampled_fit(const ParametricSurface& surface, int degree, const TensorBreaks& first,
                              const RefinementLimits& limits) {
  SampledError sampled(surface, degree);
  auto breaks = refine(first.u, first.v, limits, sampled);
  if (!breaks) return breaks.status();
  Interpolation interpolation(surface, degree, *breaks);
  auto patches = interpolation.run();
  const double distance = breaks->error;
  return grid_of(*std::move(breaks), std::move(patches), {distance, false});
}

}  // namespace

Result<PatchGrid> to_bezier(const ParametricSurface& surface, const FitOptions& options) {
  return guarded([&]() -> Result<PatchGrid> {
    if (Status status = check_options(options); !status.ok()) return status;
    const Domain& domain = surface.domain();
    const auto breaks_u = first_breaks(domain.u0, options.breaks_u, domain.u1, "u");
    if (!breaks_u) return breaks_u.status();
    const auto breaks_v = first_breaks(domain.v0, options.breaks_v, domain.v1, "v");
    if (!breaks_v) return breaks_v.status();
    const TensorBreaks first{*breaks_u, *breaks_v};
    const auto box = coarse_box(surface);
    if (!box) return box.status();
    const auto tolerance = tolerance_of(*box, options.tolerance);
    if (!tolerance) return tolerance.status();
    // The nodes next to an end are still eight doubles from it.
    const double shortest = 0x1p-49 / lobatto_parameters(options.degree)[1];
    const RefinementLimits limits{*tolerance, accepted_share * *tolerance, shortest, options.max_patches};
    if (surface.has_bounds() && options.certify)
      if (auto fit = certified_fit(surface, options.degree, first, limits)) return *std::move(fit);
    return sampled_fit(surface, options.degree, first, limits);
  });
}

}}  // namespace tessera::abi_0_1
