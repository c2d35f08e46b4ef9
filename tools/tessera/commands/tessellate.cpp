// tessera tessellate: makes a mesh of surfaces.

#include <memory>

#include "batch/batch.h"
#include "batch/kept.h"
#include "commands/commands.h"
#include "console/output.h"
#include "line/arguments.h"
#include "stages/faults.h"
#include "stages/pieces.h"
#include "stages/write.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

constexpr const char* tessellate_footer =
    R"(The mesh has positions, normals and parameters (.stl: triangles only). .obj, .glb and .gltf have one part for each
surface. Neighbours share their borders bit for bit. With --share-vertices they share vertices too. Texture
coordinates are the surfaces' parameters, see --uv. Several models become one mesh, or one mesh each if the
output is a folder (then as .ply) or contains {name}.
Each shape of a CAD file is meshed once. .glb and .gltf have a node for each instance, with its name, place and
colours, in metres; others have one mesh of all instances. --triangles and --pixels mesh all faces as one.
With --tolerance, --relative or --triangles each patch gets the rates that it needs, and neighbours meet without a
crack. The printed bound is proven, and includes fits and the rounding of the file's numbers. With --quads whole
cells are faces of four corners; strips along borders and cells at poles are triangles.
Far from zero .ply and .obj get positions in double; a .stl that does not keep the tolerance is written with a
warning.
With --in-pieces a .ply has the bytes that it has without, unless faces are trimmed: these are not joined.

Examples:
  tessera tessellate part.step -o part.glb
  tessera tessellate teapot.bpt -o teapot.ply --grid 16x16
  tessera tessellate teapot.bpt -o teapot.ply --tolerance 0.001 --angle 10
  tessera tessellate teapot.bpt -o teapot.ply --pixels 0.5 --camera=4,-8,5,0,0,1.5,40
  tessera tessellate huge.bpt -o huge.pvtp --in-pieces 4G
  tessera tessellate 'parts/*.json' -o 'meshes/{name}.obj' --grid 8x8)";

/// Reads, meshes and writes a model that is larger than memory.
Status run_in_pieces(const Job& job, const TessellateOptions& options, const CommonOptions& common, Timings& timings) {
  const Result<InPieces> result = mesh_in_pieces(job, options, timings);
  if (!result) return result.status();
  say_warnings(result->warnings);
  warn_of_rounding(job.output, result->made);
  const std::vector<std::string> faults = mesh_faults(options.mesh, result->warnings, result->made);
  Report report = report_of(job, *result, options.mesh);
  add_faults(report, options.mesh, faults);
  const Status said = report.print(job.output, common, timings);
  return said.ok() ? complain_of(job.output, faults) : said;
}

Report report_of(const Job& job, const Loaded& loaded, const Meshed& made, const MeshOptions& options,
                 const std::vector<std::string>& faults, const Timings& timings) {
  Report report = report_of(job, loaded);
  add_shape_facts(report, loaded.model, made);
  add_mesh_facts(report, options, made);
  add_border_facts(report, options, made);
  add_faults(report, options, faults);
  add_model_facts(report, loaded, made.patches, made.fit_error);
  if (made.by_shapes) report.say(", in " + readable_seconds(timings.total()));
  report.say(fit_line(made.fit_error));
  return report;
}

Status run_tessellate(const Job& job, const TessellateOptions& options, const CommonOptions& common, Timings& timings) {
  if (options.piece_bytes > 0) return run_in_pieces(job, options, common, timings);
  Result<OutputFile> out = open_output(job.output);
  if (!out) return out.status();
  const std::string path = format_path(job.output, options.write.format);
  const With with = allows_shapes(options.mesh) ? With::shapes : With::patches;
  Result<Loaded>& loaded = kept(load(job, options.load, with, timings));
  if (!loaded) return loaded.status();
  Result<Packed> packed = pack_for_meshes(*loaded, options.pack, suits_shapes(options.mesh, *loaded), timings);
  if (!packed) return packed.status();
  const Result<Meshed>& made = kept(mesh_sets(*std::move(packed), *loaded, options.mesh, path, timings));
  if (!made) return made.status();
  warn_of_rounding(job.output, *made);
  warn_of_surfaces(*loaded, *made);
  if (Status status = write_meshes(*made, path, options.write, *out, timings); !status.ok()) return status;
  const Result<std::vector<std::string>> faults = mesh_faults(options.mesh, loaded->model, *made);
  if (!faults) return faults.status();
  Status said = report_of(job, *loaded, *made, options.mesh, *faults, timings).print(job.output, common, timings);
  if (said.ok()) said = complain_of(job.output, *faults);
  return said.ok() ? loaded->status() : said;
}

constexpr const char* mesh_extension = ".ply";

std::string fault_of_mesh_file(const std::string& path) {
  if (path.empty()) return fault_of_name(path);
  return is_folder(path) || is_stream(path) || is_index(path) ? "" : check_mesh_format(path).message();
}

/// Throws UsageError if a file that has no packed form is to be packed.
void check_compression(const Plan& plan, const WriteOptions& options) {
  if (!options.mesh.packed) return;
  for (const Job& job : plan.jobs) {
    const std::string extension = lower_extension(format_path(job.output, options.format));
    if (extension != ".glb" && extension != ".gltf")
      throw UsageError("--compress", "is for .glb and .gltf, found " + (extension.empty() ? job.output : extension));
  }
}

}  // namespace

void add_tessellate(Command& tool, Session& session) {
  Command& command = tool.add_command("tessellate", "Turn surfaces into meshes");
  const auto options = std::make_shared<TessellateOptions>();
  add_models(command, options->load);
  command
      .add_text("-o,--output", "FILE",
                "The mesh file (.obj, .ply, .stl, .glb, .gltf), a folder, a name with {name}, or - for standard output",
                options->write.output)
      .require()
      .check(fault_of_mesh_file);
  add_stream_format(command, {"obj", "ply", "stl", "glb", "gltf"}, options->write.format);
  command.add_choice(
      "--up", {"z", "y"},
      "The axis of the model that points up: .glb and .gltf are turned so that viewers show it upwards [z]",
      [options](const std::string& text) { options->write.mesh.up = text == "y" ? UpAxis::y : UpAxis::z; });
  command.add_flag("--compress",
                   "Pack the numbers of .glb and .gltf, without a change of a bit, by EXT_meshopt_compression, which "
                   "most viewers know",
                   options->write.mesh.packed);
  const std::vector<const Option*> density = add_density(command, options->mesh);
  add_mesh_options(command, options->mesh);
  add_reading(command, options->load);
  add_untrimmed(command, options->pack);
  add_view(command, options->mesh);
  add_batch(command, session.common.batch);
  add_common(command, session.common);
  add_in_pieces(command, *options);
  command.footer = tessellate_footer;
  command.choose = [options, &session, density] {
    const std::vector<std::string> listed = listed_files(session.common.batch, options->load.files);
    check_input(options->load);
    check_stream_format(options->write.output, options->write.format);
    set_default(density, options->mesh);
    const Plan plan = plan_jobs(options->load.files, options->write.output, {"--output", mesh_extension}, listed);
    check_batch(session.common.batch, plan);
    check_pieces(*options, plan);
    check_formats(plan, options->mesh);
    check_compression(plan, options->write);
    session.choose(plan, options, run_tessellate);
  };
}

}  // namespace tessera::cli
