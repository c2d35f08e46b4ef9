// tessera check: whether meshes are whole.

#include <memory>

#include "batch/jobs.h"
#include "commands/commands.h"
#include "line/arguments.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

struct CheckOptions {
  std::vector<std::string> meshes;
  bool require_closed = false;
};

Json as_json(const std::string& mesh, const MeshReport& report) {
  return {{"mesh", mesh},
          {"vertices", report.vertices},
          {"distinct_positions", report.distinct_positions},
          {"triangles", report.triangles},
          {"quads", report.quads},
          {"open_edges", report.open_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"inconsistent_edges", report.inconsistent_edges},
          {"t_junctions", report.t_junctions},
          {"flipped_triangles", report.flipped_triangles},
          {"degenerate_triangles", report.degenerate_triangles},
          {"non_finite_vertices", report.non_finite_vertices},
          {"closed", report.closed()}};
}

std::string as_text(const std::string& mesh, const MeshReport& report) {
  const auto line = [](const char* what, std::size_t count, const char* note = "") {
    return std::string("  ") + what + std::to_string(count) + note + "\n";
  };
  return mesh + ": " + (report.closed() ? "closed" : "not closed") + "\n" +
         line("vertices              ", report.vertices) + line("distinct positions    ", report.distinct_positions) +
         line("triangles             ", report.triangles, report.quads > 0 ? "  (with two for each quad)" : "") +
         line("quads                 ", report.quads) +
         line("open edges            ", report.open_edges, "  (of one triangle)") +
         line("non-manifold edges    ", report.non_manifold_edges, "  (of three triangles or more)") +
         line("inconsistent edges    ", report.inconsistent_edges, "  (of two triangles of opposite orientation)") +
         line("T-junctions           ", report.t_junctions, "  (vertices inside open edges)") +
         line("flipped triangles     ", report.flipped_triangles, "  (that face away from their normals)") +
         line("degenerate triangles  ", report.degenerate_triangles) +
         line("NaN or infinite       ", report.non_finite_vertices, "  (vertices)");
}

Status run_check(const std::string& file, const CheckOptions& options, const CommonOptions& common, Timings& timings) {
  std::vector<std::string> warnings;
  const Result<Mesh> mesh = [&] {
    const auto phase = timings.phase("read");
    return read_mesh(file, {.keep_quads = true, .warnings = &warnings});
  }();
  for (const std::string& warning : warnings) warn(warning);
  if (!mesh) return mesh.status();
  const Result<MeshReport> report = [&] {
    const auto phase = timings.phase("check");
    return check(*mesh);
  }();
  if (!report) return in_file(file, report.status());
  Json json = as_json(file, *report);
  add_seconds(json, common, timings);
  if (Status status = common.json ? print_json(json) : print(as_text(file, *report)); !status.ok()) return status;
  if (report->non_finite_vertices > 0) {
    complain(file + ": " + counted(report->non_finite_vertices, "vertex", "vertices") + " with NaN or infinity");
    return already_said(StatusCode::non_finite);
  }
  if (!options.require_closed || report->closed()) return {};
  complain(file + ": expected a closed mesh, found " + counted(report->open_edges, "open edge") + " and " +
           counted(report->non_manifold_edges, "non-manifold edge"));
  return already_said(StatusCode::invalid_argument);
}

constexpr const char* check_footer =
    "Vertices at the same position, bit for bit, count as one. Open edges are no error, because a model may be open.\n"
    "The exit status is 1 only if a mesh cannot be read, holds NaN or infinity, has an index out of range, or is not\n"
    "closed with --require-closed (closed: no open and no non-manifold edges).\n"
    "\nExamples:\n"
    "  tessera check teapot.ply\n"
    "  tessera check 'meshes/*.ply' --json";

}  // namespace

void add_check(Command& tool, Session& session) {
  Command& command = tool.add_command("check", "Check meshes for cracks, flipped triangles and NaN");
  const auto options = std::make_shared<CheckOptions>();
  command
      .add_words("MESH", "FILE", "Files with meshes (.obj, .ply, .stl, .glb, .gltf), or patterns of their names",
                 options->meshes)
      .check(fault_of_name);
  command.add_flag("--require-closed", "Exit with 1 if a mesh is not closed", options->require_closed);
  add_common(command, session.common);
  command.footer = check_footer;
  command.choose = [options, &session] {
    session.command = [options, &session, plan = plan_jobs(options->meshes, "", {"MESH", "", false})] {
      return run_jobs(plan, session.common, [&](const Job& job, Timings& timings) {
        return run_check(job.inputs[0], *options, session.common, timings);
      });
    };
  };
}

}  // namespace tessera::cli
