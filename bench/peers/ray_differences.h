#pragma once
// The hits of one ray by OpenCASCADE and by Tessera: pairs of equal hits, and a cause for each hit without a partner.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "peers/trimmed_case.h"
#include "tessera/ray_hit.h"

namespace tessera::bench {

/// A point where a ray meets a face.
struct FaceHit {
  std::size_t face = 0;  ///< index into TrimmedCase::faces
  double t = 0;          ///< a length, as directions are unit vectors
  Parameters at{};       ///< OpenCASCADE's
  double slope = 1;      ///< |normal . direction|
};

/// The reason why only one of the programs has a hit. The first that applies counts.
enum class RayCause : std::uint8_t {
  edge,         ///< an edge of the face is nearer than its tolerance
  tangent,      ///< the ray grazes the surface
  twice,        ///< OpenCASCADE has the hit twice
  missed,       ///< OpenCASCADE lacks a hit that its own surface and its own classifier confirm
  refuted,      ///< OpenCASCADE has a hit that its own surface or its own classifier refutes
  unexplained,  ///< none of these
};
inline constexpr std::size_t ray_causes = 6;

/// A hit that one of the programs lacks.
struct RayDifference {
  FaceHit hit;
  bool is_ours = false;  ///< OpenCASCADE lacks it
  RayCause cause = RayCause::unexplained;
};

/// The outcome of a ray.
struct RayOutcome {
  double apart = 0;  ///< the largest difference of t in a pair
  std::vector<RayDifference> differences;
};

/// Pairs and explains the hits of rays at one model.
class RayReferee {
 public:
  /// `tolerance` is that of OpenCASCADE's intersector.
  RayReferee(const TrimmedCase& one, double tolerance);
  /// The hits of both, each in the order of t.
  RayOutcome compare(const Ray& ray, std::span<const FaceHit> ours, std::span<const FaceHit> theirs) const;

 private:
  double reach(const FaceHit& hit) const;
  bool is_near_edge(const FaceHit& hit) const;
  bool confirms(const Ray& ray, const FaceHit& hit) const;
  RayCause cause(const Ray& ray, const FaceHit& hit, bool is_ours, std::span<const FaceHit> theirs) const;

  const TrimmedCase& case_;
  double tolerance_;
  std::vector<double> edge_tolerance_;  ///< for each face, the largest of its edges
};

}  // namespace tessera::bench
