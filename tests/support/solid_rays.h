#pragma once
// Rays through closed shells, half of them aimed at edges and vertices, and what becomes of them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "model/coedge_parameter.h"
#include "model/face_points.h"
#include "support/ray_classes.h"
#include "tessera/model.h"
#include "tessera/ray_scene.h"
#include "tessera/topology.h"

namespace tessera::test {

/// Counts of rays and of their faults.
struct SolidTally {
  std::size_t lines = 0;       ///< rays from outside to infinity, which must cross an even number of times
  std::size_t outgoing = 0;    ///< rays from inside, which must cross an odd number of times
  std::size_t incoming = 0;    ///< rays from outside that end inside, which must, too
  std::size_t seams = 0;       ///< rays that pass an edge
  std::size_t unsure = 0;      ///< rays with a hit that is uncertified or incomplete, of those that pass no edge
  std::size_t unmoved = 0;     ///< rays that pass an edge and could not be moved aside
  std::size_t odd = 0;         ///< wrong counts of rays that pass no edge and have no such hit
  std::size_t border_odd = 0;  ///< of those that have a hit exactly on the border of a patch
  std::size_t unsure_odd = 0;  ///< of those that have one
  std::size_t seam_odd = 0;    ///< of rays that pass an edge and were moved
  std::size_t leaks = 0;       ///< rays between an inside and an outside point that met nothing
  std::size_t rays() const { return lines + outgoing + incoming; }
  bool good() const { return odd == 0 && leaks == 0 && seam_odd == 0; }
};

/// Draws points of the edges of a shape, and of its vertices.
class EdgeTargets {
 public:
  explicit EdgeTargets(const Shape& shape) : shape_(shape), uses_(value_of(edge_uses(shape))) {
    for (std::uint32_t edge = 0; edge < shape.edges.size(); ++edge)
      if (!uses_[edge].empty() && !shape.edges[edge].degenerate) edges_.push_back(edge);
  }
  bool empty() const { return edges_.empty(); }
  /// The point of one of an edge's faces, at its ends in half of all cases.
  Vec3 draw(Random& random) const {
    const std::uint32_t edge = edges_[random() % edges_.size()];
    const tessera::Interval& range = shape_.edges[edge].range;
    const double x = random() % 2 == 0 ? double(random() % 2) : uniform(random, 0, 1);
    const EdgeUse& use = uses_[edge][random() % uses_[edge].size()];
    const ShapeFace& face = shape_.faces[use.face];
    const TrimLoop& loop = edge_loops(face)[use.loop];
    const Curve& curve = loop.curves[use.curve];
    const double s = (1 - x) * range.from + x * range.to;
    return value_of(face_point(face, curve, curve_parameter(loop.coedges[use.curve], curve, s))).position;
  }

 private:
  const Shape& shape_;
  EdgeUses uses_;
  std::vector<std::uint32_t> edges_;
};

/// Casts rays through a shape of closed shells.
class SolidRays {
 public:
  SolidRays(const Shape& shape, const RayScene& scene, std::uint64_t seed)
      : scene_(scene), targets_(shape), box_(scene.box()), size_(box_.diagonal()), random_(seed) {
    for (int tries = 0; tries < 20000 && inside_.size() < 100; ++tries) {
      const Vec3 point = in_box();
      const auto is_odd = [&] {
        const std::vector<Hit>& hits = all({point, rays::unit_vector(random_)});
        return hits.size() % 2 == 1 && !is_flagged(hits);
      };
      if (is_odd() && is_odd() && is_odd() && is_deep(point)) inside_.push_back(point);
    }
  }

  /// How many points were found that lie inside for sure.
  std::size_t inside_count() const { return inside_.size(); }

  void cast(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 at = random_() % 2 == 0 ? near_edge() : in_box();
      const std::size_t kind = inside_.empty() ? 0 : random_() % 3;
      if (kind == 0) {
        const Vec3 from = box_.centre() + 1.5 * size_ * rays::unit_vector(random_);
        check({from, at - from}, false, ++tally_.lines);
        continue;
      }
      const Vec3& inside = inside_[random_() % inside_.size()];
      const Vec3 way = at - inside;
      if (!(dot(way, way) > 0)) continue;
      if (kind == 1) {
        check({inside, way}, true, ++tally_.outgoing);
      } else {
        const Vec3 from = inside + 2 * size_ / length(way) * way;
        Ray ray{from, inside - from};
        ray.tfar = 1;
        check(ray, true, ++tally_.incoming);
      }
    }
  }
  const SolidTally& tally() const { return tally_; }

 private:
  Vec3 in_box() {
    const Vec3 d = box_.upper - box_.lower;
    return box_.lower + Vec3{uniform(random_, 0, 1) * d.x, uniform(random_, 0, 1) * d.y, uniform(random_, 0, 1) * d.z};
  }
  /// A quarter exactly on an edge, the others 1e-14 to 1e-3 of the size beside it.
  Vec3 near_edge() {
    if (targets_.empty()) return in_box();
    const Vec3 at = targets_.draw(random_);
    if (random_() % 4 == 0) return at;
    return at + size_ * rays::power(random_, 1e-14, 1e-3) * rays::unit_vector(random_);
  }
  const std::vector<Hit>& all(const Ray& ray) {
    if (const Status status = scene_.all(std::span(&ray, 1), lists_); !status.ok()) lists_.hits.clear();
    return lists_.hits;
  }
  /// Whether no surface is near, compared with how far rays are moved aside at edges.
  bool is_deep(const Vec3& point) {
    double gap = 1e-6 * size_;
    for (const double of : value_of(scene_.edge_gaps())) gap = std::max(gap, of);
    for (int k = 0; k < 20; ++k)
      for (const Hit& hit : all({point, rays::unit_vector(random_)}))
        if (hit.t < 10 * gap) return false;
    return true;
  }
  static bool is_on_border(const std::vector<Hit>& hits) {
    const auto is_end = [](double x) { return x == 0 || x == 1; };
    return std::ranges::any_of(hits, [&](const Hit& hit) { return is_end(hit.patch_u) || is_end(hit.patch_v); });
  }
  static bool is_flagged(const std::vector<Hit>& hits) {
    return std::ranges::any_of(
        hits, [](const Hit& hit) { return hit.flags.edge || hit.flags.uncertified || hit.flags.incomplete; });
  }
  void check(const Ray& ray, bool is_odd, std::size_t) {
    const Hit nearest = scene_.closest(ray);
    if (is_odd && (nearest.kind != HitKind::hit || scene_.occluded(ray) != HitKind::hit)) ++tally_.leaks;
    const std::vector<Hit>& hits = all(ray);
    const bool is_on_edge =
        nearest.flags.edge || std::ranges::any_of(hits, [](const Hit& hit) { return hit.flags.edge; });
    const bool is_incomplete = std::ranges::any_of(hits, [](const Hit& hit) { return hit.flags.incomplete; });
    const bool is_wrong = (hits.size() % 2 == 1) != is_odd;
    if (is_on_edge) {
      ++tally_.seams;
      tally_.unmoved += is_incomplete;
      tally_.seam_odd += is_wrong && !is_incomplete;
    } else if (is_flagged(hits)) {
      ++tally_.unsure;
      tally_.unsure_odd += is_wrong;
    } else if (is_wrong) {
      ++(is_on_border(hits) ? tally_.border_odd : tally_.odd);
    }
  }

  const RayScene& scene_;
  EdgeTargets targets_;
  Box3 box_;
  double size_;
  Random random_;
  std::vector<Vec3> inside_;
  HitLists lists_;
  SolidTally tally_;
};

/// Whether each shell of a shape is closed, and each face in a shell.
inline bool is_closed(const Shape& shape) {
  const std::vector<bool> closed = value_of(closed_shells(shape));
  std::vector<bool> in_shell(shape.faces.size());
  for (const Shell& shell : shape.shells)
    for (const std::uint32_t face : shell.faces) in_shell[face] = true;
  return !closed.empty() && std::ranges::find(closed, false) == closed.end() &&
         std::ranges::find(in_shell, false) == in_shell.end();
}

}  // namespace tessera::test
