#include "tessera/ray_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "base/aligned.h"
#include "base/guard.h"
#include "eval/uniform_grid.h"
#include "parallel/parallel_for.h"
#include "ray/adjacency.h"
#include "ray/embree_scene.h"
#include "ray/facet_deviation.h"
#include "ray/ray_segment.h"
#include "ray/refine.h"
#include "ray/set_view.h"

namespace tessera {
namespace {

constexpr int max_rate = 4096;
constexpr std::size_t rays_a_task = 512;
constexpr std::size_t padding = 1;  // floats behind the last vertex, which Embree reads as 16 bytes
// Products of three lengths must stay in float's range on a facet far smaller than the model, and on the whole model.
constexpr double smallest_size = 1e-9, largest_size = 1e12;
// Facets lie before or behind the surface: so far are rays traced beyond their ends, in units of the bound on the
// distance, for rays that meet the surface at less than a right angle.
constexpr double margin_deviations = 4;
constexpr double float_rounding = 1e-6;  // of the size: positions, origins and directions in float

using Packet = std::array<FacetRay, EmbreeScene::packet>;

/// Rays that start near each other and run nearly the same way are worth a packet.
bool coherent(std::span<const RaySegment> segments, double size) {
  const RaySegment& first = segments.front();
  for (const RaySegment& other : segments) {
    if (other.empty || dot(first.direction, other.direction) < 0.99 || max_abs(first.start - other.start) > 0.1 * size)
      return false;
  }
  return true;
}

Status stale() {
  return Status(StatusCode::stale, "the patch set was edited after this ray scene was made: call refit");
}

Status short_output(std::size_t rays, std::size_t room) {
  return Status(StatusCode::buffer_too_small,
                std::to_string(rays) + " rays, but room for " + std::to_string(room) + " results");
}

}  // namespace

class RayScene::Impl {
 public:
  Impl(const PatchSet& set, UniformGrid grid, EmbreeScene scene, const RaySceneOptions& options)
      : set_(set), grid_(std::move(grid)), scene_(std::move(scene)), options_(options) {}

  Status build(const Execution& execution);
  bool fresh() const { return ready_ && revision_ == set_.revision(); }
  Status closest(std::span<const Ray> rays, std::span<Hit> hits, const Execution& execution) const;
  Status occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded, const Execution& execution) const;
  std::uint64_t revision() const { return revision_; }
  Box3 box() const {
    const Box3 box = scene_.box();
    if (!fresh() || box.empty()) return {};
    return {box.lower + set_.origin(), box.upper + set_.origin()};
  }
  std::size_t memory_bytes() const {
    return positions_.capacity() * sizeof(float) + adjacency_.memory_bytes() + scene_.memory_bytes();
  }

 private:
  Status evaluate_grids(const Execution& execution);
  void measure();
  void closest_piece(std::span<const Ray> rays, std::span<Hit> hits) const;
  void occluded_piece(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const;
  void trace(std::span<const RaySegment> segments, std::span<FacetHit> facets) const;
  Hit resolve(const Ray& ray, const RaySegment& segment, FacetHit facet) const;
  bool accept(const Ray& ray, const RaySegment& segment, const FacetHit& facet, Hit& hit) const;
  void set_normal(const SurfaceRoot& root, Hit& hit) const;

  SetView set_;
  UniformGrid grid_;
  EmbreeScene scene_;
  RaySceneOptions options_;
  AlignedVector<float> positions_;  // `[patch][iu][iv]`, borrowed by scene_
  Adjacency adjacency_;
  Box3 set_box_;         // in the model's coordinates
  Box3 box_;  // relative to the origin, a little larger than the set's
  double size_ = 0;
  double margin_ = 0;
  std::uint64_t revision_ = 0;
  bool ready_ = false;  // false after a build that failed
};

Status RayScene::Impl::evaluate_grids(const Execution& execution) {
  positions_.resize(3 * grid_.capacity() + padding);
  const auto vertices = View3<float>::interleaved(std::span(positions_).first(3 * grid_.capacity()));
  return grid_.run(set_.impl(), GridViews<float>{.position = vertices, .du = {}, .dv = {}, .normal = {}}, execution);
}

/// What the rays need to know of the set: neighbours, box, and how far facets lie from the surface.
void RayScene::Impl::measure() {
  adjacency_ = Adjacency(set_);
  double deviation = 0;
  for (std::size_t k = 0; k < set_.patch_count(); ++k) {
    deviation = std::max(deviation, facet_deviation(set_.patch(k), options_.rate, options_.rate));
  }
  const Vec3 origin = set_.origin();
  box_ = {set_box_.lower - origin, set_box_.upper - origin};
  const double rounding = float_rounding * std::max(max_abs(box_.lower), max_abs(box_.upper));
  box_.lower += {-rounding, -rounding, -rounding};
  box_.upper += {rounding, rounding, rounding};
  margin_ = margin_deviations * deviation + rounding;
}

Status RayScene::Impl::build(const Execution& execution) {
  ready_ = false;
  set_box_ = set_.box();
  size_ = set_box_.diagonal();
  const double reach = std::max(max_abs(set_box_.lower - set_.origin()), max_abs(set_box_.upper - set_.origin()));
  if (!(size_ >= smallest_size && reach <= largest_size)) {
    return Status(StatusCode::unsupported, "a ray scene holds models of a size from 1e-9 to 1e12: scale the model");
  }
  GridVertices vertices{nullptr, set_.patch_count(), options_.rate + 1, options_.rate + 1};
  if (Status status = EmbreeScene::check_size(vertices); !status.ok()) return status;
  // Until the BVH stands again nothing may trace in it, so a failure on the way leaves the scene stale.
  if (Status status = evaluate_grids(execution); !status.ok()) return status;
  measure();
  vertices.data = positions_.data();
  if (Status status = scene_.build(vertices, execution); !status.ok()) return status;
  revision_ = set_.revision();
  ready_ = true;
  return {};
}

Status RayScene::Impl::closest(std::span<const Ray> rays, std::span<Hit> hits, const Execution& execution) const {
  if (hits.size() < rays.size()) return short_output(rays.size(), hits.size());
  if (!fresh()) return stale();
  return parallel_for(rays.size(), rays_a_task, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; k += EmbreeScene::packet) {
      const std::size_t count = std::min(EmbreeScene::packet, end - k);
      closest_piece(rays.subspan(k, count), hits.subspan(k, count));
    }
  });
}

/// At most a packet of rays.
void RayScene::Impl::closest_piece(std::span<const Ray> rays, std::span<Hit> hits) const {
  std::array<RaySegment, EmbreeScene::packet> segments;
  std::array<FacetHit, EmbreeScene::packet> facets;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    hits[k] = {};
    if (is_valid(rays[k])) {
      segments[k] = cut(rays[k], set_.origin(), box_, margin_);
    } else {
      hits[k].kind = HitKind::invalid_ray;
    }
  }
  trace(std::span(segments).first(rays.size()), facets);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (facets[k].hit()) hits[k] = resolve(rays[k], segments[k], facets[k]);
  }
}

void RayScene::Impl::trace(std::span<const RaySegment> segments, std::span<FacetHit> facets) const {
  const FlushDenormals flush;
  if (segments.size() > 1 && coherent(segments, size_)) {
    Packet rays;
    for (std::size_t k = 0; k < segments.size(); ++k) rays[k] = segments[k].facet_ray();
    scene_.closest(std::span(rays).first(segments.size()), facets);
    return;
  }
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (!segments[k].empty) facets[k] = scene_.closest(segments[k].facet_ray());
  }
}

/// From the first facet on, the first one whose point of the surface lies in [tnear, tfar].
Hit RayScene::Impl::resolve(const Ray& ray, const RaySegment& segment, FacetHit facet) const {
  for (Hit hit; facet.hit();) {
    if (accept(ray, segment, facet, hit)) return hit;
    // Embree takes a denormal tnear for 0, and would find a facet at 0 again without end.
    const float next = std::nextafter(facet.t, std::numeric_limits<float>::max());
    const FacetRay behind = segment.facet_ray(std::max(next, std::numeric_limits<float>::min()));
    if (!(behind.tnear <= behind.tfar)) break;
    const FlushDenormals flush;
    facet = scene_.closest(behind);
  }
  return {};
}

bool RayScene::Impl::accept(const Ray& ray, const RaySegment& segment, const FacetHit& facet, Hit& hit) const {
  const Refiner refiner(set_, adjacency_, set_box_, options_.rate);
  const double facet_u = std::clamp(facet.u, 0.0f, 1.0f), facet_v = std::clamp(facet.v, 0.0f, 1.0f);
  SurfaceRoot root;
  const bool refined = options_.refine && refiner.refine(segment, facet.grid, facet_u, facet_v, root);
  if (!refined) {
    refiner.evaluate(segment, facet.grid, facet_u, facet_v, root);  // on [0,1]^2 this is always defined
    root.s = facet.t;
  }
  hit.t = segment.t_at(root.s);
  if (!(hit.t >= ray.tnear && hit.t <= ray.tfar) || !std::isfinite(hit.t)) return false;

  hit.kind = HitKind::hit;
  hit.flags.unrefined = !refined;
  hit.patch = root.patch;
  const PatchSource& source = set_.source(root.patch);
  hit.surface = source.surface;
  hit.patch_u = root.u, hit.patch_v = root.v;
  hit.u = source.domain.u_at(root.u), hit.v = source.domain.v_at(root.v);
  hit.position = root.position;
  hit.residual = root.residual;
  if (!refined) {
    hit.position = set_.origin() + (segment.start + root.s * segment.direction);
    hit.residual = length(root.position - hit.position);
  }
  set_normal(root, hit);
  return true;
}

/// unit_normal's answer, taken from the derivatives at hand where they are clearly regular.
void RayScene::Impl::set_normal(const SurfaceRoot& root, Hit& hit) const {
  constexpr double clearly = 1e-6;
  const Vec3 normal = cross(root.du, root.dv);
  const double du = length(root.du), dv = length(root.dv), area = length(normal);
  if (std::min(du, dv) > clearly * size_ && area > clearly * du * dv) {
    hit.normal = (1 / area) * normal;
    return;
  }
  const UnitNormal limit = unit_normal(set_.patch(root.patch), root.u, root.v);
  hit.normal = limit.direction;
  hit.flags.degenerate_normal = limit.kind != NormalKind::regular;
}

Status RayScene::Impl::occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                                const Execution& execution) const {
  if (occluded.size() < rays.size()) return short_output(rays.size(), occluded.size());
  if (!fresh()) return stale();
  return parallel_for(rays.size(), rays_a_task, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; k += EmbreeScene::packet) {
      const std::size_t count = std::min(EmbreeScene::packet, end - k);
      occluded_piece(rays.subspan(k, count), occluded.subspan(k, count));
    }
  });
}

/// At most a packet of rays. Facets decide, so the rays end where they say.
void RayScene::Impl::occluded_piece(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const {
  std::array<RaySegment, EmbreeScene::packet> segments;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (is_valid(rays[k])) segments[k] = cut(rays[k], set_.origin(), box_, 0);
  }
  const std::span<const RaySegment> used = std::span(segments).first(rays.size());
  const FlushDenormals flush;
  if (used.size() > 1 && coherent(used, size_)) {
    Packet packet;
    for (std::size_t k = 0; k < used.size(); ++k) packet[k] = used[k].facet_ray();
    scene_.occluded(std::span(packet).first(used.size()), occluded);
    return;
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    occluded[k] = !used[k].empty && scene_.occluded(used[k].facet_ray());
  }
}

RayScene::RayScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

Result<RayScene> RayScene::make(const PatchSet& set, const RaySceneOptions& options, const Execution& execution) {
  return guarded([&]() -> Result<RayScene> {
    if (options.mode != RayMode::grid) return Status(StatusCode::unsupported, "no such ray mode");
    if (options.rate < 1 || options.rate > max_rate) {
      return Status(StatusCode::invalid_argument, "the rate of a ray scene must lie between 1 and " +
                                                      std::to_string(max_rate) + ", not " +
                                                      std::to_string(options.rate));
    }
    Result<UniformGrid> grid = UniformGrid::make(set, options.rate, options.rate, options.isa);
    if (!grid) return grid.status();
    Result<EmbreeScene> scene = EmbreeScene::make();
    if (!scene) return scene.status();
    auto impl = std::make_unique<Impl>(set, *std::move(grid), *std::move(scene), options);
    if (Status status = impl->build(execution); !status.ok()) return status;
    return RayScene(std::move(impl));
  });
}

Status RayScene::closest(std::span<const Ray> rays, std::span<Hit> hits, const Execution& execution) const {
  return guarded([&] { return impl_->closest(rays, hits, execution); });
}

Status RayScene::occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                          const Execution& execution) const {
  return guarded([&] { return impl_->occluded(rays, occluded, execution); });
}

Hit RayScene::closest(const Ray& ray) const {
  Hit hit;
  if (!closest({&ray, 1}, {&hit, 1}).ok()) hit.kind = HitKind::invalid_ray;
  return hit;
}

bool RayScene::occluded(const Ray& ray) const {
  std::uint8_t result = 0;
  return occluded({&ray, 1}, {&result, 1}).ok() && result != 0;
}

Status RayScene::refit(const Execution& execution) {
  return guarded([&] { return impl_->build(execution); });
}

std::uint64_t RayScene::revision() const { return impl_->revision(); }
Box3 RayScene::box() const { return impl_->box(); }
std::size_t RayScene::memory_bytes() const { return impl_->memory_bytes(); }

}  // namespace tessera
