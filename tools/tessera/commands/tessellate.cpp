// tessera tessellate: makes a mesh of surfaces.

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>

#include "batch/batch.h"
#include "commands/commands.h"
#include "commands/tessellate_footer.h"
#include "console/output.h"
#include "line/arguments.h"
#include "stages/load.h"
#include "stages/mesh.h"
#include "stages/mesh_options.h"
#include "stages/pieces.h"
#include "stages/strict.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

constexpr double default_share = 1e-3;

/// The tolerances that the mesh keeps beside its bound, in words.
std::string kept(const TessellateOptions& options, const Meshed& made) {
  std::string said;
  if (options.certified.angle) {
    said += ", their normals within " + readable(made.angle, 3) + " degrees";
    if (made.patches_without_angle > 0)
      said += " (except for " + counted(made.patches_without_angle, "patch", "patches") + ")";
  }
  if (options.pixels > 0) said += ", within " + readable(made.pixels, 3) + " pixels in the picture";
  if (!made.keeps_tolerances) return said + ", more than the tolerance";
  said += made.proven ? ", proven" : ", proven except for fits that are sampled";
  if (options.is_default) said += " (--relative " + readable(default_share) + ", the default)";
  if (options.certified.smallest)
    said += ", the smallest tolerance for " + counted(options.certified.max_triangles, "triangle") + " is " +
            readable(made.tolerance);
  return said;
}

/// Adds the shapes of a model, and "18 solids (5 shapes at 18 places), " if they were meshed.
void add_shape_facts(Report& report, const Model& model, const Meshed& made) {
  std::size_t solids = 0;
  for (const Instance& instance : model.instances) solids += model.shapes[instance.shape].solid_count;
  const std::string shapes = counted(model.shapes.size(), "shape") + " at " + counted(model.instances.size(), "place");
  report.add("shapes", model.shapes.size());
  report.add("instances", model.instances.size());
  report.add("solids", solids,
             !made.by_shapes ? ""
             : solids > 0    ? counted(solids, "solid") + " (" + shapes + "), "
                             : shapes + ", ");
}

/// Adds the sizes of a mesh and the tolerances that it keeps.
void add_mesh_facts(Report& report, const TessellateOptions& options, const Meshed& made) {
  report.add("vertices", made.size.vertices, counted(made.size.vertices, "vertex", "vertices") + ", ");
  report.add("triangles", made.size.triangles, counted(made.size.triangles, "triangle"));
  report.add("quads", made.size.quads, options.quads ? ", " + counted(made.size.quads, "quad") : "");
  if (options.grid) {
    report.add("rate_u", options.grid->first);
    report.add("rate_v", options.grid->second);
    return;
  }
  report.add("precision", made.has_doubles ? "double" : "float");
  report.add("default_relative", options.is_default ? Json(default_share) : Json());
  report.add("bound", made.bound, ", within " + readable(made.bound, 3) + " of the surfaces");
  report.add("certified", made.proven && made.keeps_tolerances, kept(options, made));
  report.add("tolerance", std::isinf(made.tolerance) ? Json() : Json(made.tolerance));
  report.add("weld", options.certified.weld ? Json(*options.certified.weld) : Json());
  report.add("gap", made.gap);
}

/// Adds how borders meet, and the faults of the mesh with --strict. A mesh of rates has none of these facts.
void add_border_facts(Report& report, const TessellateOptions& options, const Meshed& made,
                      const std::vector<std::string>& faults) {
  if (options.grid) return;
  if (made.gap > 0) report.say(", over gaps of up to " + readable(made.gap, 3) + " in the file");
  report.add("angle", options.certified.angle ? Json(made.angle) : Json());
  report.add("patches_without_angle", made.patches_without_angle);
  report.add("pixels", options.pixels > 0 ? Json(made.pixels) : Json());
  report.add("welded_borders", made.welded_borders,
             made.welded_borders ? ", " + counted(made.welded_borders, "border") + " welded" : "");
  report.add("open_edges", made.open_edges,
             made.open_edges ? ", " + counted(made.open_edges, "open edge") : ", closed");
  report.add("cut_patches", made.cut_patches);
  report.add("crossed_surfaces", made.crossed.size());
  report.add("rough_surfaces", made.rough.size());
  report.add("faults", options.strict ? Json(faults) : Json());
}

Status report(const Job& job, const TessellateOptions& options, const CommonOptions& common, const Loaded& loaded,
              const Meshed& made, const std::vector<std::string>& faults, const Timings& timings) {
  Report report = report_of(job, loaded);
  add_shape_facts(report, loaded.model, made);
  add_mesh_facts(report, options, made);
  add_border_facts(report, options, made, faults);
  add_model_facts(report, loaded, made.patches, made.fit_error);
  if (made.by_shapes) report.say(", in " + readable_seconds(timings.total()));
  report.say(fit_line(made.fit_error));
  return report.print(job.output, common, timings);
}

Result<Meshed> make_meshes(const TessellateOptions& options, Loaded& loaded, const std::string& path,
                           Timings& timings) {
  if (suits_shapes(options, loaded)) return mesh_shapes(options, loaded, path, timings);
  if (Status status = add_patches(loaded, options.models, timings); !status.ok()) return status;
  return mesh_as_one(options, loaded, path, timings);
}

/// The options whose limits are known of pieces: these keep angles and pixels, too, but don't tell which.
TessellateOptions told_of_pieces(TessellateOptions options) {
  options.certified.angle.reset();
  options.pixels = 0;
  return options;
}

Status report_pieces(const Job& job, const TessellateOptions& options, const CommonOptions& common,
                     const InPieces& result, const std::vector<std::string>& faults, const Timings& timings) {
  const Meshed& made = result.made;
  Loaded read;
  read.files = job.inputs;
  Report report = report_of(job, read);
  report.add("pieces", result.pieces, counted(result.pieces, "piece") + ", ");
  add_mesh_facts(report, told_of_pieces(options), made);
  report.add("surfaces", result.surfaces);
  report.add("patches", made.patches);
  report.add("trimmed_surfaces", result.trimmed);
  report.add("fit_error", fit_json(made.fit_error), fit_line(made.fit_error));
  report.add("warnings", result.warnings);
  if (!options.grid) report.add("faults", options.strict ? Json(faults) : Json());
  return report.print(job.output, common, timings);
}

/// Reads, meshes and writes a model that is larger than memory.
Status run_in_pieces(const Job& job, const TessellateOptions& options, const CommonOptions& common, Timings& timings) {
  const Result<InPieces> result = mesh_in_pieces(job, options, timings);
  if (!result) return result.status();
  const Meshed& made = result->made;
  say_warnings(result->warnings);
  warn_of_rounding(job.output, made);
  const std::vector<std::string> faults =
      options.strict ? mesh_faults(result->warnings, made) : std::vector<std::string>();
  const Status said = report_pieces(job, options, common, *result, faults, timings);
  return said.ok() ? complain_of(job.output, faults) : said;
}

/// Names the surfaces whose meshes are not what was wanted.
void warn_of_surfaces(const Loaded& loaded, const Meshed& made) {
  const auto say = [&](std::size_t surface, const std::string& what) {
    warn(loaded.in_surface(surface, {StatusCode::unsupported, what}).message());
  };
  for (const std::size_t surface : made.crossed)
    say(surface, "its trimming loops cannot be made a polygon: parts of it are left out");
  for (const RoughSurface& rough : made.rough)
    say(rough.surface,
        "it cannot keep the tolerance, because of rough trimming loops, the rounding of positions, or the limit of "
        "segments: its mesh is proven to lie within " +
            readable(rough.bound, 3));
}

Status run_tessellate(const Job& job, const TessellateOptions& options, const CommonOptions& common, Timings& timings) {
  if (options.piece_bytes > 0) return run_in_pieces(job, options, common, timings);
  Result<OutputFile> out = open_output(job.output);
  if (!out) return out.status();
  Result<Loaded> loaded = load(job, options.models, allows_shapes(options) ? With::shapes : With::patches, timings);
  if (!loaded) return loaded.status();
  const std::string path = format_path(job.output, options.format);
  const Result<Meshed> made = make_meshes(options, *loaded, path, timings);
  if (!made) return made.status();
  warn_of_rounding(job.output, *made);
  warn_of_surfaces(*loaded, *made);
  {
    const auto phase = timings.phase("write");
    Status status = made->by_shapes ? write_assembly(made->assembly, path, *out) : write_mesh(made->mesh, path, *out);
    if (status.ok()) status = out->commit();
    if (!status.ok()) return status;
  }
  const Result<std::vector<std::string>> faults =
      options.strict ? mesh_faults(loaded->model, *made) : std::vector<std::string>();
  if (!faults) return faults.status();
  Status said = report(job, options, common, *loaded, *made, *faults, timings);
  if (said.ok()) said = complain_of(job.output, *faults);
  return said.ok() ? loaded->status() : said;
}

constexpr const char* mesh_extension = ".ply";

std::string fault_of_mesh_file(const std::string& path) {
  if (path.empty()) return fault_of_name(path);
  return is_folder(path) || is_stream(path) || is_index(path) ? "" : check_mesh_format(path).message();
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
  const auto options = std::make_shared<TessellateOptions>();
  add_models(command, options->models);
  command
      .add_text("-o,--output", "FILE",
                "The mesh file (.obj, .ply, .stl, .glb, .gltf), a folder, a name with {name}, or - for standard output",
                options->output)
      .require()
      .check(fault_of_mesh_file);
  add_stream_format(command, {"obj", "ply", "stl", "glb", "gltf"}, options->format);
  const std::vector<const Option*> density = add_density(command, *options);
  add_mesh_options(command, *options);
  add_reading(command, options->models);
  add_untrimmed(command, options->models);
  add_view(command, *options);
  add_batch(command, session.common.batch);
  add_common(command, session.common);
  add_in_pieces(command, *options);
  command.footer = tessellate_footer;
  command.choose = [options, &session, density] {
    const std::vector<std::string> listed = listed_files(session.common.batch, options->models.files);
    check_input(options->models);
    check_stream_format(options->output, options->format);
    options->is_default = std::ranges::none_of(density, [](const Option* option) { return option->count > 0; });
    if (options->is_default) options->certified.relative = true, options->certified.tolerance = default_share;
    const Plan plan = plan_jobs(options->models.files, options->output, {"--output", mesh_extension}, listed);
    check_batch(session.common.batch, plan);
    check_pieces(*options, plan);
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
