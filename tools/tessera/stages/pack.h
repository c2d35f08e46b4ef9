#pragma once
// The stage after load: a model becomes sets of patches.

#include <optional>
#include <vector>

#include "stages/load.h"
#include "tessera/patch_set.h"

namespace tessera::cli {

struct PackOptions {
  bool untrimmed = false;  ///< whether trimming loops are ignored
};
/// Adds --untrimmed.
void add_untrimmed(Command& command, PackOptions& options);

/// Packs what trimming loops keep of all patches into a set; with options.untrimmed, all of them. Prints a warning for
/// each surface whose loops cannot be used. Errors name file and surface.
Result<PatchSet> pack(const Loaded& loaded, const PackOptions& options, Timings& timings);

/// A set that is meshed once and seen `count` times, at most `stretch` times as large.
struct PackedSet {
  std::optional<PatchSet> set;  ///< none: a shape without instances or without faces
  std::size_t count = 1, first_surface = 0;
  double stretch = 1;
};

/// The sets of a model: one of all surfaces, or one of each shape.
struct Packed {
  std::vector<PackedSet> sets;
  bool by_shapes = false;
};

/// Packs as pack(), for meshes. If some surface is trimmed, edges that run side by side are joined where the file
/// states none, or free ones, so that faces meet along them; where that fails, faces stay unconnected.
Result<Packed> pack_for_meshes(Loaded& loaded, const PackOptions& options, bool by_shapes, Timings& timings);

/// Packs all surfaces of a model that has its patches into one set. Edges that run side by side are joined as above, in
/// shapes too, so that faces meet along them and closed shells are closed. Errors name file and surface.
Result<PatchSet> pack_joined(Loaded& loaded, const PackOptions& options, Timings& timings);

/// A shape whose edges joined_edges() has joined within a distance.
struct JoinedShape {
  Shape shape;
  double distance = 0;
};
inline constexpr std::size_t max_joined_faces = 20000;
/// Joins the edges of a shape within joining_distance(). Empty where nothing is to be joined: all edges have two faces,
/// or there are more than max_joined_faces. Errors: those of joined_edges().
Result<std::optional<JoinedShape>> joined_if_free(const Shape& shape);

}  // namespace tessera::cli
