#include "tess/certified_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/text.h"
#include "parallel/least_index.h"
#include "parallel/parallel_for.h"

namespace tessera {
namespace {

constexpr std::size_t patches_a_piece = 64;
/// Rates stay below this: parameters i / rate are then well apart in float.
constexpr int most_rate = 4096;
constexpr std::uint64_t most_vertices = std::uint64_t{1} << 32;  // 32-bit indices

Status invalid(std::string message, std::size_t patch) {
  return {StatusCode::invalid_argument, std::move(message), static_cast<std::ptrdiff_t>(patch)};
}

float rounded_up(double x) {
  const auto nearest = static_cast<float>(x);
  return double(nearest) < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

}  // namespace

double vertex_rounding(const BezierPatch& patch, const Vec3& origin) {
  double size = 0;
  for (const Vec3& p : patch.points()) size = std::max(size, max_abs(p - origin));
  const double roundings = (patch.is_rational() ? 2 : 1) * (patch.degree_u() + patch.degree_v() + 6.0);
  return std::numbers::sqrt3 * roundings * 0x1p-24 * size;
}

Result<CertifiedPlanner> CertifiedPlanner::make(const PatchSet::Impl& set, double weld, const Execution& execution) {
  CertifiedPlanner planner(set);
  const std::size_t patches = set.patches.size();
  planner.shapes_.resize(patches);
  planner.roundings_.resize(patches);
  planner.chords_.resize(patches);
  Status status = parallel_for(patches, patches_a_piece, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      planner.shapes_[k] = PatchShape::of(set.patches[k]);
      planner.roundings_[k] = vertex_rounding(set.patches[k], set.origin);
      planner.chords_[k] = ChordBound(set.patches[k]);
    }
  });
  if (!status.ok()) return status;
  if (weld > 0) {
    planner.weld_ = weld_borders(set, planner.shapes_, planner.roundings_, weld, planner.edges_);
    for (std::size_t k = 0; k < patches; ++k)
      planner.roundings_[k] = std::max(planner.roundings_[k], planner.weld_.displacements[k]);
  }
  return planner;
}

Status CertifiedPlanner::choose_rates(double tolerance, std::vector<Rates>& rates, std::vector<float>& bounds,
                                      const Execution& execution) const {
  LeastIndex rough, wide;  // rounding alone exceeds the tolerance; the rates would
  const auto choose = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const double given = roundings_[k] + fit_error_;
      if (!(given < tolerance)) {
        rough.add(k);
        continue;
      }
      const auto cheapest = chords_[k].cheapest(tolerance - given, most_rate);
      if (!cheapest) {
        wide.add(k);
        continue;
      }
      rates[k] = *cheapest;
      bounds[k] = rounded_up(chords_[k].distance(*cheapest) + given);
    }
  };
  if (Status status = parallel_for(rates.size(), patches_a_piece, execution, choose); !status.ok()) return status;
  if (rough.found())
    return invalid("the tolerance " + text(tolerance) + " is not above what float vertices of patch " +
                       std::to_string(rough.index()) + (weld_.shapes.empty() ? "" : ", welded,") + " keep, " + text(roundings_[rough.index()]) +
                       ", and the fit error, " + text(fit_error_),
                   rough.index());
  if (wide.found())
    return invalid("the tolerance " + text(tolerance) + " takes more than " + std::to_string(most_rate) +
                       " segments along a parameter of patch " + std::to_string(wide.index()),
                   wide.index());
  return {};
}

std::vector<Division> CertifiedPlanner::divide(std::span<const Rates> rates) const {
  const std::span<const PatchShape> shapes = divided_shapes();
  const auto rate_along = [&](std::size_t patch, Side side) {
    return runs_along_u(side) ? rates[patch].u : rates[patch].v;
  };
  std::vector<int> edge_rates(edges_.count(), 1);
  std::vector<std::uint8_t> even(edges_.count(), 0);  // a patch counts on no triangle straddling the middle
  for (std::size_t k = 0; k < rates.size(); ++k)
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges_.edge(k, side);
      if (edge == SharedEdges::none || shapes[k].is_curve) continue;
      edge_rates[edge] = std::max(edge_rates[edge], rate_along(k, side));
      if (rate_along(k, side) % 2 == 0) even[edge] = 1;
    }
  for (std::size_t edge = 0; edge < edge_rates.size(); ++edge)
    if (even[edge] && edge_rates[edge] % 2 != 0) ++edge_rates[edge];
  std::vector<Division> divisions;
  divisions.reserve(rates.size());
  for (std::size_t k = 0; k < rates.size(); ++k) {
    std::array<int, 4> borders{};
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges_.edge(k, side);
      borders[static_cast<std::size_t>(side)] = edge == SharedEdges::none ? rate_along(k, side) : edge_rates[edge];
    }
    divisions.push_back(Division::of(shapes[k], rates[k], borders));
  }
  return divisions;
}

Result<CertifiedPlan> CertifiedPlanner::plan(double tolerance, std::uint64_t most_triangles,
                                             const Execution& execution) const {
  if (!(tolerance > 0 && std::isfinite(tolerance)))
    return Status(StatusCode::invalid_argument, "the tolerance is " + text(tolerance) + ", it must be finite and above 0");
  CertifiedPlan plan;
  std::vector<Rates> rates(shapes_.size());
  plan.bounds_.resize(shapes_.size());
  if (Status status = choose_rates(tolerance, rates, plan.bounds_, execution); !status.ok()) return status;
  plan.divisions_ = divide(rates);
  std::size_t vertices = 0, triangles = 0;
  plan.first_vertex_.reserve(rates.size() + 1);
  plan.first_triangle_.reserve(rates.size() + 1);
  for (const Division& division : plan.divisions_) {
    plan.first_vertex_.push_back(vertices);
    plan.first_triangle_.push_back(triangles);
    vertices += division.vertex_count();
    triangles += division.triangle_count();
  }
  plan.first_vertex_.push_back(vertices);
  plan.first_triangle_.push_back(triangles);
  if (triangles <= most_triangles && vertices <= most_vertices) return plan;
  return Status(StatusCode::invalid_argument,
                "the tolerance " + text(tolerance) + " takes " + std::to_string(triangles) + " triangles and " +
                    std::to_string(vertices) + " vertices, " + std::to_string(most_triangles) + " and " +
                    std::to_string(most_vertices) + " are allowed");
}

Result<double> CertifiedPlanner::smallest_tolerance(std::uint64_t most_triangles, const Execution& execution) const {
  // One cell a patch keeps `high`; float vertices keep no more than `low`.
  double low = 0, high = 0;
  for (std::size_t k = 0; k < chords_.size(); ++k) {
    const double given = roundings_[k] + fit_error_;
    low = std::max(low, given);
    high = std::max(high, 1.001 * (given + chords_[k].distance({1, 1})));
  }
  high = std::max(high, 1.001 * low);
  if (Result<CertifiedPlan> plan = this->plan(high, most_triangles, execution); !plan) return plan.status();
  low = std::max(low, 1e-6 * high);
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    Result<CertifiedPlan> plan = this->plan(middle, most_triangles, execution);
    if (!plan && plan.status().code() != StatusCode::invalid_argument) return plan.status();
    (plan ? high : low) = middle;
  }
  return high;
}

}  // namespace tessera
