// tessera tessellate: surfaces to a mesh.

#include <memory>

#include "arguments.h"
#include "commands.h"
#include "console.h"
#include "io/formats.h"
#include "model_file.h"
#include "tessera/tessellate.h"

namespace tessera::cli {
namespace {

struct Options {
  ModelFile model;
  std::string output;
  Extent grid;
  bool json = false;
};

struct Times {
  double read = 0, tessellate = 0, write = 0;
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

Status report(const Options& options, const Model& model, const PatchSet& set, const Mesh& mesh, const Times& times) {
  if (options.json) {
    return print_json(
        Json{{"output", options.output},
             {"vertices", mesh.vertex_count()},
             {"triangles", mesh.triangle_count()},
             {"rate_u", options.grid.first},
             {"rate_v", options.grid.second},
             {"fit_error", fit_json(set)},
             {"warnings", warnings_json(model)},
             {"seconds", {{"read", times.read}, {"tessellate", times.tessellate}, {"write", times.write}}}});
  }
  return print(options.output + ": " + std::to_string(mesh.vertex_count()) + " vertices, " +
               std::to_string(mesh.triangle_count()) + " triangles; read in " + readable_seconds(times.read) +
               ", tessellated in " + readable_seconds(times.tessellate) + ", written in " +
               readable_seconds(times.write) + "\n" + fit_line(set));
}

Status run_tessellate(const Options& options) {
  Result<OutputFile> out = open_output(options.output);
  if (!out) return out.status();
  Times times;
  const Stopwatch reading;
  const Result<Model> model = open_model(options.model);
  if (!model) return model.status();
  const Result<PatchSet> set = make_patch_set(options.model, *model);
  if (!set) return set.status();
  times.read = reading.seconds();
  const Stopwatch tessellating;
  const Result<Mesh> mesh = tessellate(options, *model, *set);
  if (!mesh) return in_file(options.model.path, mesh.status());
  times.tessellate = tessellating.seconds();
  const Stopwatch writing;
  Status status = write_mesh(*mesh, options.output, *out);
  if (status.ok()) status = out->commit();
  if (!status.ok()) return status;
  times.write = writing.seconds();
  return report(options, *model, *set, *mesh, times);
}

}  // namespace

void add_tessellate(CLI::App& app, Session& session) {
  CLI::App* const command = app.add_subcommand("tessellate", "Turn surfaces into a mesh");
  const auto options = std::make_shared<Options>();
  add_model(*command, options->model);
  command->add_option("-o,--output", options->output, "The mesh to be written (.obj, .ply, .stl, .glb, .gltf)")
      ->required()
      ->type_name("MESH")
      ->check([](const std::string& path) { return check_mesh_format(path).message(); });
  command
      ->add_option_function<std::string>(
          "--grid", [options](const std::string& text) { options->grid = parse_extent("--grid", text, 1, 4096); },
          "Segments of every patch, along u and along v, 1 to 4096 each")
      ->required()
      ->type_name("NxM");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Positions, normals and parameters are written (.stl: triangles alone), a part for each surface in .obj, .glb\n"
      "and .gltf; neighbours share their borders bit for bit.\n"
      "\nExample:\n  tessera tessellate teapot.bpt -o teapot.ply --grid 16x16");
  command->callback([options, &session] {
    refuse_overwriting("--output", options->output, {options->model.path});
    session.command = [options] { return run_tessellate(*options); };
  });
}

}  // namespace tessera::cli
