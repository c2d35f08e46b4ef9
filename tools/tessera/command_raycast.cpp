// tessera raycast: pictures of surfaces, or the hits of rays from a file.

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "arguments.h"
#include "commands.h"
#include "csv.h"
#include "hits_table.h"
#include "loading.h"
#include "mesh_error.h"
#include "progress.h"
#include "raycast_footer.h"
#include "render/camera.h"
#include "render/caption.h"
#include "render/hit_image.h"
#include "terminal_picture.h"
#include "tessera/io.h"
#include "tessera/ray_scene.h"

namespace tessera::cli {
namespace {

struct Options {
  ModelOptions models;
  std::string picture, rays, hits, colour = "auto";
  bool terminal = false;
  bool sized = false;  // whether --size is on the command line
  bool all_hits = false;
  RayMode mode = RayMode::exact;
  int rate = 0;  // of grid mode; 0: chosen by the number of patches
  render::Settings settings;
  MeshErrorOptions error;
};

/// The data of a job. The scene refers to the set.
struct Scene {
  Loaded loaded;
  PatchSet set;
  RayScene rays;
  std::optional<MeshError> error;  ///< the error to shade, if any

  render::Settings settings(const Options& options) const {
    render::Settings own = options.settings;
    if (error) own.error = [this](const Vec3& point) { return error->share(point); };
    return own;
  }
  /// Captions for the lower border of the picture, the longest first. The first that fits is drawn.
  std::vector<std::string> captions() const {
    const std::string trims = trims_text(loaded.trimmed());
    std::vector<std::string> texts;
    if (error) texts = {error->caption() + (trims.empty() ? "" : ", trims not honoured")};
    if (!trims.empty()) texts.insert(texts.end(), {trims, "trims not honoured", "trims!"});
    return texts;
  }
};

/// Smaller models get finer grids: their facets then have about the size of pixels, and the scene of a large model
/// still fits into memory.
int scene_rate(std::size_t patches) {
  constexpr std::size_t segments = std::size_t{1} << 20;
  int rate = 64;
  while (rate > 8 && patches * static_cast<std::size_t>(rate * rate) > segments) rate /= 2;
  return rate;
}

const char* name_of(RayMode mode) { return mode == RayMode::exact ? "exact" : "grid"; }

Result<Scene> make_scene(Loaded loaded, const Options& asked, Timings& timings) {
  Result<PatchSet> set = pack(loaded, timings);
  if (!set) return set.status();
  const auto phase = timings.phase("build");
  Progress progress("building the scene");
  RaySceneOptions options;
  options.mode = asked.mode;
  options.rate = asked.rate > 0 ? asked.rate : scene_rate(set->patch_count());
  Result<RayScene> rays = RayScene::make(*set, options, progress.execution());
  if (!rays) return in_file(loaded.files[0], rays.status());
  return Scene{std::move(loaded), *std::move(set), *std::move(rays), {}};
}

Result<render::Image> draw(const Scene& scene, const render::Settings& settings, Timings& timings) {
  const auto phase = timings.phase("evaluate");
  Progress progress("casting rays");
  return render::render(scene.rays, scene.rays.box(), settings, progress.execution());
}

bool is_exr(const std::string& path) { return lower_extension(path) == ".exr"; }

/// Writes the picture, with a caption if the model is trimmed or an error is shown.
Status write_colours(const Job& job, const render::Settings& settings, const Scene& scene, OutputFile& out,
                     Timings& timings) {
  Result<render::Image> image = draw(scene, settings, timings);
  if (!image) return in_file(job.output, image.status());
  if (const std::vector<std::string> captions = scene.captions(); !captions.empty())
    render::add_caption(*image, captions);
  const std::string trims = trims_text(scene.loaded.trimmed());
  const auto phase = timings.phase("write");
  Status status =
      render::write_png(*image, out, trims.empty() ? render::PngTexts{} : render::PngTexts{{"Warning", trims}});
  return status.ok() ? out.commit() : status;
}

Status write_numbers(const Job& job, const render::Settings& settings, const Scene& scene, OutputFile& out,
                     Timings& timings) {
  const Result<render::HitImage> image = [&] {
    const auto phase = timings.phase("evaluate");
    Progress progress("casting rays");
    return render::cast_hits(scene.rays, scene.rays.box(), scene.loaded.model, settings, progress.execution());
  }();
  if (!image) return in_file(job.output, image.status());
  const auto phase = timings.phase("write");
  Status status = render::write_exr(*image, out);
  return status.ok() ? out.commit() : status;
}

Status draw_file(const Job& job, const Options& options, const CommonOptions& common, const Scene& scene,
                 OutputFile& out, Timings& timings) {
  const render::Settings settings = scene.settings(options);
  const Status written = is_exr(job.output) ? write_numbers(job, settings, scene, out, timings)
                                            : write_colours(job, settings, scene, out, timings);
  if (!written.ok()) return written;
  if (!common.json) {
    return print(job.output + ": " + std::to_string(settings.width) + " x " + std::to_string(settings.height) + ", " +
                 counted(scene.set.patch_count(), "patch", "patches") + "\n" +
                 (scene.error ? scene.error->text() : "") + fit_line(scene.set));
  }
  Json object = files_json(scene.loaded);
  object["output"] = job.output;
  object["width"] = settings.width;
  object["height"] = settings.height;
  object["mode"] = name_of(options.mode);
  const std::vector<std::string> captions = scene.captions();
  object["caption"] = is_exr(job.output) || captions.empty() ? "" : captions.front();
  if (scene.error) object["error"] = scene.error->json();
  add_model_facts(object, scene.loaded, scene.set);
  add_seconds(object, common, timings);
  return print_json(object);
}

Status draw_characters(const Options& options, const Scene& scene, OutputFile& out, Timings& timings) {
  render::Settings settings = scene.settings(options);
  if (!options.sized) {
    const PixelSize size = picture_size(terminal_size());
    settings.width = size.width;
    settings.height = size.height;
  }
  const Result<render::Image> image = draw(scene, settings, timings);
  if (!image) return in_file(scene.loaded.files[0], image.status());
  const auto phase = timings.phase("write");
  out.write(as_characters(*image, output_colours(options.colour)));
  const std::vector<std::string> captions = scene.captions();
  out.write(scene.loaded.files[0] + (captions.empty() ? "" : ": " + captions.front()) + "\n");
  return out.commit();
}

/// Casts rays. The result is lists of hits: one or none per ray for closest hits, or all.
Result<HitLists> cast(const Scene& scene, std::span<const Ray> rays, bool all, Timings& timings) {
  const auto phase = timings.phase("evaluate");
  Progress progress("casting rays");
  HitLists lists;
  if (all) {
    const Status status = scene.rays.all(rays, lists, progress.execution());
    return status.ok() ? Result<HitLists>(std::move(lists)) : status;
  }
  std::vector<Hit> hits(rays.size());
  if (const Status status = scene.rays.closest(rays, hits, progress.execution()); !status.ok()) return status;
  lists.first.push_back(0);
  for (const Hit& hit : hits) {
    if (hit.kind == HitKind::hit) lists.hits.push_back(hit);
    lists.first.push_back(lists.hits.size());
  }
  return lists;
}

Status trace(const Job& job, const Options& options, const CommonOptions& common, const Scene& scene,
             std::span<const Ray> rays, OutputFile& out, Timings& timings) {
  Result<HitLists> lists = cast(scene, rays, options.all_hits, timings);
  if (!lists) return lists.status();
  const HitCounts counts = use_own_parameters(scene.loaded.model, *lists);
  {
    const auto phase = timings.phase("write");
    write_hits(out, *lists);
    if (Status status = out.commit(); !status.ok()) return status;
  }
  const bool exact = options.mode == RayMode::exact;
  if (!common.json) {
    return print(job.output + ": " + counted(counts.rays, "ray") + ", " + counted(counts.hits, "hit") +
                 (options.all_hits ? ", " + counted(counts.points, "point") : "") + ", " +
                 (exact ? std::to_string(counts.uncertified) + " of them uncertified\n"
                        : std::to_string(counts.unrefined) + " of them on facets only\n"));
  }
  Json object = files_json(scene.loaded);
  object["output"] = job.output;
  object["mode"] = name_of(options.mode);
  object["rays"] = counts.rays;
  object["hits"] = counts.hits;
  object["points"] = counts.points;
  object["unrefined"] = counts.unrefined;
  object["uncertified"] = counts.uncertified;
  object["incomplete"] = counts.incomplete;
  add_model_facts(object, scene.loaded, scene.set);
  add_seconds(object, common, timings);
  return print_json(object);
}

Status run_raycast(const Job& job, const Options& options, const CommonOptions& common, Timings& timings) {
  Result<OutputFile> out = open_output(job.output);
  if (!out) return out.status();
  Result<Loaded> loaded = load(job, options.models.fit, With::patches, timings);
  if (!loaded) return loaded.status();
  std::vector<Ray> rays;
  if (!options.rays.empty()) {
    Result<std::vector<Ray>> read = read_rays(options.rays);
    if (!read) return read.status();
    rays = *std::move(read);
  }
  Result<Scene> scene = make_scene(*std::move(loaded), options, timings);
  if (!scene) return scene.status();
  if (options.settings.shade == render::Shade::error) {
    const auto phase = timings.phase("measure");
    Result<MeshError> error = measure_error(options.error, scene->set);
    if (!error) return error.status();
    scene->error = *std::move(error);
  }
  const Status status = !options.rays.empty()      ? trace(job, options, common, *scene, rays, *out, timings)
                        : !options.picture.empty() ? draw_file(job, options, common, *scene, *out, timings)
                                                   : draw_characters(options, *scene, *out, timings);
  return status.ok() ? scene->loaded.status() : status;
}

render::Camera parse_camera(const std::string& text) {
  const std::vector<double> n = parse_numbers("--camera", text, 7, "ex,ey,ez,tx,ty,tz,fovdeg");
  render::Camera camera;
  camera.eye = {n[0], n[1], n[2]};
  camera.target = {n[3], n[4], n[5]};
  camera.fov_degrees = n[6];
  const Status status = render::check(camera);
  if (!status.ok()) throw UsageError("--camera", status.message());
  return camera;
}

constexpr const char* picture_extension = ".png";

std::string fault_of_picture(const std::string& path) {
  if (is_folder(path)) return {};
  const std::string extension = lower_extension(path);
  if (extension == picture_extension || is_exr(path)) return {};
  return path + ": unsupported format \"" + extension + "\": pictures are written as .png, .exr";
}

const std::map<std::string, render::Shade> shades{
    {"lambert", render::Shade::lambert}, {"normals", render::Shade::normals}, {"uv", render::Shade::uv},
    {"patch", render::Shade::patch},     {"error", render::Shade::error},     {"curvature", render::Shade::curvature},
    {"steps", render::Shade::steps}};

/// Adds the options that make sense only with a picture, and returns them.
std::vector<const Option*> add_picture_options(Command& command, Options& options) {
  const auto set_size = [&options](const std::string& text) {
    const Extent size = parse_extent("--size", text, 1, 16384);
    options.settings.width = size.first;
    options.settings.height = size.second;
    options.sized = true;
  };
  const auto set_shade = [&options](const std::string& text) {
    options.settings.shade = shades.at(text);
    if (options.settings.shade == render::Shade::error) options.settings.samples = 2;  // distances are slow
  };
  const auto set_camera = [&options](const std::string& text) { options.settings.camera = parse_camera(text); };
  command.begin_group("Pictures");
  Option& picture =
      command
          .add_text("-o,--output", "FILE",
                    "The picture file (.png, .exr), a folder, or a name with {name} [the terminal]", options.picture)
          .check(fault_of_name)
          .check(fault_of_picture);
  return {&picture,
          &command.add("--size", "WxH", "Pixels of the picture, 1 to 16384 each [1280x800; the terminal's]", set_size),
          &command.add("--camera", "EX,EY,EZ,TX,TY,TZ,FOV",
                       "Eye, target, field of view in degrees over the picture's shorter side [a view from above that "
                       "fits the model]",
                       set_camera),
          &command.add_choice("--shade", {"lambert", "normals", "uv", "patch", "error", "curvature", "steps"},
                              "How surfaces are coloured [lambert]", set_shade),
          &command.add_flag("--terminal", "Draw on standard output, even if it is no terminal", options.terminal)
               .exclude(picture),
          &command
               .add_choice("--colour,--color", {"auto", "always", "never"},
                           "Colours in the terminal; \"always\" also in a pipe [auto]",
                           [&options](const std::string& text) { options.colour = text; })
               .exclude(picture)};
}

/// Adds --rays and --hits, which belong together and exclude pictures.
void add_ray_options(Command& command, Options& options, const std::vector<const Option*>& of_pictures) {
  command.begin_group("Hits of your own rays");
  Option& rays = command.add_text("--rays", "FILE.csv", "The table of rays to read", options.rays).check(fault_of_name);
  rays.need(
      command
          .add_text("--hits", "FILE.csv", "The table of hits to write, a folder, or a name with {name}", options.hits)
          .check(fault_of_name)
          .need(rays));
  command.add_flag("--all-hits", "Find all hits of each ray, not only the closest, in exact mode", options.all_hits)
      .need(rays);
  for (const Option* const picture : of_pictures) rays.exclude(*picture);
}

Plan plan_raycast(const Options& options, const CommonOptions& common) {
  if (!options.rays.empty()) {
    Plan plan = plan_jobs(options.models.files, options.hits, {"--hits", ".csv"});
    for (const Job& job : plan.jobs) refuse_overwriting("--hits", job.output, {options.rays});
    return plan;
  }
  const bool in_terminal = options.picture.empty();
  if (in_terminal && (common.json || (!options.terminal && !output_is_terminal()))) {
    throw UsageError("raycast",
                     "expected -o FILE, or --rays FILE.csv and --hits FILE.csv" +
                         std::string(common.json ? "" : ", or --terminal, as standard output is no terminal"));
  }
  return plan_jobs(options.models.files, options.picture, {"--output", picture_extension, false});
}

void add_mode(Command& command, Options& options) {
  command.begin_group("Method");
  command.add_choice(
      "--mode", {"grid", "exact"}, "Rays meet the surfaces (exact), or facets first (grid) [exact]",
      [&options](const std::string& text) { options.mode = text == "exact" ? RayMode::exact : RayMode::grid; });
  command.add_count(
      "--rate", "N",
      "Segments of a patch's grid in each direction in --mode grid, 1 to 256 [64, fewer for many patches]", 1, 256,
      [&options](std::size_t rate) { options.rate = static_cast<int>(rate); });
}

/// Rules that depend on the values of options.
void check_options(Command& command, const Options& options) {
  if (command.option("--shade").count > 0 && is_exr(options.picture))
    throw UsageError("--shade", "an .exr picture holds numbers and takes no --shade");
  check_error_options(command, options.settings.shade);
  if (options.all_hits && options.mode == RayMode::grid)
    throw UsageError("--all-hits", "needs --mode exact, found --mode grid");
  if (options.settings.shade == render::Shade::steps && options.mode == RayMode::grid)
    throw UsageError("--shade", "steps needs --mode exact, found --mode grid");
  if (options.rate > 0 && options.mode != RayMode::grid)
    throw UsageError("--rate", "needs --mode grid, found --mode exact");
}

}  // namespace

void add_raycast(Command& tool, Session& session) {
  Command& command = tool.add_command("raycast", "Draw pictures with rays, or find the hits of your own rays");
  const auto options = std::make_shared<Options>();
  add_models(command, options->models);
  const std::vector<const Option*> of_pictures = add_picture_options(command, *options);
  add_error_options(command, options->error, command.option("--shade"));
  add_ray_options(command, *options, of_pictures);
  add_mode(command, *options);
  add_fit(command, options->models);
  add_common(command, session.common);
  command.footer = raycast_footer;
  command.choose = [options, &command, &session] {
    check_options(command, *options);
    const Plan plan = plan_raycast(*options, session.common);
    session.command = [options, plan, &session] {
      return run_jobs(plan, session.common, [&](const Job& job, Timings& timings) {
        return run_raycast(job, *options, session.common, timings);
      });
    };
  };
}

}  // namespace tessera::cli
