#pragma once
// The parts of tessera raycast: the scene, pictures of it, and hits of the user's rays.

#include <optional>
#include <string>
#include <vector>

#include "batch/team.h"
#include "picture/mesh_error.h"
#include "render/mesh_distance.h"
#include "render/mesh_patches.h"
#include "render/render.h"
#include "stages/pack.h"
#include "tessera/ray_scene.h"

namespace tessera::cli {

struct RaycastOptions {
  LoadOptions load;
  PackOptions pack;
  std::string picture, format, rays, hits, colour = "auto";
  bool terminal = false;
  bool sized = false;   ///< whether --size is on the command line
  bool shaded = false;  ///< whether --shade is on the command line
  bool edges = false;
  bool all_hits = false;
  RayMode mode = RayMode::exact;
  int rate = 0;  ///< of grid mode; 0: chosen by the number of patches
  render::Settings settings;
  MeshErrorOptions error;
  Team* team = nullptr;        ///< null: this process alone
  bool data_parallel = false;  ///< whether each process of the team has a run of the patches

  /// Whether this process writes the results.
  bool writes() const { return !team || team->leads(); }
};

/// The data of a job: surfaces, or meshes whose triangles are the patches. The scene refers to the set.
struct RaycastScene {
  Loaded loaded;  ///< without surfaces for meshes
  PatchSet set;
  RayScene rays;
  std::optional<render::MeshPatches> meshes;
  std::optional<MeshError> error;                    ///< the error to shade, if any
  std::optional<render::MeshDistance> borders = {};  ///< where surfaces end, to draw as lines
  std::vector<std::optional<Colour>> colours = {};   ///< of the patches of surfaces; none: no face has a colour
  double mesh_bound = 0;                             ///< of the mesh that surfaces are drawn by; 0 if they are not
  bool keeps_trims = false;                          ///< whether that mesh is of what loops keep
  std::optional<std::uint64_t> first_patch = {};     ///< if the set has only a run of the patches
  std::optional<std::size_t> all_patches = {};       ///< then how many there are
  std::optional<Box3> all_box = {};                  ///< and their box

  /// The options' settings, with what this scene adds.
  render::Settings settings(const RaycastOptions& options) const;
  /// Captions for the lower border of the picture, the longest first. The first that fits is drawn.
  std::vector<std::string> captions() const;
  /// How surfaces are drawn, as "drawn by a mesh within 0.001 of the surfaces"; empty if rays meet them as they are.
  std::string surfaces_caption() const;
  std::string counted_parts() const;  ///< "32 patches", "1 triangle"
  Box3 box() const { return all_box ? *all_box : rays.box(); }
  std::size_t patch_count() const { return all_patches ? *all_patches : set.patch_count(); }
  /// Finds the closest hits, with the team if there is one: see Team::closest().
  Status closest(const RaycastOptions& options, std::span<const Ray> of, std::span<Hit> hits,
                 const Execution& execution) const;
};

/// Reads the models or meshes of a job, and builds the scene. Errors: those of reading; invalid_argument (surfaces and
/// meshes in one job; options that meshes cannot have); those of the scene.
Result<RaycastScene> make_scene(const Job& job, const RaycastOptions& options, Timings& timings);

/// "exact" or "grid".
const char* name_of(RayMode mode);
bool is_exr(const std::string& path);

/// Draws the job's picture into its file, and reports it.
Status draw_file(const Job& job, const RaycastOptions& options, const CommonOptions& common, const RaycastScene& scene,
                 OutputFile& out, Timings& timings);
/// Draws the picture with characters.
Status draw_characters(const RaycastOptions& options, const RaycastScene& scene, OutputFile& out, Timings& timings);
/// Casts the user's rays, writes the table of hits, and reports it.
Status write_ray_hits(const Job& job, const RaycastOptions& options, const CommonOptions& common,
                      const RaycastScene& scene, std::span<const Ray> rays, OutputFile& out, Timings& timings);

}  // namespace tessera::cli
