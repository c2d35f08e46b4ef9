#pragma once
// A ray on its way through the instances of a scene, with the nearest root so far.

#include <cstddef>
#include <cstdint>
#include <limits>

#include "ray/line/ray_line.h"
#include "ray/line/ray_query.h"
#include "tessera/ray_scene.h"

namespace tessera { inline namespace abi_0_1 {

/// A ray on its way through the instances, and the nearest root found so far.
struct InstanceLane {
  Ray ray;  ///< its end follows the root
  bool valid;
  const RayLine* line;  ///< in the world
  std::size_t index;    ///< in the batch
  std::uint32_t mask;
  bool found, incomplete, overflow, stopped;
  std::uint32_t steps;
  double t;           ///< of the root, if the closest is wanted
  unsigned instance;  ///< the root's instance
  RayLine own;        ///< the line in that instance
  LeafRoot root;

  InstanceLane() {}
  void set(const Ray& given, const RayLine* along, std::size_t which, std::uint32_t bits) {
    ray = given, line = along, index = which, mask = bits;
    found = incomplete = overflow = stopped = false;
    steps = 0;
  }
  /// Takes over the result of a query in an instance. Among roots with one t the first instance's counts, in any order.
  void take(const RayQuery& query, unsigned in) {
    incomplete |= query.incomplete, overflow |= query.overflow, stopped |= query.stopped;
    steps += query.steps;
    if (!query.found) return;
    if (query.wanted == RootsWanted::closest) {
      const double met = query.t_of(query.best);
      if (found && !(met < t || (met == t && in < instance))) return;
      t = met, instance = in, own = query.line, root = query.best;
      ray.tfar = t;
    }
    found = true;
  }
  /// Returns the s up to which instances are still of interest.
  double end(RootsWanted wanted) const {
    if (stopped || overflow || (found && wanted == RootsWanted::any)) return -std::numeric_limits<double>::infinity();
    return (ray.tfar - line->base) * line->speed - line->shift + line->slack;
  }
};

}}  // namespace tessera::abi_0_1
