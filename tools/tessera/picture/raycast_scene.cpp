// Scenes of surfaces and of meshes.

#include <algorithm>

#include "console/output.h"
#include "console/progress.h"
#include "picture/raycast.h"
#include "render/face_borders.h"
#include "tessera/io.h"
#include "tessera/tessellation.h"

namespace tessera::cli {
namespace {

/// Smaller models get finer grids: their facets then have about the size of pixels, and the scene of a large model
/// still fits into memory.
int scene_rate(std::size_t patches) {
  constexpr std::size_t segments = std::size_t{1} << 20;
  int rate = 64;
  while (rate > 8 && patches * static_cast<std::size_t>(rate * rate) > segments) rate /= 2;
  return rate;
}

bool holds_only_meshes(const std::string& path) {
  const std::string extension = lower_extension(path);
  return extension == ".ply" || extension == ".stl" || extension == ".glb" || extension == ".gltf";
}

/// Whether a file is a mesh. An .obj file is one if it has no surfaces that can be read, but faces.
bool is_mesh(const std::string& path) {
  if (holds_only_meshes(path)) return true;
  if (lower_extension(path) != ".obj") return false;
  const Result<Model> model = read_model(path);
  if (model || model.status().code() != StatusCode::unsupported) return false;
  const Result<Mesh> mesh = read_mesh(path);
  return mesh && mesh->triangle_count() > 0;
}

/// Refuses options that need surfaces.
Status check_mesh_options(const std::string& mesh, const Job& job, const RaycastOptions& options) {
  using enum render::Shade;
  const render::Shade shade = options.settings.shade;
  std::string wants;
  if (!options.rays.empty()) wants = "--rays needs";
  if (is_exr(format_path(job.output, options.format))) wants = "an .exr picture needs";
  if (shade == error || shade == curvature || shade == uv) wants = "--shade error, curvature and uv need";
  if (wants.empty()) return {};
  return {StatusCode::invalid_argument, wants + " surfaces, found the mesh " + mesh};
}

Result<RayScene> build(const PatchSet& set, const RaycastOptions& asked, const std::string& file, Timings& timings,
                       const std::optional<Box3>& box = {}) {
  const auto phase = timings.phase("build");
  Progress progress("building the scene");
  RaySceneOptions options;
  options.mode = asked.mode;
  options.rate = asked.rate > 0 ? asked.rate : scene_rate(set.patch_count());
  options.box = box;
  Result<RayScene> rays = RayScene::make(set, options, progress.execution());
  return rays ? std::move(rays) : in_file(file, rays.status());
}

/// Reads a mesh and adds its triangles.
Status add_mesh(const std::string& file, render::MeshPatches& meshes) {
  const Result<Mesh> mesh = read_mesh(file, {.keep_quads = true});
  if (!mesh) return mesh.status();
  const Status status = meshes.add(*mesh);
  return status.ok() ? status : in_file(file, status);
}

Result<RaycastScene> make_mesh_scene(const Job& job, const RaycastOptions& options, Timings& timings) {
  Loaded loaded;
  render::MeshPatches meshes;
  for (const std::string& file : job.inputs) {
    const auto phase = timings.phase("read");
    if (Status status = add_mesh(file, meshes); !status.ok()) return status;
    loaded.files.push_back(file);
  }
  Result<PatchSet> set = timings.measure("pack", [&] { return meshes.pack(); });
  if (!set) return in_file(job.inputs[0], set.status());
  Result<RayScene> rays = build(*set, options, job.inputs[0], timings);
  if (!rays) return rays.status();
  return RaycastScene{std::move(loaded), *std::move(set), *std::move(rays), std::move(meshes), {}};
}

/// The colours of patches: those of faces, or else of their instances. None if no face has one.
std::vector<std::optional<Colour>> colours_of(const Model& model, const PatchSet& set) {
  std::vector<std::optional<Colour>> of_surfaces(model.surfaces.size()), colours;
  for (const Instance& instance : model.instances) {
    const std::vector<ShapeFace>& faces = model.shapes[instance.shape].faces;
    for (std::size_t k = 0; k < faces.size(); ++k)
      of_surfaces[instance.first_surface + k] = faces[k].colour ? faces[k].colour : instance.colour;
  }
  if (std::ranges::none_of(of_surfaces, [](const auto& colour) { return colour.has_value(); })) return colours;
  for (std::size_t k = 0; k < set.patch_count(); ++k) colours.push_back(of_surfaces[set.source(k).surface]);
  return colours;
}

/// Whether a picture shows the shape alone, so that a mesh can stand for the surfaces.
bool shows_shape(const Job& job, const RaycastOptions& options) {
  using enum render::Shade;
  const render::Shade shade = options.settings.shade;
  const bool needs_surfaces = shade == error || shade == curvature || shade == uv || shade == patch || shade == steps;
  return !needs_surfaces && options.rays.empty() && !is_exr(format_path(job.output, options.format));
}

/// The lines where surfaces end, if any does. A triangle's face is the surface that it lies on.
Result<std::optional<render::MeshDistance>> borders_of(const Mesh& mesh, const PatchSet& surfaces) {
  std::vector<std::uint32_t> faces;
  faces.reserve(mesh.patches.size());
  for (const std::uint32_t patch : mesh.patches) faces.push_back(surfaces.source(patch).surface);
  const Mesh borders = render::face_borders(mesh, faces);
  if (borders.indices.empty()) return std::optional<render::MeshDistance>();
  Result<render::MeshDistance> made = render::MeshDistance::make(borders);
  if (!made) return made.status();
  return std::optional(*std::move(made));
}

/// Makes a scene of the mesh of surfaces, which knows where they end.
Result<RaycastScene> make_drawn_scene(Loaded loaded, const PatchSet& surfaces, const RaycastOptions& options,
                                      Timings& timings) {
  constexpr double share_of_size = 2e-4;  // below a pixel in pictures of up to 2000 pixels
  render::MeshPatches meshes;
  std::optional<render::MeshDistance> borders;
  double bound = 0;
  {
    const auto phase = timings.phase("mesh");
    Progress progress("meshing the surfaces");
    const Result<Tessellation> plan = Tessellation::make(
        surfaces, {.tolerance = share_of_size, .relative = true, .parameters = VertexParameters::patch},
        progress.execution());
    if (!plan) return in_file(loaded.files[0], plan.status());
    Result<Mesh> mesh = plan->allocate();
    if (!mesh) return mesh.status();
    if (Status status = plan->run(surfaces, mesh->views()); !status.ok()) return status;
    if (Status status = meshes.add(*mesh); !status.ok()) return status;
    bound = plan->bound();
    if (options.edges) {
      Result<std::optional<render::MeshDistance>> made = borders_of(*mesh, surfaces);
      if (!made) return made.status();
      borders = *std::move(made);
    }
  }
  Result<PatchSet> set = meshes.pack();
  if (!set) return in_file(loaded.files[0], set.status());
  Result<RayScene> rays = build(*set, options, loaded.files[0], timings);
  if (!rays) return rays.status();
  RaycastScene scene{std::move(loaded), *std::move(set), *std::move(rays), std::move(meshes), {}, std::move(borders)};
  scene.colours = colours_of(scene.loaded.model, surfaces);
  scene.mesh_bound = bound;
  scene.keeps_trims = surfaces.cut_count() > 0;
  return scene;
}

/// Makes a set of a run of a set's patches. Errors: unsupported (trims, shapes), those of PatchSet::make().
Result<PatchSet> part_of_set(const PatchSet& set, const Model& model, const PartRun& run) {
  const auto unsupported = [](const char* what) {
    return Status(StatusCode::unsupported, std::string("--data-parallel: the model has ") + what +
                                               ", and parts of it would not know how these go on in other parts");
  };
  if (!model.instances.empty()) return unsupported("shapes with edges");
  if (set.cut_count() > 0) return unsupported("trimmed patches");
  std::vector<BezierPatch> patches;
  std::vector<PatchSource> sources;
  for (std::size_t k = run.begin; k < run.end; ++k) {
    patches.push_back(set.patch(k));
    sources.push_back(set.source(k));
  }
  return PatchSet::make(patches, {.blocks = set.blocks(), .fit_error = set.fit_error(), .sources = sources});
}

/// Makes the scene of this process's run of the patches.
Result<RaycastScene> make_part_scene(Loaded loaded, const PatchSet& whole, const RaycastOptions& options,
                                     Timings& timings) {
  const PartRun run = options.team->run_of(whole.patch_count());
  if (run.begin == run.end)
    return in_file(loaded.files[0],
                   Status(StatusCode::invalid_argument, "--data-parallel: there are fewer patches than ranks: " +
                                                            counted(whole.patch_count(), "patch", "patches")));
  Result<PatchSet> set = part_of_set(whole, loaded.model, run);
  if (!set) return in_file(loaded.files[0], set.status());
  Result<RayScene> rays = build(*set, options, loaded.files[0], timings, whole.box());
  if (!rays) return rays.status();
  const Result<Box3> box = options.team->common_box(rays->box());
  if (!box) return box.status();
  loaded.grids = {};
  RaycastScene scene{std::move(loaded), *std::move(set), *std::move(rays), {}, {}};
  scene.first_patch = run.begin;
  scene.all_patches = whole.patch_count();
  scene.all_box = *box;
  return scene;
}

Result<RaycastScene> make_surface_scene(const Job& job, const RaycastOptions& options, Timings& timings) {
  Result<Loaded> loaded = load(job, options.load, With::patches, timings);
  if (!loaded) return loaded.status();
  Result<PatchSet> set = pack(*loaded, options.pack, timings);
  if (!set) return set.status();
  if (options.data_parallel) return make_part_scene(*std::move(loaded), *set, options, timings);
  if (options.edges && shows_shape(job, options)) return make_drawn_scene(*std::move(loaded), *set, options, timings);
  if (options.edges)
    return Status(StatusCode::invalid_argument, "--edges needs --shade lambert, normals or clay, and a .png picture");
  Result<RayScene> rays = build(*set, options, loaded->files[0], timings);
  if (!rays) return rays.status();
  RaycastScene scene{*std::move(loaded), *std::move(set), *std::move(rays), {}, {}};
  scene.colours = colours_of(scene.loaded.model, scene.set);
  if (options.settings.shade == render::Shade::error) {
    Result<MeshError> error = timings.measure("measure", [&] { return measure_error(options.error, scene.set); });
    if (!error) return error.status();
    scene.error = *std::move(error);
  }
  return scene;
}

}  // namespace

const char* name_of(RayMode mode) { return mode == RayMode::exact ? "exact" : "grid"; }

bool is_exr(const std::string& path) { return lower_extension(path) == ".exr"; }

render::Settings RaycastScene::settings(const RaycastOptions& options) const {
  render::Settings own = options.settings;
  if (error) own.error = [this](const Vec3& point) { return error->share(point); };
  if (meshes) own.normal = [this](const Hit& hit) { return meshes->normal(hit); };
  if (!colours.empty())
    own.colour = [this](const Hit& hit) { return colours[meshes ? meshes->patch(hit) : hit.patch]; };
  if (borders)
    own.nearest_edge = [this](const Hit& hit, double within) { return borders->nearest(hit.position, within); };
  else if (meshes && options.edges)
    own.nearest_edge = [this](const Hit& hit, double) { return meshes->nearest_edge(hit); };
  return own;
}

std::vector<std::string> RaycastScene::captions() const {
  std::vector<std::string> texts;
  if (error) texts = {error->caption()};
  if (mesh_bound > 0)
    texts.insert(texts.end(),
                 {surfaces_caption(), keeps_trims ? "trimmed, drawn by a mesh" : "drawn by a mesh", "mesh"});
  return texts;
}

std::string RaycastScene::surfaces_caption() const {
  const std::string mesh = "drawn by a mesh within " + readable(mesh_bound, 2) + " of ";
  if (mesh_bound > 0 && keeps_trims)
    return counted(loaded.trimmed(), "surface is", "surfaces are") + " trimmed: " + mesh + "what is kept";
  if (mesh_bound > 0) return mesh + "the surfaces";
  return {};
}

std::string RaycastScene::counted_parts() const {
  return meshes ? counted(meshes->triangle_count(), "triangle") : counted(patch_count(), "patch", "patches");
}

Status RaycastScene::closest(const RaycastOptions& options, std::span<const Ray> of, std::span<Hit> hits,
                             const Execution& execution) const {
  return options.team ? options.team->closest(rays, first_patch, of, hits, execution)
                      : rays.closest(of, hits, execution);
}

Result<RaycastScene> make_scene(const Job& job, const RaycastOptions& options, Timings& timings) {
  std::vector<std::string> meshes, models;
  for (const std::string& file : job.inputs) (is_mesh(file) ? meshes : models).push_back(file);
  if (!meshes.empty() && !models.empty())
    return Status(StatusCode::invalid_argument, "a picture shows surfaces or meshes, found the mesh " + meshes[0] +
                                                    " and the surfaces of " + models[0]);
  if (!meshes.empty()) {
    if (Status status = check_mesh_options(meshes[0], job, options); !status.ok()) return status;
  }
  return meshes.empty() ? make_surface_scene(job, options, timings) : make_mesh_scene(job, options, timings);
}

}  // namespace tessera::cli
