#include "tess/certified_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "base/text.h"
#include "parallel/least_index.h"
#include "parallel/parallel_for.h"
#include "tess/chord_bound.h"

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

Status CertifiedPlan::choose_rates(const PatchSet::Impl& set, const CertifiedOptions& options,
                                   const Execution& execution) {
  const std::size_t patches = set.patches.size();
  shapes_.resize(patches);
  rates_.resize(patches);
  bounds_.resize(patches);
  LeastIndex rough, wide;  // rounding alone exceeds the tolerance; the rates would
  const auto choose = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const BezierPatch& patch = set.patches[k];
      shapes_[k] = PatchShape::of(patch);
      const double given = vertex_rounding(patch, set.origin) + set.fit_error.distance;
      if (!(given < options.tolerance)) {
        rough.add(k);
        continue;
      }
      const ChordBound bound(patch);
      const auto rates = bound.cheapest(options.tolerance - given, most_rate);
      if (!rates) {
        wide.add(k);
        continue;
      }
      rates_[k] = *rates;
      bounds_[k] = rounded_up(bound.distance(*rates) + given);
    }
  };
  if (Status status = parallel_for(patches, patches_a_piece, execution, choose); !status.ok()) return status;
  if (rough.found()) {
    const std::size_t k = rough.index();
    const double rounding = vertex_rounding(set.patches[k], set.origin);
    return invalid("the tolerance " + text(options.tolerance) + " is not above what float vertices of patch " +
                       std::to_string(k) + " keep, " + text(rounding) + ", and the fit error, " +
                       text(set.fit_error.distance),
                   k);
  }
  if (wide.found())
    return invalid("the tolerance " + text(options.tolerance) + " takes more than " + std::to_string(most_rate) +
                       " segments along a parameter of patch " + std::to_string(wide.index()),
                   wide.index());
  return {};
}

void CertifiedPlan::divide(const PatchSet::Impl& set) {
  const SharedEdges edges(set);
  const auto rate_along = [&](std::size_t patch, Side side) { return runs_along_u(side) ? rates_[patch].u : rates_[patch].v; };
  std::vector<int> edge_rates(edges.count(), 1);
  std::vector<std::uint8_t> even(edges.count(), 0);  // a patch counts on no triangle straddling the middle
  for (std::size_t k = 0; k < rates_.size(); ++k)
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges.edge(k, side);
      if (edge == SharedEdges::none || shapes_[k].is_curve) continue;
      edge_rates[edge] = std::max(edge_rates[edge], rate_along(k, side));
      if (rate_along(k, side) % 2 == 0) even[edge] = 1;
    }
  for (std::size_t edge = 0; edge < edge_rates.size(); ++edge)
    if (even[edge] && edge_rates[edge] % 2 != 0) ++edge_rates[edge];
  divisions_.reserve(rates_.size());
  for (std::size_t k = 0; k < rates_.size(); ++k) {
    std::array<int, 4> borders{};
    for (const Side side : all_sides) {
      const std::uint32_t edge = edges.edge(k, side);
      borders[static_cast<std::size_t>(side)] = edge == SharedEdges::none ? rate_along(k, side) : edge_rates[edge];
    }
    divisions_.push_back(Division::of(shapes_[k], rates_[k], borders));
  }
}

Status CertifiedPlan::count(const CertifiedOptions& options) {
  std::size_t vertices = 0, triangles = 0;
  first_vertex_.reserve(divisions_.size() + 1);
  first_triangle_.reserve(divisions_.size() + 1);
  for (const Division& division : divisions_) {
    first_vertex_.push_back(vertices);
    first_triangle_.push_back(triangles);
    vertices += division.vertex_count();
    triangles += division.triangle_count();
  }
  first_vertex_.push_back(vertices);
  first_triangle_.push_back(triangles);
  if (triangles <= options.most_triangles && vertices <= most_vertices) return {};
  return {StatusCode::invalid_argument,
          "the tolerance " + text(options.tolerance) + " takes " + std::to_string(triangles) + " triangles and " +
              std::to_string(vertices) + " vertices, " + std::to_string(options.most_triangles) + " and " +
              std::to_string(most_vertices) + " are allowed"};
}

Result<CertifiedPlan> CertifiedPlan::make(const PatchSet::Impl& set, const CertifiedOptions& options,
                                          const Execution& execution) {
  if (!(options.tolerance > 0 && std::isfinite(options.tolerance)))
    return Status(StatusCode::invalid_argument,
                  "the tolerance is " + text(options.tolerance) + ", it must be finite and above 0");
  CertifiedPlan plan;
  if (Status status = plan.choose_rates(set, options, execution); !status.ok()) return status;
  plan.divide(set);
  if (Status status = plan.count(options); !status.ok()) return status;
  return plan;
}

}  // namespace tessera
