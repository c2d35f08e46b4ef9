#pragma once
// Access to an exact scene for the user's Embree scenes, and for scenes of instances.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "ray/leaf/leaf_tracer.h"
#include "ray/line/ray_line.h"
#include "ray/line/ray_query.h"
#include "ray/scene/batch_layout.h"
#include "tessera/ray_scene.h"

namespace tessera { inline namespace abi_0_1 {

/// Limits steps to the range of Hit::steps.
inline std::uint16_t saturated_u16(std::uint32_t steps) { return static_cast<std::uint16_t>(std::min(steps, 0xffffu)); }

/// The sizes of exact scenes: squares of lengths stay normal numbers.
inline constexpr double smallest_exact = 1e-140, largest_exact = 1e140;

/// Stays in place while its ray scene lives. Const calls from any number of threads.
class ExactSource {
 public:
  virtual ~ExactSource() = default;
  virtual bool fresh() const = 0;
  virtual const LeafTracer& tracer() const = 0;
  /// Returns the box of all possible hits, in the model's coordinates.
  virtual Box3 reach() const = 0;
  /// Returns the line of a valid ray in the model's coordinates.
  virtual RayLine line(const Ray& ray) const = 0;
  virtual RayLine line(const Ray& ray, const Placement& placement) const = 0;
  /// Returns RayScene::spawn_offset().
  virtual double offset() const = 0;
  /// Runs the query, whose line must not be empty, inside a FlushDenormals.
  virtual void trace(RayQuery& query) const = 0;
  /// Runs up to a packet of queries for one kind of roots, together if they are coherent.
  virtual void trace(std::span<RayQuery* const> queries) const = 0;
  /// Sets the members that `parts` names, and flags, patch, surface and parameters. All others, such as t, steps and
  /// the instance, are unchanged.
  virtual void set_hit(const RayLine& line, const LeafRoot& root, HitParts parts, Hit& hit) const = 0;
  Hit hit_at(const RayLine& line, const LeafRoot& root) const {
    Hit hit;
    set_hit(line, root, {}, hit);
    hit.t = line.t_at(root.s);
    return hit;
  }
  /// Appends the hits of a query for all roots, in order and each once.
  virtual void hits_of(RayQuery& query, std::vector<Hit>& hits) const = 0;
};

}}  // namespace tessera::abi_0_1
