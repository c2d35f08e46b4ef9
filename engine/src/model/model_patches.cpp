#include "model/model_patches.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "base/impl_access.h"
#include "parallel/least_index.h"
#include "parallel/long_lists.h"
#include "parallel/parallel_for.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// How far the outline of a spline, as CAD files have it, may be off the sides of its domain, as a share of it.
constexpr double outline_snap = 0x1p-13;

/// A number that loops share with few others.
double key_of(const std::vector<TrimLoop>& loops) {
  double key = 0;
  for (const TrimLoop& loop : loops)
    for (const Curve& curve : loop.curves) key += curve.points().front().x + 0.7548776662466927 * curve.points()[1].y;
  return key;
}

/// Whether a surface is worth another thread's time, and calls no function of the caller's, which may not expect one.
bool takes_a_while(const Surface& surface) {
  return std::holds_alternative<BSplineSurface>(surface) || std::holds_alternative<QuadricPiece>(surface);
}

}  // namespace

bool FaceTrimsFinder::Known::is_for(const std::vector<TrimLoop>& others, const PatchGrid& grid,
                                    const TrimOptions& other) const {
  const CutLines& lines = impl_of(trims.region).lines;
  return options.periodic_u == other.periodic_u && options.periodic_v == other.periodic_v &&
         options.snap == other.snap && std::ranges::equal(lines.u.lines, grid.breaks_u()) &&
         std::ranges::equal(lines.v.lines, grid.breaks_v()) &&
         std::ranges::equal(*loops, others, [](const TrimLoop& a, const TrimLoop& b) {
           return a.hole == b.hole && a.curves == b.curves;
         });
}

TrimOptions FaceTrimsFinder::options_of(const PatchGrid& grid, bool is_loose) {
  TrimOptions options = TrimRegion::Impl::options_of(grid);
  if (is_loose) options.snap = outline_snap;
  return options;
}

Result<FaceTrims> FaceTrimsFinder::make(const std::vector<TrimLoop>& loops, const PatchGrid& grid,
                                        const TrimOptions& options, CurveExtractions& extractions) {
  Result<TrimRegion> region = TrimRegion::Impl::make(loops, grid.breaks_u(), grid.breaks_v(), options,
                                                     TrimRegion::Impl::Use::patches, &extractions);
  if (!region) return region.status();
  FaceTrims trims{*std::move(region), {}};
  if (!trims.region.is_whole()) trims.uses = patch_uses(trims.region);
  return trims;
}

Status FaceTrimsFinder::find_ahead(std::span<const SurfaceLoops> faces, const std::atomic<bool>* cancel) {
  constexpr std::size_t faces_per_task = 1;
  // One face of each key: faces of one key are nearly always equal.
  std::vector<std::pair<double, const SurfaceLoops*>> due;
  for (const SurfaceLoops& face : faces)
    if (face.grid && *face.grid && face.loops && *face.loops)
      if (const double key = key_of(**face.loops); !known_.contains(key)) due.emplace_back(key, &face);
  std::ranges::stable_sort(due, {}, [](const auto& of) { return of.first; });
  due.erase(std::ranges::unique(due, {}, [](const auto& of) { return of.first; }).begin(), due.end());
  std::vector<std::optional<Result<FaceTrims>>> made(due.size());
  const auto make_some = [&](std::size_t begin, std::size_t end) {
    const auto extractions = extractions_.take();
    for (std::size_t k = begin; k < end; ++k) {
      const SurfaceLoops& face = *due[k].second;
      made[k].emplace(make(**face.loops, **face.grid, options_of(**face.grid, face.is_loose), *extractions));
    }
  };
  if (Status status = parallel_for(due.size(), faces_per_task, {.cancel = cancel}, make_some); !status.ok())
    return status;
  for (std::size_t k = 0; k < due.size(); ++k) {
    const SurfaceLoops& face = *due[k].second;
    if (*made[k])
      known_.emplace(due[k].first, Known{**face.loops, options_of(**face.grid, face.is_loose), **std::move(made[k])});
  }
  return {};
}

Result<FaceTrims*> FaceTrimsFinder::find(const Shared<std::vector<TrimLoop>>& loops, const PatchGrid& grid,
                                         bool is_loose) {
  const TrimOptions options = options_of(grid, is_loose);
  const auto [first, last] = known_.equal_range(key_of(loops));
  for (auto known = first; known != last; ++known)
    if (known->second.is_for(loops, grid, options)) return &known->second.trims;
  const auto extractions = extractions_.take();
  Result<FaceTrims> trims = make(loops, grid, options, *extractions);
  if (!trims) return trims.status();
  return &known_.emplace(key_of(loops), Known{loops, options, *std::move(trims)})->second.trims;
}

void GatheredPatches::add(std::size_t surface, PatchGrid&& grid) {
  add_sources(surface, grid);
  std::vector<BezierPatch> added = std::move(grid).take_patches();
  if (patches.empty())
    patches = std::move(added);
  else
    patches.insert(patches.end(), std::move_iterator(added.begin()), std::move_iterator(added.end()));
}

void GatheredPatches::add(std::size_t surface, const PatchGrid& grid) {
  add_sources(surface, grid);
  patches.insert(patches.end(), grid.patches().begin(), grid.patches().end());
}

void GatheredPatches::add_sources(std::size_t surface, const PatchGrid& grid) {
  const auto u = grid.breaks_u(), v = grid.breaks_v();
  domains.push_back(grid.domain());
  box.extend(grid.box());
  note_error(grid.fit_error());
  for (std::size_t i = 0; i + 1 < u.size(); ++i)
    for (std::size_t j = 0; j + 1 < v.size(); ++j)
      sources.push_back({static_cast<std::uint32_t>(surface), {u[i], u[i + 1], v[j], v[j + 1]}});
  surface_count = surface + 1;
}

void GatheredPatches::add_single(std::span<const ModelSurface> surfaces) {
  surface_count = surfaces.size();
  const ListSize sizes[] = {size_of(sources, surface_count), size_of(domains, surface_count)};
  resize_lists(sizes);
  patches.reserve(surface_count);
  for (std::size_t k = 0; k < surface_count; ++k) {
    patches.push_back(std::get<BezierPatch>(surfaces[k].surface));
    sources[k].surface = static_cast<std::uint32_t>(k);
  }
}

void GatheredPatches::reserve(std::span<const PatchGrid> grids) {
  std::size_t count = 0;
  for (const PatchGrid& grid : grids) count += grid.patches().size();
  patches.reserve(count);
  sources.reserve(count);
  domains.reserve(grids.size());
}

void GatheredPatches::add_kept(std::size_t surface, const PatchGrid& grid, FaceTrims& face) {
  const std::vector<PatchUse>& uses = face.uses;
  domains.push_back(grid.domain());
  note_error(grid.fit_error());
  surface_count = surface + 1;
  if (!face.index && std::ranges::find(uses, PatchUse::cut) != uses.end()) {
    face.index = static_cast<std::uint32_t>(trims.regions.size());
    trims.regions.push_back(face.region);
  }
  for (std::size_t place = 0; place < uses.size(); ++place) {
    if (uses[place] == PatchUse::out) continue;
    if (uses[place] == PatchUse::cut)
      trims.cuts.push_back(
          {static_cast<std::uint32_t>(patches.size()), *face.index, static_cast<std::uint32_t>(place)});
    sources.push_back({static_cast<std::uint32_t>(surface), grid.patch_domain(place)});
    patches.push_back(grid.patches()[place]);
    box.extend(patches.back().hull_box());
  }
}

void GatheredPatches::note_error(const FitError& error) {
  fit_error.distance = std::max(fit_error.distance, error.distance);
  fit_error.certified = fit_error.certified && error.certified;
}

Result<PatchSet> GatheredPatches::packed(PatchSetOptions options) && {
  note_error(options.fit_error);
  options.fit_error = fit_error;
  if (patches.empty() && surface_count > 0)
    return Status(StatusCode::invalid_argument, "trimming loops cut away every patch");
  const std::optional<Box3> known = box.empty() ? std::nullopt : std::optional(box);
  Result<PatchSet> set = PatchSet::Impl::make(std::move(patches), std::move(sources), surface_count, known, options);
  if (set && domains.size() == set->surface_count()) impl_of(*set).domains = std::move(domains);
  if (!set || trims.cuts.empty()) return set;
  trims.is_cut.resize(set->patch_count());
  for (const PatchTrims::Cut& cut : trims.cuts) trims.is_cut[cut.patch] = 1;
  impl_of(*set).trims = std::make_shared<const PatchTrims>(std::move(trims));
  return set;
}

void ModelPatches::name_edges(const Shape& shape, const Affine& placement, std::size_t first) {
  if (shape.edges.empty() || !options_.trims) return;
  faces_.resize(first + shape.faces.size());
  for (std::size_t k = 0; k < shape.faces.size(); ++k)
    faces_[first + k] = {&shape.faces[k], static_cast<std::uint32_t>(edges_.edges.size())};
  const auto first_vertex = static_cast<std::uint32_t>(edges_.vertices.size());
  const auto vertex = [&](std::uint32_t id) { return id == no_id ? no_id : first_vertex + id; };
  for (const BrepEdge& edge : shape.edges)
    edges_.edges.push_back({edge.range, vertex(edge.start), vertex(edge.end), edge.degenerate});
  for (const BrepVertex& of : shape.vertices) edges_.vertices.push_back(placement.point(of.position));
}

void ModelPatches::name_edges() {
  for (const Instance& instance : model_.instances)
    name_edges(model_.shapes[instance.shape], instance.placement, instance.first_surface);
}

void ModelPatches::find_loops(std::size_t surface, SurfaceLoops& of) const {
  const NamedFace named = named_face(surface);
  const bool is_trimmed = !model_.surfaces[surface].trims->empty();
  const bool has_outline = named.face && !named.face->outline->empty();
  if (!options_.trims || !(is_trimmed || has_outline)) return;
  ModelSurface cut = model_.surfaces[surface];
  if (!is_trimmed) cut.trims = named.face->outline;
  of.loops = grid_trims(cut);
  // The outline of a quadric has the pace of its edges, which snapping to lines between patches would change.
  of.is_loose = !is_trimmed && !std::holds_alternative<QuadricPiece>(cut.surface);
}

Status ModelPatches::add_grids(std::span<const PatchGrid> grids) {
  const auto is_trimmed = [](const ModelSurface& surface) { return !surface.trims->empty(); };
  if (faces_.empty() && std::ranges::none_of(model_.surfaces, is_trimmed)) all_.reserve(grids);
  for (const PatchGrid& grid : grids) {
    SurfaceLoops of;
    find_loops(ends_.size(), of);
    if (!of.loops) {
      all_.add(ends_.size(), grid);
      ends_.push_back(all_.patches.size());
    } else {
      of.grid = grid;
      if (Status status = add(std::move(of)); !status.ok()) return status;
    }
  }
  return {};
}

Status ModelPatches::add(PatchGrid grid) {
  SurfaceLoops of{.grid = std::move(grid)};
  find_loops(ends_.size(), of);
  return add(std::move(of));
}

Status ModelPatches::add(SurfaceLoops of) {
  const std::size_t k = ends_.size(), first = all_.patches.size();
  const NamedFace named = named_face(k);
  PatchGrid& grid = **of.grid;
  if (!of.loops) {
    all_.add(k, std::move(grid));
  } else {
    const Result<Shared<std::vector<TrimLoop>>>& loops = *of.loops;
    const Result<FaceTrims*> trims = loops ? trims_.find(*loops, grid, of.is_loose) : loops.status();
    if (!trims && trims.status().code() == StatusCode::out_of_memory) return trims.status();
    if (!trims) faults_.push_back(in_surface(model_, k, trims.status()));
    const std::size_t places = grid.patches().size();
    if (!trims || (*trims)->region.is_whole()) {
      all_.add(k, std::move(grid));
    } else {
      all_.add_kept(k, grid, **trims);
    }
    if (trims && named.face) add_edges(named.first_edge, *loops, **trims, first, places);
  }
  ends_.push_back(all_.patches.size());
  return {};
}

bool ModelPatches::is_whole_patch(std::size_t surface) const {
  const ModelSurface& of = model_.surfaces[surface];
  return std::holds_alternative<BezierPatch>(of.surface) && of.trims->empty() && !named_face(surface).face &&
         of.placement == Affine{};
}

bool ModelPatches::pass_whole_patch() {
  if (!is_whole_patch(ends_.size())) return false;
  ends_.push_back(all_.patches.size());
  return true;
}

Result<bool> ModelPatches::add_if_single() {
  constexpr std::size_t surfaces_per_task = 2048;
  const std::size_t count = model_.surfaces.size();
  const auto find_other = [this](std::size_t begin, std::size_t end) {
    while (begin < end && is_whole_patch(begin)) ++begin;
    return begin;
  };
  const Result<std::size_t> other = find_first(count, find_other, surfaces_per_task);
  if (!other) return other.status();
  if (*other < count) return false;
  all_.add_single(model_.surfaces);
  ends_.resize(count);
  std::iota(ends_.begin(), ends_.end(), std::size_t{1});
  return true;
}

Status ModelPatches::add_all(const FitOptions& fit) {
  // Batches, so that the grids of a large model are not all in memory beside the patches.
  constexpr std::size_t batch = 256, surfaces_per_task = 2;
  const Execution& execution = progress_.loops();
  const Execution quiet{.cancel = execution.cancel};
  if (ends_.empty()) {
    const Result<bool> added = add_if_single();
    if (!added || *added) return added.status();
  }
  std::vector<SurfaceLoops> some;
  for (std::size_t first = 0; first < model_.surfaces.size(); first += batch) {
    some.clear();
    some.resize(std::min(batch, model_.surfaces.size() - first));
    const auto convert = [&](std::size_t k) {
      some[k].grid = to_bezier(model_.surfaces[first + k], fit);
      find_loops(first + k, some[k]);
    };
    const auto convert_some = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        if (takes_a_while(model_.surfaces[first + k].surface)) convert(k);
    };
    if (Status status = parallel_for(some.size(), surfaces_per_task, quiet, convert_some); !status.ok()) return status;
    for (std::size_t k = 0; k < some.size(); ++k)
      if (!some[k].grid) convert(k);
    if (Status status = trims_.find_ahead(some, execution.cancel); !status.ok()) return status;
    for (SurfaceLoops& of : some) {
      if (!*of.grid) return in_surface(model_, ends_.size(), of.grid->status());
      if (Status status = add(std::move(of)); !status.ok()) return status;
    }
    if (execution.progress)
      execution.progress(static_cast<double>(ends_.size()) / static_cast<double>(model_.surfaces.size()));
  }
  return {};
}

Box3 ModelPatches::take_box() {
  all_.patches.clear(), all_.sources.clear(), all_.trims.cuts.clear(), edges_.faces.clear();
  return std::exchange(all_.box, {});
}

Result<PatchSet> ModelPatches::packed() && {
  PatchSetOptions packing = options_;
  packing.execution = progress_.loops();
  Result<PatchSet> set = std::move(all_).packed(packing);
  if (set) (void)progress_.finish({});
  if (set) impl_of(*set).trim_faults = std::move(faults_);
  if (set && !edges_.faces.empty()) impl_of(*set).edges = std::make_shared<const PatchEdges>(std::move(edges_));
  if (set || set.status().index() == Status::no_index) return set;
  const auto patch = static_cast<std::size_t>(set.status().index());
  const auto surface = std::upper_bound(ends_.begin(), ends_.end(), patch) - ends_.begin();
  return in_surface(model_, static_cast<std::size_t>(surface), set.status());
}

void ModelPatches::add_edges(std::uint32_t first_edge, const Shared<std::vector<TrimLoop>>& loops,
                             const FaceTrims& trims, std::size_t first, std::size_t places) {
  const auto names = [](const TrimLoop& loop) { return !loop.coedges.empty(); };
  if (std::ranges::none_of(*loops, names)) return;
  PatchEdges::Face face{first_edge, loops, trims.region, {}};
  face.patches.assign(places, no_id);
  const bool is_whole = all_.patches.size() - first == places;
  for (std::size_t place = 0; place < places; ++place)
    if (is_whole || trims.uses[place] != PatchUse::out) face.patches[place] = static_cast<std::uint32_t>(first++);
  edges_.faces.push_back(std::move(face));
}

}}  // namespace tessera::abi_0_1
