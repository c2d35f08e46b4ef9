// Grid mode: evaluated grids in a tree, then Newton's method.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "kernel/table/kernel_table.h"
#include "ray/border/adjacency.h"
#include "ray/facet/facet_source.h"
#include "ray/facet/packet_refine.h"
#include "ray/facet/refine.h"
#include "ray/leaf/patch_regions.h"
#include "ray/line/flush_denormals.h"
#include "ray/line/ray_segment.h"
#include "ray/scene/batch_layout.h"
#include "ray/scene/ray_scene_impl.h"
#include "ray/scene/surface_hit.h"
#include "ray/tree/ray_trees.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_rate = 4096;
// Products of three lengths must stay in float's range on a facet far smaller than the model, and on the whole model.
constexpr double smallest_grid = 1e-9, largest_grid = 1e12;
// Facets lie before or behind the surface, so rays are traced beyond their ends by this multiple of the bound on the
// distance. It is above 1 for rays that meet the surface at less than a right angle.
constexpr double margin_deviations = 4;
constexpr double reach_cells = 3;        // a facet of a regular grid lies within one cell of its root
constexpr double float_rounding = 1e-6;  // share of the size: positions, origins and directions in float

using Packet = std::array<FacetRay, FacetTree::packet>;
static_assert(rays_per_turn <= FacetTree::packet);

/// Returns whether rays start near each other and run nearly the same way, so that a packet pays.
bool coherent(std::span<const RaySegment> segments, double size) {
  const RaySegment& first = segments.front();
  for (const RaySegment& other : segments) {
    if (other.empty || dot(first.direction, other.direction) < 0.99 || max_abs(first.start - other.start) > 0.1 * size)
      return false;
  }
  return true;
}

class GridScene final : public PatchScene {
 public:
  GridScene(const PatchSet& set, std::unique_ptr<FacetSource> facets, std::unique_ptr<FacetTree> tree, bool refines,
            bool has_holes, Isa isa)
      : PatchScene(set),
        facets_(std::move(facets)),
        tree_(std::move(tree)),
        refines_(refines),
        has_holes_(has_holes),
        kernels_(ray_kernels(isa)) {}

  std::size_t memory_bytes() const override {
    return facets_->memory_bytes() + regions_.memory_bytes() + adjacency_.memory_bytes() + tree_->memory_bytes();
  }

 private:
  Status build(const Execution& execution) override;
  /// Trees of facets are not refitted.
  Status update(std::uint64_t, const Execution& execution) override { return build(execution); }
  double size() const override { return size_; }
  Box3 model_box() const override {
    const Box3 box = tree_->box();
    return {box.lower + set().origin(), box.upper + set().origin()};
  }
  bool can_filter() const override { return false; }
  void closest_piece(const RayBatch& batch, const HitWriter& hits, std::size_t begin, std::size_t end) const override;
  void occluded_piece(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t begin,
                      std::size_t end) const override;
  Status all_of(const Ray&, std::vector<Hit>&) const override {
    return Status(StatusCode::unsupported, "all() needs a scene in exact mode, this one is in grid mode");
  }

  void measure();
  void closest_packet(std::span<const Ray> rays, std::span<Hit> hits) const;
  void occluded_packet(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const;
  void trace(std::span<const RaySegment> segments, std::span<FacetHit> facets) const;
  Hit hit_of(const Ray& ray, const RaySegment& segment, FacetHit facet) const;
  bool refine(const RaySegment& segment, const FacetHit& facet, SurfaceRoot& root) const;
  bool is_cut_away(const SurfaceRoot& root) const;
  FacetHit facet_behind(const RaySegment& segment, const FacetHit& facet) const;
  bool meets_kept_facet(const RaySegment& segment) const;
  bool accept(const Ray& ray, const RaySegment& segment, const SurfaceRoot& root, bool refined, Hit& hit) const;

  FacetHit closest_facet(const FacetRay& ray) const { return located(tree_->closest(ray)); }
  FacetHit located(const FacetHit& hit) const { return hit.hit() ? facets_->located(hit) : hit; }

  std::unique_ptr<FacetSource> facets_;  // borrowed by tree_
  std::unique_ptr<FacetTree> tree_;
  bool refines_;
  bool has_holes_;  // the facets do: then all of them are kept
  PatchRegions regions_;
  const kernel::RayKernels& kernels_;
  Adjacency adjacency_;
  Box3 set_box_;  // in the model's coordinates
  Box3 box_;      // relative to the origin, a little larger than the set's
  double size_ = 0;
  double margin_ = 0;
  double reach_ = 0;  // distance of roots from their facets, in parameters
};

/// Measures the set for the rays: neighbours, box, and the facets' distance from the surface.
void GridScene::measure() {
  adjacency_ = Adjacency(set());
  const Vec3 origin = set().origin();
  box_ = {set_box_.lower - origin, set_box_.upper - origin};
  const double rounding = float_rounding * std::max(max_abs(box_.lower), max_abs(box_.upper));
  box_.lower += {-rounding, -rounding, -rounding};
  box_.upper += {rounding, rounding, rounding};
  margin_ = margin_deviations * facets_->deviation(set()) + rounding;
  reach_ = reach_cells * facets_->largest_cell();
}

Status GridScene::build(const Execution& execution) {
  set_box_ = set().box();
  size_ = set_box_.diagonal();
  const double reach = std::max(max_abs(set_box_.lower - set().origin()), max_abs(set_box_.upper - set().origin()));
  if (!(size_ >= smallest_grid && reach <= largest_grid)) {
    return Status(StatusCode::unsupported, "a ray scene holds models of a size from 1e-9 to 1e12: scale the model");
  }
  if (!has_holes_ && !regions_.any()) {
    if (Status status = regions_.build(set(), execution); !status.ok()) return status;
  }
  // Until the tree is complete nothing may trace in it, so a failure before that leaves the scene stale.
  if (Status status = facets_->build(set(), *tree_, execution); !status.ok()) return status;
  measure();
  return {};
}

void GridScene::closest_piece(const RayBatch& batch, const HitWriter& writer, std::size_t begin,
                              std::size_t end) const {
  TurnRoom<Ray> room;
  TurnRoom<Hit> hit_room;
  for_turns(batch, begin, end, [&](std::size_t first, std::size_t count) {
    const std::span<Hit> hits = writer.place(first, count, hit_room.span());
    closest_packet(batch.rays.read(first, count, room.span()), hits);
    writer.write(first, hits);
  });
}

/// Traces at most a packet of rays.
void GridScene::closest_packet(std::span<const Ray> rays, std::span<Hit> hits) const {
  std::array<RaySegment, FacetTree::packet> segments;
  std::array<FacetHit, FacetTree::packet> facets;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    hits[k] = {};
    if (is_valid(rays[k])) {
      segments[k] = cut(rays[k], set().origin(), box_, margin_);
    } else {
      hits[k].kind = HitKind::invalid_ray;
    }
  }
  trace(std::span(segments).first(rays.size()), facets);
  PacketRefiner refiner(set(), kernels_, reach_);
  if (refines_) refiner.run(std::span(segments).first(rays.size()), std::span(facets).first(rays.size()));
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (!facets[k].hit()) continue;
    if (refiner.has_root(k) && accept(rays[k], segments[k], refiner.root(k, segments[k], facets[k]), true, hits[k]))
      continue;
    hits[k] = hit_of(rays[k], segments[k], facets[k]);
  }
}

void GridScene::trace(std::span<const RaySegment> segments, std::span<FacetHit> facets) const {
  const FlushDenormals flush;
  if (segments.size() > 1 && coherent(segments, size_)) {
    Packet rays;
    for (std::size_t k = 0; k < segments.size(); ++k) rays[k] = segments[k].facet_ray();
    tree_->closest(std::span(rays).first(segments.size()), facets);
    for (FacetHit& facet : facets.first(segments.size())) facet = located(facet);
    return;
  }
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (!segments[k].empty) facets[k] = closest_facet(segments[k].facet_ray());
  }
}

/// Returns the first hit, from the first facet on, whose point of the surface lies in [tnear, tfar].
Hit GridScene::hit_of(const Ray& ray, const RaySegment& segment, FacetHit facet) const {
  for (Hit hit; facet.hit();) {
    SurfaceRoot root;
    const bool refined = refine(segment, facet, root);
    if (accept(ray, segment, root, refined, hit)) return hit;
    facet = facet_behind(segment, facet);
  }
  return {};
}

/// Returns the first facet behind another.
FacetHit GridScene::facet_behind(const RaySegment& segment, const FacetHit& facet) const {
  // Embree treats a denormal tnear as 0, and would find a facet at 0 again forever.
  const float next = std::nextafter(facet.t, std::numeric_limits<float>::max());
  const FacetRay behind = segment.facet_ray(std::max(next, std::numeric_limits<float>::min()));
  if (!(behind.tnear <= behind.tfar)) return {};
  const FlushDenormals flush;
  return closest_facet(behind);
}

/// Returns whether loops cut away a point of a patch.
bool GridScene::is_cut_away(const SurfaceRoot& root) const {
  return regions_.any() &&
         regions_.side_of(root.patch, set().source(root.patch).domain, root.u, root.v) == TrimSide::outside;
}

/// Moves a facet's hit to the surface. If that fails, `root` is the facet's own point.
bool GridScene::refine(const RaySegment& segment, const FacetHit& facet, SurfaceRoot& root) const {
  const Refiner refiner(set(), adjacency_, set_box_, reach_);
  if (refines_ && refiner.refine(segment, facet.grid, facet.u, facet.v, root)) return true;
  refiner.evaluate(segment, facet.grid, facet.u, facet.v, root);  // always defined on [0,1]^2
  root.s = facet.t;
  return false;
}

/// Returns false if t is not between the ray's ends, or if loops cut the point away.
bool GridScene::accept(const Ray& ray, const RaySegment& segment, const SurfaceRoot& root, bool refined,
                       Hit& hit) const {
  hit.t = segment.t_at(root.s);
  if (!std::isfinite(hit.t)) return false;
  if (!(hit.t >= ray.tnear && hit.t <= ray.tfar)) {
    // The segment's start, and with it the rounding of s, depends on tnear.
    const double rounding = segment.rounding() / segment.scale;
    if (!(hit.t >= ray.tnear - rounding && hit.t <= ray.tfar + rounding)) return false;
    hit.t = std::clamp(hit.t, ray.tnear, ray.tfar);
  }
  if (is_cut_away(root)) return false;

  hit.flags.unrefined = !refined;
  set_surface_point(set(), size_, 1, root.patch, root.u, root.v, {root.position, root.du, root.dv}, hit);
  hit.residual = root.residual;
  if (!refined) {
    hit.position = set().origin() + (segment.start + root.s * segment.direction);
    hit.residual = length(root.position - hit.position);
  }
  return true;
}

void GridScene::occluded_piece(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t begin,
                               std::size_t end) const {
  TurnRoom<Ray> room;
  std::array<std::uint8_t, rays_per_turn> found;
  for_turns(batch, begin, end, [&](std::size_t first, std::size_t count) {
    occluded_packet(batch.rays.read(first, count, room.span()), std::span(found).first(count));
    for (std::size_t k = 0; k < count; ++k) occluded.at(first + k, 0) = found[k];
  });
}

/// Tests at most a packet of rays. Facets decide, so the rays end at [tnear, tfar].
void GridScene::occluded_packet(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const {
  std::array<RaySegment, FacetTree::packet> segments;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (is_valid(rays[k])) segments[k] = cut(rays[k], set().origin(), box_, 0);
  }
  const std::span<const RaySegment> used = std::span(segments).first(rays.size());
  if (regions_.any()) {
    for (std::size_t k = 0; k < used.size(); ++k) occluded[k] = !used[k].empty && meets_kept_facet(used[k]);
    return;
  }
  const FlushDenormals flush;
  if (used.size() > 1 && coherent(used, size_)) {
    Packet packet;
    for (std::size_t k = 0; k < used.size(); ++k) packet[k] = used[k].facet_ray();
    tree_->occluded(std::span(packet).first(used.size()), occluded);
    return;
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    occluded[k] = !used[k].empty && tree_->occluded(used[k].facet_ray());
  }
}

/// Returns whether the ray meets a facet whose point of the surface loops keep.
bool GridScene::meets_kept_facet(const RaySegment& segment) const {
  const auto first = [&] {
    const FlushDenormals flush;
    return closest_facet(segment.facet_ray());
  };
  for (FacetHit facet = first(); facet.hit(); facet = facet_behind(segment, facet)) {
    SurfaceRoot root;
    refine(segment, facet, root);
    if (!is_cut_away(root)) return true;
  }
  return false;
}

/// `has_holes`: the facets have those of the loops.
Result<std::unique_ptr<RayScene::Impl>> scene_of(const PatchSet& set, std::unique_ptr<FacetSource> facets,
                                                 const RaySceneOptions& options, bool has_holes) {
  const Result<Isa> isa = usable_isa(options.isa);
  if (!isa) return isa.status();
  Result<std::unique_ptr<FacetTree>> tree = ray_trees().facets(*isa);
  if (!tree) return tree.status();
  return std::unique_ptr<RayScene::Impl>(
      std::make_unique<GridScene>(set, std::move(facets), *std::move(tree), options.refine, has_holes, *isa));
}

}  // namespace

Result<std::unique_ptr<RayScene::Impl>> make_grid_scene(const PatchSet& set, const RaySceneOptions& options) {
  if (options.rate < 1 || options.rate > max_rate) {
    return Status(StatusCode::invalid_argument, "the rate of a ray scene must lie between 1 and " +
                                                    std::to_string(max_rate) + ", not " + std::to_string(options.rate));
  }
  Result<std::unique_ptr<FacetSource>> facets = grid_facets(set, options.rate, options.isa);
  if (!facets) return facets.status();
  return scene_of(set, *std::move(facets), options, false);
}

Result<std::unique_ptr<RayScene::Impl>> make_mesh_scene(const PatchSet& set, const Mesh& mesh,
                                                        const RaySceneOptions& options) {
  return scene_of(set, mesh_facets(mesh), options, true);
}

}}  // namespace tessera::abi_0_1
