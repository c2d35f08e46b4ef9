// tessera tessellate: makes a mesh of surfaces.

#include <algorithm>
#include <functional>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>

#include "arguments.h"
#include "commands.h"
#include "loading.h"
#include "memory.h"
#include "output.h"
#include "progress.h"
#include "tessellate_footer.h"
#include "tessera/io.h"
#include "tessera/tessellation.h"

namespace tessera::cli {
namespace {

struct Options {
  ModelOptions models;
  std::string output, format;
  std::optional<Extent> grid;
  TessellationOptions certified;  ///< used if there is no grid
  bool is_default = false;        ///< whether no density is on the command line
  std::uint64_t max_memory = 0;   ///< bytes of the mesh; 0: a share of what is free
  bool quads = false;
  double pixels = 0;  ///< above 0 if requested
  View view;
};

constexpr double default_share = 1e-3;
constexpr double degree = std::numbers::pi / 180;
constexpr int max_segments = 4096;
constexpr std::size_t max_triangles = std::size_t{1} << 40;

struct Tessellated {
  Mesh mesh;
  double tolerance = 0;
  std::size_t welded_borders = 0, open_edges = 0;
  std::vector<std::size_t> crossed;  ///< surfaces with loops that cannot be made polygons
  double angle = 0;                  ///< degrees
  std::size_t patches_without_angle = 0;
  double pixels = 0;
  double bound = 0;     ///< largest distance of mesh and surfaces; 0: unknown
  bool proven = false;  ///< false if sampled: callables fitted without bounds on their derivatives
};

/// Refuses a mesh that takes more memory than --max-memory, or than most of what is free.
Status check_memory(const MeshCapacity& mesh, const Options& options) {
  // Position, normal and parameters of a vertex in float, and its position in double; the indices and the patch of a
  // triangle, or of half a quad; and writing takes about as much again as the vertices.
  const bool has_doubles = !options.grid && options.certified.precision == Precision::double_precision;
  const std::uint64_t vertex_bytes = 2 * (32 + (has_doubles ? 24 : 0)), max_bytes = options.max_memory;
  constexpr std::uint64_t triangle_bytes = 16;
  const std::uint64_t triangles = mesh.triangles + 2 * mesh.quads;
  const std::uint64_t needed = mesh.vertices * vertex_bytes + triangles * triangle_bytes;
  const std::uint64_t limit = max_bytes > 0 ? max_bytes : available_memory() / 4 * 3;
  if (needed <= limit) return {};
  return {StatusCode::out_of_memory, "a mesh of " + counted(triangles, "triangle") + " needs " +
                                         readable_bytes(needed) + " of memory, the limit is " + readable_bytes(limit) +
                                         (max_bytes > 0 ? "" : ", three quarters of what is free") +
                                         "; use fewer segments, a tolerance, or --max-memory"};
}

Result<Mesh> run_plan(const Result<Tessellation>& plan, const PatchSet& set, const Options& options) {
  if (!plan) return plan.status();
  if (Status status = check_memory(plan->capacity(), options); !status.ok()) return status;
  Result<Mesh> mesh = plan->allocate();
  if (!mesh) return mesh;
  Progress progress("tessellating");
  const Status status = plan->run(set, mesh->views(), progress.execution());
  if (!status.ok()) return status;
  return mesh;
}

Result<Tessellated> tessellate(const Options& options, const Model& model, const PatchSet& set) {
  Tessellated made;
  Result<Mesh> mesh = [&] {
    if (options.grid) {
      const UniformRates rates{options.grid->first, options.grid->second};
      return run_plan(Tessellation::make(set, {.rates = rates, .quads = options.quads}), set, options);
    }
    TessellationOptions certified = options.certified;
    certified.quads = options.quads;
    if (options.pixels > 0) certified.pixels = PixelTolerance{options.pixels, options.view};
    const Result<Tessellation> plan = Tessellation::make(set, certified);
    if (plan) {
      made.tolerance = plan->tolerance();
      made.open_edges = plan->open_edges();
      made.welded_borders = plan->welded_borders();
      made.angle = plan->angle() / degree;
      made.patches_without_angle = plan->patches_without_angle();
      made.pixels = plan->pixels();
      made.bound = plan->bound();
      made.proven = plan->certified();
      for (const std::uint32_t patch : plan->crossed_patches()) {
        const std::size_t surface = set.source(patch).surface;
        if (made.crossed.empty() || made.crossed.back() != surface) made.crossed.push_back(surface);
      }
    }
    return run_plan(plan, set, options);
  }();
  if (!mesh) return mesh.status();
  Result<std::vector<MeshPart>> parts = parts_by_surface(*mesh, set, model);
  if (!parts) return parts.status();
  made.mesh = *std::move(mesh);
  made.mesh.parts = *std::move(parts);
  return made;
}

/// The tolerances that the mesh keeps, in words.
std::string kept(const Options& options, const Tessellated& made) {
  if (options.grid) return "";
  std::string said = ", within " + readable(made.bound, 3) + " of the surfaces";
  if (options.certified.angle) {
    said += ", their normals within " + readable(made.angle, 3) + " degrees";
    if (made.patches_without_angle > 0)
      said += " (except for " + counted(made.patches_without_angle, "patch", "patches") + ")";
  }
  if (options.pixels > 0) said += ", within " + readable(made.pixels, 3) + " pixels in the picture";
  said += made.proven ? ", proven" : ", proven except for fits that are sampled";
  if (options.is_default) said += " (--relative " + readable(default_share) + ", the default)";
  if (options.certified.smallest)
    said += ", the smallest tolerance for " + counted(options.certified.max_triangles, "triangle") + " is " +
            readable(made.tolerance);
  if (made.welded_borders) said += ", " + counted(made.welded_borders, "border") + " welded";
  return said + (made.open_edges ? ", " + counted(made.open_edges, "open edge") : ", closed");
}

Status report(const Job& job, const Options& options, const CommonOptions& common, const Loaded& loaded,
              const PatchSet& set, const Tessellated& made, const Timings& timings) {
  const Mesh& mesh = made.mesh;
  if (!common.json)
    return print_report(job.output, job.output + ": " + counted(mesh.vertex_count(), "vertex", "vertices") + ", " +
                                        counted(mesh.triangle_count(), "triangle") +
                                        (options.quads ? ", " + counted(mesh.quad_count(), "quad") : "") +
                                        kept(options, made) + "\n" + fit_line(set));
  Json object = files_json(loaded);
  object["output"] = job.output;
  object["vertices"] = mesh.vertex_count();
  object["triangles"] = mesh.triangle_count();
  object["quads"] = mesh.quad_count();
  if (options.grid) {
    object["rate_u"] = options.grid->first;
    object["rate_v"] = options.grid->second;
  } else {
    object["precision"] = options.certified.precision == Precision::double_precision ? "double" : "float";
    object["default_relative"] = options.is_default ? Json(default_share) : Json();
    object["bound"] = made.bound;
    object["certified"] = made.proven;
    object["angle"] = options.certified.angle ? Json(made.angle) : Json();
    object["patches_without_angle"] = made.patches_without_angle;
    object["pixels"] = options.pixels > 0 ? Json(made.pixels) : Json();
    object["tolerance"] = std::isinf(made.tolerance) ? Json() : Json(made.tolerance);
    object["weld"] = options.certified.weld ? Json(*options.certified.weld) : Json();
    object["welded_borders"] = made.welded_borders;
    object["open_edges"] = made.open_edges;
    object["cut_patches"] = set.cut_count();
    object["crossed_surfaces"] = made.crossed.size();
  }
  add_model_facts(object, loaded, set);
  add_seconds(object, common, timings);
  return print_report(job.output, object.text() + "\n");
}

Status run_tessellate(const Job& job, const Options& options, const CommonOptions& common, Timings& timings) {
  Result<OutputFile> out = open_output(job.output);
  if (!out) return out.status();
  const Result<Loaded> loaded = load(job, options.models, With::patches, timings);
  if (!loaded) return loaded.status();
  const Result<PatchSet> set = pack(*loaded, options.models, timings);
  if (!set) return set.status();
  const Result<Tessellated> made = [&] {
    const auto phase = timings.phase("evaluate");
    return tessellate(options, loaded->model, *set);
  }();
  if (!made && options.grid && set->cut_count() > 0)
    return in_file(job.inputs[0], {made.status().code(), made.status().message() + " (--untrimmed)"});
  if (!made) return in_file(job.inputs[0], made.status());
  for (const std::size_t surface : made->crossed)
    warn(loaded
             ->in_surface(surface, {StatusCode::unsupported,
                                    "its trimming loops cannot be made a polygon: parts of it are left out"})
             .message());
  {
    const auto phase = timings.phase("write");
    Status status = write_mesh(made->mesh, format_path(job.output, options.format), *out);
    if (status.ok()) status = out->commit();
    if (!status.ok()) return status;
  }
  const Status said = report(job, options, common, *loaded, *set, *made, timings);
  return said.ok() ? loaded->status() : said;
}

constexpr const char* extension_in_folders = ".ply";

std::string fault_of_output(const std::string& path) {
  if (path.empty()) return fault_of_name(path);
  return is_folder(path) || is_stream(path) ? "" : check_mesh_format(path).message();
}

/// Adds the options for how fine the mesh is, and returns them. Without any, a relative tolerance is used.
std::vector<const Option*> add_density(Command& command, Options& options) {
  TessellationOptions& certified = options.certified;
  command.begin_group("Density [--relative 0.001]");
  Option& grid = command.add(
      "--grid", "NxM", "Segments of every patch, along u and along v, 1 to 4096 each",
      [&options](const std::string& text) { options.grid = parse_extent("--grid", text, 1, max_segments); });
  Option& tolerance = command.add_length("--tolerance", "LENGTH",
                                         "Largest distance between mesh and surfaces, in the model's unit; proven",
                                         [&certified](double value) { certified.tolerance = value; });
  Option& relative =
      command.add_length("--relative", "SHARE", "The tolerance as a share of the model's size, the diagonal of its box",
                         [&certified](double value) {
                           certified.tolerance = value;
                           certified.relative = true;
                         });
  Option& triangles =
      command.add_count("--triangles", "COUNT", "The smallest tolerance that needs at most this many triangles", 1,
                        max_triangles, [&certified](std::size_t count) {
                          certified.max_triangles = count;
                          certified.smallest = true;
                        });
  Option& angle = command.add_length(
      "--angle", "DEGREES", "Largest turn of the surfaces' normals within a triangle, up to 90; proven",
      [&certified](double value) {
        if (value > 90) throw UsageError("--angle", "expected at most 90 degrees, found " + readable(value));
        certified.angle = value * degree;
      });
  Option& pixels = command.add_length(
      "--pixels", "P", "Largest distance between mesh and surfaces in --camera's picture, in pixels; proven",
      [&options](double value) { options.pixels = value; });
  for (const Option* const other : {&tolerance, &relative, &triangles, &angle, &pixels}) grid.exclude(*other);
  tolerance.exclude(relative).exclude(triangles);
  relative.exclude(triangles);
  return {&grid, &tolerance, &relative, &triangles, &angle, &pixels};
}

/// Adds the camera of --pixels.
void add_view(Command& command, Options& options) {
  View& view = options.view;
  const auto set_camera = [&view](const std::string& text) {
    const std::vector<double> n = parse_numbers("--camera", text, 7, "ex,ey,ez,tx,ty,tz,fovdeg");
    view.eye = {n[0], n[1], n[2]};
    view.target = {n[3], n[4], n[5]};
    view.field_of_view = n[6] * degree;
    if (view.eye == view.target) throw UsageError("--camera", "the eye and the target are the same point");
    if (!(n[6] > 0 && n[6] < 180)) throw UsageError("--camera", "the field of view must lie between 0 and 180 degrees");
  };
  const auto set_size = [&view](const std::string& text) {
    const Extent size = parse_extent("--size", text, 1, 1 << 20);
    view.width = size.first;
    view.height = size.second;
  };
  Option& pixels = command.option("--pixels");
  command.begin_group("The camera of --pixels");
  Option& camera = command.add("--camera", "EX,EY,EZ,TX,TY,TZ,FOV",
                               "Eye, target and field of view in degrees across the shorter side; z is up", set_camera);
  pixels.need(camera);
  camera.need(pixels);
  command.add("--size", "WxH", "Pixels of the camera's picture [1280x800]", set_size).need(camera);
  command
      .add_length("--near", "LENGTH", "Points nearer to the eye are not seen [a thousandth of the target's distance]",
                  [&view](double value) { view.near_distance = value; })
      .need(camera);
  command
      .add_length("--orthographic", "LENGTH",
                  "Parallel rays, and the length that the picture's shorter side shows; the field of view is not used",
                  [&view](double value) {
                    view.orthographic = true;
                    view.extent = value;
                  })
      .need(camera);
}

/// Adds a budget: a limit of the triangles, not a target.
void add_cap(Command& command, Options& options) {
  command
      .add_count("--max-triangles", "COUNT",
                 "Limit on triangles, not for --grid; an error says how many are needed [1073741824]", 1, max_triangles,
                 [&options](std::size_t count) { options.certified.max_triangles = count; })
      .exclude(command.option("--triangles"));
  command
      .add_flag("--fewest", "Search for a mesh with fewer triangles, not for --grid; takes 15 to 200 us per patch",
                options.certified.fewest)
      .exclude(command.option("--grid"));
}

void add_memory(Command& command, Options& options) {
  command.add("--max-memory", "SIZE", "Limit on the mesh's memory, like 800M or 12G [three quarters of what is free]",
              [&options](const std::string& text) { options.max_memory = parse_bytes("--max-memory", text); });
}

void add_weld(Command& command, Options& options) {
  const auto set_weld = [&options](const std::string& text) {
    options.certified.weld = parse_numbers("--weld", text, 1, "of at least 0")[0];
    if (!(*options.certified.weld >= 0))
      throw UsageError("--weld", "expected a length of at least 0, found " + quote(text));
  };
  command.add("--weld", "LENGTH",
              "Join borders within this distance of each other, not for --grid; 0: only borders with equal bits "
              "[an eighth of the tolerance]",
              set_weld);
}

/// Adds options for the normals and vertices that neighbours share.
void add_sharing(Command& command, Options& options) {
  const Option& grid = command.option("--grid");
  const auto set_crease = [&options](const std::string& text) {
    const double angle = parse_numbers("--crease", text, 1, "from 0 to 180")[0];
    if (!(angle >= 0 && angle <= 180))
      throw UsageError("--crease", "expected an angle of 0 to 180 degrees, found " + quote(text));
    options.certified.crease_angle = angle * degree;
  };
  command
      .add("--crease", "DEGREES",
           "Share normals along a border where they differ by no more than this angle, and keep a crease elsewhere "
           "[each patch has its own normals]",
           set_crease)
      .exclude(grid);
  command
      .add_flag("--share-vertices",
                "Store vertices once that neighbours share: with --crease those with the same normal, otherwise all, "
                "without normals",
                options.certified.share_vertices)
      .exclude(grid);
}

void add_precision(Command& command, Options& options) {
  command
      .add_choice("--precision", {"float", "double"},
                  "Precision of positions; double (.ply and .obj) keeps a small tolerance for parts far from each "
                  "other [float]",
                  [&options](const std::string& text) {
                    options.certified.precision =
                        text == "double" ? Precision::double_precision : Precision::single_precision;
                  })
      .exclude(command.option("--grid"));
}

/// The formats without quads and without positions in double.
constexpr const char* simple_formats[] = {".stl", ".glb", ".gltf"};

/// Throws UsageError if a file cannot hold what an option requests.
void check_formats(const Plan& plan, const char* option, const std::string& held, const std::string& wanted) {
  for (const Job& job : plan.jobs) {
    const std::string extension = lower_extension(job.output);
    if (std::find(std::begin(simple_formats), std::end(simple_formats), extension) != std::end(simple_formats))
      throw UsageError(option, extension + " can hold only " + held + "; .obj and .ply can hold " + wanted);
  }
}

}  // namespace

void add_tessellate(Command& tool, Session& session) {
  Command& command = tool.add_command("tessellate", "Turn surfaces into meshes");
  const auto options = std::make_shared<Options>();
  add_models(command, options->models);
  command
      .add_text("-o,--output", "FILE",
                "The mesh file (.obj, .ply, .stl, .glb, .gltf), a folder, a name with {name}, or - for standard output",
                options->output)
      .require()
      .check(fault_of_output);
  add_stream_format(command, {"obj", "ply", "stl", "glb", "gltf"}, options->format);
  const std::vector<const Option*> density = add_density(command, *options);
  command.begin_group("The mesh");
  add_cap(command, *options);
  add_memory(command, *options);
  add_weld(command, *options);
  add_sharing(command, *options);
  command.add_flag("--quads", "Write whole cells as quads, in .obj and .ply [triangles only]", options->quads);
  add_precision(command, *options);
  add_reading(command, options->models);
  add_untrimmed(command, options->models);
  add_view(command, *options);
  add_common(command, session.common);
  command.footer = tessellate_footer;
  command.choose = [options, &session, density] {
    check_input(options->models);
    check_stream_format(options->output, options->format);
    options->is_default = std::ranges::none_of(density, [](const Option* option) { return option->count > 0; });
    if (options->is_default) options->certified.relative = true, options->certified.tolerance = default_share;
    const Plan plan = plan_jobs(options->models.files, options->output, {"--output", extension_in_folders});
    if (options->quads) check_formats(plan, "--quads", "triangles", "quads");
    if (options->certified.precision == Precision::double_precision)
      check_formats(plan, "--precision", "positions in float", "positions in double");
    session.command = [options, plan, &session] {
      return run_jobs(plan, session.common, [&](const Job& job, Timings& timings) {
        return run_tessellate(job, *options, session.common, timings);
      });
    };
  };
}

}  // namespace tessera::cli
