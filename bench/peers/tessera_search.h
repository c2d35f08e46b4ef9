#pragma once
// Finds certified meshes of a set whose measured error equals that of another program's mesh.

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "peers/interleaved.h"
#include "peers/mesh_distance.h"
#include "tessera/tessellation.h"

namespace tessera::bench {

/// A mesh's figures.
struct MeasuredMesh {
  std::size_t triangles = 0;
  double error = 0;      ///< the largest distance found
  double bound = 0;      ///< the proven bound
  double tolerance = 0;  ///< the tolerance of its plan
  bool holds() const { return error <= bound; }
};

/// Makes and measures meshes of a set.
class CertifiedMesher {
 public:
  CertifiedMesher(const PatchSet& set, bool fewest) : set_(set), fewest_(fewest) {}

  Result<Tessellation> plan(double tolerance) const {
    return Tessellation::make(set_, {.tolerance = tolerance, .fewest = fewest_});
  }

  /// Throws std::runtime_error if the mesh is not valid.
  MeasuredMesh measure(const Tessellation& plan, double tolerance, int steps) const {
    Result<Mesh> mesh = plan.allocate();
    if (!mesh || !plan.run(set_, mesh->views()).ok()) throw std::runtime_error("a plan makes no mesh");
    const Result<MeshReport> report = check(*mesh);
    if (!report || report->non_finite_vertices > 0 || mesh->triangle_count() != plan.capacity().triangles)
      throw std::runtime_error("a mesh is not valid");
    const auto at = [&](std::size_t patch, double u, double v) { return de_casteljau(set_.patch(patch), u, v); };
    return {mesh->triangle_count(), largest_distance(triangles_of(*mesh), at, steps), plan.bound(), tolerance};
  }

  /// About the coarsest mesh whose measured error is at most `error`, within `rounding`. Empty if there is no plan for
  /// that tolerance.
  std::optional<MeasuredMesh> coarsest(double error, int steps) const {
    const Result<Tessellation> proven = plan(error);
    if (!proven) return {};
    MeasuredMesh good = measure(*proven, error, steps);
    const double limit = 1e6 * error;
    double known = error, bad = 2 * limit;  // tolerances: none up to `known` saves more, `bad` is too large
    for (int step = 0; step < max_steps && bad > 1.01 * known; ++step) {
      const double scaled = known * std::clamp(error / good.error, 1.02, 20.0);
      const double next = scaled < bad ? scaled : std::sqrt(known * bad);
      if (next > limit) break;
      const Result<Tessellation> coarser = plan(next);
      if (!coarser) break;
      const bool saves = coarser->capacity().triangles < good.triangles;
      const MeasuredMesh found = saves ? measure(*coarser, next, steps) : good;
      if (found.error <= (1 + rounding) * error)
        good = found, known = next;
      else
        bad = next;
    }
    return good.triangles <= max_scanned ? scanned(good, error, steps) : good;
  }

  /// The time of plan, positions, normals and triangles, in existing memory.
  double seconds(double tolerance) const {
    Mesh mesh = *plan(tolerance)->allocate();
    MeshViews out = mesh.views();
    out.parameter = {};
    out.patch = {};
    const auto make = [&] {
      return seconds_of([&] {
        const auto again = plan(tolerance);
        if (!again || !again->run(set_, out).ok()) throw std::runtime_error("a plan makes no mesh");
      });
    };
    return best_interleaved(2, {make}, 0.01)[0];
  }

 private:
  /// For coarse meshes, whose error does not always grow with the tolerance. Tries larger tolerances, the largest
  /// first.
  MeasuredMesh scanned(const MeasuredMesh& good, double error, int steps) const {
    std::size_t tried = 0;
    for (double tolerance = 30 * good.tolerance; tolerance > 1.02 * good.tolerance; tolerance *= 0.96) {
      const Result<Tessellation> coarser = plan(tolerance);
      if (!coarser || coarser->capacity().triangles == tried) continue;
      tried = coarser->capacity().triangles;
      if (tried >= good.triangles) break;
      const MeasuredMesh found = measure(*coarser, tolerance, steps);
      if (found.error <= (1 + rounding) * error) return found;
    }
    return good;
  }

  static constexpr int max_steps = 14;
  static constexpr std::size_t max_scanned = 1000;
  static constexpr double rounding = 1e-3;  // equal chords have different errors if one mesh has float vertices
  const PatchSet& set_;
  bool fewest_;
};

}  // namespace tessera::bench
