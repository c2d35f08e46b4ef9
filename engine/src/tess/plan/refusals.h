#pragma once
// The errors of limits that patches cannot keep, or only with too many triangles, and the tolerance that they could.

#include <cstdint>
#include <optional>
#include <string>

#include "tess/plan/certified_plan.h"
#include "tess/plan/plan_facts.h"

namespace tessera { inline namespace abi_0_1 {

/// Names the limits that a plan must keep, as "the tolerance 0.001 with the angle 0.1".
std::string wanted(const PlannerOptions& options, double tolerance);
/// Tells why a patch cannot keep the limits, and what it could keep.
Status refusal(const PlanFacts& facts, const PlanRequest& request, std::size_t patch);
/// The error of a tolerance for which a cut patch takes more triangles than the limit.
Status too_many_of_patch(const PlannerOptions& options, const PlanRequest& request, std::size_t patch);
/// The error of a tolerance for which cut patches take more than `triangles`, which exceed the limit.
Status too_many_of_cuts(const PlannerOptions& options, const PlanRequest& request, std::uint64_t triangles);
/// The error of a plan that takes more triangles than the limit, or more vertices than 32-bit indices have.
Status too_many_in_all(const PlannerOptions& options, const PlanRequest& request, const MeshCapacity& capacity);

/// Returns about the smallest tolerance that the vertices keep with max_triangles, to two digits; none if it is far
/// above the rounding of the vertices.
std::optional<double> nearest_tolerance(const PlanFacts& facts, std::uint64_t max_triangles);

}}  // namespace tessera::abi_0_1
