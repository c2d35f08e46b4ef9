// Compares Tessera's certified tessellation with OpenCASCADE's BRepMesh_IncrementalMesh on the same surfaces, each on
// one thread. OpenCASCADE gets a deflection, and the real distance of its mesh from the surface is measured at 66
// points of each triangle. Tessera gets about the largest tolerance at which its own mesh, measured in the same way, is
// at least as near. (Tessera's distance is also proven: the bound stands beside the measured one.) A plan of the fewest
// triangles, which takes more time, is compared likewise. Times span all work from surfaces in memory (Bezier patches
// packed in a set, or faces of a shape) to positions, normals and triangles.

#include <tbb/global_control.h>
#include <Standard_Version.hxx>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "convert/wavy_surface.h"
#include "peers/interleaved.h"
#include "peers/occt_shape.h"
#include "peers/results.h"
#include "support/synthetic_sets.h"
#include "tessera/convert.h"
#include "tessera/model.h"
#include "tessera/tessellation.h"

namespace tessera::bench { namespace {

constexpr int rounds = 3;
constexpr int sample_steps = 10;  // 66 points of each triangle

/// A surface to mesh.
struct Subject {
  std::string name;
  PatchSet set;
  OcctShape shape;
};

Subject spline_subject(int spans) {
  const BSplineSurface surface = test::value_of(wavy_surface(spans, 3, false));
  return {"B-spline, one face of " + std::to_string(spans) + " x " + std::to_string(spans) + " spans",
          test::value_of(make_patch_set(test::value_of(to_bezier(surface)))), OcctShape({occt_surface(surface)})};
}

Subject patches_subject(const std::string& name, const std::vector<BezierPatch>& patches) {
  std::vector<Handle(Geom_Surface)> surfaces;
  for (const BezierPatch& patch : patches) surfaces.push_back(occt_surface(patch));
  return {name, test::value_of(PatchSet::make(patches)), OcctShape(surfaces)};
}

/// A mesh's figures.
struct Measured {
  std::size_t triangles = 0;
  double error = 0, seconds = 0, bound = 0;
};

Measured measure_occt(Subject& subject, double deflection) {
  Measured measured;
  measured.seconds = best_interleaved(rounds, {[&] { return subject.shape.mesh(deflection); }})[0];
  const std::vector<SurfaceTriangle> triangles = subject.shape.triangles();
  measured.triangles = triangles.size();
  const auto at = [&](std::size_t face, double u, double v) { return subject.shape.point(face, u, v); };
  measured.error = largest_distance(triangles, at, sample_steps);
  return measured;
}

Mesh mesh_of(const Subject& subject, const TessellationOptions& options, double& bound) {
  const Tessellation plan = test::value_of(Tessellation::make(subject.set, options));
  Mesh mesh = test::value_of(plan.allocate());
  if (!plan.run(subject.set, mesh.views()).ok()) std::abort();
  bound = plan.bound();
  return mesh;
}

Measured measure_mesh(const Subject& subject, const TessellationOptions& options) {
  Measured measured;
  const Mesh mesh = mesh_of(subject, options, measured.bound);
  measured.triangles = mesh.triangle_count();
  const auto at = [&](std::size_t patch, double u, double v) { return de_casteljau(subject.set.patch(patch), u, v); };
  measured.error = largest_distance(triangles_of(mesh), at, sample_steps);
  return measured;
}

/// Writes positions, normals and triangles into existing memory.
double seconds_of_mesh(const Subject& subject, const TessellationOptions& options) {
  double bound = 0;
  Mesh mesh = mesh_of(subject, options, bound);
  MeshViews out = mesh.views();
  out.parameter = {};
  out.patch = {};
  const auto make = [&] {
    return seconds_of([&] {
      const auto plan = Tessellation::make(subject.set, options);
      if (!plan || !plan->run(subject.set, out).ok()) std::abort();
    });
  };
  return best_interleaved(rounds, {make})[0];
}

/// About the coarsest mesh whose measured error is at most `error`.
Measured measure_tessera(const Subject& subject, double error, bool fewest) {
  double tolerance = 2 * error;
  const auto options = [fewest](double within) { return TessellationOptions{.tolerance = within, .fewest = fewest}; };
  std::optional<std::pair<double, Measured>> best;
  for (int step = 0; step < 12; ++step) {
    const Measured found = measure_mesh(subject, options(tolerance));
    if (found.error <= error && (!best || tolerance > best->first)) best = {tolerance, found};
    if (found.error <= error && found.error > 0.97 * error) break;
    tolerance *= 0.99 * error / found.error;
  }
  if (!best) best = {0.9 * error, measure_mesh(subject, options(0.9 * error))};  // proven to be near enough
  best->second.seconds = seconds_of_mesh(subject, options(best->first));
  return best->second;
}

bool compare(Subject& subject, double deflection) {
  const Measured occt = measure_occt(subject, deflection);
  const Measured ours = measure_tessera(subject, occt.error, false),
                 fewest = measure_tessera(subject, occt.error, true);
  std::printf("%-38s %9.1e | %8zu %9.2e %9.3f | %8zu %9.2e %9.2e %9.5f", subject.name.c_str(), deflection,
              occt.triangles, occt.error, 1e3 * occt.seconds, ours.triangles, ours.error, ours.bound,
              1e3 * ours.seconds);
  for (const Measured* const one : {&ours, &fewest})
    std::printf(" | %7.0f %9.2f", occt.seconds / one->seconds,
                static_cast<double>(one->triangles) / static_cast<double>(occt.triangles));
  std::printf("\n");
  std::fflush(stdout);
  char deflected[32];
  std::snprintf(deflected, sizeof deflected, "%.2g", deflection);
  add_result({"meshes of equal error: " + subject.name, "OpenCASCADE " OCC_VERSION_COMPLETE,
              std::string("BRepMesh_IncrementalMesh, deflection ") + deflected,
              static_cast<double>(occt.triangles) / occt.seconds, "certified mesh, by its time",
              occt.seconds / ours.seconds});
  const auto keeps = [&](const Measured& one) { return one.error <= one.bound && one.error <= occt.error; };
  if (keeps(ours) && keeps(fewest)) return true;
  std::fputs("occt_mesh: a bound is exceeded, or the mesh is further away than OpenCASCADE's\n", stderr);
  return false;
}

int run() {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  std::printf("%-38s %9s | %-28s | %-38s | %-17s | %s\n", "", "", "OpenCASCADE", "Tessera", "over the other's",
              "the same of the fewest");
  std::printf("%-38s %9s | %8s %9s %9s | %8s %9s %9s %9s | %7s %9s | %7s %9s\n", "surface", "deflection", "triangles",
              "error", "ms", "triangles", "error", "bound", "ms", "faster", "triangles", "faster", "triangles");
  bool good = true;
  Subject subjects[] = {spline_subject(40), patches_subject("400 bicubic faces", test::wavy_field(20, 20)),
                        patches_subject("closed body of 6 bicubic faces", test::closed_body()),
                        patches_subject("sphere of 8 rational octants", test::sphere())};
  for (Subject& subject : subjects)
    for (const double relative : {3e-3, 1e-3, 3e-4, 1e-4})
      good = compare(subject, relative * subject.set.box().diagonal()) && good;
  return good ? 0 : 1;
}

}}  // namespace tessera::bench

int main() { return tessera::bench::run(); }
