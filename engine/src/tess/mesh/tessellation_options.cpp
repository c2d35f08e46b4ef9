// Checks the options of plans from tolerances.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "base/impl_access.h"
#include "base/text.h"
#include "tess/mesh/proven_mesh.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double max_weld = 0.05;  // a share of the model's size

/// Returns a weld, or the largest one of a set if that is less. Looks at no more patches than it takes to tell.
double at_most_max_weld(double weld, const PatchSet& set) {
  Box3 box;
  if (const std::optional<Box3>& given = impl_of(set).given_box) return std::min(weld, max_weld * given->diagonal());
  for (const BezierPatch& patch : impl_of(set).patches) {
    box.extend(patch.hull_box());
    if (max_weld * box.diagonal() >= weld) return weld;
  }
  return max_weld * box.diagonal();
}

/// Checks how borders and edges are joined.
Status check_joining(const Joining& joining, const PatchSet& set) {
  const auto bad = [](const std::string& message) { return Status(StatusCode::invalid_argument, message); };
  if (joining.crease_angle && !(*joining.crease_angle >= 0 && *joining.crease_angle <= std::numbers::pi))
    return bad("the crease angle is " + text(*joining.crease_angle) + " radians, it must be from 0 to pi");
  const double weld = joining.weld.value_or(0);
  if (!(weld >= 0 && std::isfinite(weld)))
    return bad("the weld is " + text(weld) + ", it must be finite and at least 0");
  if (weld > 0 && weld > at_most_max_weld(weld, set))
    return bad("the weld is " + text(weld) + ", more than a twentieth of the model's size, " +
               text(set.model_box().diagonal()));
  if (joining.max_gap && !(*joining.max_gap >= 0))
    return bad("the largest gap is " + text(*joining.max_gap) + ", it must be at least 0");
  return {};
}

/// The largest and the smallest distance that options ask for; none if they ask for none.
struct Distances {
  std::optional<double> largest = {}, smallest = {};

  explicit Distances(const TessellationOptions& options)
      : largest(options.tolerance), smallest(options.border_tolerance ? options.border_tolerance : options.tolerance) {
    const std::vector<double>& of_surfaces = options.surface_tolerances;
    if (of_surfaces.empty()) return;
    const auto [least, most] = std::ranges::minmax(of_surfaces);
    largest = most, smallest = least;
  }
};

/// Checks the tolerance of borders.
Status check_border_tolerance(const TessellationOptions& options, const PatchSet& set) {
  if (!options.border_tolerance) return {};
  const auto bad = [](const std::string& message) { return Status(StatusCode::invalid_argument, message); };
  // Levels must agree to the last bit on the length that borders keep, so it is no share.
  if (!options.tolerance || options.relative || options.angle || options.pixels || options.fewest ||
      options.headroom > 0)
    return bad("a border tolerance needs a tolerance, as a length, and none of angle, pixels, headroom and fewest");
  if (!(*options.border_tolerance > 0 && *options.border_tolerance <= *options.tolerance))
    return bad("the border tolerance is " + text(*options.border_tolerance) +
               ", it must be above 0 and at most the tolerance, " + text(*options.tolerance));
  const bool closes = impl_of(set).edges && options.joining.close_edges;
  return set.cut_count() == 0 && !closes
             ? Status()
             : Status(StatusCode::unsupported, "a border tolerance is for sets without cut patches and closed edges");
}

/// Checks the tolerances of surfaces.
Status check_surface_tolerances(const TessellationOptions& options, const PatchSet& set) {
  const std::vector<double>& tolerances = options.surface_tolerances;
  if (tolerances.empty()) return {};
  if (options.tolerance || options.budget)
    return {StatusCode::invalid_argument, std::string("there are both surface tolerances and ") +
                                              (options.tolerance ? "a tolerance" : "a budget") +
                                              " for all surfaces: set one of them"};
  if (tolerances.size() != set.surface_count())
    return {StatusCode::count_mismatch, "the set has " + counted(set.surface_count(), "surface") + ", found " +
                                            counted(tolerances.size(), "surface tolerance")};
  for (std::size_t k = 0; k < tolerances.size(); ++k)
    if (!(tolerances[k] > 0 && std::isfinite(tolerances[k])))
      return {StatusCode::invalid_argument,
              "the tolerance of surface " + std::to_string(k) + " is " + text(tolerances[k]) +
                  ", it must be finite and above 0",
              static_cast<std::ptrdiff_t>(k)};
  return {};
}

/// Sets the shares of the largest tolerance that patches keep.
void set_shares(const TessellationOptions& options, const PatchSet& set, PlannerOptions& planner) {
  const Distances distances(options);
  if (options.surface_tolerances.empty() || *distances.smallest == *distances.largest) return;
  constexpr double down = 1 - 0x1p-52;  // a share of the largest is then no more than the tolerance
  const auto share = [&](double tolerance) {
    return tolerance < *distances.largest ? down * (tolerance / *distances.largest) : 1;
  };
  for (std::size_t patch = 0; patch < set.patch_count(); ++patch)
    planner.shares.push_back(share(options.surface_tolerances[set.source(patch).surface]));
  planner.least_share = share(*distances.smallest);
}

/// How borders are welded for the smallest tolerance of any surface, if there is one.
WeldRules weld_rules(const TessellationOptions& options, std::optional<double> smallest, const PatchSet& set) {
  if (options.joining.weld) return {.reach = *options.joining.weld};
  if (smallest && !options.relative) return {at_most_max_weld(*smallest / 8, set), true};
  const double size = set.model_box().diagonal();
  return {smallest ? std::min(*smallest * size / 8, max_weld * size) : 1e-6 * size, true};
}

/// Checks how segments follow edits.
Status check_edits(const TessellationOptions& options) {
  const auto bad = [](const std::string& message) { return Status(StatusCode::invalid_argument, message); };
  if (!(options.spare >= 0 && std::isfinite(options.spare)))
    return bad("the spare is " + text(options.spare) + ", it must be finite and at least 0");
  if (!(options.headroom >= 0 && options.headroom <= 0.9))
    return bad("the headroom is " + text(options.headroom) + ", it must be from 0 to 0.9");
  return options.budget && options.headroom > 0 ? bad("a budget has no headroom: set a tolerance") : Status();
}

}  // namespace

Result<PlannerOptions> planner_options(const TessellationOptions& options, const PatchSet& set) {
  const auto bad = [](const std::string& message) { return Status(StatusCode::invalid_argument, message); };
  // The conditions are written so that NaN fails.
  if (Status status = check_surface_tolerances(options, set); !status.ok()) return status;
  const std::optional<double> smallest = Distances(options).smallest;
  if (!smallest && !options.angle && !options.pixels && !options.budget)
    return bad("there are neither rates nor a tolerance: set rates, a distance, an angle, pixels or a budget");
  if (options.tolerance && options.budget)
    return bad("there are both a tolerance and a budget, which finds the tolerance: set one of them");
  if (Status status = check_edits(options); !status.ok()) return status;
  if (options.tolerance && !(*options.tolerance > 0 && std::isfinite(*options.tolerance)))
    return bad("the tolerance is " + text(*options.tolerance) + ", it must be finite and above 0");
  if (options.angle && !(*options.angle > 0 && *options.angle <= std::numbers::pi / 2))
    return bad("the angle is " + text(*options.angle) + " radians, it must be above 0 and at most pi / 2");
  if (options.angle_rate < 1 || options.angle_rate > max_rate)
    return bad("the angle's rate is " + std::to_string(options.angle_rate) + ", it must be from 1 to " +
               std::to_string(max_rate));
  if (options.pixels && !(options.pixels->pixels > 0 && std::isfinite(options.pixels->pixels)))
    return bad("the tolerance is " + text(options.pixels->pixels) + " pixels, it must be finite and above 0");
  if (Status status = check_border_tolerance(options, set); !status.ok()) return status;
  if (options.joining.share_vertices && options.parameters == VertexParameters::patch)
    return bad("parameters of patches differ wherever patches meet, so no vertex could be shared: choose one of both");
  if (Status status = check_joining(options.joining, set); !status.ok()) return status;
  PlannerOptions planner;
  planner.closes_edges = options.joining.close_edges;
  planner.lists_edge_vertices = options.joining.edge_vertices;
  planner.max_gap = options.joining.max_gap.value_or(std::numeric_limits<double>::infinity());
  planner.weld = weld_rules(options, smallest, set);
  set_shares(options, set, planner);
  planner.angle = options.angle;
  planner.angle_rate = options.angle_rate;
  planner.fewest = options.fewest;
  // Cut patches are cut in several attempts, each of which asks for the bounds again.
  constexpr std::size_t kept_bounds = std::size_t{1} << 16;
  planner.keeps_bounds = options.budget || (set.cut_count() > 0 && set.patch_count() <= kept_bounds);
  planner.f64_positions = options.precision == Precision::double_precision;
  if (planner.f64_positions) planner.f64_patches.assign(set.patch_count(), 1);
  if (!options.pixels) return planner;
  Result<Camera> camera = Camera::make(options.pixels->view);
  if (!camera) return camera.status();
  planner.camera = *camera;
  planner.pixels = options.pixels->pixels;
  return planner;
}

Result<double> tolerance_of(const TessellationOptions& options, const PatchSet& set) {
  const std::optional<double> largest = Distances(options).largest;
  const double tolerance = largest ? *largest * (options.relative ? set.model_box().diagonal() : 1)
                                   : std::numeric_limits<double>::infinity();
  if (tolerance > 0 || !(largest > 0.0)) return tolerance;  // planner_options() tells of others
  return Status(StatusCode::invalid_argument, "the tolerance is " + text(tolerance) + ": the model has no size");
}

}}  // namespace tessera::abi_0_1
