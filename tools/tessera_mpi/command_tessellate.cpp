// tessera_mpi tessellate: each rank meshes a part of a model.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <system_error>

#include "commands/commands.h"
#include "console/output.h"
#include "console/report.h"
#include "io/mesh/mesh_pieces.h"
#include "mpi/mpi_ply.h"
#include "stages/write.h"
#include "tessera/io.h"
#include "tessera/part_mesh.h"
#include "tessera/surface_file.h"
#include "tessera/topology.h"
#include "tessera_mpi/mpi_team.h"

namespace tessera::cli {
namespace {

/// Names the edges that faces share: those that the file states, and those that run side by side.
Status join_faces(Model& model, const PackOptions& options) {
  if (options.untrimmed)
    for (ModelSurface& surface : model.surfaces) surface.trims = {};
  const auto is_trimmed = [](const ModelSurface& surface) { return !surface.trims->empty(); };
  if (options.untrimmed || (model.instances.empty() && std::ranges::none_of(model.surfaces, is_trimmed))) {
    model.shapes.clear(), model.instances.clear();
    return {};
  }
  if (model.instances.empty()) {
    Shape all;
    for (const ModelSurface& surface : model.surfaces) all.faces.push_back({surface});
    model.shapes = {std::move(all)};
    model.instances = {{}};
  }
  for (Shape& shape : model.shapes) {
    const Result<std::optional<JoinedShape>> joined = joined_if_free(shape);
    if (joined && *joined) shape = (*joined)->shape;
  }
  Result<std::vector<ModelSurface>> surfaces = placed_faces(model.shapes, model.instances);
  if (surfaces) model.surfaces = *std::move(surfaces);
  return surfaces.status();
}

/// Takes this rank's part of a model that each rank reads whole.
Result<ModelPart> part_of_whole(const Job& job, const TessellateOptions& options, Timings& timings,
                                const Transport& transport) {
  Result<Loaded> loaded = load(job, options.load, With::surfaces, timings);
  if (!loaded) return loaded.status();
  if (Status status = join_faces(loaded->model, options.pack); !status.ok()) return status;
  const Result<SurfaceExtents> extents = surface_extents(loaded->model, options.load.fit);
  if (!extents) return extents.status();
  const PartRun run = run_of_part(loaded->model.surfaces.size(), transport.part(), transport.part_count());
  return part_of(loaded->model, *extents, run.begin, run.end, part_reach(options.mesh.certified, extents->box()));
}

/// Reads this rank's part of a file of patches, and what is around it. Every rank returns at the same stage.
Result<ModelPart> part_of_file(const Job& job, const TessellateOptions& options, Transport& transport) {
  const Result<SurfaceFile> file = SurfaceFile::open(job.inputs[0]);
  if (Status status = transport.agree(file.status()); !status.ok()) return status;
  const SurfaceSource source{file->size(), [&](std::uint64_t first, std::uint64_t end) {
                               return file->read(static_cast<std::size_t>(first), static_cast<std::size_t>(end));
                             }};
  const PartRun run = run_of_part(source.count, transport.part(), transport.part_count());
  const Result<PartOutline> outline = find_part(source, run, options.mesh.certified, transport, options.load.fit);
  if (!outline) return outline.status();
  return load_part(source, *outline);
}

MeshTotals totals_of(const PartSums& sums, bool double_positions) {
  return {sums.all.vertices, sums.all.triangles, sums.all.quads, true, true, true, double_positions};
}

/// Writes one .ply file, `output`, as the leader's `out`.
Status write_ply(const PartMesh& own, const PartSums& sums, const MeshTotals& totals, const std::string& output,
                 OutputFile& out, MpiTeam& team) {
  const Result<PlyLayout> layout = PlyLayout::make(totals);
  if (!layout) return layout.status();
  const Result<std::string> file = team.text_of_leader(out.temporary().string());
  if (!file) return file.status();
  const PiecePlace place{sums.before.vertices, sums.before.triangles, sums.before.quads, sums.before.patches};
  Status written = write_ply_piece(MPI_COMM_WORLD, *file, *layout, own.mesh, place);
  if (!written.ok()) written = Status(written.code(), output + ": " + written.message());
  return team.transport().agree(written);
}

/// Writes a piece for each rank, then the index. If any rank fails, no piece stays.
Status write_vtp(const PartMesh& own, const PartSums& sums, const MeshTotals& totals, const std::string& index,
                 MpiTeam& team) {
  Transport& transport = team.transport();
  const Status piece = write_vtp_piece(own.mesh, totals, index, transport.part(), sums.before.patches);
  Status written = transport.agree(piece);
  if (written.ok())
    written = transport.agree(team.leads() ? write_pvtp(totals, index, transport.part_count()) : Status());
  std::error_code ignored;
  if (!written.ok() && piece.ok()) std::filesystem::remove(vtp_piece_path(index, transport.part()), ignored);
  return written;
}

Status report(const Job& job, const CommonOptions& common, const PartSums& sums, const Transport& transport,
              const Timings& timings) {
  const bool has_bound = std::isfinite(sums.bound);  // rates keep none
  Report report;
  report.add("output", job.output, job.output + ": ");
  report.add("models", job.inputs);
  report.add("ranks", transport.part_count());
  report.add("patches", sums.all.patches);
  report.add("vertices", sums.all.vertices, counted(sums.all.vertices, "vertex", "vertices") + ", ");
  report.add("triangles", sums.all.triangles, counted(sums.all.triangles + 2 * sums.all.quads, "triangle"));
  report.add("quads", sums.all.quads);
  report.add("bound", has_bound ? Json(sums.bound) : Json(),
             has_bound ? ", within " + readable(sums.bound, 3) + " of the surfaces" : "");
  report.add("certified", sums.certified, has_bound && sums.certified ? ", proven" : "");
  report.add("gap", sums.gap);
  report.add("bytes_sent", transport.bytes_sent(), ", by " + counted(transport.part_count(), "rank"));
  return report.print(job.output, common, timings);
}

bool is_ply(const std::string& path) { return lower_extension(path) == ".ply"; }

/// Whether ranks read runs of a file, instead of all of it.
bool reads_runs(const std::string& path) { return lower_extension(path) == ".bpt"; }

/// Warns if only some ranks evaluate without fused multiply-adds: their parts then differ from those of the others.
Status compare_instruction_sets(const std::string& output, MpiTeam& team) {
  const Result<Isa> own = default_isa();
  const bool is_sse2 = own && *own == Isa::sse2;
  double found[] = {is_sse2 ? 1.0 : 0.0, is_sse2 ? 0.0 : 1.0};
  if (Status status = team.transport().reduce_max(found); !status.ok()) return status;
  if (team.leads() && found[0] + found[1] > 1)
    warn(output +
         ": some ranks use sse2 and others do not, so this is the mesh of neither: set TESSERA_ISA=sse2 for all");
  return {};
}

Status mesh_together(const Job& job, const TessellateOptions& options, const CommonOptions& common, MpiTeam& team,
                     Timings& timings) {
  Transport& transport = team.transport();
  Result<OutputFile> out = open_output(is_ply(job.output) ? job.output : "/dev/null", team.leads());
  if (Status status = transport.agree(out.status()); !status.ok()) return status;
  if (Status status = compare_instruction_sets(job.output, team); !status.ok()) return status;
  Result<ModelPart> part = reads_runs(job.inputs[0]) ? part_of_file(job, options, transport)
                                                     : part_of_whole(job, options, timings, transport);
  if (Status status = transport.agree(part.status()); !status.ok()) return status;
  const FilePlan plan = plan_for_file(options.mesh, part->box, job.output);
  Result<PartMesh> own =
      timings.measure("mesh", [&] { return tessellate_part(*part, plan.options, {}, options.load.fit); });
  if (own && plan.has_double_sums) add_double_sums(own->mesh);
  Result<PartSums> sums = sum_parts(own, plan.options, transport);
  if (!sums) return sums.status();
  sums->bound += plan.rounding;
  const auto phase = timings.phase("write");
  const MeshTotals totals =
      totals_of(*sums, plan.has_double_sums || plan.options.precision == Precision::double_precision);
  Status status = is_ply(job.output) ? write_ply(*own, *sums, totals, job.output, *out, team)
                                     : write_vtp(*own, *sums, totals, job.output, team);
  if (status.ok() && team.leads() && is_ply(job.output)) status = out->commit();
  status = transport.agree(status);
  return status.ok() && team.leads() ? report(job, common, *sums, transport, timings) : status;
}

std::string fault_of_place(const std::string& path) {
  const std::string extension = lower_extension(path);
  return extension == ".ply" || extension == ".pvtp" ? "" : "is " + path + ", it must end in .ply or .pvtp";
}

/// Throws UsageError if an option decides for the whole mesh.
void check_local(const MeshOptions& options) {
  const TessellationOptions& mesh = options.certified;
  const auto refuse = [](const char* option) {
    throw UsageError(option, "decides for the whole mesh, of which each rank has a part: use tessera tessellate");
  };
  if (mesh.budget) refuse("--triangles");
  if (mesh.fewest) refuse("--fewest");
  if (mesh.joining.crease_angle) refuse("--crease");
  if (mesh.joining.share_vertices) refuse("--share-vertices");
}

}  // namespace

void add_tessellate_by_ranks(Command& tool, Session& session, MpiTeam& team) {
  Command& command = tool.add_command("tessellate", "Turn a model into a mesh, each rank a part of it");
  const auto options = std::make_shared<TessellateOptions>();
  add_models(command, options->load);
  command
      .add_text("-o,--output", "FILE",
                "The mesh: .ply, one file; or .pvtp, an index that viewers open, with a file .vtp for each rank",
                options->write.output)
      .require()
      .check(fault_of_place);
  const std::vector<const Option*> density = add_density(command, options->mesh);
  add_mesh_options(command, options->mesh);
  add_reading(command, options->load);
  add_untrimmed(command, options->pack);
  add_view(command, options->mesh);
  add_common(command, session.common);
  command.footer =
      "The mesh is the same for any number of ranks, byte for byte, on one instruction set. Ranks read runs of a .bpt\n"
      "file, and all of any other file. Instances are meshed where they stand, as one mesh. Not for options that "
      "decide\n"
      "for the whole mesh: --triangles, --fewest, --share-vertices, --crease.\n"
      "\nExamples:\n"
      "  mpirun -n 4 tessera_mpi tessellate sheet.bpt -o sheet.ply --tolerance 0.01\n"
      "  mpirun -n 4 tessera_mpi tessellate part.step -o part.pvtp --relative 1e-4";
  command.choose = [options, &session, &team, density] {
    check_input_of_team(options->load);
    if (options->load.files.size() != 1) throw UsageError("MODEL", "expected one file");
    set_default(density, options->mesh);
    check_local(options->mesh);
    options->mesh.certified = plan_options(options->mesh);
    const Plan plan = plan_jobs(options->load.files, options->write.output, {"--output", ".ply"});
    session.command = [options, plan, &session, &team] {
      return run_jobs(plan, session.common, [&](const Job& job, Timings& timings) {
        return mesh_together(job, *options, session.common, team, timings);
      });
    };
  };
}

}  // namespace tessera::cli
