#include "conformance/patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tessera/evaluate.h"

namespace tessera::test {
namespace {

constexpr std::size_t count = 5;  // parameters in each direction

/// The largest coordinate of the control points, seen from `origin`.
double size_of(const BezierPatch& patch, const Vec3& origin) {
  double size = 0;
  for (const Vec3& p : patch.points()) size = std::max(size, max_abs(p - origin));
  return size;
}

struct Errors {
  double in_double = 0, in_float = 0;  // distances from the surface
};

/// Patch `k`, and its records of the float grid, against its surface.
Errors errors_of(const Model& model, const PatchSet& set, std::size_t k, const std::vector<float>& grid) {
  const std::vector<double> parameters = uniform_parameters(count);
  const PatchSource& source = set.source(k);
  const ModelSurface& surface = model.surfaces.at(source.surface);
  Errors errors;
  for (std::size_t n = 0; n < count * count; ++n) {
    const double s = parameters[n / count], t = parameters[n % count];
    const auto [u, v] = own_parameters(surface.surface, source.domain.u_at(s), source.domain.v_at(t));
    const Result<SurfaceJet> jet = evaluate_jet(surface, u, v);
    EXPECT_TRUE(jet.ok()) << jet.status().message();
    if (!jet) return errors;
    const float* const p = &grid[3 * (k * count * count + n)];
    const Vec3 by_kernels = set.origin() + Vec3{p[0], p[1], p[2]};
    errors.in_double = std::max(errors.in_double, max_abs(evaluate_jet(set.patch(k), s, t).position - jet->position));
    errors.in_float = std::max(errors.in_float, max_abs(by_kernels - jet->position));
  }
  return errors;
}

}  // namespace

PatchFigures expect_patches_follow_surfaces(const Model& model) {
  PatchFigures figures;
  const Result<PatchSet> set = make_patch_set(model);
  EXPECT_TRUE(set.ok()) << set.status().message();
  if (!set) return figures;
  const std::vector<double> parameters = uniform_parameters(count);
  const Result<GridPlan> plan = GridPlan::make(*set, parameters, parameters);
  EXPECT_TRUE(plan.ok()) << plan.status().message();
  if (!plan) return figures;
  std::vector<float> grid(3 * plan->capacity());
  EXPECT_TRUE(evaluate(*set, *plan, QuantityViews<float>{.position = View3<float>::interleaved(grid)}).ok());
  const double fit = set->fit_error().distance;
  for (std::size_t k = 0; k < set->patch_count(); ++k) {
    const double size = size_of(set->patch(k), {}) * 0x1p-52,
                 float_size = size_of(set->patch(k), set->origin()) * 0x1p-23;
    const Errors errors = errors_of(model, *set, k, grid);
    EXPECT_LE(errors.in_double, fit + 64 * size) << "patch " << k << " of surface " << set->source(k).surface;
    EXPECT_LE(errors.in_float, fit + 64 * size + 8 * float_size) << "patch " << k << " of " << set->source(k).surface;
    figures.double_error = std::max(figures.double_error, (errors.in_double - fit) / size);
    figures.float_error = std::max(figures.float_error, (errors.in_float - fit) / float_size);
  }
  figures.patches = set->patch_count();
  figures.points = set->patch_count() * count * count;
  return figures;
}

}  // namespace tessera::test
