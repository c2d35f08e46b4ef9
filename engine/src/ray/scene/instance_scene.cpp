// Scenes of instances: exact scenes that stand in several places. A ray is mapped back into the coordinates of each.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <string>

#include "base/impl_access.h"
#include "ray/line/flush_denormals.h"
#include "ray/line/ray_lines.h"
#include "ray/line/ray_segment.h"
#include "ray/scene/batch_filter.h"
#include "ray/scene/batch_layout.h"
#include "ray/scene/coherent_lines.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/instance_lane.h"
#include "ray/scene/ray_scene_impl.h"
#include "ray/tree/ray_trees.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct PlacedScene {
  const RayScene::Impl* scene;
  const ExactSource* source;
  Affine to_world;
  std::uint32_t mask;
  Placement placement;  ///< of the scene's frame at the last build
};

std::string name_of(std::size_t instance) { return "instance " + std::to_string(instance) + ": "; }

/// Returns the box of the corners, with their rounding and that of the rays.
Box3 placed_box(const Affine& map, double condition, const Box3& box) {
  Box3 out;
  for (int corner = 0; corner < 8; ++corner) {
    out.extend(map.point({corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                          corner & 4 ? box.upper.z : box.lower.z}));
  }
  const double norm = map.norm_bound() * std::max(max_abs(box.lower), max_abs(box.upper)) + max_abs(map.translation);
  const double rounding = 16 * epsilon * condition * norm;
  return {out.lower - Vec3{rounding, rounding, rounding}, out.upper + Vec3{rounding, rounding, rounding}};
}

/// Returns the direction of det(M) M^-T n, which r_u x r_v becomes.
Vec3 placed_normal(const Affine& map, const Vec3& n) {
  const auto& c = map.columns;
  const double scale = 1 / std::max({max_abs(c[0]), max_abs(c[1]), max_abs(c[2])});
  const Vec3 u = scale * c[0], v = scale * c[1], w = scale * c[2];  // products fit
  return normalized(n.x * cross(v, w) + n.y * cross(w, u) + n.z * cross(u, v));
}

using Lane = InstanceLane;

class InstanceScene final : public RayScene::Impl {
 public:
  InstanceScene(std::vector<PlacedScene> instances, std::unique_ptr<InstanceTree> tree)
      : instances_(std::move(instances)), tree_(std::move(tree)) {
    for (const PlacedScene& instance : instances_) {
      if (std::find(scenes_.begin(), scenes_.end(), instance.scene) == scenes_.end()) scenes_.push_back(instance.scene);
    }
  }

  std::size_t memory_bytes() const override {
    return tree_->memory_bytes() + instances_.capacity() * sizeof(PlacedScene);
  }
  double spawn_offset() const override { return spawn_offset_; }
  Result<LocalGeometry> local_geometry(const Hit& hit) const override;

 private:
  /// Grows with each refit of a scene. While a scene is stale it is the largest value, which no build has.
  std::uint64_t source_revision() const override {
    std::uint64_t sum = 0;
    for (const RayScene::Impl* scene : scenes_) {
      if (!scene->fresh()) return std::numeric_limits<std::uint64_t>::max();
      sum += scene->revision();
    }
    return sum;
  }
  Status build(const Execution& execution) override;
  Status update(std::uint64_t, const Execution& execution) override { return build(execution); }
  Box3 model_box() const override { return box_; }
  void closest_piece(const RayBatch& batch, const HitWriter& hits, std::size_t begin, std::size_t end) const override;
  void occluded_piece(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t begin,
                      std::size_t end) const override;
  void prepare_borders() const override {
    for (const RayScene::Impl* scene : scenes_) scene->prepare_borders();
  }
  Status all_of(const Ray& ray, std::vector<Hit>& hits) const override;

  template <class LineOf, class Done>
  void trace(const RayBatch& batch, std::size_t first, std::span<const Ray> rays, const LineOf& line_at,
             std::span<Lane> lanes, RootsWanted wanted, const Done& done) const;
  template <class Done>
  void trace_all(const RayBatch& batch, std::size_t begin, std::size_t end, RootsWanted wanted, const Done& done) const;
  void meet(std::span<Lane* const> lanes, RootsWanted wanted, BatchFilter* filter) const;
  template <std::size_t Most>
  void meet_together(std::span<Lane* const> lanes, RootsWanted wanted, BatchFilter* filter) const;
  template <std::size_t Most, class Take>
  void meet_instance(unsigned instance, std::span<Lane* const> lanes, RootsWanted wanted, BatchFilter* filter,
                     const Take& take) const;
  void place(const RayLine& line, unsigned instance, HitParts parts, Hit& hit) const;

  std::vector<PlacedScene> instances_;
  std::vector<const RayScene::Impl*> scenes_;  // each once
  std::unique_ptr<InstanceTree> tree_;
  double spawn_offset_ = 0;  // the largest of any instance
  SceneFrame frame_;
  Box3 box_, scene_box_;  // of all instances, in the world's and this scene's coordinates
};

Status InstanceScene::build(const Execution& execution) {
  std::vector<Box3> boxes(instances_.size());
  box_ = {}, spawn_offset_ = 0;
  for (std::size_t k = 0; k < instances_.size(); ++k) {
    PlacedScene& instance = instances_[k];
    if (!instance.scene->fresh())
      return Status(StatusCode::stale, name_of(k) + "the patch set of its scene was edited: refit that scene first",
                    static_cast<std::ptrdiff_t>(k));
    const LeafTracer& tracer = instance.source->tracer();
    const auto placement = Placement::of(instance.to_world, tracer.nets->frame());
    if (placement) {
      const double condition = instance.to_world.norm_bound() * placement->growth;
      const double gap = tracer.tubes->largest_gap() / tracer.nets->frame().scale;
      const Box3 box = instance.scene->box();
      boxes[k] =
          placed_box(instance.to_world, condition, {box.lower - Vec3{gap, gap, gap}, box.upper + Vec3{gap, gap, gap}});
    }
    if (!placement || !is_finite(boxes[k].lower) || !is_finite(boxes[k].upper))
      return Status(is_finite(instance.to_world) ? StatusCode::invalid_argument : StatusCode::non_finite,
                    name_of(k) + "the map must be finite and not nearly singular", static_cast<std::ptrdiff_t>(k));
    instance.placement = *placement;
    box_.extend(boxes[k]);
    spawn_offset_ =
        std::max(spawn_offset_, instance.to_world.norm_bound() * instance.scene->spawn_offset() +
                                    8 * epsilon * std::max(max_abs(boxes[k].lower), max_abs(boxes[k].upper)));
  }
  if (!(box_.diagonal() >= smallest_exact && box_.diagonal() <= largest_exact))
    return Status(StatusCode::unsupported,
                  "a scene of instances is limited to sizes from 1e-140 to 1e140: scale the model");
  frame_ = SceneFrame::around(box_);
  for (Box3& box : boxes) box = {frame_.to_scene(box.lower), frame_.to_scene(box.upper)};
  scene_box_ = {frame_.to_scene(box_.lower), frame_.to_scene(box_.upper)};
  return tree_->build(std::move(boxes), execution);
}

/// Runs a query of each lane against an instance, and calls take(lane, query) after it.
template <std::size_t Most, class Take>
void InstanceScene::meet_instance(unsigned instance, std::span<Lane* const> lanes, RootsWanted wanted,
                                  BatchFilter* filter, const Take& take) const {
  const PlacedScene& of = instances_[instance];
  const SceneFilter own_filter(filter, *of.source->tracer().set, instance);
  TurnRoom<RayLine> room;
  const std::span<RayLine> lines = room.span();
  std::array<std::optional<RayQuery>, Most> queries;
  std::array<RayQuery*, Most> traced;
  std::size_t count = 0;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    if ((lanes[k]->mask & of.mask) == 0) continue;
    lines[k] = of.source->line(lanes[k]->ray, of.placement);
    if (lines[k].empty) continue;
    queries[k].emplace(lanes[k]->ray, lines[k], wanted);
    queries[k]->filter = own_filter.if_any(), queries[k]->index = lanes[k]->index;
    traced[count++] = &*queries[k];
  }
  if (count > 0) of.source->trace(std::span(traced).first(count));
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    if (queries[k]) take(*lanes[k], *queries[k]);
  }
}

/// Traces one lane, or several that are worth a packet.
template <std::size_t Most>
void InstanceScene::meet_together(std::span<Lane* const> lanes, RootsWanted wanted, BatchFilter* filter) const {
  std::array<const RayLine*, Most> lines;
  for (std::size_t k = 0; k < lanes.size(); ++k) lines[k] = lanes[k]->line;
  tree_->visit(std::span(lines).first(lanes.size()), [&](unsigned instance, unsigned met, auto& ends) {
    std::array<Lane*, Most> now;
    std::size_t count = 0;
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      if (met >> k & 1u) now[count++] = lanes[k];
    }
    meet_instance<Most>(instance, std::span(now).first(count), wanted, filter,
                        [&](Lane& lane, const RayQuery& query) { lane.take(query, instance); });
    for (std::size_t k = 0; k < lanes.size(); ++k) ends[k] = lanes[k]->end(wanted);
  });
}

void InstanceScene::meet(std::span<Lane* const> lanes, RootsWanted wanted, BatchFilter* filter) const {
  const FlushDenormals flush;
  if (worth_a_packet(lanes.size(), [&](std::size_t k) -> const RayLine& { return *lanes[k]->line; }))
    return meet_together<InstanceTree::packet>(lanes, wanted, filter);
  for (Lane* const& lane : lanes) meet_together<1>({&lane, 1}, wanted, filter);
}

/// Traces one turn. A ray that is invalid or misses the scene has an empty line. Calls done(first, lanes) at the end.
template <class LineOf, class Done>
void InstanceScene::trace(const RayBatch& batch, std::size_t first, std::span<const Ray> rays, const LineOf& line_at,
                          std::span<Lane> lanes, RootsWanted wanted, const Done& done) const {
  std::array<Lane*, rays_per_turn> used;
  std::size_t met = 0;
  bool leaves_surface = false;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    Lane& lane = lanes[k];
    lane.set(rays[k], line_at(k), first + k, batch.rays.mask(first + k));
    if (lane.line->empty) continue;
    used[met++] = &lane;
    leaves_surface |= rays[k].spawn_offset > 0;
  }
  if (leaves_surface) prepare_borders();
  meet(std::span(used).first(met), wanted, batch.filter);
  for (const Lane* lane : std::span(used).first(met))
    if (lane->overflow) throw std::bad_alloc();
  done(first, lanes.first(rays.size()));
}

template <class Done>
void InstanceScene::trace_all(const RayBatch& batch, std::size_t begin, std::size_t end, RootsWanted wanted,
                              const Done& done) const {
  TurnRoom<Ray> room;
  if (end - begin == 1) {
    const std::span<const Ray> ray = batch.rays.read(begin, 1, room.span());
    Lane lane;
    lane.valid = is_valid(ray[0]);
    const RayLine line = lane.valid ? line_of(ray[0], frame_, scene_box_) : RayLine{};
    trace(
        batch, begin, ray, [&](std::size_t) { return &line; }, {&lane, 1}, wanted, done);
    return;
  }
  RayTurn turn(frame_, scene_box_, *instances_[0].source->tracer().kernels);
  std::array<Lane, rays_per_turn> lanes;
  for_turns(batch, begin, end, [&](std::size_t first, std::size_t count) {
    const std::span<const Ray> rays = batch.rays.read(first, count, room.span());
    turn.set(rays);
    for (std::size_t k = 0; k < count; ++k) lanes[k].valid = turn.valid()[k];
    trace(
        batch, first, rays, [&](std::size_t k) { return &turn.line(k); }, lanes, wanted, done);
  });
}

/// Maps a hit from the coordinates of the instance's scene.
void InstanceScene::place(const RayLine& line, unsigned instance, HitParts parts, Hit& hit) const {
  const Affine& map = instances_[instance].to_world;
  hit.instance = instance;
  if (parts.normal) hit.normal = placed_normal(map, hit.normal);
  if (parts.derivatives) hit.du = map.vector(hit.du), hit.dv = map.vector(hit.dv);
  if (!parts.point) return;
  hit.position = map.point(hit.position);
  const Vec3 from_start = frame_.to_scene(hit.position) - line.start;
  const double x = dot(line.across[0], from_start), y = dot(line.across[1], from_start);
  hit.residual = std::sqrt(x * x + y * y) / frame_.scale;
}

Result<LocalGeometry> InstanceScene::local_geometry(const Hit& hit) const {
  if (hit.instance >= instances_.size())
    return Status(StatusCode::invalid_argument, "there is no instance " + std::to_string(hit.instance) +
                                                    " in a scene of " + std::to_string(instances_.size()));
  const PlacedScene& instance = instances_[hit.instance];
  Result<LocalGeometry> own = instance.scene->local_geometry(hit);
  if (!own) return own;
  SurfaceJet jet = evaluate_jet(instance.source->tracer().set->patch(hit.patch), hit.patch_u, hit.patch_v);
  for (Vec3* const derivative : {&jet.du, &jet.dv, &jet.duu, &jet.duv, &jet.dvv})
    *derivative = instance.to_world.vector(*derivative);
  jet.position = instance.to_world.point(jet.position);
  LocalGeometry placed = tessera::local_geometry(jet);
  if (!placed.defined) placed.normal = {placed_normal(instance.to_world, own->normal.direction), own->normal.kind};
  return placed;
}

void InstanceScene::closest_piece(const RayBatch& batch, const HitWriter& writer, std::size_t begin,
                                  std::size_t end) const {
  const HitParts parts = writer.parts();
  TurnRoom<Hit> room;
  trace_all(batch, begin, end, RootsWanted::closest, [&](std::size_t first, std::span<const Lane> lanes) {
    const std::span<Hit> hits = writer.place(first, lanes.size(), room.span());
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      const Lane& lane = lanes[k];
      Hit& hit = hits[k];
      if (lane.found) {
        instances_[lane.instance].source->set_hit(lane.own, lane.root, parts, hit);
        hit.t = lane.t;
        place(*lane.line, lane.instance, parts, hit);
      } else {
        hit = {};
        if (!lane.valid) hit.kind = HitKind::invalid_ray;
      }
      hit.flags.incomplete = lane.incomplete, hit.steps = saturated_u16(lane.steps);
    }
    writer.write(first, hits);
  });
}

void InstanceScene::occluded_piece(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t begin,
                                   std::size_t end) const {
  trace_all(batch, begin, end, RootsWanted::any, [&](std::size_t first, std::span<const Lane> lanes) {
    for (std::size_t k = 0; k < lanes.size(); ++k) occluded.at(first + k, 0) = lanes[k].found;
  });
}

Status InstanceScene::all_of(const Ray& ray, std::vector<Hit>& hits) const {
  if (!is_valid(ray)) return {};
  const RayLine line = line_of(ray, frame_, scene_box_);
  if (line.empty) return {};
  Lane lane;
  lane.set(ray, &line, 0, ~0u);
  if (ray.spawn_offset > 0) prepare_borders();
  std::vector<Hit> own;
  const auto first = static_cast<std::ptrdiff_t>(hits.size());
  const auto take = [&](unsigned instance, RayQuery& query) {
    try {
      own.clear();
      instances_[instance].source->hits_of(query, own);
      for (Hit& hit : own) {
        place(line, instance, {}, hit);
        hits.push_back(hit);
      }
    } catch (...) {  // called from within a tree, and Embree cannot handle exceptions
      lane.overflow = true;
    }
    lane.take(query, instance);
  };
  {
    const FlushDenormals flush;
    Lane* const lanes[] = {&lane};
    tree_->visit({&lane.line, 1}, [&](unsigned instance, unsigned, auto& ends) {
      meet_instance<1>(instance, lanes, RootsWanted::all, nullptr,
                       [&](Lane&, RayQuery& query) { take(instance, query); });
      ends[0] = lane.end(RootsWanted::all);
    });
  }
  if (lane.overflow) return Status(StatusCode::out_of_memory, "out of memory");
  std::stable_sort(hits.begin() + first, hits.end(),
                   [](const Hit& a, const Hit& b) { return a.t != b.t ? a.t < b.t : a.instance < b.instance; });
  for (auto hit = hits.begin() + first; hit != hits.end(); ++hit)
    hit->flags.incomplete = lane.incomplete, hit->steps = saturated_u16(lane.steps);
  return {};
}

}  // namespace

Result<std::unique_ptr<RayScene::Impl>> make_instance_scene(std::span<const RayInstance> instances) {
  if (instances.empty())
    return Status(StatusCode::invalid_argument, "the list of instances is empty: a scene needs at least 1");
  if (instances.size() >= Hit::no_instance)
    return Status(StatusCode::unsupported, "a ray scene holds at most " + std::to_string(Hit::no_instance - 1) +
                                               " instances, not " + std::to_string(instances.size()));
  std::vector<PlacedScene> out;
  for (std::size_t k = 0; k < instances.size(); ++k) {
    const RayScene* const scene = instances[k].scene;
    if (scene == nullptr)
      return Status(StatusCode::invalid_argument, name_of(k) + "its scene is a null pointer",
                    static_cast<std::ptrdiff_t>(k));
    if (impl_of(*scene).exact_source() == nullptr)
      return Status(StatusCode::unsupported,
                    name_of(k) + "its scene is in grid mode or holds instances; make a scene of patches in exact mode",
                    static_cast<std::ptrdiff_t>(k));
    out.push_back({&impl_of(*scene), impl_of(*scene).exact_source(), instances[k].to_world, instances[k].mask, {}});
  }
  Result<std::unique_ptr<InstanceTree>> tree = ray_trees().instances(*out[0].source->tracer().kernels);
  if (!tree) return tree.status();
  return std::unique_ptr<RayScene::Impl>(std::make_unique<InstanceScene>(std::move(out), *std::move(tree)));
}

}}  // namespace tessera::abi_0_1
