// Compares the triangles of certified meshes with those of OpenCASCADE's BRepMesh_IncrementalMesh, mainly on rational
// surfaces: classic shapes, and the surfaces of models. Both meshes are measured in one way, by samples
// (peers/mesh_distance.h). The ratio of triangles is that at equal measured error: Tessera uses about the largest
// tolerance at which the measured error of its mesh does not exceed OpenCASCADE's.
//
// OpenCASCADE also has an angular deflection, 0.5 rad by default, which may force triangles that the distance does not
// need. OpenCASCADE meshes each case at 0.5 rad and at pi rad, which forces none. The row shows the mesh that suits
// OpenCASCADE better: the one with the larger ratio. A mesh that takes more than 5 s is made at 0.5 rad only.

#include <tbb/global_control.h>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <optional>

#include "peers/lean_cases.h"
#include "peers/occt_shape.h"
#include "peers/results.h"
#include "peers/tessera_search.h"

namespace tessera::bench { namespace {

constexpr char usage[] =
    "tessera_peer_occt_lean_mesh [--fewest] [--only NAME]\n\n"
    "Triangles and times of certified meshes beside OpenCASCADE's at equal measured error, one thread: cylinders, a "
    "cone, a\n"
    "sphere, a torus, NURBS surfaces, the rational surfaces of tools/models and of the folder TESSERA_TEST_DATA; then "
    "how\n"
    "far proven bounds lie above measured errors on polynomial ones. About 5 minutes.\n"
    "  --fewest     Tessera's meshes of the fewest triangles\n"
    "  --only NAME  shapes and files whose names contain NAME\n"
    "Exit status 1 if a mesh is not valid or a bound does not hold.\n";

constexpr std::size_t max_triangles = 300000;                     // larger meshes are skipped
constexpr double max_shape_seconds = 60, max_model_seconds = 10;  // for one of OpenCASCADE's meshes
constexpr double max_seconds_for_angles = 5;
constexpr double angles[] = {occt_default_angle, std::numbers::pi};

/// Fine meshes have many triangles and need fewer samples of each. Even, so that the middles of edges are sampled.
int sample_steps(std::size_t triangles) { return triangles <= 10000 ? 10 : 6; }

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

/// OpenCASCADE's mesh, and Tessera's at equal error.
struct Pair {
  double angle = 0, seconds = 0;
  std::size_t triangles = 0;
  double error = 0;
  std::optional<MeasuredMesh> equal = {};
  double ratio() const { return static_cast<double>(equal->triangles) / static_cast<double>(triangles); }
};

struct Row {
  std::string name, kinds;
  bool is_model = false;
  double tolerance = 0, rate = 0, ratio = 0, faster = 0;
  std::size_t patches = 0, triangles = 0, occt_triangles = 0;
};

class Report {
 public:
  explicit Report(bool fewest) : fewest_(fewest) {}

  void compare(const LeanCase& one) {
    OcctShape shape(one.surfaces);
    bool stopped = false;
    for (const double tolerance : one.tolerances) {
      std::printf("%-46.46s %8.2e | ", one.name.c_str(), tolerance);
      const std::string why = stopped ? "OpenCASCADE's mesh before it took too long" : compare(one, shape, tolerance);
      if (!why.empty()) std::printf("skipped: %s\n", why.c_str());
      stopped = stopped || why.starts_with("OpenCASCADE");
      std::fflush(stdout);
    }
  }

  /// Reports Tessera's mesh only.
  void measure(const LeanCase& one) {
    const CertifiedMesher mesher(one.set, fewest_);
    std::printf("%-46.46s %7zu |", one.name.c_str(), one.set.patch_count());
    for (std::size_t k = 0; k < one.tolerances.size(); ++k) {
      const Result<Tessellation> plan = mesher.plan(one.tolerances[k]);
      if (!plan || plan->capacity().triangles > max_triangles) {
        std::printf(" %8s %5s", plan ? "many" : "failed", "");
        continue;
      }
      const std::size_t triangles = plan->capacity().triangles;
      const MeasuredMesh mesh = checked(mesher.measure(*plan, one.tolerances[k], sample_steps(triangles)), *plan);
      std::printf(" %8zu", mesh.triangles);
      if (mesh.error > 1e-3 * mesh.tolerance) {  // the surface is not flat
        std::printf(" %5.2f", mesh.bound / mesh.error);
        looseness_.resize(one.tolerances.size());
        looseness_[k].push_back(mesh.bound / mesh.error);
      } else {
        std::printf(" %5s", "flat");
      }
    }
    std::printf("\n");
    std::fflush(stdout);
  }

  void finish_comparison() const {
    summarize("shapes", [](const Row& row) { return !row.is_model; });
    summarize("rational models", [](const Row& row) { return row.is_model; });
    summarize("all", [](const Row&) { return true; });
    std::vector<Row> worse;
    std::ranges::copy_if(rows_, std::back_inserter(worse), [](const Row& row) { return row.ratio > 1; });
    std::ranges::sort(worse, std::greater{}, &Row::ratio);
    std::printf("\n%zu of %zu rows take more triangles than OpenCASCADE:\n", worse.size(), rows_.size());
    for (const Row& row : worse)
      std::printf("%5.2f %-46.46s %8.2e %7zu by %7zu triangles, %5zu patches of rate %6.2f, %s\n", row.ratio,
                  row.name.c_str(), row.tolerance, row.triangles, row.occt_triangles, row.patches, row.rate,
                  row.kinds.c_str());
  }
  void finish_measures() const {
    std::printf("medians of the bound over the measured error:");
    for (const std::vector<double>& of_tolerance : looseness_) std::printf(" %.2f", median(of_tolerance));
    std::printf("\n");
  }
  bool good() const { return good_; }

 private:
  /// Prints the rest of a row, or returns why there is none.
  std::string compare(const LeanCase& one, OcctShape& shape, double tolerance) {
    const CertifiedMesher mesher(one.set, fewest_);
    const Result<Tessellation> plan = mesher.plan(tolerance);
    if (!plan) return "Tessera: " + plan.status().message();
    if (plan->capacity().triangles > max_triangles)
      return "Tessera takes " + std::to_string(plan->capacity().triangles) + " triangles";
    std::optional<Pair> best;
    for (const double angle : angles) {
      if (best && best->seconds > max_seconds_for_angles) break;
      Pair pair{.angle = angle};
      if (const std::string why = mesh_occt(one, shape, tolerance, pair); !why.empty()) return why;
      if (best && pair.triangles == best->triangles) continue;
      pair.equal = mesher.coarsest(pair.error, sample_steps(pair.triangles));
      if (!pair.equal)
        return "Tessera takes " + std::to_string(plan->capacity().triangles) + " triangles; at OpenCASCADE's error " +
               mesher.plan(pair.error).status().message();
      if (!best || pair.ratio() > best->ratio()) best = pair;
    }
    const MeasuredMesh same =
        checked(mesher.measure(*plan, tolerance, sample_steps(plan->capacity().triangles)), *plan);
    checked(*best->equal, *plan);
    add_row(one, *best, same, mesher.seconds(best->equal->tolerance));
    return {};
  }

  std::string mesh_occt(const LeanCase& one, OcctShape& shape, double tolerance, Pair& pair) const {
    const double max_seconds = one.is_model ? max_model_seconds : max_shape_seconds;
    pair.seconds = shape.mesh(tolerance, pair.angle, max_seconds);
    if (std::isinf(pair.seconds)) return "OpenCASCADE takes more than " + std::to_string(int(max_seconds)) + " s";
    if (pair.seconds < 0.1)
      pair.seconds = best_interleaved(2, {[&] { return shape.mesh(tolerance, pair.angle); }}, 0.01)[0];
    const std::vector<SurfaceTriangle> triangles = shape.triangles();
    pair.triangles = triangles.size();
    if (triangles.empty()) return "OpenCASCADE makes no triangles";
    if (triangles.size() > max_triangles)
      return "OpenCASCADE takes " + std::to_string(triangles.size()) + " triangles, " + std::to_string(pair.seconds) +
             " s";
    pair.error = largest_distance(
        triangles, [&](std::size_t face, double u, double v) { return shape.point(face, u, v); },
        sample_steps(triangles.size()));
    return {};
  }

  /// Returns the mesh; reports a bound that does not hold.
  MeasuredMesh checked(const MeasuredMesh& mesh, const Tessellation& plan) {
    if (!mesh.holds() && plan.certified()) {
      std::fprintf(stderr, "occt_lean_mesh: measured %.9g, proven %.9g\n", mesh.error, mesh.bound);
      good_ = false;
    }
    return mesh;
  }

  void add_row(const LeanCase& one, const Pair& pair, const MeasuredMesh& same, double seconds) {
    const std::size_t patches = one.set.patch_count();
    const double rate = std::sqrt(static_cast<double>(pair.equal->triangles) / (2.0 * static_cast<double>(patches)));
    const Row row{one.name,     patch_kinds(one.set),   one.is_model, same.tolerance,        rate,
                  pair.ratio(), pair.seconds / seconds, patches,      pair.equal->triangles, pair.triangles};
    std::printf("%8zu %8.2e %9.3f %4.2f | %8zu %8.2e %5.2f | %8zu %8.2e %8.4f %6.1f | %5.2f %7.0f\n", pair.triangles,
                pair.error, 1e3 * pair.seconds, pair.angle, same.triangles, same.error, same.bound / same.error,
                pair.equal->triangles, pair.equal->error, 1e3 * seconds, rate, row.ratio, row.faster);
    rows_.push_back(row);
  }

  template <class Predicate>
  void summarize(const char* what, Predicate&& counts) const {
    std::vector<double> ratios, dense, faster;
    for (const Row& row : rows_)
      if (counts(row)) {
        ratios.push_back(row.ratio);
        faster.push_back(row.faster);
        if (row.rate >= 2) dense.push_back(row.ratio);
      }
    if (ratios.empty()) return;
    const auto worst = [](const std::vector<double>& all) { return all.empty() ? 0 : *std::ranges::max_element(all); };
    std::printf(
        "%s, %zu rows: triangles by OpenCASCADE's at equal error: median %.2f, worst %.2f; at rates of 2 or more "
        "(%zu rows) median %.2f, worst %.2f; %.0f times as fast (median)\n",
        what, ratios.size(), median(ratios), worst(ratios), dense.size(), median(dense), worst(dense), median(faster));
    add_result({std::string("lean meshes of equal error: ") + what, "OpenCASCADE " OCC_VERSION_COMPLETE,
                "BRepMesh_IncrementalMesh, times as fast (median)", 0, "certified mesh", median(faster)});
  }

  bool fewest_, good_ = true;
  std::vector<Row> rows_;
  std::vector<std::vector<double>> looseness_;
};

int run(bool fewest, const std::string& only) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  Report report(fewest);
  std::vector<LeanCase> cases = shape_cases(only), models = model_cases(only);
  std::ranges::move(models, std::back_inserter(cases));
  std::printf("%-46s %8s | %-32s | %-23s | %-33s | %s\n", "", "", "OpenCASCADE " OCC_VERSION_COMPLETE,
              "Tessera, that tolerance", "Tessera, OpenCASCADE's error", "ours by theirs");
  std::printf("%-46s %8s | %8s %8s %9s %4s | %8s %8s %5s | %8s %8s %8s %6s | %5s %7s\n", "surface", "within",
              "triangles", "error", "ms", "rad", "triangles", "error", "bound", "triangles", "error", "ms", "rate",
              "tri.", "faster");
  for (const LeanCase& one : cases)
    if (!one.surfaces.empty()) report.compare(one);
  report.finish_comparison();
  std::printf(
      "\nPolynomial models: triangles, and the bound over the measured error, at 3e-2, 1e-2, 1e-3, 1e-4 of the size\n");
  for (const LeanCase& one : cases)
    if (one.surfaces.empty()) report.measure(one);
  report.finish_measures();
  return report.good() ? 0 : 1;
}

}}  // namespace tessera::bench

int main(int argc, char** argv) {
  bool fewest = false;
  std::string only;
  for (int k = 1; k < argc; ++k) {
    if (std::strcmp(argv[k], "--help") == 0 || std::strcmp(argv[k], "-h") == 0)
      return std::fputs(tessera::bench::usage, stdout) < 0;
    if (std::strcmp(argv[k], "--fewest") == 0) {
      fewest = true;
    } else if (std::strcmp(argv[k], "--only") == 0 && k + 1 < argc) {
      only = argv[++k];
    } else {
      std::fprintf(stderr, "unknown option '%s'\n%s", argv[k], tessera::bench::usage);
      return 2;
    }
  }
  try {
    return tessera::bench::run(fewest, only);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "occt_lean_mesh: %s\n", error.what());
  } catch (const Standard_Failure& failure) {
    std::fprintf(stderr, "occt_lean_mesh: OpenCASCADE: %s\n", failure.GetMessageString());
  }
  return 1;
}
