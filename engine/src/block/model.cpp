#include "tessera/model.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>

#include "base/impl_access.h"
#include "base/text.h"
#include "block/patch_edges.h"
#include "block/patch_set_impl.h"
#include "block/patch_trims.h"
#include "tessera/guard.h"
#include "tessera/status.h"
#include "tessera/topology.h"
#include "trim/grid_loops.h"
#include "trim/trim_region_impl.h"

namespace tessera::inline abi_0_1 {
namespace {

/// What the loops of a face keep.
struct FaceTrims {
  TrimRegion region;
  std::vector<PatchUse> uses;               ///< by patch_uses(); empty if the face is whole
  std::optional<std::uint32_t> index = {};  ///< into PatchTrims::regions
};

/// Finds the trims of faces. Faces of equal loops over equal grids share them, as instances of a part do.
class FaceTrimsFinder {
 public:
  /// How far the outline of a spline, as CAD files have it, may be off the sides of its domain, as a share of it.
  static constexpr double outline_snap = 0x1p-13;
  /// Returns the trims of the next face, to stay until the next call.
  Result<FaceTrims*> find(const Shared<std::vector<TrimLoop>>& loops, const PatchGrid& grid, bool is_loose) {
    TrimOptions options = TrimRegion::Impl::options_of(grid);
    if (is_loose) options.snap = outline_snap;
    const auto [first, last] = known_.equal_range(key_of(loops));
    for (auto known = first; known != last; ++known)
      if (known->second.is_for(loops, grid, options)) return &known->second.trims;
    Result<TrimRegion> region = TrimRegion::Impl::make(*loops, grid.breaks_u(), grid.breaks_v(), options,
                                                       TrimRegion::Impl::Use::patches, &extractions_);
    if (!region) return region.status();
    FaceTrims trims{*std::move(region), {}};
    if (!trims.region.is_whole()) trims.uses = patch_uses(trims.region);
    return &known_.emplace(key_of(loops), Known{loops, options, std::move(trims)})->second.trims;
  }

 private:
  struct Known {
    Shared<std::vector<TrimLoop>> loops;
    TrimOptions options;
    FaceTrims trims;

    bool is_for(const std::vector<TrimLoop>& others, const PatchGrid& grid, const TrimOptions& other) const {
      const CutLines& lines = impl_of(trims.region).lines;
      return options.periodic_u == other.periodic_u && options.periodic_v == other.periodic_v &&
             options.snap == other.snap && std::ranges::equal(lines.u.lines, grid.breaks_u()) &&
             std::ranges::equal(lines.v.lines, grid.breaks_v()) &&
             std::ranges::equal(*loops, others, [](const TrimLoop& a, const TrimLoop& b) {
               return a.hole == b.hole && a.curves == b.curves;
             });
    }
  };

  /// A number that loops share with few others.
  static double key_of(const std::vector<TrimLoop>& loops) {
    double key = 0;
    for (const TrimLoop& loop : loops)
      for (const Curve& curve : loop.curves) key += curve.points().front().x + 0.7548776662466927 * curve.points()[1].y;
    return key;
  }

  std::unordered_multimap<double, Known> known_;
  CurveExtractions extractions_;
};

/// The patches of one surface after the other, and the source of each patch.
struct Gathered {
  std::vector<BezierPatch> patches;
  std::vector<PatchSource> sources;
  std::size_t surface_count = 0;
  Box3 box;
  FitError fit_error;
  PatchTrims trims;

  void add(std::size_t surface, PatchGrid grid) {
    const auto u = grid.breaks_u(), v = grid.breaks_v();
    box.extend(grid.box());
    note_error(grid);
    std::vector<BezierPatch> added = std::move(grid).take_patches();
    if (patches.empty()) {
      patches = std::move(added);
      sources.reserve(patches.size());
    } else {
      patches.insert(patches.end(), std::move_iterator(added.begin()), std::move_iterator(added.end()));
    }
    std::vector<PatchSource> row;
    for (std::size_t k = 0; k + 1 < v.size(); ++k)
      row.push_back({static_cast<std::uint32_t>(surface), {0, 1, v[k], v[k + 1]}});
    for (std::size_t k = 0; k + 1 < u.size(); ++k) {
      for (PatchSource& source : row) {
        source.domain.u0 = u[k];
        source.domain.u1 = u[k + 1];
      }
      sources.insert(sources.end(), row.begin(), row.end());
    }
    surface_count = surface + 1;
  }

  /// Adds what a face keeps of its patches.
  void add_kept(std::size_t surface, const PatchGrid& grid, FaceTrims& face) {
    const std::vector<PatchUse>& uses = face.uses;
    note_error(grid);
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

  void note_error(const PatchGrid& grid) {
    fit_error.distance = std::max(fit_error.distance, grid.fit_error().distance);
    fit_error.certified = fit_error.certified && grid.fit_error().certified;
  }

  Result<PatchSet> packed(PatchSetOptions options) && {
    options.fit_error = fit_error;
    if (patches.empty() && surface_count > 0)
      return Status(StatusCode::invalid_argument, "trimming loops cut away every patch");
    Result<PatchSet> set = PatchSet::Impl::make(std::move(patches), std::move(sources), surface_count, box, options);
    if (!set || trims.cuts.empty()) return set;
    trims.is_cut.resize(set->patch_count());
    for (const PatchTrims::Cut& cut : trims.cuts) trims.is_cut[cut.patch] = 1;
    impl_of(*set).trims = std::make_shared<const PatchTrims>(std::move(trims));
    return set;
  }
};

/// The share of a tolerance that fits may use; the rest is for the rounding of placed points.
constexpr double share_for_fits = 0.99;

}  // namespace

Status in_surface(const Model& model, std::size_t surface, const Status& status) {
  return guarded([&] {
    const std::string& name = model.surfaces[surface].name;
    return Status(
        status.code(),
        "surface " + std::to_string(surface) + (name.empty() ? "" : " (" + name + ")") + ": " + status.message(),
        static_cast<std::ptrdiff_t>(surface));
  });
}

Result<SurfaceJet> evaluate_jet(const ModelSurface& surface, double u, double v) {
  return guarded([&]() -> Result<SurfaceJet> {
    Result<SurfaceJet> jet = evaluate_jet(surface.surface, u, v);
    if (!jet) return jet;
    const Affine& map = surface.placement;
    const Vec3 position = map.point(jet->position);
    if (!is_finite(position))
      return Status(StatusCode::non_finite, "the surface's point at (" + text(u) + ", " + text(v) + ") is (" +
                                                text(position.x) + ", " + text(position.y) + ", " + text(position.z) +
                                                ") after its placement, beyond the range of double");
    return SurfaceJet{position,
                      map.vector(jet->du),
                      map.vector(jet->dv),
                      map.vector(jet->duu),
                      map.vector(jet->duv),
                      map.vector(jet->dvv)};
  });
}

Result<PatchGrid> to_bezier(const ModelSurface& surface, const FitOptions& options) {
  return guarded([&]() -> Result<PatchGrid> {
    if (surface.placement == Affine{}) return to_bezier(surface.surface, options);
    FitOptions before = options;  // lengths before the placement
    const double norm = surface.placement->norm_bound();
    if (norm > 0)
      before.tolerance = std::min(share_for_fits * options.tolerance / norm, std::numeric_limits<double>::max());
    Result<PatchGrid> grid = to_bezier(surface.surface, before);
    if (grid) grid = transform(*grid, surface.placement);
    if (grid && options.tolerance > 0 && grid->fit_error().distance > options.tolerance)
      return Status(StatusCode::invalid_argument,
                    "the tolerance " + text(options.tolerance) +
                        " is below the rounding of the placed surface; the error reached is " +
                        text(grid->fit_error().distance));
    return grid;
  });
}

Result<Shared<std::vector<TrimLoop>>> grid_trims(const ModelSurface& surface) {
  return guarded([&]() -> Result<Shared<std::vector<TrimLoop>>> {
    const auto* const piece = std::get_if<QuadricPiece>(&surface.surface);
    if (!piece || surface.trims->empty()) return surface.trims;
    Result<std::vector<TrimLoop>> loops = grid_loops(*surface.trims, *piece);
    if (!loops) return loops.status();
    return Shared<std::vector<TrimLoop>>(*std::move(loops));
  });
}

namespace {

/// Gathers the patches of a model's surfaces one by one.
class ModelPatches {
 public:
  ModelPatches(const Model& model, const PatchSetOptions& options) : model_(model), options_(options) {}

  /// States that the surfaces from `first` on are the faces of a shape, which must outlive this object.
  void name_edges(const Shape& shape, std::size_t first) {
    if (shape.edges.empty() || !options_.trims) return;
    faces_.resize(first + shape.faces.size());
    for (std::size_t k = 0; k < shape.faces.size(); ++k)
      faces_[first + k] = {&shape.faces[k], static_cast<std::uint32_t>(edges_.edges.size())};
    const auto vertex = [&](std::uint32_t id) { return id == no_id ? no_id : edges_.vertex_count + id; };
    for (const BrepEdge& edge : shape.edges)
      edges_.edges.push_back({edge.range, vertex(edge.start), vertex(edge.end), edge.degenerate});
    edges_.vertex_count += static_cast<std::uint32_t>(shape.vertices.size());
  }

  /// Adds the next surface's patches.
  Status add(PatchGrid grid) {
    const std::size_t k = ends_.size(), first = all_.patches.size();
    ModelSurface surface = model_.surfaces[k];
    const NamedFace named = k < faces_.size() ? faces_[k] : NamedFace{};
    const bool is_trimmed = !surface.trims->empty();
    if (named.face && !is_trimmed) surface.trims = named.face->outline;
    if (!options_.trims || surface.trims->empty()) {
      all_.add(k, std::move(grid));
    } else {
      const Result<Shared<std::vector<TrimLoop>>> loops = grid_trims(surface);
      // The outline of a quadric has the pace of its edges, which snapping to lines between patches would change.
      const bool is_loose = !is_trimmed && !std::holds_alternative<QuadricPiece>(surface.surface);
      const Result<FaceTrims*> trims = loops ? trims_.find(*loops, grid, is_loose) : loops.status();
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

  Result<PatchSet> packed() && {
    Result<PatchSet> set = std::move(all_).packed(options_);
    if (set) impl_of(*set).trim_faults = std::move(faults_);
    if (set && !edges_.faces.empty()) impl_of(*set).edges = std::make_shared<const PatchEdges>(std::move(edges_));
    if (set || set.status().index() == Status::no_index) return set;
    const auto patch = static_cast<std::size_t>(set.status().index());
    const auto surface = std::upper_bound(ends_.begin(), ends_.end(), patch) - ends_.begin();
    return in_surface(model_, static_cast<std::size_t>(surface), set.status());
  }

 private:
  struct NamedFace {
    const ShapeFace* face = nullptr;
    std::uint32_t first_edge = 0;
  };

  /// Notes the patches of a face whose loops name edges. `first`: its first patch.
  void add_edges(std::uint32_t first_edge, const Shared<std::vector<TrimLoop>>& loops, const FaceTrims& trims,
                 std::size_t first, std::size_t places) {
    const auto names = [](const TrimLoop& loop) { return !loop.coedges.empty(); };
    if (std::ranges::none_of(*loops, names)) return;
    PatchEdges::Face face{first_edge, loops, trims.region, {}};
    face.patches.assign(places, no_id);
    const bool is_whole = all_.patches.size() - first == places;
    for (std::size_t place = 0; place < places; ++place)
      if (is_whole || trims.uses[place] != PatchUse::out) face.patches[place] = static_cast<std::uint32_t>(first++);
    edges_.faces.push_back(std::move(face));
  }

  const Model& model_;
  const PatchSetOptions& options_;
  Gathered all_;
  FaceTrimsFinder trims_;
  std::vector<NamedFace> faces_;  ///< by surface, as far as there are any
  PatchEdges edges_;
  std::vector<Status> faults_;
  std::vector<std::size_t> ends_;  ///< the end of each surface's patches
};

/// Converts all surfaces of a model and adds them to `patches`.
Result<PatchSet> converted(const Model& model, const FitOptions& fit, ModelPatches patches) {
  for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
    Result<PatchGrid> grid = to_bezier(model.surfaces[k], fit);
    if (!grid) return in_surface(model, k, grid.status());
    if (Status status = patches.add(*std::move(grid)); !status.ok()) return status;
  }
  return std::move(patches).packed();
}

}  // namespace

Result<PatchSet> make_patch_set(const Model& model, const PatchSetOptions& options, const FitOptions& fit) {
  return guarded([&]() -> Result<PatchSet> {
    if (Status status = check_topology(model); !status.ok()) return status;
    ModelPatches patches(model, options);
    for (const Instance& instance : model.instances)
      patches.name_edges(model.shapes[instance.shape], instance.first_surface);
    return converted(model, fit, std::move(patches));
  });
}

Result<PatchSet> make_patch_set(const Model& model, std::span<const PatchGrid> grids, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    if (grids.size() != model.surfaces.size())
      return Status(StatusCode::count_mismatch,
                    "there are " + counted(grids.size(), "grid") + " for " + counted(model.surfaces.size(), "surface"));
    if (Status status = check_topology(model); !status.ok()) return status;
    ModelPatches patches(model, options);
    for (const Instance& instance : model.instances)
      patches.name_edges(model.shapes[instance.shape], instance.first_surface);
    for (const PatchGrid& grid : grids)
      if (Status status = patches.add(grid); !status.ok()) return status;
    return std::move(patches).packed();
  });
}

Result<PatchSet> make_patch_set(const Shape& shape, const PatchSetOptions& options, const FitOptions& fit) {
  return guarded([&]() -> Result<PatchSet> {
    if (Status status = check_topology(shape); !status.ok()) return status;
    Model faces;
    faces.surfaces.assign(shape.faces.begin(), shape.faces.end());
    ModelPatches patches(faces, options);
    patches.name_edges(shape, 0);
    return converted(faces, fit, std::move(patches));
  });
}

Result<PatchSet> make_patch_set(std::span<const PatchGrid> grids, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    Gathered all;
    for (std::size_t k = 0; k < grids.size(); ++k) all.add(k, grids[k]);
    return std::move(all).packed(options);
  });
}

Result<PatchSet> make_patch_set(PatchGrid grid, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    Gathered all;
    all.add(0, std::move(grid));
    return std::move(all).packed(options);
  });
}

}  // namespace tessera::inline abi_0_1
