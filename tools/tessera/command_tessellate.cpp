// tessera tessellate: surfaces to a mesh.

#include <memory>

#include "arguments.h"
#include "commands.h"
#include "io/formats.h"
#include "loading.h"
#include "progress.h"
#include "tessera/tessellate.h"

namespace tessera::cli {
namespace {

struct Options {
  ModelOptions models;
  std::string output;
  Extent grid;
};

Result<Mesh> tessellate(const Options& options, const Model& model, const PatchSet& set) {
  const Result<TessellationPlan> plan =
      TessellationPlan::make(set, {.rate_u = options.grid.first, .rate_v = options.grid.second, .isa = {}});
  if (!plan) return plan.status();
  Result<Mesh> mesh = plan->allocate();
  if (!mesh) return mesh;
  Progress progress("tessellating");
  const Status status = plan->run(set, mesh->views(), progress.execution());
  if (!status.ok()) return status;
  Result<std::vector<MeshPart>> parts = parts_by_surface(*mesh, set, model);
  if (!parts) return parts.status();
  mesh->parts = *std::move(parts);
  return mesh;
}

Status report(const Job& job, const Options& options, const CommonOptions& common, const Loaded& loaded,
              const PatchSet& set, const Mesh& mesh, const Timings& timings) {
  if (!common.json) {
    return print(job.output + ": " + std::to_string(mesh.vertex_count()) + " vertices, " +
                 std::to_string(mesh.triangle_count()) + " triangles\n" + fit_line(set));
  }
  Json object = files_json(loaded);
  object["output"] = job.output;
  object["vertices"] = mesh.vertex_count();
  object["triangles"] = mesh.triangle_count();
  object["rate_u"] = options.grid.first;
  object["rate_v"] = options.grid.second;
  add_model_facts(object, loaded, set);
  add_seconds(object, common, timings);
  return print_json(object);
}

Status run_tessellate(const Job& job, const Options& options, const CommonOptions& common, Timings& timings) {
  Result<OutputFile> out = open_output(job.output);
  if (!out) return out.status();
  const Result<Loaded> loaded = load(job, options.models.fit, With::patches, timings);
  if (!loaded) return loaded.status();
  const Result<PatchSet> set = pack(*loaded, timings);
  if (!set) return set.status();
  const Result<Mesh> mesh = [&] {
    const auto phase = timings.phase("evaluate");
    return tessellate(options, loaded->model, *set);
  }();
  if (!mesh) return in_file(job.inputs[0], mesh.status());
  {
    const auto phase = timings.phase("write");
    Status status = write_mesh(*mesh, job.output, *out);
    if (status.ok()) status = out->commit();
    if (!status.ok()) return status;
  }
  const Status said = report(job, options, common, *loaded, *set, *mesh, timings);
  return said.ok() ? loaded->status() : said;
}

constexpr const char* extension_in_folders = ".ply";

std::string fault_of_output(const std::string& path) {
  if (path.empty()) return fault_of_name(path);
  return is_folder(path) ? "" : check_mesh_format(path).message();
}

constexpr const char* footer =
    "Positions, normals and parameters are written (.stl: triangles alone), a part for each surface in .obj, .glb and\n"
    ".gltf; neighbours share their borders bit for bit. Several models become\n"
    "one mesh, or one each where the output is a folder (then as .ply) or holds {name}.\n"
    "\nExamples:\n"
    "  tessera tessellate teapot.bpt -o teapot.ply --grid 16x16\n"
    "  tessera tessellate 'parts/*.json' -o 'meshes/{name}.obj' --grid 8x8";

}  // namespace

void add_tessellate(CLI::App& app, Session& session) {
  CLI::App* const command = app.add_subcommand("tessellate", "Turn surfaces into meshes");
  const auto options = std::make_shared<Options>();
  add_models(*command, options->models);
  command
      ->add_option("-o,--output", options->output,
                   "The mesh to be written (.obj, .ply, .stl, .glb, .gltf), or a folder, or a name with {name}")
      ->required()
      ->type_name("FILE")
      ->check(fault_of_output);
  command
      ->add_option_function<std::string>(
          "--grid", [options](const std::string& text) { options->grid = parse_extent("--grid", text, 1, 4096); },
          "Segments of every patch, along u and along v, 1 to 4096 each")
      ->required()
      ->type_name("NxM");
  add_common(*command, session.common);
  command->footer(footer);
  command->callback([options, &session] {
    const Plan plan = plan_jobs(options->models.files, options->output, {"--output", extension_in_folders});
    session.command = [options, plan, &session] {
      return run_jobs(plan, session.common, [&](const Job& job, Timings& timings) {
        return run_tessellate(job, *options, session.common, timings);
      });
    };
  });
}

}  // namespace tessera::cli
