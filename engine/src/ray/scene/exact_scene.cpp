// Exact mode: pieces of patches in a tree, each searched for all its roots.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "base/text.h"
#include "kernel/table/kernel_table.h"
#include "ray/border/distinct_roots.h"
#include "ray/border/fold_roots.h"
#include "ray/border/lazy_adjacency.h"
#include "ray/border/nearest_root.h"
#include "ray/leaf/leaf_nets.h"
#include "ray/leaf/leaf_search.h"
#include "ray/line/flush_denormals.h"
#include "ray/line/line_aside.h"
#include "ray/line/ray_lines.h"
#include "ray/scene/batch_filter.h"
#include "ray/scene/batch_layout.h"
#include "ray/scene/coherent_lines.h"
#include "ray/scene/exact_options.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/ray_scene_impl.h"
#include "ray/scene/surface_hit.h"
#include "ray/tree/ray_trees.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double default_tolerance = 2e-12;  // share of the size
constexpr std::size_t max_leaves = 0xffffffff;
constexpr double max_bend = 1;     // share of a piece's length
constexpr double max_reach = 0.5;  // of tubes beyond the box of pieces, in the scene's coordinates: see box_padding.h
const double least_tolerance = 2 * search_rounding(max_degree, max_degree, Leaf::max_halvings, SearchSpace::max_depth);
constexpr std::size_t min_in_turn = 4;
static_assert(rays_per_turn == RayTurn::size && rays_per_turn <= LeafTree::packet);

/// The rays of one turn after tracing. A ray that is invalid or misses the scene has no query.
struct TracedTurn {
  std::size_t first;
  std::span<const bool> valid;
  std::span<const std::optional<RayQuery>> queries;
};

class ExactScene final : public PatchScene, private ExactSource {
 public:
  ExactScene(const PatchSet& set, std::unique_ptr<LeafTree> tree, const RaySceneOptions& options)
      : PatchScene(set), tree_(std::move(tree)), options_(options), follows_(options.editable) {}

  std::size_t memory_bytes() const override {
    return nets_.memory_bytes() + trims_.memory_bytes() + tubes_.memory_bytes() + adjacency_.memory_bytes() +
           tree_->memory_bytes();
  }

  const ExactSource* exact_source() const override { return this; }
  std::vector<double> edge_gaps() const override { return tubes_.gaps(); }

 private:
  bool fresh() const override { return Impl::fresh(); }
  const LeafTracer& tracer() const override { return tree_->tracer(); }
  Box3 reach() const override { return {frame_.to_model(scene_box_.lower), frame_.to_model(scene_box_.upper)}; }
  RayLine line(const Ray& ray) const override { return line_of(ray, frame_, scene_box_); }
  RayLine line(const Ray& ray, const Placement& placement) const override {
    return line_of(ray, placement, frame_, scene_box_);
  }
  double offset() const override { return spawn_offset(); }
  void trace(RayQuery& query) const override;
  void trace(std::span<RayQuery* const> queries) const override;
  void set_hit(const RayLine& line, const LeafRoot& root, HitParts parts, Hit& hit) const override;
  void hits_of(RayQuery& query, std::vector<Hit>& hits) const override;

  Status build(const Execution& execution) override;
  Status update(std::uint64_t since, const Execution& execution) override;
  Box3 model_box() const override { return box_; }
  void closest_piece(const RayBatch& batch, const HitWriter& hits, std::size_t begin, std::size_t end) const override;
  void occluded_piece(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t begin,
                      std::size_t end) const override;
  void prepare_borders() const override { (void)adjacency_.of(set()); }
  Status all_of(const Ray& ray, std::vector<Hit>& hits) const override;
  double size() const override { return size_; }
  Result<Hit> resolve(const Ray& ray, std::uint32_t patch, double u, double v) const override;
  using PatchScene::resolve;
  std::size_t own_patches() const { return options_.patches.value_or(set().patch_count()); }
  double tolerance() const { return options_.tolerance.value_or(default_tolerance * size_) * frame_.scale; }
  /// Returns the radius of tubes around edges whose faces meet: roots beside them are right up to the tolerance.
  double tube_radius() const { return 4 * std::max(tolerance(), least_tolerance); }
  void measure();
  void trace_alone(RayQuery& query) const;
  void complete_roots(RayQuery& query) const;
  void append_hits(const RayQuery& query, const RootsAside& found, std::vector<Hit>& hits) const;
  template <class Done>
  void trace_all(const RayBatch& batch, std::size_t begin, std::size_t end, RootsWanted wanted, const Done& done) const;
  template <class Done>
  void trace_each(const RayBatch& batch, std::size_t begin, std::size_t end, RootsWanted wanted, SearchSpace& space,
                  const Done& done) const;
  template <class Done>
  void trace_turns(const RayBatch& batch, std::size_t begin, std::size_t end, RootsWanted wanted, SearchSpace& space,
                   const Done& done) const;
  void trace_queries(std::span<RayQuery* const> queries, SearchSpace& space) const;
  void trace_turn(std::span<std::optional<RayQuery>> queries, SearchSpace& space) const;

  LeafNets nets_;  // borrowed by tree_, like the borders
  LazyAdjacency adjacency_;
  LeafTrims trims_;
  EdgeTubes tubes_;
  std::unique_ptr<LeafTree> tree_;
  RaySceneOptions options_;
  mutable SearchPool pool_;
  SceneFrame frame_;
  Box3 box_;        // of the leaves' control points, in the model's coordinates
  Box3 scene_box_;  // of all possible hits, in the scene's
  double size_ = 0;
  bool follows_;     // the tree can be updated
  int updates_ = 0;  // since the last build
};

void ExactScene::measure() {
  scene_box_ = {};
  const std::span<const Box3> boxes = nets_.boxes();
  for (std::size_t leaf = 0; leaf < boxes.size(); ++leaf)
    if (!trims_.any() || trims_.use(leaf) != PatchUse::out) scene_box_.extend(boxes[leaf]);
  box_ = {frame_.to_model(scene_box_.lower), frame_.to_model(scene_box_.upper)};
  const double reach = std::max({tolerance(), least_tolerance, std::min(tubes_.largest_gap(), max_reach)});
  scene_box_.lower += Vec3{-reach, -reach, -reach}, scene_box_.upper += Vec3{reach, reach, reach};
}

Status ExactScene::build(const Execution& execution) {
  const Result<Box3> box = frame_box(options_, set().box());
  if (!box) return box.status();
  if (own_patches() > set().patch_count())
    return Status(StatusCode::invalid_argument, "the ray scene takes " + counted(own_patches(), "patch", "patches") +
                                                    ", the set has " + std::to_string(set().patch_count()));
  size_ = box->diagonal();
  if (!(size_ >= smallest_exact && size_ <= largest_exact))
    return Status(StatusCode::unsupported,
                  "an exact ray scene holds models of a size from 1e-140 to 1e140: scale the model");
  frame_ = SceneFrame::around(*box);
  updates_ = 0;
  adjacency_.forget();
  const Flatness flatness{std::ilogb(static_cast<double>(options_.pieces)), max_bend};
  if (Status status = nets_.plan(set(), frame_, flatness, execution); !status.ok()) return status;
  if (Status status = trims_.build(set(), nets_.planned(), execution); !status.ok()) return status;
  tubes_.clear();
  if (options_.edges)
    if (Status status = tubes_.build(set(), frame_, adjacency_, tube_radius(), execution); !status.ok()) return status;
  const std::size_t leaf_count = nets_.leaves().size();
  if (leaf_count + tubes_.count() > max_leaves)
    return Status(StatusCode::unsupported, "more than the 2^32 - 1 pieces of patches of one ray scene");
  if (Status status = nets_.make(set(), execution); !status.ok()) return status;
  measure();
  const TracedLeaves leaves{&set(),      &nets_,
                            &adjacency_, own_patches(),
                            tolerance(), trims_.any() ? &trims_ : nullptr,
                            &tubes_,     static_cast<unsigned>(leaf_count)};
  if (Status status = tree_->build(leaves, follows_, execution); !status.ok()) return status;
  if (!follows_) nets_.drop_boxes();
  return {};
}

Status ExactScene::update(std::uint64_t since, const Execution& execution) {
  const bool stood = std::exchange(follows_, true);
  const Result<Box3> box = frame_box(options_, set().box());
  if (!box) return box.status();
  const bool has_frame = options_.box || frame_.holds(*box);
  if (!stood || !has_frame || ++updates_ == options_.rebuild_after) return build(execution);
  size_ = box->diagonal();
  adjacency_.forget();
  const std::vector<std::uint32_t> edited = set().edited_since(since);
  if (Status status = nets_.update(set(), edited, execution); !status.ok()) return status;
  const Result<bool> same = tubes_.update(edited, adjacency_, tube_radius(), execution);
  if (!same) return same.status();
  if (!*same) return build(execution);
  measure();
  return tree_->refit(tolerance(), execution);
}

void ExactScene::set_hit(const RayLine& line, const LeafRoot& root, HitParts parts, Hit& hit) const {
  hit.flags = {.edge = root.is_on_edge};
  if (!root.certified) {
    hit.flags.uncertified = true;
    hit.flags.within_tolerance = root.residual > search_rounding(max_degree, max_degree, 0, 0);
  }
  if (!parts.any()) {
    set_place(set(), root.patch, root.u, root.v, hit);
    return;
  }
  FirstOrder at{root.position, root.du, root.dv};
  if (root.has_point) {
    at.position = frame_.to_model(root.position);
  } else {
    at = first_order(set().patch(root.patch), root.u, root.v, frame_.centre);
    at = {frame_.centre + at.position, frame_.scale * at.du, frame_.scale * at.dv};
  }
  set_surface_point(set(), size_ * frame_.scale, 1 / frame_.scale, root.patch, root.u, root.v, at, hit, parts);
  if (parts.point) hit.residual = distance(line, frame_.to_scene(hit.position)) / frame_.scale;
  if (!root.certified && parts.normal) {
    constexpr double sine = 1e-3;
    hit.flags.tangential = !hit.flags.degenerate_normal && std::abs(dot(hit.normal, line.direction)) <= sine;
  }
}

/// Moves from (u,v) to the point nearest to the ray, which is a root if there is one.
Result<Hit> ExactScene::resolve(const Ray& ray, std::uint32_t patch, double u, double v) const {
  if (Status status = check_point(patch, u, v); !status.ok()) return status;
  if (!is_valid(ray)) return Status(StatusCode::invalid_argument, "the ray is not valid");
  Ray whole = ray;
  whole.tnear = 0, whole.tfar = std::numeric_limits<double>::infinity();
  const RayLine along = line(whole);
  if (along.empty) return Status(StatusCode::invalid_argument, "the ray misses the scene");
  const LeafRoot root = nearest_to_ray(set().patch(patch), frame_, along, patch, u, v);
  Hit hit = hit_at(along, root);
  hit.flags.uncertified = hit.flags.tangential = hit.flags.within_tolerance = false;
  const int degree_u = set().patch(patch).degree_u(), degree_v = set().patch(patch).degree_v();
  const double rounding = search_rounding(degree_u, degree_v, Leaf::max_halvings, SearchSpace::max_depth);
  hit.flags.unrefined = !(root.residual <= std::max(tracer().tolerance, 2 * rounding));
  return hit;
}

/// Traces the queries, as a packet if the rays are coherent.
void ExactScene::trace_queries(std::span<RayQuery* const> queries, SearchSpace& space) const {
  if (worth_a_packet(queries.size(), [&](std::size_t k) -> const RayLine& { return queries[k]->line; }))
    return tree_->trace(queries, space);
  for (RayQuery* query : queries) tree_->trace(*query, space);
}

void ExactScene::trace_turn(std::span<std::optional<RayQuery>> queries, SearchSpace& space) const {
  std::array<RayQuery*, rays_per_turn> wanted;
  std::size_t count = 0;
  bool leaves_surface = false;
  for (std::optional<RayQuery>& query : queries) {
    if (!query) continue;
    wanted[count++] = &*query;
    leaves_surface |= query->line.spawn > 0;
  }
  if (leaves_surface) prepare_borders();
  const FlushDenormals flush;
  trace_queries(std::span(wanted).first(count), space);
}

/// Calls `done(turn)` after each turn.
template <class Done>
void ExactScene::trace_all(const RayBatch& batch, std::size_t begin, std::size_t end, RootsWanted wanted,
                           const Done& done) const {
  SearchSpace space(nets_.largest(), &pool_);
  const auto finish = [&](const TracedTurn& turn) {
    // A search without memory has decided nothing; this becomes the call's Status.
    for (const std::optional<RayQuery>& query : turn.queries)
      if (query && query->overflow) throw std::bad_alloc();
    done(turn);
  };
  end - begin < min_in_turn ? trace_each(batch, begin, end, wanted, space, finish)
                            : trace_turns(batch, begin, end, wanted, space, finish);
}

template <class Done>
void ExactScene::trace_each(const RayBatch& batch, std::size_t begin, std::size_t end, RootsWanted wanted,
                            SearchSpace& space, const Done& done) const {
  const SceneFilter filter(batch.filter, set());
  TurnRoom<Ray> room;
  for (std::size_t k = begin; k < end && !batch.stopped(); ++k) {
    const Ray& ray = batch.rays.read(k, 1, room.span())[0];
    const bool valid = is_valid(ray);
    const RayLine along = valid ? line(ray) : RayLine{};
    std::optional<RayQuery> query;
    if (!along.empty) {
      query.emplace(ray, along, wanted);
      query->filter = filter.if_any(), query->index = k;
      if (along.spawn > 0) prepare_borders();
      const FlushDenormals flush;
      tree_->trace(*query, space);
    }
    done({k, {&valid, 1}, {&query, 1}});
  }
}

/// Makes lines, searches and hits by turns of a few rays: denormal numbers count only in the first and the last step.
template <class Done>
void ExactScene::trace_turns(const RayBatch& batch, std::size_t begin, std::size_t end, RootsWanted wanted,
                             SearchSpace& space, const Done& done) const {
  const SceneFilter filter(batch.filter, set());
  RayTurn turn(frame_, scene_box_, *tracer().kernels);
  TurnRoom<Ray> room;
  std::array<std::optional<RayQuery>, rays_per_turn> queries;
  for_turns(batch, begin, end, [&](std::size_t first, std::size_t count) {
    const std::span<const Ray> now = batch.rays.read(first, count, room.span());
    turn.set(now);
    for (std::size_t k = 0; k < count; ++k) {
      queries[k].reset();
      if (turn.line(k).empty) continue;
      queries[k].emplace(now[k], turn.line(k), wanted);
      queries[k]->filter = filter.if_any(), queries[k]->index = first + k;
    }
    trace_turn(std::span(queries).first(count), space);
    done({first, turn.valid().first(count), std::span(queries).first(count)});
  });
}

void ExactScene::closest_piece(const RayBatch& batch, const HitWriter& writer, std::size_t begin,
                               std::size_t end) const {
  const HitParts parts = writer.parts();
  TurnRoom<Hit> room;
  trace_all(batch, begin, end, RootsWanted::closest, [&](const TracedTurn& turn) {
    const std::span<Hit> hits = writer.place(turn.first, turn.queries.size(), room.span());
    for (std::size_t k = 0; k < turn.queries.size(); ++k) {
      const std::optional<RayQuery>& query = turn.queries[k];
      Hit& hit = hits[k];
      if (query && query->found) {
        set_hit(query->line, query->best, parts, hit);
        hit.instance = Hit::no_instance, hit.t = query->t_of(query->best);
      } else {
        hit = {};
        if (!turn.valid[k]) hit.kind = HitKind::invalid_ray;
      }
      if (query) hit.flags.incomplete = query->incomplete, hit.steps = saturated_u16(query->steps);
    }
    writer.write(turn.first, hits);
  });
}

void ExactScene::occluded_piece(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t begin,
                                std::size_t end) const {
  trace_all(batch, begin, end, RootsWanted::any, [&](const TracedTurn& turn) {
    for (std::size_t k = 0; k < turn.queries.size(); ++k)
      occluded.at(turn.first + k, 0) = turn.queries[k] && turn.queries[k]->found;
  });
}

void ExactScene::trace(RayQuery& query) const {
  SearchSpace space(nets_.largest(), &pool_);
  tree_->trace(query, space);
}

void ExactScene::trace(std::span<RayQuery* const> queries) const {
  SearchSpace space(nets_.largest(), &pool_);
  trace_queries(queries, space);
}

void ExactScene::trace_alone(RayQuery& query) const {
  const FlushDenormals flush;
  trace(query);
}

/// Makes the roots of a line those of its hits.
void ExactScene::complete_roots(RayQuery& query) const {
  keep_distinct(set(), adjacency_.of(set()), query.roots);
  complete_folds(set(), adjacency_.of(set()), frame_, query.line, trims_, query.roots);
}

/// Appends the hits of a query: its roots, or those of its line moved sideways.
void ExactScene::append_hits(const RayQuery& query, const RootsAside& found, std::vector<Hit>& hits) const {
  for (const LeafRoot& root : found.roots) {
    if (root.patch >= own_patches()) continue;
    Hit& hit = hits.emplace_back(hit_at(found.line, root));
    hit.t = std::clamp(found.line.t_at(root.s), query.ray.tnear, query.ray.tfar);
    hit.flags.edge = query.edge_gap > 0;
    if (hit.flags.edge) hit.residual = distance(query.line, frame_.to_scene(hit.position)) / frame_.scale;
    hit.flags.incomplete = query.incomplete;
    hit.steps = saturated_u16(query.steps);
  }
}

void ExactScene::hits_of(RayQuery& query, std::vector<Hit>& hits) const {
  complete_roots(query);
  if (query.edge_gap == 0) return append_hits(query, {query.line, std::move(query.roots)}, hits);
  const auto find_roots = [&](RayQuery& other) { trace_alone(other), complete_roots(other); };
  const RootsAside aside = roots_aside(query, scene_box_, find_roots);
  if (query.overflow) return;
  query.incomplete = aside.incomplete;
  append_hits(query, aside, hits);
}

Status ExactScene::all_of(const Ray& ray, std::vector<Hit>& hits) const {
  if (!is_valid(ray)) return {};
  const RayLine along = line(ray);
  if (along.empty) return {};
  RayQuery query(ray, along, RootsWanted::all);
  trace_alone(query);
  if (!query.overflow) hits_of(query, hits);
  return query.overflow ? Status(StatusCode::out_of_memory, "out of memory") : Status();
}

}  // namespace

Result<std::unique_ptr<RayScene::Impl>> make_exact_scene(const PatchSet& set, const RaySceneOptions& options) {
  if (Status status = check_exact(options); !status.ok()) return status;
  const Result<Isa> isa = usable_isa(options.isa);
  if (!isa) return isa.status();
  Result<std::unique_ptr<LeafTree>> tree = ray_trees().leaves(*isa);
  if (!tree) return tree.status();
  return std::unique_ptr<RayScene::Impl>(std::make_unique<ExactScene>(set, *std::move(tree), options));
}

}}  // namespace tessera::abi_0_1
