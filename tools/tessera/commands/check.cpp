// tessera check: whether meshes are whole.

#include <memory>

#include "batch/jobs.h"
#include "commands/commands.h"
#include "console/report.h"
#include "line/arguments.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

struct CheckOptions {
  std::vector<std::string> meshes;
  bool require_closed = false;
};

Report report_of(const std::string& mesh, const MeshReport& found) {
  Report report;
  report.add("mesh", mesh, mesh + ": " + (found.closed() ? "closed" : "not closed"));
  const auto add = [&](const char* name, std::size_t count, const char* label, const char* note = "") {
    report.add(name, count, std::string("\n  ") + label + std::to_string(count) + note);
  };
  add("vertices", found.vertices, "vertices              ");
  add("distinct_positions", found.distinct_positions, "distinct positions    ");
  add("triangles", found.triangles, "triangles             ", found.quads > 0 ? "  (with two for each quad)" : "");
  add("quads", found.quads, "quads                 ");
  add("open_edges", found.open_edges, "open edges            ", "  (of one triangle)");
  add("non_manifold_edges", found.non_manifold_edges, "non-manifold edges    ", "  (of three triangles or more)");
  add("inconsistent_edges", found.inconsistent_edges, "inconsistent edges    ",
      "  (of two triangles of opposite orientation)");
  add("t_junctions", found.t_junctions, "T-junctions           ", "  (vertices inside open edges)");
  add("flipped_triangles", found.flipped_triangles, "flipped triangles     ", "  (that face away from their normals)");
  add("degenerate_triangles", found.degenerate_triangles, "degenerate triangles  ");
  add("non_finite_vertices", found.non_finite_vertices, "NaN or infinite       ", "  (vertices)");
  report.add("closed", found.closed());
  return report;
}

Status run_check(const Job& job, const CheckOptions& options, const CommonOptions& common, Timings& timings) {
  const std::string& file = job.inputs[0];
  std::vector<std::string> warnings;
  const Result<Mesh> mesh =
      timings.measure("read", [&] { return read_mesh(file, {.keep_quads = true, .warnings = &warnings}); });
  for (const std::string& warning : warnings) warn(warning);
  if (!mesh) return mesh.status();
  const Result<MeshReport> report = timings.measure("check", [&] { return check(*mesh); });
  if (!report) return in_file(file, report.status());
  if (Status status = report_of(file, *report).print({}, common, timings); !status.ok()) return status;
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
    session.choose(plan_jobs(options->meshes, "", {"MESH", "", false}), options, run_check);
  };
}

}  // namespace tessera::cli
