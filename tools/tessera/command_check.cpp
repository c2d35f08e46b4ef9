// tessera check: whether a mesh is whole.

#include <memory>

#include "commands.h"
#include "console.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

struct Options {
  std::string mesh;
  bool json = false;
};

Json as_json(const Options& options, const MeshReport& report) {
  return {{"mesh", options.mesh},
          {"vertices", report.vertices},
          {"distinct_positions", report.distinct_positions},
          {"triangles", report.triangles},
          {"open_edges", report.open_edges},
          {"non_manifold_edges", report.non_manifold_edges},
          {"inconsistent_edges", report.inconsistent_edges},
          {"degenerate_triangles", report.degenerate_triangles},
          {"non_finite_vertices", report.non_finite_vertices},
          {"closed", report.closed()}};
}

std::string as_text(const Options& options, const MeshReport& report) {
  const auto line = [](const char* what, std::size_t count, const char* note = "") {
    return std::string("  ") + what + std::to_string(count) + note + "\n";
  };
  return options.mesh + ": " + (report.closed() ? "closed" : "not closed") + "\n" +
         line("vertices              ", report.vertices) + line("distinct positions    ", report.distinct_positions) +
         line("triangles             ", report.triangles) +
         line("open edges            ", report.open_edges, "  (of one triangle)") +
         line("non-manifold edges    ", report.non_manifold_edges, "  (of three triangles or more)") +
         line("inconsistent edges    ", report.inconsistent_edges,
              "  (whose two triangles are turned against each other)") +
         line("degenerate triangles  ", report.degenerate_triangles) +
         line("NaN or infinite       ", report.non_finite_vertices, "  (vertices)");
}

Status run_check(const Options& options) {
  const Result<Mesh> mesh = read_mesh(options.mesh);
  if (!mesh) return mesh.status();
  const Result<MeshReport> report = check(*mesh);
  if (!report) return in_file(options.mesh, report.status());
  Status status = options.json ? print_json(as_json(options, *report)) : print(as_text(options, *report));
  if (status.ok() && report->non_finite_vertices != 0) {
    status = Status(StatusCode::non_finite, options.mesh + ": " + std::to_string(report->non_finite_vertices) +
                                                " vertices with NaN or infinity");
  }
  return status;
}

}  // namespace

void add_check(CLI::App& app, Session& session) {
  CLI::App* const command = app.add_subcommand("check", "Count what is wrong with a mesh");
  const auto options = std::make_shared<Options>();
  command->add_option("MESH", options->mesh, "The mesh (.obj, .ply)")->required()->type_name("FILE");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Vertices at the same position, bit for bit, count as one. Open edges are no error, as a model may be open:\n"
      "the exit status is 1 only if the mesh cannot be read, holds NaN or infinity, or has an index out of range.\n"
      "\nExample:\n  tessera check teapot.ply");
  command->callback([options, &session] { session.command = [options] { return run_check(*options); }; });
}

}  // namespace tessera::cli
