#include "ray/leaf_tracer.h"

#include <xmmintrin.h>

#include <algorithm>

#include "ray/polished_root.h"
#include "ray/spawn_root.h"

namespace tessera {
namespace {

// Of s in a kernel: what the ray's start and direction round by in float (embree_ray.h), and as much again.
constexpr double probe_pad = 4e-6;

float narrow(double x) { return static_cast<float>(x); }

/// What a root is polished with, while the kernel works.
void fetch(const BezierPatch& patch) {
  constexpr std::ptrdiff_t points_a_line = 64 / static_cast<std::ptrdiff_t>(sizeof(Vec3));
  const std::span<const Vec3> points = patch.points();
  const Vec3* const end = points.data() + std::min<std::size_t>(points.size(), 16);
  for (const Vec3* point = points.data(); point < end; point += points_a_line)
    _mm_prefetch(reinterpret_cast<const char*>(point), _MM_HINT_T0);
}

/// Whether tnear and tfar are no question.
bool lies_between(const kernel::RayRoot& root, const RayLine& line) {
  const double s = root.s, off = static_cast<double>(root.s_error) + line.slack;
  return s - off > line.near && s + off < line.far;
}

}  // namespace

kernel::RayProbe probe_of(const RayQuery& query) {
  const Vec3 &o = query.line.start, &d = query.line.direction;
  return {{narrow(o.x), narrow(o.y), narrow(o.z), 0},
          {narrow(d.x), narrow(d.y), narrow(d.z), 0},
          narrow(std::max(query.near, -8.0) - probe_pad),
          8,
          false};
}

float probe_far(const RayQuery& query) { return narrow(std::min(query.far, 8.0) + probe_pad); }

void LeafTracer::search(unsigned leaf_index, kernel::RayProbe& probe, RayQuery& query, SearchSpace& space) const {
  const Leaf& leaf = nets->leaves()[leaf_index];
  probe.far = probe_far(query);
  ++query.steps;
  if (query.line.spawn > 0) query.origin = this;
  if (decide(leaf, leaf_index, probe, query)) return;
  if (!space.make_ready()) {
    query.overflow = query.incomplete = true;
    return;
  }
  nets->write_net(*set, leaf, space.leaf_net(), space.spare_net());
  search_leaf(leaf, space.leaf_net(), tolerance, space, query);
}

OriginRoot LeafTracer::judge(const RayLine& line, const LeafRoot& root) const {
  return judge_origin(set->patch(root.patch), nets->frame(), line, root);
}

/// In float, where that proves what there is; then in double what was found.
bool LeafTracer::decide(const Leaf& leaf, unsigned leaf_index, kernel::RayProbe& probe, RayQuery& query) const {
  const auto trace = leaf.rational ? kernels->trace_rational_leaf : kernels->trace_polynomial_leaf;
  const kernel::RayLeaf& local = nets->local(leaf_index);
  kernel::RayRoots roots;
  probe.any = query.wanted == RootsWanted::any && query.origin == nullptr;
  if (!probe.any) fetch(set->patch(leaf.patch));
  if (!trace(local, probe, roots)) return false;
  if (roots.count == 0) return true;
  if (probe.any) {
    query.found = lies_between(roots.root[0], query.line);
    if (query.found) return true;
    probe.any = false;  // that one is next to an end: all must be looked at
    if (!trace(local, probe, roots)) return false;
  }
  const auto polished = [&](int k, LeafRoot& root) {
    return polish(set->patch(leaf.patch), nets->frame(), leaf, *kernels, query.line, roots.root[k],
                  query.wanted == RootsWanted::all, root);
  };
  LeafRoot first;
  if (!polished(0, first)) return false;
  if (roots.count > 1) {
    LeafRoot others[kernel::RayRoots::most - 1];
    for (int k = 1; k < roots.count; ++k) {
      if (!polished(k, others[k - 1])) return false;
    }
    for (int k = 1; k < roots.count; ++k) query.take(others[k - 1]);
  }
  query.take(first);
  return true;
}

}  // namespace tessera
