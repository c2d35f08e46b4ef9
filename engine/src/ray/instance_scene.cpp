// Scenes of instances: exact scenes that stand in several places, each met by the ray as taken back into its coordinates.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ray/embree_boxes.h"
#include "ray/embree_scene.h"
#include "ray/exact_source.h"
#include "ray/ray_scene_impl.h"
#include "ray/ray_segment.h"

namespace tessera {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double smallest_size = 1e-140, largest_size = 1e140;  // as of exact scenes

struct Instance {
  const RayScene::Impl* scene;
  const ExactSource* source;
  Affine to_world;
  Placement placement;  ///< of the scene's frame, as it was when this was built
};

std::string name_of(std::size_t instance) { return "instance " + std::to_string(instance) + ": "; }

/// Of the corners, with their rounding and that of the rays.
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

/// det(M) M^-T n: what r_u x r_v becomes.
Vec3 placed_normal(const Affine& map, const Vec3& n) {
  const auto& c = map.columns;
  const double scale = 1 / std::max({max_abs(c[0]), max_abs(c[1]), max_abs(c[2])});
  const Vec3 u = scale * c[0], v = scale * c[1], w = scale * c[2];  // products fit
  return normalized(n.x * cross(v, w) + n.y * cross(w, u) + n.z * cross(u, v));
}

class InstanceScene final : public RayScene::Impl {
 public:
  InstanceScene(std::vector<Instance> instances, EmbreeBoxes boxes)
      : instances_(std::move(instances)), boxes_(std::move(boxes)) {
    for (const Instance& instance : instances_) {
      if (std::find(scenes_.begin(), scenes_.end(), instance.scene) == scenes_.end()) scenes_.push_back(instance.scene);
    }
  }

  std::size_t memory_bytes() const override { return boxes_.memory_bytes() + instances_.capacity() * sizeof(Instance); }
  double spawn_offset() const override { return spawn_offset_; }
  Result<LocalGeometry> local_geometry(const Hit& hit) const override;

 private:
  /// Grows with each refit of one of the scenes; of no scene that is stale.
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
  void closest_piece(std::span<const Ray> rays, std::span<Hit> hits) const override {
    for (std::size_t k = 0; k < rays.size(); ++k) hits[k] = closest(rays[k]);
  }
  void occluded_piece(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const override {
    for (std::size_t k = 0; k < rays.size(); ++k) occluded[k] = is_occluded(rays[k]);
  }
  void prepare_borders() const override {
    for (const RayScene::Impl* scene : scenes_) scene->prepare_borders();
  }
  Status all_of(const Ray& ray, std::vector<Hit>& hits) const override;

  Hit closest(const Ray& ray) const;
  bool is_occluded(const Ray& ray) const;
  template <class Take>
  void meet(const Ray& ray, const RayLine& line, RootsWanted wanted, Take take) const;
  Hit placed_hit(const RayLine& line, unsigned instance, Hit hit) const;

  std::vector<Instance> instances_;
  std::vector<const RayScene::Impl*> scenes_;  // each once
  EmbreeBoxes boxes_;
  double spawn_offset_ = 0;  // the largest of any instance
  SceneFrame frame_;
  Box3 box_, scene_box_;  // of all instances, in the world's and this scene's coordinates
};

Status InstanceScene::build(const Execution& execution) {
  std::vector<Box3> boxes(instances_.size());
  box_ = {}, spawn_offset_ = 0;
  for (std::size_t k = 0; k < instances_.size(); ++k) {
    Instance& instance = instances_[k];
    if (!instance.scene->fresh())
      return Status(StatusCode::stale, name_of(k) + "the patch set of its scene was edited: refit that scene first",
                    static_cast<std::ptrdiff_t>(k));
    const auto placement = Placement::of(instance.to_world, instance.source->tracer().nets->frame());
    if (placement) {
      const double condition = instance.to_world.norm_bound() * placement->back.norm_bound();
      boxes[k] = placed_box(instance.to_world, condition, instance.scene->box());
    }
    if (!placement || !is_finite(boxes[k].lower) || !is_finite(boxes[k].upper))
      return Status(
          StatusCode::invalid_argument,
          name_of(k) + "the map is not finite, or so nearly singular that rays cannot be taken back through it",
          static_cast<std::ptrdiff_t>(k));
    instance.placement = *placement;
    box_.extend(boxes[k]);
    spawn_offset_ =
        std::max(spawn_offset_, instance.to_world.norm_bound() * instance.scene->spawn_offset() +
                                    8 * epsilon * std::max(max_abs(boxes[k].lower), max_abs(boxes[k].upper)));
  }
  if (!(box_.diagonal() >= smallest_size && box_.diagonal() <= largest_size))
    return Status(StatusCode::unsupported, "a scene of instances holds sizes from 1e-140 to 1e140");
  frame_ = SceneFrame::around(box_);
  for (Box3& box : boxes) box = {frame_.to_scene(box.lower), frame_.to_scene(box.upper)};
  scene_box_ = {frame_.to_scene(box_.lower), frame_.to_scene(box_.upper)};
  return boxes_.build(std::move(boxes), execution);
}

/// Runs a query against each instance that the line meets. take(instance, its query) returns up to which t others are
/// still of interest.
template <class Take>
void InstanceScene::meet(const Ray& ray, const RayLine& line, RootsWanted wanted, Take take) const {
  Ray within = ray;
  if (ray.spawn_offset > 0) prepare_borders();
  const FlushDenormals flush;
  boxes_.visit(line, [&](unsigned k) {
    const RayLine own = instances_[k].source->line(within, instances_[k].placement);
    if (!own.empty) {
      RayQuery query(within, own, wanted);
      instances_[k].source->trace(query);
      within.tfar = std::min(within.tfar, take(k, query));
    }
    if (within.tfar < within.tnear) return -infinity;
    return (within.tfar - line.base) * line.speed - line.shift + line.slack;
  });
}

/// Of the hit in the instance's scene.
Hit InstanceScene::placed_hit(const RayLine& line, unsigned instance, Hit hit) const {
  const Affine& map = instances_[instance].to_world;
  hit.instance = instance;
  hit.position = map.point(hit.position);
  hit.normal = placed_normal(map, hit.normal);
  hit.du = map.vector(hit.du), hit.dv = map.vector(hit.dv);
  const Vec3 from_start = frame_.to_scene(hit.position) - line.start;
  const double x = dot(line.across[0], from_start), y = dot(line.across[1], from_start);
  hit.residual = std::sqrt(x * x + y * y) / frame_.scale;
  return hit;
}

Result<LocalGeometry> InstanceScene::local_geometry(const Hit& hit) const {
  if (hit.instance >= instances_.size())
    return Status(StatusCode::invalid_argument, "there is no instance " + std::to_string(hit.instance) +
                                                    " in a scene of " + std::to_string(instances_.size()));
  const Instance& instance = instances_[hit.instance];
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

Hit InstanceScene::closest(const Ray& ray) const {
  Hit hit;
  if (!is_valid(ray)) {
    hit.kind = HitKind::invalid_ray;
    return hit;
  }
  const RayLine line = line_of(ray, frame_, scene_box_);
  if (line.empty) return hit;
  unsigned nearest = 0;
  std::uint32_t steps = 0;
  bool incomplete = false;
  meet(ray, line, RootsWanted::closest, [&](unsigned instance, const RayQuery& query) {
    incomplete |= query.incomplete, steps += query.steps;
    if (!query.found) return infinity;
    const Hit own = instances_[instance].source->hit_at(query.line, query.best);
    if (hit.kind == HitKind::hit && !(own.t < hit.t)) return infinity;
    hit = own, nearest = instance;
    return hit.t;
  });
  if (hit.kind == HitKind::hit) hit = placed_hit(line, nearest, hit);
  hit.flags.incomplete = incomplete, hit.steps = told(steps);
  return hit;
}

bool InstanceScene::is_occluded(const Ray& ray) const {
  if (!is_valid(ray)) return false;
  const RayLine line = line_of(ray, frame_, scene_box_);
  bool found = false;
  if (!line.empty) {
    meet(ray, line, RootsWanted::any, [&](unsigned, const RayQuery& query) {
      found |= query.found;
      return found ? -infinity : infinity;
    });
  }
  return found;
}

Status InstanceScene::all_of(const Ray& ray, std::vector<Hit>& hits) const {
  if (!is_valid(ray)) return {};
  const RayLine line = line_of(ray, frame_, scene_box_);
  if (line.empty) return {};
  bool overflow = false, incomplete = false;
  std::uint32_t steps = 0;
  std::vector<Hit> own;
  const auto first = static_cast<std::ptrdiff_t>(hits.size());
  meet(ray, line, RootsWanted::all, [&](unsigned instance, RayQuery& query) {
    overflow |= query.overflow, incomplete |= query.incomplete, steps += query.steps;
    try {
      own.clear();
      instances_[instance].source->hits_of(query, own);
      for (const Hit& hit : own) hits.push_back(placed_hit(line, instance, hit));
    } catch (...) {  // called from Embree, which knows no exceptions
      overflow = true;
    }
    return overflow ? -infinity : infinity;
  });
  if (overflow) return Status(StatusCode::out_of_memory, "out of memory");
  std::stable_sort(hits.begin() + first, hits.end(),
                   [](const Hit& a, const Hit& b) { return a.t != b.t ? a.t < b.t : a.instance < b.instance; });
  for (auto hit = hits.begin() + first; hit != hits.end(); ++hit)
    hit->flags.incomplete = incomplete, hit->steps = told(steps);
  return {};
}

}  // namespace

Result<std::unique_ptr<RayScene::Impl>> make_instance_scene(std::span<const RayInstance> instances) {
  if (instances.empty()) return Status(StatusCode::invalid_argument, "a scene of instances needs at least one");
  if (instances.size() >= Hit::no_instance)
    return Status(StatusCode::unsupported, "more than the 2^32 - 1 instances of one ray scene");
  std::vector<Instance> out;
  for (std::size_t k = 0; k < instances.size(); ++k) {
    const RayScene* const scene = instances[k].scene;
    if (scene == nullptr)
      return Status(StatusCode::invalid_argument, name_of(k) + "no scene", static_cast<std::ptrdiff_t>(k));
    if (scene->impl().exact_source() == nullptr)
      return Status(StatusCode::unsupported, name_of(k) + "its scene is none of patches in exact mode",
                    static_cast<std::ptrdiff_t>(k));
    out.push_back({&scene->impl(), scene->impl().exact_source(), instances[k].to_world, {}});
  }
  Result<EmbreeBoxes> boxes = EmbreeBoxes::make();
  if (!boxes) return boxes.status();
  return std::unique_ptr<RayScene::Impl>(std::make_unique<InstanceScene>(std::move(out), *std::move(boxes)));
}

}  // namespace tessera
