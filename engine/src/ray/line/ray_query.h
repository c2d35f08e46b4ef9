#pragma once
// The query of a ray in exact mode, and the roots that it has found so far.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "ray/line/ray_line.h"
#include "tessera/ray_scene.h"
#include "tessera/trim_region.h"

namespace tessera { inline namespace abi_0_1 {

constexpr double no_part = std::numeric_limits<double>::infinity();
constexpr double parameter_rounding = 1e-15;  // in a patch's parameters

/// A point of a patch on a ray.
struct LeafRoot {
  std::uint32_t patch = 0;
  double u = 0, v = 0;            ///< in the patch
  double s = 0;                   ///< along the line
  double from = no_part;          ///< lower bound of s, for a part that counts as one root
  double residual = 0;            ///< distance from the line, in the scene's coordinates
  double noise = 0;               ///< bound on the rounding of the residual
  double gain_u = 0, gain_v = 0;  ///< how far a parameter moves if the point moves by 1 across the line
  double part_u = 0, part_v = 0;  ///< extent of a part that is taken as one root, else 0
  bool certified = false;         ///< the only root of its surroundings, up to rounding
  bool upwards = false;           ///< if the gains are known: the side of du x dv to which the line goes
  bool has_point = false;
  bool is_on_edge = false;  ///< a point of an edge near the line: see edge_tubes.h
  Vec3 position, du, dv;    ///< if has_point: of the patch, in the scene's coordinates
};

/// Bounds, in u and v, the distance from `a` of the root that `a` and another point may both stand for. Both points lie
/// within `apart` of the line, so within that of each other across it. The parameters follow by the Jacobian there: for
/// a map with a contraction of 1/2 by 2 |J^-1| apart (root_certificate.h). A part that is taken as a whole reaches as
/// far as its size.
inline double reach_u(const LeafRoot& a, double apart) { return a.part_u + 2 * a.gain_u * apart + parameter_rounding; }
inline double reach_v(const LeafRoot& a, double apart) { return a.part_v + 2 * a.gain_v * apart + parameter_rounding; }
/// Bounds the distance of two points of a line across it.
inline double apart(const LeafRoot& a, const LeafRoot& b) { return a.residual + a.noise + b.residual + b.noise; }

/// Returns whether the line leaves a surface on one side at `a` and on the other at `b`; these are then two roots.
inline bool on_other_sides(const LeafRoot& a, const LeafRoot& b) {
  return a.certified && b.certified && a.upwards != b.upwards;
}

/// Returns whether two points of one patch stand for the same root.
inline bool same_place(const LeafRoot& a, const LeafRoot& b) {
  if (on_other_sides(a, b)) return false;
  const double across = apart(a, b);
  return std::abs(a.u - b.u) <= reach_u(a, across) + reach_u(b, across) &&
         std::abs(a.v - b.v) <= reach_v(a, across) + reach_v(b, across);
}

enum class RootsWanted : std::uint8_t { closest, any, all };

/// Says whether a root stands for the origin of the ray.
enum class OriginRoot : std::uint8_t {
  other,
  same,
  indistinct,  ///< cannot be told apart from its neighbours
};

/// The test that decides this: see spawn_root.h.
class OriginTest {
 public:
  virtual OriginRoot decide_root(const RayLine& line, const LeafRoot& root) const = 0;

 protected:
  ~OriginTest() = default;
};

/// Returns the least number from x on, x >= 0, that counts in a search, where denormal ones are taken as 0. Decided by
/// bits.
inline double min_normal(double x) {
  constexpr double least = std::numeric_limits<double>::min();
  return std::bit_cast<std::uint64_t>(x) - 1 < std::bit_cast<std::uint64_t>(least) - 1 ? least : x;
}

/// Tells on which side of the loops of its face a root lies: see leaf_trims.h.
class RootSides {
 public:
  virtual TrimSide side_of(const LeafRoot& root) const = 0;
  /// Whether a root of any patch, also of a whole one, is not outside.
  virtual bool keeps(const LeafRoot& root) const = 0;

 protected:
  ~RootSides() = default;
};

/// The point of a patch that a ray leaves.
struct LeftPoint {
  std::uint32_t patch = 0;
  double u = 0, v = 0;
};

struct RayQuery;

/// The caller's filter of roots: see batch_filter.h.
class RootFilter {
 public:
  virtual HitVerdict decide(const RayQuery& query, const LeafRoot& root) const noexcept = 0;

 protected:
  ~RootFilter() = default;
};

struct RayQuery {
  RayQuery(const Ray& of, const RayLine& along, RootsWanted which)
      : ray(of),
        line(along),
        wanted(which),
        least(min_normal(of.tnear)),
        near(along.near - along.slack),
        far(along.leave) {}

  const Ray& ray;
  const RayLine& line;
  RootsWanted wanted;
  double least;             ///< least t of roots
  double near, far;         ///< range of useful roots; far shrinks to the closest so far
  double unsure = no_part;  ///< least `from` of the roots so far
  bool found = false;
  std::uint32_t steps = 0;                                  ///< number of leaves and of their parts that were searched
  bool incomplete = false;                                  ///< a limit of work was reached: there may be more roots
  bool overflow = false;                                    ///< memory for more roots ran out
  LeafRoot best;                                            ///< if found
  double best_t = std::numeric_limits<double>::infinity();  ///< its t
  std::vector<LeafRoot> roots;                              ///< if all are wanted
  const OriginTest* origin = nullptr;                       ///< if the line leaves a surface
  const LeftPoint* left = nullptr;                          ///< if it is known where the line leaves a surface
  const RootSides* trims = nullptr;                         ///< if loops cut the leaf that is searched
  const RootFilter* filter = nullptr;                       ///< if not all roots count; never if all are wanted
  std::size_t index = 0;                                    ///< index of the ray in the batch, for the filter
  bool stopped = false;                                     ///< by the filter
  double edge_gap = 0;  ///< if all are wanted: the largest gap of the edges that the line passes

  /// Returns t of a root that was taken. Call it where denormal numbers count.
  double t_of(const LeafRoot& root) const { return std::clamp(line.t_at(root.s), ray.tnear, ray.tfar); }
  bool done() const { return (found && wanted == RootsWanted::any) || overflow || stopped; }
  /// Returns whether roots must have gains. Near a loop they must have them, too.
  bool needs_gains() const { return wanted == RootsWanted::all || origin != nullptr; }

  /// Takes a root, unless it is cut away. Returns false if its t is outside of [tnear, tfar], or if it stands for the
  /// origin that the ray leaves: there may be others beside it.
  bool take(const LeafRoot& root) {
    if (origin != nullptr) {  // first: rounding may put the origin itself before tnear
      const OriginRoot is = origin->decide_root(line, root);
      if (is != OriginRoot::other) return is == OriginRoot::indistinct;
    }
    const double t = line.t_at(root.s);
    if (!(t >= least && t <= ray.tfar)) return false;
    if (trims == nullptr) return add(root, t);
    const TrimSide side = trims->side_of(root);
    if (side == TrimSide::outside) return true;
    LeafRoot kept = root;
    kept.certified = kept.certified && side == TrimSide::inside;
    return add(kept, t);
  }

  /// Returns whether root `a`, at its t, comes before `b`. Of roots at equal t it is the point of an edge, then that of
  /// the first patch, whichever was searched first: s is finer than t, and would tell the scene of a whole model from
  /// those of its parts. Two pieces of a patch may find one root with other last digits.
  static bool precedes(const LeafRoot& a, double t_a, const LeafRoot& b, double t_b) {
    return t_a < t_b || (t_a == t_b && wins_at_equal_t(a, b));
  }

  /// Takes the point of an edge that the line passes within its gap. Where all roots are wanted it is none.
  void take_edge(const LeafRoot& root, double gap) {
    edge_gap = std::max(edge_gap, gap);
    if (wanted != RootsWanted::all) add(root, line.t_at(root.s));
  }

 private:
  [[gnu::noinline]] static bool wins_at_equal_t(const LeafRoot& a, const LeafRoot& b) {
    if (a.is_on_edge != b.is_on_edge) return a.is_on_edge;
    const auto order = [](const LeafRoot& r) {
      return std::tie(r.patch, r.u, r.v, r.s, r.residual, r.position.x, r.position.y, r.position.z);
    };
    return order(a) < order(b);
  }

  /// Adds a root that counts.
  bool add(const LeafRoot& root, double t) {
    if (wanted == RootsWanted::all) {
      try {
        roots.push_back(root);
      } catch (...) {  // called from within a tree, and Embree cannot handle exceptions
        overflow = true;
      }
    } else if (precedes(root, t, best, best_t)) {
      if (filter != nullptr && !counts(root)) return true;
      best = root;
      best_t = t;
      far = std::min(far, root.s);
    }
    unsure = std::min(unsure, root.from);
    if (unsure < best.s) best.certified = false;  // the part may hold an earlier root
    found = true;
    return true;
  }

  bool counts(const LeafRoot& root) {
    const HitVerdict verdict = filter->decide(*this, root);
    if (verdict != HitVerdict::accept && verdict != HitVerdict::reject) {
      stopped = true;
      far = -std::numeric_limits<double>::infinity();
    }
    return verdict == HitVerdict::accept;
  }
};

}}  // namespace tessera::abi_0_1
