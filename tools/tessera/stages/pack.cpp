#include "stages/pack.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "console/progress.h"
#include "tessera/edge_matching.h"
#include "tessera/topology.h"

namespace tessera::cli {
namespace {

/// The set, after its faults are printed, or its error, with the places in the file.
Result<PatchSet> with_places(const Loaded& loaded, std::size_t first_surface, Result<PatchSet> set) {
  if (!set) return loaded.in_place(first_surface, set.status());
  for (const Status& fault : set->trim_faults())
    warn(loaded.in_place(first_surface, fault).message() + "; it is kept whole");
  return set;
}

/// Whether some edge has one face, or a face names no edges.
Result<bool> has_free_edges(const Shape& shape) {
  const Result<EdgeUses> uses = edge_uses(shape);
  if (!uses) return uses.status();
  for (std::size_t k = 0; k < shape.edges.size(); ++k)
    if ((*uses)[k].size() == 1 && !shape.edges[k].degenerate) return true;
  for (const ShapeFace& face : shape.faces) {
    const std::vector<TrimLoop>& loops = edge_loops(face);
    const auto is_nameless = [](const TrimLoop& loop) { return loop.coedges.empty(); };
    if (loops.empty() || std::any_of(loops.begin(), loops.end(), is_nameless)) return true;
  }
  return false;
}

/// Packs all surfaces.
Result<PatchSet> pack_faces(const Loaded& loaded, const PackOptions& options, Timings& timings) {
  if (options.untrimmed || loaded.trimmed() == 0 || !loaded.model.instances.empty())
    return pack(loaded, options, timings);
  const Result<std::optional<JoinedShape>> joined = timings.measure("join", [&] {
    Shape faces;
    for (const ModelSurface& surface : loaded.model.surfaces) faces.faces.push_back({surface});
    return joined_if_free(faces);
  });
  if (!joined || !*joined) return pack(loaded, options, timings);
  const auto phase = timings.phase("pack");
  return with_places(loaded, 0, make_patch_set((*joined)->shape, {}, loaded.fit));
}

/// Joins the free edges of a model's shapes, and places their faces anew. Where joining fails, a shape stays as it is.
Status join_shapes(Model& model) {
  bool has_joined = false;
  for (Shape& shape : model.shapes) {
    Result<std::optional<JoinedShape>> joined = joined_if_free(shape);
    if (!joined || !*joined) continue;
    shape = std::move((*joined)->shape);
    has_joined = true;
  }
  if (!has_joined) return {};
  Result<std::vector<ModelSurface>> faces = placed_faces(model.shapes, model.instances);
  if (!faces) return faces.status();
  model.surfaces = *std::move(faces);
  return {};
}

/// Packs the faces of a shape, whose lengths grow by at most `stretch` where instances stand.
Result<PatchSet> pack_shape(const Loaded& loaded, const Shape& stated, double stretch, const PackOptions& options) {
  PatchSetOptions packing;
  packing.trims = !options.untrimmed;
  FitOptions fit = loaded.fit;
  if (stretch > 0) fit.tolerance /= stretch;
  // Files may leave it to their readers to find which edges are the same. Where that fails, faces stay unconnected.
  const Result<std::optional<JoinedShape>> joined =
      packing.trims ? joined_if_free(stated) : Result<std::optional<JoinedShape>>(std::optional<JoinedShape>());
  return make_patch_set(joined && *joined ? (*joined)->shape : stated, packing, fit);
}

/// Packs all shapes that have instances, side by side. Messages name the surfaces of a shape's first instance.
Result<Packed> pack_shapes(const Loaded& loaded, const PackOptions& options, Timings& timings) {
  const auto phase = timings.phase("pack");
  const Model& model = loaded.model;
  const std::size_t count = model.shapes.size();
  Packed packed{{}, true};
  for (std::size_t k = 0; k < count; ++k) packed.sets.push_back({{}, 0, 0, 0});
  for (const Instance& instance : model.instances) {
    PackedSet& shape = packed.sets[instance.shape];
    if (shape.count++ == 0) shape.first_surface = instance.first_surface;
    shape.stretch = std::max(shape.stretch, instance.placement->norm_bound());
  }
  std::vector<std::optional<Result<PatchSet>>> made(count);
  PartsProgress progress("packing", count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
    if (interrupted()) return;
    if (packed.sets[k].count > 0 && !model.shapes[k].faces.empty())
      made[k].emplace(pack_shape(loaded, model.shapes[k], packed.sets[k].stretch, options));
    progress.tell(k, 1);
  });
  if (interrupted()) return Status(StatusCode::cancelled, "interrupted");
  for (std::size_t k = 0; k < count; ++k) {
    if (!made[k]) continue;
    Result<PatchSet> set = with_places(loaded, packed.sets[k].first_surface, *std::move(made[k]));
    if (!set) return set.status();
    packed.sets[k].set = *std::move(set);
  }
  return packed;
}

}  // namespace

void add_untrimmed(Command& command, PackOptions& options) {
  command.add_flag("--untrimmed", "Ignore trimming loops: take whole surfaces", options.untrimmed);
}

Result<PatchSet> pack(const Loaded& loaded, const PackOptions& options, Timings& timings) {
  const auto phase = timings.phase("pack");
  PatchSetOptions packing;
  packing.trims = !options.untrimmed;
  return with_places(loaded, 0,
                     loaded.grids.empty() ? make_patch_set(loaded.model, packing, loaded.fit)
                                          : make_patch_set(loaded.model, loaded.grids, packing));
}

Result<Packed> pack_for_meshes(Loaded& loaded, const PackOptions& options, bool by_shapes, Timings& timings) {
  if (by_shapes) return pack_shapes(loaded, options, timings);
  if (Status status = add_patches(loaded, timings); !status.ok()) return status;
  Result<PatchSet> set = pack_faces(loaded, options, timings);
  if (!set) return set.status();
  Packed packed;
  packed.sets.emplace_back().set = *std::move(set);
  return packed;
}

Result<PatchSet> pack_joined(Loaded& loaded, const PackOptions& options, Timings& timings) {
  if (!options.untrimmed && !loaded.model.instances.empty()) {
    const Status status = timings.measure("join", [&] { return join_shapes(loaded.model); });
    if (!status.ok()) return in_file(loaded.files[0], status);
  }
  return pack_faces(loaded, options, timings);
}

Result<std::optional<JoinedShape>> joined_if_free(const Shape& shape) {
  if (shape.faces.size() > max_joined_faces) return std::optional<JoinedShape>();
  const Result<bool> is_open = has_free_edges(shape);
  if (!is_open) return is_open.status();
  if (!*is_open) return std::optional<JoinedShape>();
  const Result<double> distance = joining_distance(shape);
  if (!distance) return distance.status();
  if (!(*distance > 0)) return std::optional<JoinedShape>();
  Result<Shape> made = joined_edges(shape, *distance);
  if (!made) return made.status();
  return std::optional<JoinedShape>({*std::move(made), *distance});
}

}  // namespace tessera::cli
