// tessera raycast: a picture of surfaces, or the hits of given rays.

#include <map>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "console.h"
#include "csv.h"
#include "io/formats.h"
#include "model_file.h"
#include "render/camera.h"
#include "render/hit_image.h"
#include "tessera/ray_scene.h"

namespace tessera::cli {
namespace {

struct Options {
  ModelFile model;
  std::string picture, rays, hits;
  render::Settings settings;
};

/// Finer grids for smaller models: facets then are near the pixels' size, and a large model's scene still fits memory.
int scene_rate(std::size_t patches) {
  constexpr std::size_t segments = std::size_t{1} << 20;
  int rate = 64;
  while (rate > 8 && patches * static_cast<std::size_t>(rate * rate) > segments) rate /= 2;
  return rate;
}

Result<RayScene> make_scene(const PatchSet& set) {
  Progress progress("building the scene");
  RaySceneOptions options;
  options.rate = scene_rate(set.patch_count());
  return RayScene::make(set, options, progress.execution());
}

bool is_exr(const std::string& path) { return lower_extension(path) == ".exr"; }

/// What is in the picture, and how long it took to cast.
Status cast_picture(const Options& options, const Model& model, const RayScene& scene, OutputFile& out,
                    double& seconds) {
  const Stopwatch drawing;
  const auto cast = [&](const auto& make, const auto& write) {
    const auto image = [&] {
      Progress progress("casting rays");
      return make(progress.execution());
    }();
    if (!image) return in_file(options.picture, image.status());
    seconds = drawing.seconds();
    return write(*image);
  };
  const Box3 box = scene.box();
  const render::Settings& settings = options.settings;
  if (is_exr(options.picture))
    return cast([&](const Execution& e) { return render::cast_hits(scene, box, model, settings, e); },
                [&](const render::HitImage& image) { return render::write_exr(image, out); });
  return cast([&](const Execution& e) { return render::render(scene, box, settings, e); },
              [&](const render::Image& image) { return render::write_png(image, out); });
}

Status draw(const Options& options, const Model& model, const PatchSet& set, const RayScene& scene,
            double scene_seconds, OutputFile& out) {
  double draw_seconds = 0;
  Status status = cast_picture(options, model, scene, out, draw_seconds);
  if (status.ok()) status = out.commit();
  if (!status.ok()) return status;
  const render::Settings& settings = options.settings;
  return print(options.picture + ": " + std::to_string(settings.width) + " x " + std::to_string(settings.height) +
               ", " + std::to_string(set.patch_count()) + " patches; scene built in " +
               readable_seconds(scene_seconds) + ", picture cast in " + readable_seconds(draw_seconds) + "\n" +
               fit_line(set));
}

constexpr std::string_view hits_header = "ray,hit,t,surface,patch,u,v,x,y,z,nx,ny,nz\n";

void write_hit(OutputFile& out, std::size_t ray, const Hit& hit) {
  constexpr int digits = 17;
  out.write_number(ray);
  if (hit.kind != HitKind::hit) return out.write(",0,,,,,,,,,,,\n");
  out.write(",1,");
  out.write_number(hit.t, digits);
  out.write(',');
  out.write_number(hit.surface);
  out.write(',');
  out.write_number(hit.patch);
  for (const double value :
       {hit.u, hit.v, hit.position.x, hit.position.y, hit.position.z, hit.normal.x, hit.normal.y, hit.normal.z}) {
    out.write(',');
    out.write_number(value, digits);
  }
  out.write('\n');
}

Status trace(const Options& options, const Model& model, const RayScene& scene, std::span<const Ray> rays,
             OutputFile& out) {
  std::vector<Hit> hits(rays.size());
  const Stopwatch tracing;
  Status status = [&] {
    Progress progress("casting rays");
    return scene.closest(rays, hits, progress.execution());
  }();
  if (!status.ok()) return status;
  const double seconds = tracing.seconds();
  out.write(hits_header);
  for (std::size_t k = 0; k < hits.size() && !out.failed(); ++k) {
    Hit& hit = hits[k];
    if (hit.kind == HitKind::hit) {
      const auto own = own_parameters(model.surfaces[hit.surface].surface, hit.u, hit.v);
      hit.u = own[0];
      hit.v = own[1];
    }
    write_hit(out, k, hit);
  }
  status = out.commit();
  if (!status.ok()) return status;
  std::size_t found = 0, unrefined = 0;
  for (const Hit& hit : hits) {
    found += hit.kind == HitKind::hit;
    unrefined += hit.kind == HitKind::hit && hit.flags.unrefined;
  }
  return print(options.hits + ": " + std::to_string(hits.size()) + " rays, " + std::to_string(found) + " hits, " +
               std::to_string(unrefined) + " of them on facets only; cast in " + readable_seconds(seconds) + "\n");
}

Status run_raycast(const Options& options) {
  Result<OutputFile> out = open_output(options.rays.empty() ? options.picture : options.hits);
  if (!out) return out.status();
  const Result<Model> model = open_model(options.model);
  if (!model) return model.status();
  std::vector<Ray> rays;
  if (!options.rays.empty()) {
    Result<std::vector<Ray>> read = read_rays(options.rays);
    if (!read) return read.status();
    rays = *std::move(read);
  }
  const Result<PatchSet> set = make_patch_set(options.model, *model);
  if (!set) return set.status();
  const Stopwatch building;
  const Result<RayScene> scene = make_scene(*set);
  if (!scene) return in_file(options.model.path, scene.status());
  if (!options.rays.empty()) return trace(options, *model, *scene, rays, *out);
  return draw(options, *model, *set, *scene, building.seconds(), *out);
}

render::Camera parse_camera(const std::string& text) {
  const std::vector<double> n = parse_numbers("--camera", text, 7, "ex,ey,ez,tx,ty,tz,fovdeg");
  render::Camera camera;
  camera.eye = {n[0], n[1], n[2]};
  camera.target = {n[3], n[4], n[5]};
  camera.fov_degrees = n[6];
  const Status status = render::check(camera);
  if (!status.ok()) throw CLI::ValidationError("--camera", status.message());
  return camera;
}

std::string fault_of_picture(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".png" || is_exr(path)) return {};
  return path + ": unsupported format \"" + extension + "\": pictures are written as .png, .exr";
}

constexpr const char* footer =
    "A picture: -o, with --size, --shade and --camera. The default camera fits the model; its up is the z axis.\n"
    ".exr holds numbers, of one ray through the middle of each pixel: floats Z (distance from the eye), N.X N.Y N.Z,\n"
    "UV.U UV.V (parameters of the surface), integers surface and patch; where nothing is met Z is inf, the integers "
    "4294967295.\n"
    "Hits of given rays: --rays and --hits. Rays are a table with the header line ox,oy,oz,dx,dy,dz or\n"
    "ox,oy,oz,dx,dy,dz,tnear,tfar: numbers of at most 1.844e18, the direction not zero, 0 <= tnear <= tfar, tfar may "
    "be inf;\n"
    "# begins a comment. Hits are the table ray,hit,t,surface,patch,u,v,x,y,z,nx,ny,nz, a row for each ray in the\n"
    "order of the rays, counted from 0; a miss has hit = 0 and empty fields. 17 significant digits.\n"
    "\nExamples:\n"
    "  tessera raycast teapot.bpt -o teapot.png --size 1280x720\n"
    "  tessera raycast teapot.bpt -o teapot.png --shade normals --camera=4,-8,5,0,0,1.5,40\n"
    "  tessera raycast teapot.bpt --rays rays.csv --hits hits.csv";

const std::map<std::string, render::Shade> shades{{"lambert", render::Shade::lambert},
                                                  {"normals", render::Shade::normals},
                                                  {"uv", render::Shade::uv},
                                                  {"patch", render::Shade::patch}};

/// The options that make sense with a picture alone. Returns --shade.
CLI::Option* add_picture_options(CLI::App& command, CLI::Option* picture, render::Settings& settings) {
  const auto set_size = [&settings](const std::string& text) {
    const Extent size = parse_extent("--size", text, 1, 16384);
    settings.width = size.first;
    settings.height = size.second;
  };
  const auto set_shade = [&settings](const std::string& text) { settings.shade = shades.at(text); };
  const auto set_camera = [&settings](const std::string& text) { settings.camera = parse_camera(text); };
  command.add_option_function<std::string>("--size", set_size, "Pixels of the picture, 1 to 16384 each [1280x800]")
      ->type_name("WxH")
      ->needs(picture);
  CLI::Option* const shade =
      command.add_option_function<std::string>("--shade", set_shade, "How surfaces are coloured [lambert]")
          ->check(CLI::IsMember({"lambert", "normals", "uv", "patch"}))
          ->needs(picture);
  command
      .add_option_function<std::string>("--camera", set_camera,
                                        "Eye, target, field of view in degrees over the picture's shorter side")
      ->type_name("ex,ey,ez,tx,ty,tz,fovdeg")
      ->needs(picture);
  return shade;
}

}  // namespace

void add_raycast(CLI::App& app, Session& session) {
  CLI::App* const command = app.add_subcommand("raycast", "Draw a picture by rays, or find the hits of given rays");
  const auto options = std::make_shared<Options>();
  add_model(*command, options->model);
  CLI::Option* const picture =
      command->add_option("-o,--output", options->picture, "The picture to be written (.png, .exr)");
  picture->check(fault_of_picture)->type_name("PICTURE");
  const CLI::Option* const shade = add_picture_options(*command, picture, options->settings);
  CLI::Option* const rays = command->add_option("--rays", options->rays, "The table of rays");
  rays->check(fault_of_name)->type_name("FILE.csv");
  CLI::Option* const hits = command->add_option("--hits", options->hits, "The table of hits to be written");
  hits->check(fault_of_name)->type_name("OUT.csv")->needs(rays);
  rays->needs(hits)->excludes(picture);
  command->footer(footer);
  command->callback([options, shade, &session] {
    if (options->picture.empty() && options->rays.empty()) {
      throw CLI::ValidationError("raycast", "expected -o PICTURE, or --rays FILE.csv and --hits OUT.csv");
    }
    if (shade->count() > 0 && is_exr(options->picture)) {
      throw CLI::ValidationError("--shade", "pictures of numbers (.exr) have no shade");
    }
    refuse_overwriting("--output", options->picture, {options->model.path});
    refuse_overwriting("--hits", options->hits, {options->model.path, options->rays});
    session.command = [options] { return run_raycast(*options); };
  });
}

}  // namespace tessera::cli
