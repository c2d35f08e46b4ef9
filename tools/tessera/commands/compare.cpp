// tessera compare: how far a mesh and the surfaces of a model are apart, both ways.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "batch/jobs.h"
#include "commands/commands.h"
#include "compare/comparison.h"
#include "compare/deviation_files.h"
#include "console/console.h"
#include "console/output.h"
#include "console/progress.h"
#include "line/arguments.h"
#include "picture/view_options.h"
#include "stages/pack.h"
#include "tessera/io.h"
#include "tessera/tessellation.h"

namespace tessera::cli {
namespace {

constexpr std::size_t max_samples = 100000000;

struct CompareOptions {
  LoadOptions load;
  PackOptions pack;
  std::string mesh, output, format;
  MeshUnitOptions unit;
  std::optional<std::size_t> samples;
  std::optional<double> spacing, tolerance, full;
  render::Settings view;
};

/// Both sides of a comparison, ready to be searched.
struct Sides {
  Mesh mesh;                     ///< in the model's coordinates
  render::MeshDistance nearest;  ///< points of the mesh
  EvenPoints on_mesh;
  ComparedModel model;
  Mesh drawn;  ///< of the model, fine enough to spread points by
  EvenPoints on_drawn;
};

Result<Mesh> read_compared(const CompareOptions& options, Timings& timings) {
  std::vector<std::string> warnings;
  Result<Mesh> mesh =
      timings.measure("read", [&] { return read_mesh(options.mesh, {.up = options.unit.up, .warnings = &warnings}); });
  say_warnings(warnings);
  return mesh;
}

/// A mesh of the model whose vertices know their parameters.
Result<Mesh> drawn_mesh(const PatchSet& set, Timings& timings) {
  constexpr double share_of_size = 1e-3;
  const auto phase = timings.phase("mesh");
  Progress progress("meshing the model");
  const Result<Tessellation> plan = Tessellation::make(
      set, {.tolerance = share_of_size, .relative = true, .parameters = VertexParameters::patch}, progress.execution());
  if (!plan) return plan.status();
  Result<Mesh> mesh = plan->allocate();
  if (!mesh) return mesh;
  if (Status status = plan->run(set, mesh->views(), progress.execution()); !status.ok()) return status;
  return mesh;
}

Result<Sides> make_sides(Mesh mesh, const PatchSet& set, const CompareOptions& options, Timings& timings) {
  Result<render::MeshDistance> nearest = timings.measure("build", [&] { return render::MeshDistance::make(mesh); });
  if (!nearest) return in_file(options.mesh, nearest.status());
  Result<EvenPoints> on_mesh = EvenPoints::make(mesh);
  if (!on_mesh) return in_file(options.mesh, on_mesh.status());
  const std::string& file = options.load.files[0];
  Result<Mesh> drawn = drawn_mesh(set, timings);
  if (!drawn) return in_file(file, drawn.status());
  Result<EvenPoints> on_drawn = EvenPoints::make(*drawn);
  if (!on_drawn) return in_file(file, on_drawn.status());
  std::optional<Progress> progress;
  Result<ComparedModel> model = timings.measure("build", [&] {
    return ComparedModel::make(set, [&](const char* work) { return progress.emplace(work).execution(); });
  });
  if (!model) return in_file(file, model.status());
  return Sides{std::move(mesh),   *std::move(nearest), *std::move(on_mesh),
               *std::move(model), *std::move(drawn),   *std::move(on_drawn)};
}

/// How many points are spread over an area. Errors: invalid_argument (too many).
Result<std::size_t> samples_on(const EvenPoints& even, const CompareOptions& options, std::size_t triangles) {
  constexpr std::size_t fewest = 100000, most = 1000000;
  if (options.samples) return *options.samples;
  if (!options.spacing) return std::clamp(triangles, fewest, most);
  const double count = std::ceil(even.area() / *options.spacing / *options.spacing);
  if (count <= static_cast<double>(max_samples)) return static_cast<std::size_t>(count);
  return Status(StatusCode::invalid_argument, "--spacing: points " + readable(*options.spacing) +
                                                  " apart are more than " + std::to_string(max_samples) +
                                                  "; use a larger spacing");
}

Status compare(const Sides& sides, const CompareOptions& options, Timings& timings, Comparison& found) {
  const std::size_t triangles = sides.mesh.triangle_count();
  const Result<std::size_t> of_mesh = samples_on(sides.on_mesh, options, triangles),
                            of_model = samples_on(sides.on_drawn, options, triangles);
  if (!of_mesh) return of_mesh.status();
  if (!of_model) return of_model.status();
  found.vertices = sides.mesh.vertex_count(), found.triangles = triangles;
  const auto phase = timings.phase("evaluate");
  {
    Progress progress("mesh to model");
    Result<MeshDeviations> mesh = deviations_of_mesh(sides.model, sides.mesh, sides.on_mesh, *of_mesh,
                                                     [&](double share) { progress.tell(share); });
    if (!mesh) return in_file(options.mesh, mesh.status());
    found.mesh = *std::move(mesh);
  }
  Progress progress("model to mesh");
  Result<Deviations> model = deviations_of_model(sides.model, sides.drawn, sides.on_drawn, *of_model, sides.nearest,
                                                 [&](double share) { progress.tell(share); });
  if (!model) return in_file(options.mesh, model.status());
  found.model = *model;
  return {};
}

/// Warns of a mesh that seems to be in another unit.
void warn_of_size(const Mesh& mesh, const PatchSet& set, const std::string& file) {
  constexpr double far_apart = 8;
  Box3 box;
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) box.extend(render::position_of(mesh, k));
  const double share = box.diagonal() / set.model_box().diagonal();
  if (share < far_apart && share > 1 / far_apart) return;
  warn(file + ": the mesh is " + readable(share, 3) +
       " times as large as the model; --mesh-unit and --scale change it");
}

bool is_picture(const std::string& path) { return lower_extension(path) == ".png"; }

Status write_output(const Job& job, const CompareOptions& options, const Sides& sides, const Comparison& found,
                    const Model& model, OutputFile& out, Timings& timings) {
  Status status;
  if (!is_picture(format_path(job.output, options.format))) {
    const auto phase = timings.phase("write");
    status = write_deviation_ply(sides.mesh, found.mesh.of_vertices, out);
    return status.ok() ? out.commit() : status;
  }
  const double size = sides.model.set().box().diagonal(), largest = found.mesh.all.largest.distance;
  DeviationPicture picture{options.view, options.full.value_or(found.tolerance.value_or(largest)), ""};
  picture.full = std::max(picture.full, 1e-12 * size);  // above 0 also for an exact mesh
  const std::size_t slash = options.mesh.rfind('/');
  picture.caption = options.mesh.substr(slash == std::string::npos ? 0 : slash + 1) + ": deviation" +
                    (model.unit.empty() ? "" : " in " + model.unit) + ", largest " + readable(largest, 3);
  status = draw_deviations(sides.model, sides.mesh, picture, out, timings);
  return status.ok() ? out.commit() : in_file(options.mesh, status);
}

Status report(const Job& job, const CommonOptions& common, const Loaded& loaded, const PatchSet& set,
              const Comparison& found, const Timings& timings) {
  Report report = report_of(job, loaded);
  report.say(loaded.files[0]);
  add_comparison(report, found, loaded.model);
  add_model_facts(report, loaded, set.patch_count(), set.fit_error());
  report.say(fit_line(set.fit_error()));
  if (Status printed = report.print(job.output, common, timings); !printed.ok()) return printed;
  if (found.within_tolerance()) return {};
  complain(found.file + ": the largest deviation is " + length_text(found.largest(), loaded.model.unit) +
           ", more than " + length_text(*found.tolerance, loaded.model.unit));
  return already_said(StatusCode::invalid_argument);
}

Status run_compare(const Job& job, const CompareOptions& options, const CommonOptions& common, Timings& timings) {
  std::optional<OutputFile> out;
  if (!job.output.empty()) {
    Result<OutputFile> opened = open_output(job.output);
    if (!opened) return opened.status();
    out.emplace(*std::move(opened));
  }
  Result<Mesh> mesh = read_compared(options, timings);
  if (!mesh) return mesh.status();
  Result<Loaded> loaded = load(job, options.load, With::patches, timings);
  if (!loaded) return loaded.status();
  Comparison found;
  found.file = options.mesh, found.tolerance = options.tolerance;
  const Result<MeshUnit> unit = unit_of_mesh(options.unit, options.mesh, loaded->model.unit);
  if (!unit) return in_file(loaded->files[0], unit.status());
  found.unit = *unit, found.rounding = unit->scale * float_rounding(*mesh);
  scale_mesh(*mesh, unit->scale);
  const Result<PatchSet> set = pack_joined(*loaded, options.pack, timings);
  if (!set) return set.status();
  const Result<Sides> sides = make_sides(*std::move(mesh), *set, options, timings);
  if (!sides) return sides.status();
  warn_of_size(sides->mesh, *set, options.mesh);
  Status status = compare(*sides, options, timings, found);
  if (status.ok() && out) status = write_output(job, options, *sides, found, loaded->model, *out, timings);
  if (status.ok()) status = report(job, common, *loaded, *set, found, timings);
  return status.ok() ? loaded->status() : status;
}

std::string fault_of_deviation_file(const std::string& path) {
  if (path.empty()) return fault_of_name(path);
  const std::string extension = lower_extension(path);
  if (is_stream(path) || extension == ".png" || extension == ".ply") return {};
  return path + ": unsupported format \"" + extension + "\": deviations are written as .png, .ply";
}

void add_points(Command& command, CompareOptions& options) {
  command.begin_group("Points");
  const Option& samples = command.add_count(
      "--samples", "N",
      "Points spread evenly over each side, 0 to 100000000 [one for each triangle of the mesh, 100000 to 1000000]", 0,
      max_samples, [&options](std::size_t count) { options.samples = count; });
  command
      .add_length("--spacing", "LENGTH", "One point for each square of this side, in the model's unit, instead",
                  [&options](double length) { options.spacing = length; })
      .exclude(samples);
}

void add_pictures(Command& command, CompareOptions& options) {
  command.begin_group("Output");
  const Option& output =
      command
          .add_text("-o,--output", "FILE",
                    "A picture of the mesh in the colours of its deviations (.png), the mesh with a deviation at each "
                    "vertex (.ply), or - for standard output [none]",
                    options.output)
          .check(fault_of_deviation_file);
  add_stream_format(command, {"png", "ply"}, options.format);
  command
      .add_length("--full", "LENGTH", "The deviation of the last colour [the tolerance, or else the largest]",
                  [&options](double length) { options.full = length; })
      .need(output);
  for (const Option* const option : add_picture_view(command, "1280x800", options.view))
    command.option(option->name()).need(output);
}

constexpr const char* compare_footer =
    R"(Mesh to model: the distance from the vertices of the mesh, and from points spread evenly over its triangles, to the
nearest point of the surfaces, as loops trim them; a point that is "not proven" may be nearer. Model to mesh: from points
of the surfaces to the nearest triangle, which finds what the mesh lacks. Largest distances are of all points; mean, root
mean square and the bound of 99% of the points are of those spread evenly, so they do not depend on how triangles are
distributed. Distances are exact at these points, and say nothing of others: more points find larger ones.
Where surfaces are closed, deviations to the outside and to the inside are told apart: positive is outside.
A mesh has no unit: its coordinates count as the model's, but for glTF, which is in metres. Meshes are read as floats.
Pictures: without sides, deep blue is 0, red is --full, and magenta is beyond. With sides, grey is 0, red is outside and
blue inside; magenta and violet are beyond. tessera raycast MODEL --shade error --mesh MESH -o FILE draws the other way.
The .ply has the deviation as the property quality of its vertices.
The exit status is 1 if a deviation of either way is larger than --tolerance; all is written and printed before.

Examples:
  tessera compare part.step part.stl
  tessera compare part.step part.stl --tolerance 0.05 --json
  tessera compare part.step scan.ply --mesh-unit in -o deviations.png --full 0.1
  tessera compare teapot.bpt teapot.obj --spacing 0.01 -o deviations.ply)";

}  // namespace

void add_compare(Command& tool, Session& session) {
  Command& command = tool.add_command("compare", "Measure how far a mesh and surfaces are apart, both ways");
  const auto options = std::make_shared<CompareOptions>();
  add_model(command, options->load);
  command.add_text("MESH", "FILE", "The file with the mesh (.obj, .ply, .stl, .glb, .gltf)", options->mesh)
      .require()
      .check(fault_of_name);
  command.add_length("--tolerance", "LENGTH", "Exit with 1 if a deviation is larger, in the model's unit [no limit]",
                     [options](double length) { options->tolerance = length; });
  add_mesh_unit(command, options->unit);
  add_untrimmed(command, options->pack);
  add_reading(command, options->load);
  add_points(command, *options);
  add_pictures(command, *options);
  add_common(command, session.common);
  command.footer = compare_footer;
  command.choose = [options, &session] {
    check_input(options->load);
    check_stream_format(options->output, options->format);
    turn_camera(options->view);
    const Plan plan = plan_jobs(options->load.files, options->output, {"--output", ".png"});
    check_overwriting("--output", plan.outputs(), {options->mesh});
    session.choose(plan, options, run_compare);
  };
}

}  // namespace tessera::cli
