#include "tess/plan/refusals.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "base/text.h"
#include "tess/plan/make_plan.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status invalid(std::string message, std::size_t patch) {
  return {StatusCode::invalid_argument, std::move(message), static_cast<std::ptrdiff_t>(patch)};
}

/// Rounds x > 0 up to two digits.
double rounded_up_shortly(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  for (double count = std::ceil(x / unit); std::isfinite(count); ++count) {
    std::array<char, 32> digits;
    char* const end =
        std::to_chars(digits.data(), digits.data() + digits.size(), count * unit, std::chars_format::general, 2).ptr;
    double value = 0;
    std::from_chars(digits.data(), end, value);
    if (value >= x) return value;
  }
  return x;  // too small for two digits in double
}

bool is_displaced(const Weld& weld, std::size_t patch) {
  return !weld.displacements.empty() && weld.displacements[patch] > 0;
}

}  // namespace

std::optional<double> nearest_tolerance(const PlanFacts& facts, std::uint64_t max_triangles) {
  const PatchNeeds& needs = facts.needs;
  const std::size_t patches = needs.shapes().size();
  double given = 0;
  for (std::size_t k = 0; k < patches; ++k) given = std::max(given, needs.given(k) / needs.tolerance_of(k, 1));
  // `room` is left for the chords; rates go by its root.
  for (double room = given / 8; room < 1e12 * given; room *= 2) {
    const double tolerance = rounded_up_shortly(given + room);
    const auto serves = [&](std::size_t k) { return needs.segments_for(k, {tolerance}, max_rate).are_found(); };
    std::size_t served = 0;
    while (served < patches && serves(served)) ++served;
    if (served < patches) continue;
    if (needs.set().trims) {  // to cut patches takes long, and leaves at most so many triangles
      double cells = 0;
      for (std::size_t k = 0; k < patches; ++k) cells += needs.segments_for(k, {tolerance}, max_rate).cells;
      if (4 * cells <= static_cast<double>(max_triangles)) return 2 * tolerance;
      continue;
    }
    const Result<CertifiedPlan> found = make_plan(facts, {tolerance}, {});
    if (found && found->capacity().triangles <= max_triangles && has_32_bit_indices(found->capacity()))
      return tolerance;
  }
  return {};
}

Status refusal(const PlanFacts& facts, const PlanRequest& request, std::size_t patch) {
  using Failure = NeededSegments::Failure;
  const PatchNeeds& needs = facts.needs;
  const PlannerOptions& options = needs.options();
  const Failure failure = needs.segments_for(patch, request, max_rate).failure;
  const double tolerance = request.tolerance;
  const std::string rounding =
      text(rounded_up_shortly(needs.roundings()[patch])) +
      (is_displaced(facts.borders.weld(), patch) ? ", the displacement of welded " : ", the rounding of ") +
      (options.f64_positions ? "vertices in double of patch " : "float vertices of patch ") + std::to_string(patch) +
      ", plus " + text(needs.fit_error()) + ", the fit error";
  const bool is_near = failure == Failure::wide && needs.given(patch) > needs.tolerance_of(patch, tolerance) / 2;
  if (failure == Failure::rough || is_near) {
    const std::optional<double> nearest = nearest_tolerance(facts, request.max_triangles);
    const double share = needs.tolerance_of(patch, 1);
    return invalid("the tolerance " + text(share * tolerance) +
                       (is_near ? " leaves too little room above " : " must be above ") + rounding +
                       (nearest ? "; " + text(share * *nearest) + " is enough" : ""),
                   patch);
  }
  if (failure == Failure::rough_pixels)
    return invalid("the tolerance of " + text(options.pixels) + " pixels at the view's near distance must be above " +
                       rounding + "; set a larger near distance",
                   patch);
  constexpr int unlimited = 1 << 24;
  double triangles = 0;
  const char* about = "about ";
  for (std::size_t k = 0; k < needs.shapes().size(); ++k) {
    const NeededSegments needed = needs.segments_for(k, {tolerance}, unlimited);
    const bool is_known = needed.are_found();
    if (!is_known) about = "more than ";
    triangles += 2 * (is_known ? needed.cells : unlimited);
  }
  std::array<char, 32> count;
  std::snprintf(count.data(), count.size(), "%.2g", triangles);
  return invalid(wanted(options, tolerance) + " takes more than " + std::to_string(max_rate) +
                     " segments along a parameter of patch " + std::to_string(patch) + ", and " + about + count.data() +
                     " triangles in all",
                 patch);
}

std::string wanted(const PlannerOptions& options, double tolerance) {
  std::string said;
  const auto add = [&said](const std::string& more) { said += (said.empty() ? "" : " with ") + more; };
  const std::string from = options.shares.empty() ? "" : text(options.least_share * tolerance) + " to ";
  if (std::isfinite(tolerance)) add("the tolerance " + from + text(tolerance));
  if (options.angle) add("the angle " + text(*options.angle));
  if (options.camera) add("the tolerance of " + text(options.pixels) + " pixels");
  return said;
}

Status too_many_of_patch(const PlannerOptions& options, const PlanRequest& request, std::size_t patch) {
  return invalid(wanted(options, request.tolerance) + " takes more triangles for patch " + std::to_string(patch) +
                     " alone than the limit of " + std::to_string(request.max_triangles),
                 patch);
}

Status too_many_of_cuts(const PlannerOptions& options, const PlanRequest& request, std::uint64_t triangles) {
  return {StatusCode::invalid_argument, wanted(options, request.tolerance) + " takes more than " +
                                            std::to_string(triangles) + " triangles, the limit is " +
                                            std::to_string(request.max_triangles)};
}

Status too_many_in_all(const PlannerOptions& options, const PlanRequest& request, const MeshCapacity& capacity) {
  return {StatusCode::invalid_argument,
          wanted(options, request.tolerance) + " takes " + std::to_string(capacity.triangles) + " triangles and " +
              std::to_string(capacity.vertices) + " vertices, the limits are " + std::to_string(request.max_triangles) +
              " and " + std::to_string(max_vertices)};
}

}}  // namespace tessera::abi_0_1
