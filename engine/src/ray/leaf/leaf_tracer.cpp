#include "ray/leaf/leaf_tracer.h"

#include <algorithm>

#include "ray/border/spawn_root.h"
#include "ray/leaf/polished_root.h"
#include "ray/line/lane_vectors.h"
#include "ray/net/seen_point.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Padding of s in a kernel: twice the rounding of the ray's start and direction in float (box_padding.h).
constexpr double probe_pad = 4e-6;

float narrow(double x) { return static_cast<float>(x); }

void fetch(const void* from, std::size_t bytes) {
  for (std::size_t k = 0; k < bytes; k += 64) __builtin_prefetch(static_cast<const char*>(from) + k);
}

/// Prefetches the data that polish a root and make a hit, while the kernel works. The leaf gives the points' address,
/// since the patch is not loaded yet.
void fetch_patch(const SetView& set, const Leaf& leaf) {
  fetch(&set.patch(leaf.patch), sizeof(BezierPatch));
  fetch(&set.source(leaf.patch), sizeof(PatchSource));
  fetch(leaf.points, std::min<std::size_t>(static_cast<std::size_t>(leaf.size()), 16) * sizeof(Vec3));
}

/// Returns whether the root is surely between tnear and tfar.
bool lies_between(const kernel::RayRoot& root, const RayLine& line) {
  const double s = root.s, off = static_cast<double>(root.s_error) + line.slack;
  return s - off > line.near && s + off < line.far;
}

/// Returns whether the root is surely not the origin that the line leaves. decide_origin() says so, too, without
/// evaluating the patch, by the distance and the angle: a kernel proves no root at a sine below 1e-7, since float
/// rounds by more, and the offset is at most 1e-12.
bool is_far_from_origin(const kernel::RayRoot& root, const RayLine& line) {
  constexpr double far = 1e-2;
  if (!(line.spawn > 0)) return true;
  const double off = static_cast<double>(root.s_error) + line.slack;
  return line.spawn < 1e-12 && root.s - off > line.s_of_origin() + far;
}

/// Drops the root that is the point which the line leaves. That point is a root, so it lies where a kernel has proven
/// exactly one root, or it is none of those in that rectangle.
void drop_left_point(const Leaf& leaf, const LeftPoint& left, kernel::RayRoots& roots) {
  constexpr double rounding = 2.4e-7;  // of a place in float, in a piece
  const double u = (left.u - leaf.u0) / leaf.du - 0.5, v = (left.v - leaf.v0) / leaf.dv - 0.5;
  const auto is_left = [&](const kernel::RayRoot& root) {
    return std::abs(double{root.u} - u) <= double{root.radius_u} + rounding &&
           std::abs(double{root.v} - v) <= double{root.radius_v} + rounding;
  };
  roots.count = static_cast<int>(std::remove_if(roots.root, roots.root + roots.count, is_left) - roots.root);
}

kernel::RayRoot root_of(const kernel::RayPacket& rays, std::size_t lane) {
  return {rays.u[lane], rays.v[lane], rays.s[lane], rays.radius_u[lane], rays.radius_v[lane], rays.s_error[lane]};
}

/// Returns the far end of a kernel's ray.
float probe_far(const RayQuery& query) { return narrow(std::min(query.far, 8.0) + probe_pad); }

}  // namespace

kernel::RayProbe probe_of(const RayQuery& query) {
  const Vec3 &o = query.line.start, &d = query.line.direction;
  return {{narrow(o.x), narrow(o.y), narrow(o.z), 0},
          {narrow(d.x), narrow(d.y), narrow(d.z), 0},
          narrow(std::max(query.near, -8.0) - probe_pad),
          8,
          false};
}

void QueryPacket::set(std::size_t lane, RayQuery& query) {
  queries[lane] = &query;
  const kernel::RayProbe& probe = probes[lane] = probe_of(query);
  const RayLine& line = query.line;
  for (std::size_t i = 0; i < 3; ++i)
    rays.origin[i][lane] = probe.origin[i], rays.direction[i][lane] = probe.direction[i];
  rays.near[lane] = probe.near, rays.far[lane] = probe_far(query);
  put(line.start, polished.start, lane), put(line.direction, polished.direction, lane);
  put(line.across[0], polished.across[0], lane), put(line.across[1], polished.across[1], lane);
}

/// Sets a ray that ends before it begins: kernels look at it too, and decide it at once.
void QueryPacket::set_idle(std::size_t lane) {
  queries[lane] = nullptr;
  for (std::size_t i = 0; i < 3; ++i) rays.origin[i][lane] = rays.direction[i][lane] = 0;
  rays.near[lane] = 1, rays.far[lane] = 0;
}

double TracedLeaves::tolerance_of(const Leaf& leaf) const {
  return std::max(tolerance,
                  2 * search_rounding(leaf.degree_u, leaf.degree_v, leaf.halvings(), SearchSpace::max_depth));
}

void LeafTracer::search_tube(unsigned tube, RayQuery& query) const {
  if (tubes->patch(tube) < patches || query.wanted == RootsWanted::all) tubes->search(tube, query);
}

void LeafTracer::search(unsigned leaf_index, kernel::RayProbe& probe, RayQuery& query, SearchSpace& space) const {
  if (leaf_index >= first_tube) return search_tube(leaf_index - first_tube, query);
  fetch(&nets->local(leaf_index), kernel::ray_leaf_bytes(false));
  const Leaf& leaf = nets->leaves()[leaf_index];
  if (leaf.patch >= patches && query.wanted != RootsWanted::all) return;
  const PatchUse use = use_of(leaf_index);
  if (use == PatchUse::out) return;
  query.trims = use == PatchUse::cut ? trims : nullptr;
  probe.far = probe_far(query);
  ++query.steps;
  if (query.line.spawn > 0) query.origin = this;
  if (decide(leaf, leaf_index, probe, query)) return;
  if (query.line.spawn > 0) query.origin = this;
  if (!space.make_ready()) {
    query.overflow = query.incomplete = true;
    return;
  }
  nets->write_net(*set, leaf, space.leaf_net(), space.spare_net());
  search_leaf(leaf, space.leaf_net(), tolerance_of(leaf), space, query);
}

void LeafTracer::search(unsigned leaf_index, QueryPacket& packet, unsigned lanes, SearchSpace& space) const {
  // Packets never ask for all roots.
  const bool is_tube = leaf_index >= first_tube;
  if (!is_tube && nets->leaves()[leaf_index].patch >= patches) return;
  const bool together = !is_tube && kernels->packets != nullptr && use_of(leaf_index) != PatchUse::out;
  unsigned open = together ? decide(leaf_index, packet, lanes) : lanes;
  for (std::size_t lane = 0; open != 0; ++lane, open >>= 1) {
    if (open & 1u) search(leaf_index, packet.probes[lane], *packet.queries[lane], space);
  }
}

/// Returns the side of a root of a cut leaf, by what a kernel has proven of it. `border`: it lies near a loop.
TrimSide LeafTracer::side_of(const Leaf& leaf, const kernel::RayRoot& root) const {
  if (root.at_border) return TrimSide::border;
  const double u = 0.5 + double{root.u}, v = 0.5 + double{root.v};
  const double off_u = 2 * double{root.radius_u}, off_v = 2 * double{root.radius_v};
  const KeptSquares& squares = trims->squares(static_cast<std::size_t>(&leaf - nets->leaves().data()));
  const TrimSide side = squares.side_of({u - off_u, u + off_u, v - off_v, v + off_v});
  if (side != TrimSide::border) return side;
  const RootStart about = start_of(leaf, root);
  return trims->side_near(leaf.patch, about.u, about.v, about.reach_u, about.reach_v);
}

/// Decides a packet's rays together. Returns the lanes that remain undecided.
unsigned LeafTracer::decide(unsigned leaf_index, QueryPacket& packet, unsigned lanes) const {
  const Leaf& leaf = nets->leaves()[leaf_index];
  fetch_patch(*set, leaf);
  for (std::size_t lane = 0; lane < QueryPacket::size; ++lane) {
    if (lanes >> lane & 1u) packet.rays.far[lane] = probe_far(*packet.queries[lane]);
  }
  const bool is_cut = use_of(leaf_index) == PatchUse::cut;
  const kernel::RayPacketKernels& side_by_side = *kernels->packets;
  (leaf.rational ? side_by_side.trace_rational_leaf : side_by_side.trace_polynomial_leaf)(nets->local(leaf_index),
                                                                                          packet.rays, lanes);
  unsigned open = 0;
  PacketRoots roots;
  for (std::size_t lane = 0; lane < QueryPacket::size; ++lane) {
    if ((lanes >> lane & 1u) == 0 || packet.rays.state[lane] == kernel::RayPacket::nothing) continue;
    RayQuery& query = *packet.queries[lane];
    query.trims = nullptr;
    const auto root = [&] { return root_of(packet.rays, lane); };
    const bool has_root = packet.rays.state[lane] == kernel::RayPacket::root && is_far_from_origin(root(), query.line);
    const TrimSide side = has_root && is_cut ? side_of(leaf, root()) : TrimSide::inside;
    if (side == TrimSide::outside) continue;
    const bool any = query.wanted == RootsWanted::any && query.filter == nullptr;
    if (has_root && any && side == TrimSide::inside && lies_between(root(), query.line)) {
      query.found = true;
      ++query.steps;
    } else {
      (has_root && !any ? roots.lanes : open) |= 1u << lane;
      if (side == TrimSide::border) roots.near_loops |= 1u << lane;
    }
  }
  return roots.lanes == 0 ? open : open | take_roots(leaf, packet, roots);
}

/// Prepares a root near a loop: the query asks on which side of it the root lies. Returns false if rounding leaves that
/// undecided. Not inlined, so that other roots cost no more for it.
[[gnu::noinline]] bool LeafTracer::take_gain(RayQuery& query, LeafRoot& root) const {
  query.trims = trims;
  return set_gain(seen({root.position, root.du, root.dv}, query.line), 1, 1, root);
}

/// Takes the roots of these lanes. Returns the lanes that rounding leaves undecided.
unsigned LeafTracer::take_roots(const Leaf& leaf, QueryPacket& packet, const PacketRoots& roots) const {
  const BezierPatch& patch = set->patch(leaf.patch);
  if (!polished_side_by_side(patch)) return take_each_root(leaf, packet, roots);
  kernel::PolishedRays& rays = packet.polished;
  for (std::size_t lane = 0; lane < QueryPacket::size; ++lane) {
    if ((roots.lanes >> lane & 1u) == 0) continue;
    const RootStart start = start_of(leaf, root_of(packet.rays, lane));
    rays.u[lane] = start.u, rays.v[lane] = start.v;
    rays.reach_u[lane] = start.reach_u, rays.reach_v[lane] = start.reach_v;
  }
  polish_side_by_side(patch, nets->frame(), *kernels, start_of(leaf, {}), rays, roots.lanes);
  const double rounding = search_rounding(leaf.degree_u, leaf.degree_v, 0, 0);
  unsigned open = 0;
  for (std::size_t lane = 0; lane < QueryPacket::size; ++lane) {
    if ((roots.lanes >> lane & 1u) == 0) continue;
    LeafRoot root;
    root.patch = leaf.patch;
    root.u = rays.root_u[lane], root.v = rays.root_v[lane];
    root.position = get(rays.position, lane), root.du = get(rays.du, lane), root.dv = get(rays.dv, lane);
    root.has_point = true;
    root.s = rays.s[lane];
    root.residual = rounding;
    root.certified = true;
    RayQuery& query = *packet.queries[lane];
    if (rays.state[lane] != kernel::PolishedRays::found ||
        ((roots.near_loops >> lane & 1u) != 0 && !take_gain(query, root))) {
      open |= 1u << lane;
      continue;
    }
    ++query.steps;
    query.take(root);
  }
  return open;
}

/// Takes the roots one by one.
unsigned LeafTracer::take_each_root(const Leaf& leaf, QueryPacket& packet, const PacketRoots& roots) const {
  unsigned open = 0;
  for (std::size_t lane = 0; lane < QueryPacket::size; ++lane) {
    if ((roots.lanes >> lane & 1u) == 0) continue;
    RayQuery& query = *packet.queries[lane];
    LeafRoot root;
    root.patch = leaf.patch;
    const bool is_found = polish(set->patch(leaf.patch), nets->frame(), *kernels, query.line,
                                 start_of(leaf, root_of(packet.rays, lane)), false, root);
    if (!is_found || ((roots.near_loops >> lane & 1u) != 0 && !take_gain(query, root))) {
      open |= 1u << lane;
      continue;
    }
    ++query.steps;
    query.take(root);
  }
  return open;
}

OriginRoot LeafTracer::decide_root(const RayLine& line, const LeafRoot& root) const {
  return decide_origin(*set, borders->found(), nets->frame(), line, root);
}

bool LeafTracer::has(const LeftPoint& point) const {
  // Written so that NaN fails.
  return point.patch < set->patch_count() && point.u >= 0 && point.u <= 1 && point.v >= 0 && point.v <= 1;
}

Vec3 LeafTracer::at(const LeftPoint& point) const {
  const FirstOrder found = scene_point(set->patch(point.patch), nets->frame(), *kernels, point.u, point.v);
  return nets->frame().to_model(found.position);
}

/// Decides in float, if that proves which roots there are, and then finds these in double.
bool LeafTracer::decide(const Leaf& leaf, unsigned leaf_index, kernel::RayProbe& probe, RayQuery& query) const {
  const auto trace = leaf.rational ? kernels->trace_rational_leaf : kernels->trace_polynomial_leaf;
  const kernel::RayLeaf& local = nets->local(leaf_index);
  kernel::RayRoots roots;
  const bool has_left_point = query.left != nullptr && query.left->patch == leaf.patch;
  probe.any = query.wanted == RootsWanted::any && query.filter == nullptr && !has_left_point;
  if (!probe.any && !has_left_point) fetch_patch(*set, leaf);
  if (!trace(local, probe, roots)) return false;
  if (has_left_point) drop_left_point(leaf, *query.left, roots);
  if (roots.count == 0) return true;
  if (probe.any && !roots.root[0].at_border) {
    if (decide_any(leaf, roots.root[0], query)) return true;
    probe.any = false;
    if (!trace(local, probe, roots)) return false;
  }
  return take_roots(leaf, roots, query);
}

/// Takes the one root of a query for any, unless it is next to an end or the origin, or not surely kept: then all are
/// needed.
bool LeafTracer::decide_any(const Leaf& leaf, const kernel::RayRoot& root, RayQuery& query) const {
  query.found = lies_between(root, query.line) && is_far_from_origin(root, query.line) &&
                (query.trims == nullptr || side_of(leaf, root) == TrimSide::inside);
  return query.found;
}

/// Returns the test that a root needs, or null. Where all roots are wanted, all have the same, since they are compared
/// with each other.
const OriginTest* LeafTracer::origin_test(const kernel::RayRoot& root, const RayQuery& query) const {
  if (!(query.line.spawn > 0)) return nullptr;
  return query.wanted != RootsWanted::all && is_far_from_origin(root, query.line) ? nullptr : this;
}

/// Takes the roots of one ray. Returns false if rounding leaves something undecided.
bool LeafTracer::take_roots(const Leaf& leaf, const kernel::RayRoots& roots, RayQuery& query) const {
  LeafRoot taken[kernel::RayRoots::most];
  TrimSide sides[kernel::RayRoots::most];
  const OriginTest* tests[kernel::RayRoots::most];
  int count = 0;
  const RootSides* const loops = query.trims;
  for (int k = 0; k < roots.count; ++k) {
    const BezierPatch& patch = set->patch(leaf.patch);
    const RootStart start = start_of(leaf, roots.root[k]);
    LeafRoot& root = taken[count];
    const TrimSide side = sides[count] = loops == nullptr ? TrimSide::inside : side_of(leaf, roots.root[k]);
    if (side == TrimSide::outside) continue;
    root.patch = leaf.patch;
    query.origin = tests[count] = origin_test(roots.root[k], query);
    if (roots.root[k].at_border) {
      const BorderRoot what =
          polish_at_border(patch, nets->frame(), *kernels, query.line, start, tolerance_of(leaf), root);
      if (what == BorderRoot::open) return false;
      if (what == BorderRoot::beyond) continue;
    } else if (const bool with_gain = query.needs_gains() || side == TrimSide::border;
               !polish(patch, nets->frame(), *kernels, query.line, start, with_gain, root)) {
      return false;
    }
    ++count;
  }
  for (int k = 0; k < count; ++k) {
    query.trims = sides[k] == TrimSide::inside ? nullptr : loops;
    query.origin = tests[k];
    query.take(taken[k]);
  }
  return true;
}

}}  // namespace tessera::abi_0_1
