// Finds tolerances that patches cannot keep, divides such patches, and makes the messages about them.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/infinity.h"
#include "base/text.h"
#include "tess/plan/certified_plan.h"

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

}  // namespace

std::vector<std::uint8_t> CertifiedPlanner::patches_that_need_f64(double tolerance) const {
  const double most = max_rounding * tolerance;
  const bool is_any_rough = largest_rounding_ > most;
  if (!is_any_rough && pictures_.empty()) return {};
  const auto is_rough_in_picture = [&](std::size_t k) {
    const ScreenSpaceBound& picture = pictures_[k];
    return !(roundings_[k] + fit_error_ < picture.distance()) ||
           (picture.projected() && !(picture.moved_pixels() < options_.pixels));
  };
  std::vector<std::uint8_t> patches(shapes_.size(), 0);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const PatchSet::Slot slot = set_->slots[k];
    patches[k] = (is_any_rough && own_rounding(set_->group_of_block(slot.block), slot) > most) ||
                 (!pictures_.empty() && is_rough_in_picture(k));
  }
  if (std::ranges::find(patches, 1) == patches.end()) return {};
  if (!pictures_.empty() && set_->trims) add_givers_of_cut(patches);
  return patches;
}

void CertifiedPlanner::add_givers_of_cut(std::vector<std::uint8_t>& patches) const {
  std::vector<std::uint8_t> edges(edges_.count(), 0);
  const auto for_sides = [&](std::size_t patch, auto visit) {
    for (const Side side : all_sides)
      if (const std::uint32_t edge = edges_.edge(patch, side); edge != no_id) visit(edges[edge]);
  };
  for (std::size_t k = 0; k < patches.size(); ++k)
    if (is_cut(k) && patches[k]) for_sides(k, [](std::uint8_t& edge) { edge = 1; });
  for (std::size_t k = 0; k < patches.size(); ++k)
    if (!is_cut(k)) for_sides(k, [&](std::uint8_t edge) { patches[k] |= edge; });
}

bool CertifiedPlanner::is_rough(double tolerance) const {
  return std::any_of(roundings_.begin(), roundings_.end(),
                     [&](double rounding) { return !(2 * (rounding + fit_error_) < tolerance); });
}

std::optional<double> CertifiedPlanner::nearest_tolerance(std::uint64_t max_triangles) const {
  double given = 0;
  for (const double rounding : roundings_) given = std::max(given, rounding + fit_error_);
  // `room` is left for the chords; rates go by its root.
  for (double room = given / 8; room < 1e12 * given; room *= 2) {
    const double tolerance = rounded_up_shortly(given + room);
    const auto serves = [&](std::size_t k) { return choose(k, {tolerance}, max_rate).failure == Failure::none; };
    std::size_t served = 0;
    while (served < shapes_.size() && serves(served)) ++served;
    if (served < shapes_.size()) continue;
    if (set_->trims) {  // to cut patches takes long, and leaves at most so many triangles
      double cells = 0;
      for (std::size_t k = 0; k < shapes_.size(); ++k) cells += choose(k, {tolerance}, max_rate).cells;
      if (4 * cells <= static_cast<double>(max_triangles)) return 2 * tolerance;
      continue;
    }
    const Result<CertifiedPlan> found = plan({tolerance}, {});
    if (found && found->capacity().triangles <= max_triangles && found->capacity().vertices <= max_vertices)
      return tolerance;
  }
  return {};
}

// Chords far below the errors of the vertices gain nothing. Grids of cut patches stay within a few ten megabytes.
CertifiedPlanner::Choice CertifiedPlanner::choose_beyond(std::size_t patch, const Request& request) const {
  constexpr int max_rate_of_cut = 512;
  const double given = 1.25 * (roundings_[patch] + fit_error_);
  Request relaxed = request;
  relaxed.fewest = false, relaxed.kept = {};
  constexpr int most = 64;  // the last limits are infinite, so it ends
  for (int k = 1;; ++k) {
    relaxed.slack = k < most ? std::ldexp(1.0, k) : infinity;
    if (k < most && !(relaxed.slack * request.tolerance > given)) continue;
    const Choice choice = choose(patch, relaxed, is_cut(patch) ? max_rate_of_cut : max_rate);
    if (choice.failure == Failure::none || k == most) return choice;
  }
}

// A tolerance that some patches keep is that of the mesh, and the others state their bounds. One that none keeps is a
// mistake.
Status CertifiedPlanner::keep_beyond(const Request& request, std::span<const std::uint8_t> beyond,
                                     CertifiedPlan& plan) const {
  const auto count = std::ranges::count(beyond, 1);
  if (count == 0) return {};
  const auto first = static_cast<std::size_t>(std::ranges::find(beyond, 1) - beyond.begin());
  if (count == std::ssize(beyond)) return refusal(choose(first, request, max_rate).failure, first, request);
  plan.set_beyond(beyond);
  return {};
}

Status CertifiedPlanner::refusal(Failure failure, std::size_t patch, const Request& request) const {
  const double tolerance = request.tolerance;
  const std::string rounding = text(rounded_up_shortly(roundings_[patch])) +
                               (is_displaced(patch) ? ", the displacement of welded " : ", the rounding of ") +
                               (options_.f64_positions ? "vertices in double of patch " : "float vertices of patch ") +
                               std::to_string(patch) + ", plus " + text(fit_error_) + ", the fit error";
  const bool is_near = failure == Failure::wide && roundings_[patch] + fit_error_ > tolerance / 2;
  if (failure == Failure::rough || is_near) {
    const std::optional<double> nearest = nearest_tolerance(request.max_triangles);
    return invalid("the tolerance " + text(tolerance) +
                       (is_near ? " leaves too little room above " : " must be above ") + rounding +
                       (nearest ? "; " + text(*nearest) + " is enough" : ""),
                   patch);
  }
  if (failure == Failure::rough_pixels)
    return invalid("the tolerance of " + text(options_.pixels) + " pixels at the view's near distance must be above " +
                       rounding + "; set a larger near distance",
                   patch);
  constexpr int unlimited = 1 << 24;
  double triangles = 0;
  const char* about = "about ";
  for (std::size_t k = 0; k < shapes_.size(); ++k) {
    const Choice choice = choose(k, {tolerance}, unlimited);
    const bool is_known = choice.failure == Failure::none;
    if (!is_known) about = "more than ";
    triangles += 2 * (is_known ? choice.cells : unlimited);
  }
  std::array<char, 32> count;
  std::snprintf(count.data(), count.size(), "%.2g", triangles);
  return invalid(wanted(tolerance) + " takes more than " + std::to_string(max_rate) +
                     " segments along a parameter of patch " + std::to_string(patch) + ", and " + about + count.data() +
                     " triangles in all",
                 patch);
}

std::string CertifiedPlanner::wanted(double tolerance) const {
  std::string said;
  const auto add = [&said](const std::string& more) { said += (said.empty() ? "" : " with ") + more; };
  if (std::isfinite(tolerance)) add("the tolerance " + text(tolerance));
  if (options_.angle) add("the angle " + text(*options_.angle));
  if (options_.camera) add("the tolerance of " + text(options_.pixels) + " pixels");
  return said;
}

}}  // namespace tessera::abi_0_1
