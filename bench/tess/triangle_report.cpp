// Compares the triangles of certified meshes with those that known true errors would allow: the best uniform rates of
// each patch alone that, by search, keep the tolerance at 28 points of each triangle. Such patches do not meet, so they
// are not a mesh. Also shows the triangles for the patches' own certified rates without strips.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/impl_access.h"
#include "report_arguments.h"
#include "support/synthetic_sets.h"
#include "support/triangle_distance.h"
#include "tess/mesh/proven_mesh.h"
#include "tessera/io.h"
#include "tessera/tessellation.h"

namespace {

using namespace tessera;

constexpr char usage[] =
    "tessera_triangle_report [--fewest] [MODEL...]\n\n"
    "Triangles of certified meshes over those of the best uniform rates, of built-in sets and of models.\n"
    "  --fewest  meshes of the fewest triangles\n";

/// At most this many patches of a set are searched, evenly spread.
constexpr std::size_t max_patches = 200;

/// Whether a uniform mesh keeps a distance, at 28 points of each triangle.
bool keeps(const BezierPatch& patch, Rates rates, double tolerance) {
  constexpr int steps = 6;
  const auto at = [&](double i, double j) { return de_casteljau(patch, i / rates.u, j / rates.v); };
  for (int i = 0; i < rates.u; ++i)
    for (int j = 0; j < rates.v; ++j) {
      const Vec3 p00 = at(i, j), p10 = at(i + 1, j), p11 = at(i + 1, j + 1), p01 = at(i, j + 1);
      for (const bool upper : {false, true})
        for (int a = 0; a <= steps; ++a)
          for (int b = 0; a + b <= steps; ++b) {
            const double s = double(a) / steps, t = double(b) / steps;  // from 00 towards 11, and to the third corner
            const Vec3 p = at(i + s + (upper ? 0 : t), j + s + (upper ? t : 0));
            if (test::distance_to_triangle(p, p00, p11, upper ? p01 : p10) > tolerance) return false;
          }
    }
  return true;
}

/// The cheapest rates that keep the tolerance, among those with at most as many cells as `known`, which keeps it.
Rates best_rates(const BezierPatch& patch, Rates known, double tolerance) {
  Rates best = known;
  for (int u = 1; u <= best.u * best.v; ++u) {
    const int most = (best.u * best.v - 1) / u;  // fewer cells than the best so far
    if (most < 1 || !keeps(patch, {u, most}, tolerance)) continue;
    int low = 0, high = most;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (keeps(patch, {u, middle}, tolerance) ? high : low) = middle;
    }
    best = {u, high};
  }
  return best;
}

void report(const std::string& name, const PatchSet& set, double relative, bool fewest) {
  const double tolerance = relative * set.box().diagonal();
  const auto plan = test::value_of(Tessellation::make(set, {.tolerance = tolerance, .fewest = fewest}));
  const CertifiedPlan& inside = dynamic_cast<const ProvenMesh&>(impl_of(plan)).plan();
  const std::size_t step = 1 + (set.patch_count() - 1) / max_patches;
  double mesh = 0, rates = 0, best = 0;
  for (std::size_t k = 0; k < set.patch_count(); k += step) {
    const Rates own = inside.patches().segments[k].rates();
    if (inside.division(k).empty) continue;
    const Rates found = best_rates(set.patch(k), own, tolerance);
    mesh += static_cast<double>(inside.first_triangle(k + 1) - inside.first_triangle(k));
    rates += 2.0 * own.u * own.v;
    best += 2.0 * found.u * found.v;
  }
  std::printf("%-28s %8.0e %8zu %10.1f %10.0f %10.2f %10.2f\n", name.c_str(), relative, set.patch_count(),
              mesh / (static_cast<double>(set.patch_count()) / static_cast<double>(step)), best, rates / best,
              mesh / best);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const bench::ReportArguments asked(argc, argv, usage);
  std::printf("%-28s %8s %8s %10s %10s %10s %10s\n", "set", "relative", "patches", "a patch", "best", "rates", "mesh");
  std::printf("(triangles a patch; of the best rates in all; ours over that, by our rates alone and of the mesh)\n");
  const auto report_all = [fewest = asked.fewest](const std::string& name, const PatchSet& set) {
    for (const double relative : {3e-3, 1e-3, 3e-4, 1e-4}) report(name, set, relative, fewest);
  };
  report_all("waves", test::value_of(PatchSet::make(test::wavy_field(12, 12))));
  report_all("closed body", test::value_of(PatchSet::make(test::closed_body())));
  report_all("sphere, rational", test::value_of(PatchSet::make(test::sphere())));
  for (const char* const path : asked.models) {
    const Result<Model> model = read_model(path);
    const Result<PatchSet> set = model ? make_patch_set(*model) : Result<PatchSet>(model.status());
    if (!set) {
      std::fprintf(stderr, "%s\n", set.status().message().c_str());
      return 1;
    }
    report_all(model->name.empty() ? path : model->name, *set);
  }
  return 0;
}
