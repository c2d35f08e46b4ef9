#pragma once
// What a ray is asked for in exact mode, and the roots that it has met so far.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "ray/ray_line.h"

namespace tessera {

constexpr double no_part = std::numeric_limits<double>::infinity();

/// A point of a patch on a ray.
struct LeafRoot {
  std::uint32_t patch = 0;
  double u = 0, v = 0;                ///< in the patch
  double s = 0;                       ///< along the line
  double from = no_part;              ///< of a part that is taken as one root: nothing of it comes before that s
  double residual = 0;                ///< distance from the line, in the scene's coordinates
  double radius_u = 0, radius_v = 0;  ///< how far another root may be that is the same
  bool certified = false;             ///< the one root of its surroundings, up to rounding
  bool has_point = false;
  Vec3 position, du, dv;  ///< where has_point: of the patch, in the scene's coordinates
};

/// Whether two roots of one patch are the same.
inline bool same_place(const LeafRoot& a, const LeafRoot& b) {
  constexpr double rounding = 1e-12;
  return std::abs(a.u - b.u) <= a.radius_u + b.radius_u + rounding &&
         std::abs(a.v - b.v) <= a.radius_v + b.radius_v + rounding;
}

enum class RootsWanted : std::uint8_t { closest, any, all };

/// Whether a root stands for the origin of the ray.
enum class OriginRoot : std::uint8_t {
  other,
  same,
  indistinct,  ///< it and its neighbours can't be told apart
};

/// What tells that: spawn_root.h.
class OriginTest {
 public:
  virtual OriginRoot judge(const RayLine& line, const LeafRoot& root) const = 0;

 protected:
  ~OriginTest() = default;
};

/// The least number from x on, x >= 0, that counts in a search, which takes denormal ones for 0: told by its bits.
inline double least_normal(double x) {
  constexpr double least = std::numeric_limits<double>::min();
  return std::bit_cast<std::uint64_t>(x) - 1 < std::bit_cast<std::uint64_t>(least) - 1 ? least : x;
}

struct RayQuery {
  RayQuery(const Ray& of, const RayLine& along, RootsWanted which)
      : ray(of),
        line(along),
        wanted(which),
        least(least_normal(of.tnear)),
        near(along.near - along.slack),
        far(along.leave) {}

  const Ray& ray;
  const RayLine& line;
  RootsWanted wanted;
  double least;             ///< t of roots
  double near, far;         ///< roots outside are of no use; far shrinks to the closest so far
  double unsure = no_part;  ///< least `from` of the roots so far
  bool found = false;
  std::uint32_t steps = 0;             ///< leaves looked at and parts of them searched
  bool incomplete = false;             ///< a bound on work was reached: there may be more
  bool overflow = false;               ///< memory for more roots ran out
  LeafRoot best;                       ///< where found
  std::vector<LeafRoot> roots;         ///< where all are wanted
  const OriginTest* origin = nullptr;  ///< where the line leaves a surface

  /// Of a root that was taken, seen from where denormal numbers count.
  double t_of(const LeafRoot& root) const { return std::clamp(line.t_at(root.s), ray.tnear, ray.tfar); }
  bool done() const { return (found && wanted == RootsWanted::any) || overflow; }

  /// False where the root's t is outside of [tnear, tfar], or where it stands for the origin that the ray leaves: there
  /// may be others beside it.
  bool take(const LeafRoot& root) {
    if (origin != nullptr) {  // first: rounding may have left the origin itself before tnear
      const OriginRoot is = origin->judge(line, root);
      if (is != OriginRoot::other) return is == OriginRoot::indistinct;
    }
    const double t = line.t_at(root.s);
    if (!(t >= least && t <= ray.tfar)) return false;
    if (wanted == RootsWanted::all) {
      try {
        roots.push_back(root);
      } catch (...) {  // called from Embree, which knows no exceptions
        overflow = true;
      }
    } else if (!found || root.s < best.s) {
      best = root;
      far = std::min(far, root.s);
    }
    unsure = std::min(unsure, root.from);
    if (unsure < best.s) best.certified = false;  // the part may hold a root that comes before
    found = true;
    return true;
  }
};

}  // namespace tessera
