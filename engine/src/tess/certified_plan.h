#pragma once
// How each patch of a set is divided so that a tolerance is kept and neighbours meet.

#include <cstdint>
#include <span>
#include <vector>

#include "block/patch_set_impl.h"
#include "tess/chord_bound.h"
#include "tess/shared_edges.h"
#include "tess/stitched_patch.h"
#include "tess/weld.h"
#include "tessera/certified_tessellation.h"

namespace tessera {

/// The largest distance between a float vertex, relative to the set's origin, and the surface's point. Each term of a sum of
/// B_i B_j V_ij, or of B_i B_j w_ij V_ij and of B_i B_j w_ij, has gone through at most m + n + 6 roundings: of the packed
/// coefficient, of the weights, and of the sums (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., sec. 3.1).
/// The terms' sizes add up to at most the largest |V|, and so they do for rational patches, over the sum of weights.
double vertex_rounding(const BezierPatch& patch, const Vec3& origin);

class CertifiedPlan {
 public:
  std::size_t patch_count() const { return divisions_.size(); }
  const Division& division(std::size_t patch) const { return divisions_[patch]; }
  std::size_t first_vertex(std::size_t patch) const { return first_vertex_[patch]; }
  std::size_t first_triangle(std::size_t patch) const { return first_triangle_[patch]; }
  MeshCapacity capacity() const { return {first_vertex_.back(), first_triangle_.back()}; }
  std::span<const float> bounds() const { return bounds_; }

 private:
  friend class CertifiedPlanner;
  std::vector<Division> divisions_;
  std::vector<std::size_t> first_vertex_, first_triangle_;  ///< of each patch, and the number of all
  std::vector<float> bounds_;
};

/// What is known of a set before a tolerance is.
class CertifiedPlanner {
 public:
  /// Errors: cancelled. `weld`: finite, at least 0.
  static Result<CertifiedPlanner> make(const PatchSet::Impl& set, double weld, const Execution& execution);

  /// Before welding.
  std::span<const PatchShape> shapes() const { return shapes_; }
  const Weld& weld() const { return weld_; }
  /// Errors: invalid_argument, as CertifiedTessellation::make says; cancelled.
  Result<CertifiedPlan> plan(double tolerance, std::uint64_t most_triangles, const Execution& execution) const;
  /// The smallest tolerance, within 1 percent, whose mesh has at most so many triangles. Errors: invalid_argument (not
  /// even one cell a patch keeps the budget).
  Result<double> smallest_tolerance(std::uint64_t most_triangles, const Execution& execution) const;

 private:
  CertifiedPlanner(const PatchSet::Impl& set) : edges_(set), fit_error_(set.fit_error.distance) {}
  /// The rates that each patch needs for itself, and its bound.
  Status choose_rates(double tolerance, std::vector<Rates>& rates, std::vector<float>& bounds,
                      const Execution& execution) const;
  std::vector<Division> divide(std::span<const Rates> rates) const;
  std::span<const PatchShape> divided_shapes() const { return weld_.shapes.empty() ? shapes_ : weld_.shapes; }

  SharedEdges edges_;
  double fit_error_;
  std::vector<PatchShape> shapes_;
  Weld weld_;
  std::vector<double> roundings_;  ///< vertex_rounding() of each patch, or by how much its vertices are off when welded
  std::vector<ChordBound> chords_;
};

}  // namespace tessera
