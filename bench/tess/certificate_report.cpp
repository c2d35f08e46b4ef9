// Checks that certified tessellations keep their bounds, and measures how loose these are: for each patch the bound
// over the true largest distance, found by branch and bound that shares no code with the bounds. Exit status 1 if a
// bound is exceeded, or the median on bicubic patches is above 3.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "report_arguments.h"
#include "support/synthetic_sets.h"
#include "support/true_distance.h"
#include "tess/certificate_sets.h"
#include "tessera/io.h"
#include "tessera/tessellation.h"

namespace {

using namespace tessera;

constexpr char usage[] =
    "tessera_certificate_report [--fewest] [MODEL...]\n\n"
    "Bounds of certified meshes over true distances, of built-in sets and of models.\n"
    "  --fewest  meshes of the fewest triangles\n"
    "Exit status 1 if a bound is exceeded, or the median on bicubic patches is above 3.\n";

/// At most this many patches of a set are checked, evenly spread, and this many triangles of each.
constexpr std::size_t max_patches = 300, max_triangles = 600;

struct Looseness {
  std::size_t patches = 0, triangles = 0, exceeded = 0;
  std::vector<double> ratios;  ///< bound over true distance, for each patch that is not flat up to rounding
};

Looseness measure(const PatchSet& set, double tolerance, bool fewest) {
  const Tessellation plan = test::value_of(Tessellation::make(set, {.tolerance = tolerance, .fewest = fewest}));
  Mesh mesh = test::value_of(plan.allocate());
  if (const Status status = plan.run(set, mesh.views()); !status.ok()) {
    std::fprintf(stderr, "%s\n", status.message().c_str());
    std::exit(1);
  }
  std::vector<std::size_t> first(set.patch_count() + 1, mesh.triangle_count());
  for (std::size_t t = mesh.triangle_count(); t-- > 0;) first[mesh.patches[t]] = t;
  for (std::size_t k = set.patch_count(); k-- > 0;) first[k] = std::min(first[k], first[k + 1]);
  Looseness result;
  const std::size_t step = 1 + (set.patch_count() - 1) / max_patches;
  for (std::size_t k = 0; k < set.patch_count(); k += step) {
    const double bound = plan.bounds()[k];
    double low = 0, high = 0;
    const std::size_t count = first[k + 1] - first[k], stride = 1 + count / max_triangles;
    for (std::size_t t = first[k]; t < first[k + 1]; t += stride) {
      const BezierPatch patch = set.patch(k);
      test::DistanceRange found = test::largest_distance(patch, test::triangle_of(mesh, t), 0.03, 400);
      // Points of a scaled sweep may lie nearest to the triangle's neighbours.
      if (found.low > bound) found = test::largest_distance(patch, mesh, t, first[k], first[k + 1], 0.03, 400);
      low = std::max(low, found.low);
      high = std::max(high, found.high);
      ++result.triangles;
    }
    ++result.patches;
    if (low > bound) ++result.exceeded;
    if (count > 0 && high > 1e-3 * tolerance) result.ratios.push_back(bound / low);
  }
  std::sort(result.ratios.begin(), result.ratios.end());
  return result;
}

/// Prints a row; false if it breaks a promise.
bool report(const std::string& name, const PatchSet& set, double relative, bool bicubic, bool fewest) {
  const Looseness result = measure(set, relative * set.box().diagonal(), fewest);
  const auto at = [&](double share) {
    return result.ratios.empty()
               ? 0
               : result.ratios[static_cast<std::size_t>(share * static_cast<double>(result.ratios.size() - 1))];
  };
  std::printf("%-28s %8.0e %8zu %9zu %9zu %8.2f %8.2f %8.2f\n", name.c_str(), relative, result.patches,
              result.triangles, result.exceeded, at(0), at(0.5), at(0.99));
  std::fflush(stdout);
  return result.exceeded == 0 && (!bicubic || at(0.5) <= 3);
}

}  // namespace

int main(int argc, char** argv) {
  bool good = true;
  const bench::ReportArguments asked(argc, argv, usage);
  std::printf("%-28s %8s %8s %9s %9s %8s %8s %8s\n", "set", "relative", "patches", "triangles", "exceeded", "least",
              "median", "p99");
  for (const test::CertificateSet& set : test::certificate_sets())
    for (const double relative : {3e-3, 3e-4})
      good = report(set.name, test::value_of(PatchSet::make(set.patches)), relative, set.bicubic, asked.fewest) && good;
  for (const char* const path : asked.models) {
    const Result<Model> model = read_model(path);
    const Result<PatchSet> set = model ? make_patch_set(*model) : Result<PatchSet>(model.status());
    if (!set) {
      std::fprintf(stderr, "%s\n", set.status().message().c_str());
      return 1;
    }
    good = report(model->name, *set, 3e-4, false, asked.fewest) && good;
  }
  return good ? 0 : 1;
}
