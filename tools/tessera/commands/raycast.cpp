// tessera raycast: pictures of surfaces, or the hits of rays from a file.

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "commands/commands.h"
#include "console/output.h"
#include "console/terminal.h"
#include "line/arguments.h"
#include "picture/raycast.h"
#include "picture/view_options.h"
#include "table/csv.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

constexpr const char* raycast_footer =
    R"(Pictures: -o, with --size, --shade and --camera. The default camera fits the model; --up names the axis that points up.
Several models are one scene, or one picture each if the output is a folder or contains {name}. Rays see what trimming loops
keep; --untrimmed takes surfaces whole.
--shade error shows the distance of a mesh from the surfaces: deep blue where it is near, red at the proven bound of
a certified mesh or at the largest distance found of your own mesh, magenta beyond.
--shade lambert and clay show the colours that a CAD file states for faces or instances; other faces are white and
grey. --shade clay has no floor.
--shade curvature shows Gaussian curvature: domes are red, saddles blue, and grey is zero. --shade steps shows the
cost of each pixel's ray in --mode exact, in pieces of patches looked at and parts of them searched: blue for one,
red for 256 and more.
A bar in the picture says which number a colour stands for.
Meshes (.ply, .stl, .glb, .gltf, and .obj with faces) are drawn by their normals. --shade error, curvature and uv,
.exr and --rays need surfaces.
--edges draws a line wherever a surface, or a face of a CAD part, ends or meets another; seams have none. A mesh
within 0.0002 of the size then stands for the surfaces, as the picture says at its lower border and in its metadata
(Warning), and --shade is lambert, normals or clay. The lines of a mesh file are the edges of its
triangles.
.exr holds numbers of one ray through the middle of each pixel: the floats Z (distance from the eye), N.X N.Y N.Z,
UV.U UV.V (parameters of the surface), and the integers surface and patch. For a miss, Z is inf and the integers
are 4294967295.
Without -o the picture is drawn in the terminal, one model after the other, two pixels per character. It has 24-bit
colours if COLORTERM names them, 256 colours if TERM does, and otherwise plain characters, as in a pipe or with
NO_COLOR.
Hits of your own rays: --rays and --hits. Rays are a table with the header line ox,oy,oz,dx,dy,dz or
ox,oy,oz,dx,dy,dz,tnear,tfar. Numbers are at most 1.844e18, the direction is not zero, 0 <= tnear <= tfar, and tfar
may be inf; # begins a comment. Hits are the table ray,hit,t,surface,patch,u,v,x,y,z,nx,ny,nz,edge,name with 17
significant digits. edge is 1 if the ray passes an edge of a shape within its gap; name is that of the surface
or face, if it has one. The table has one row for each ray, in the order of the rays, counted from 0. A miss has
hit = 0 and empty fields. With --all-hits a ray has one row for each of its hits, in the order of t.
--mode exact meets the surface itself, silhouettes too. --mode grid meets facets first and then the surface, and may
miss a silhouette.

Examples:
  tessera raycast teapot.bpt
  tessera raycast teapot.bpt -o teapot.png --size 1280x720
  tessera raycast teapot.bpt -o teapot.png --shade normals --camera=4,-8,5,0,0,1.5,40
  tessera raycast teapot.bpt -o error.png --shade error --relative 0.003
  tessera raycast teapot.bpt -o error.png --shade error --mesh teapot.stl
  tessera raycast part.step -o part.png --edges --shade clay
  tessera raycast teapot.stl -o edges.png --edges --shade clay --up y
  tessera raycast teapot.bpt -o cost.png --shade steps
  tessera raycast teapot.bpt -o facets.png --mode grid --rate 4
  tessera raycast 'parts/*.step' -o 'pictures/{name}.png'
  tessera raycast teapot.bpt --rays rays.csv --hits hits.csv
  tessera raycast teapot.bpt --rays rays.csv --hits hits.csv --all-hits)";

Status run_raycast(const Job& job, const RaycastOptions& options, const CommonOptions& common, Timings& timings) {
  Result<OutputFile> out = open_output(job.output, options.writes());
  if (!out) return out.status();
  std::vector<Ray> rays;
  if (!options.rays.empty()) {
    Result<std::vector<Ray>> read = read_rays(options.rays);
    if (!read) return read.status();
    rays = *std::move(read);
  }
  const Result<RaycastScene> scene = make_scene(job, options, timings);
  if (!scene) return scene.status();
  const Status status = !options.rays.empty()      ? write_ray_hits(job, options, common, *scene, rays, *out, timings)
                        : !options.picture.empty() ? draw_file(job, options, common, *scene, *out, timings)
                                                   : draw_characters(options, *scene, *out, timings);
  return status.ok() ? scene->loaded.status() : status;
}

constexpr const char* picture_extension = ".png";

std::string fault_of_picture(const std::string& path) {
  if (is_folder(path) || is_stream(path)) return {};
  const std::string extension = lower_extension(path);
  if (extension == picture_extension || is_exr(path)) return {};
  return path + ": unsupported format \"" + extension + "\": pictures are written as .png, .exr";
}

const std::map<std::string, render::Shade> shades{
    {"lambert", render::Shade::lambert}, {"normals", render::Shade::normals}, {"uv", render::Shade::uv},
    {"patch", render::Shade::patch},     {"error", render::Shade::error},     {"curvature", render::Shade::curvature},
    {"clay", render::Shade::clay},       {"steps", render::Shade::steps}};

void make_draft(render::Settings& settings) {
  settings.samples = 2;
  settings.simple_light = true;
}

/// Adds the options that make sense only with a picture, and returns them.
std::vector<const Option*> add_picture_options(Command& command, RaycastOptions& options) {
  const auto set_shade = [&options](const std::string& text) {
    options.settings.shade = shades.at(text);
    options.shaded = true;
    if (options.settings.shade == render::Shade::error) options.settings.samples = 2;  // distances are slow
  };
  const auto set_quality = [&options](const std::string& text) {
    if (text == "draft") make_draft(options.settings);
  };
  command.begin_group("Pictures");
  Option& picture =
      command
          .add_text("-o,--output", "FILE",
                    "The picture file (.png, .exr), a folder, a name with {name}, or - for standard output [the "
                    "terminal]",
                    options.picture)
          .check(fault_of_name)
          .check(fault_of_picture);
  std::vector<const Option*> added = add_picture_view(command, "1280x800; the terminal's", options.settings);
  added.insert(
      added.end(),
      {&command.add_choice("--shade", {"lambert", "normals", "uv", "patch", "error", "curvature", "clay", "steps"},
                           "How surfaces are coloured [lambert]", set_shade),
       &command.add_flag("--edges", "Draw lines where surfaces end or meet; on meshes, the edges of triangles",
                         options.edges),
       &command.add_choice("--quality", {"draft", "final"},
                           "A draft has fewer rays per pixel and simple light; it takes a fifth of the time "
                           "[final; draft for several files]",
                           set_quality),
       &command.add_flag("--terminal", "Draw on standard output, even if it is no terminal", options.terminal)
            .exclude(picture),
       &command
            .add_choice("--colour,--color", {"auto", "always", "never"},
                        "Colours in the terminal; \"always\" also in a pipe [auto]",
                        [&options](const std::string& text) { options.colour = text; })
            .exclude(picture)});
  added.insert(added.begin(), &picture);
  return added;
}

/// Adds --rays and --hits, which belong together and exclude pictures.
void add_ray_options(Command& command, RaycastOptions& options, const std::vector<const Option*>& of_pictures) {
  command.begin_group("Hits of your own rays");
  Option& rays = command.add_text("--rays", "FILE.csv", "The table of rays to read", options.rays).check(fault_of_name);
  rays.need(
      command
          .add_text("--hits", "FILE.csv", "The table of hits to write, a folder, or a name with {name}", options.hits)
          .check(fault_of_name)
          .need(rays));
  if (!options.team)
    command.add_flag("--all-hits", "Find all hits of each ray, not only the closest, in exact mode", options.all_hits)
        .need(rays);
  for (const Option* const picture : of_pictures) rays.exclude(*picture);
}

Plan plan_raycast(const RaycastOptions& options, const CommonOptions& common) {
  if (!options.rays.empty()) {
    Plan plan = plan_jobs(options.load.files, options.hits, {"--hits", ".csv"});
    check_overwriting("--hits", plan.outputs(), {options.rays});
    return plan;
  }
  const bool in_terminal = options.picture.empty();
  const bool draws_there = options.terminal || (!options.team && output_is_terminal());
  if (in_terminal && (common.json || !draws_there)) {
    throw UsageError("raycast",
                     "expected -o FILE, or --rays FILE.csv and --hits FILE.csv" +
                         std::string(common.json ? "" : ", or --terminal, as standard output is no terminal"));
  }
  return plan_jobs(options.load.files, options.picture, {"--output", picture_extension, false});
}

void add_mode(Command& command, RaycastOptions& options) {
  command.begin_group("Method");
  command.add_choice(
      "--mode", {"grid", "exact"}, "Rays meet the surfaces (exact), or facets first (grid) [exact]",
      [&options](const std::string& text) { options.mode = text == "exact" ? RayMode::exact : RayMode::grid; });
  command.add_count(
      "--rate", "N",
      "Segments of a patch's grid in each direction in --mode grid, 1 to 256 [64, fewer for many patches]", 1, 256,
      [&options](std::size_t rate) { options.rate = static_cast<int>(rate); });
}

void add_team_options(Command& command, RaycastOptions& options) {
  command.begin_group("Ranks");
  command.add_flag("--data-parallel",
                   "Each rank has a scene of its run of the patches, and all trace all rays: for --rays and .exr "
                   "pictures in exact mode",
                   options.data_parallel);
}

/// Rules for ranks that work together.
void check_team(const RaycastOptions& options) {
  check_input_of_team(options.load);
  if (!options.data_parallel) return;
  if (options.rays.empty() && !is_exr(format_path(options.picture, options.format)))
    throw UsageError("--data-parallel", "needs --rays FILE.csv, or a picture as .exr");
  if (options.mode == RayMode::grid) throw UsageError("--data-parallel", "needs --mode exact, found --mode grid");
}

/// Rules that depend on the values of options.
void check_options(Command& command, const RaycastOptions& options) {
  check_stream_format(options.picture, options.format);
  if (command.option("--shade").count > 0 && is_exr(format_path(options.picture, options.format)))
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
  const auto options = std::make_shared<RaycastOptions>();
  options->team = session.team;
  add_models(command, options->load);
  const std::vector<const Option*> of_pictures = add_picture_options(command, *options);
  add_stream_format(command, {"png", "exr"}, options->format);
  add_error_options(command, options->error, command.option("--shade"));
  add_ray_options(command, *options, of_pictures);
  add_mode(command, *options);
  if (session.team) add_team_options(command, *options);
  add_reading(command, options->load);
  add_untrimmed(command, options->pack);
  add_common(command, session.common);
  command.footer = raycast_footer;
  command.choose = [options, &command, &session] {
    check_input(options->load);
    check_options(command, *options);
    if (options->team) check_team(*options);
    turn_camera(options->settings);
    options->sized = command.option("--size").count > 0;
    const Plan plan = plan_raycast(*options, session.common);
    const bool is_picture = options->rays.empty() && !is_exr(format_path(options->picture, options->format));
    if (plan.jobs.size() > 1 && is_picture && command.option("--quality").count == 0) {
      make_draft(options->settings);
      if (!options->team)
        complain(std::to_string(plan.jobs.size()) +
                 " pictures are drawn as drafts; --quality final takes about five times as long");
    }
    session.choose(plan, options, run_raycast);
  };
}

}  // namespace tessera::cli
