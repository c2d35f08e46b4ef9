#pragma once
// Makes the plan of a mesh: how each patch is divided so that the limits are kept and neighbours meet.

#include "tess/plan/certified_plan.h"
#include "tess/plan/plan_facts.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes a plan without a limit on its triangles in all. Errors: invalid_argument (limits that no patch keeps, or only
/// with more triangles of a cut patch than the limit), cancelled.
Result<CertifiedPlan> make_plan(const PlanFacts& facts, const PlanRequest& request, const Execution& execution);

/// Makes the plan with the fewer triangles, by fewest segments or by plain ones. Errors: as for make_plan().
Result<CertifiedPlan> make_leaner_plan(const PlanFacts& facts, const PlanRequest& request, const Execution& execution);

/// Makes a plan as make_leaner_plan() does. Errors also: invalid_argument (more triangles than the limit, more vertices
/// than 32-bit indices).
Result<CertifiedPlan> make_limited_plan(const PlanFacts& facts, const PlanRequest& request, const Execution& execution);

/// Returns the smallest tolerance 2^(k/128), for whole k, whose mesh has at most max_triangles, and at least 1e-6 of
/// what one cell per patch keeps. Errors: invalid_argument (one cell per patch exceeds max_triangles), cancelled.
Result<double> smallest_tolerance(const PlanFacts& facts, std::uint64_t max_triangles, const Execution& execution);

}}  // namespace tessera::abi_0_1
