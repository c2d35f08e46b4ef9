// The command line: surfaces in, points, meshes, pictures and ray hits out.

#include <cstdio>
#include <exception>
#include <sstream>

#include "commands.h"
#include "console.h"
#include "tessera/isa.h"

namespace {

constexpr int success = 0, bad_input = 1, bad_command_line = 2;

void complain(const std::string& message) { std::fprintf(stderr, "tessera: %s\n", message.c_str()); }

void describe(CLI::App& app) {
  app.set_version_flag("--version", "tessera " TESSERA_VERSION);
  app.require_subcommand(0, 1);  // none is seen after parsing, so that a wrong word is named first
  app.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("tessera: ") + error.what() + "\nTry tessera --help, or --help after a command.\n";
  });
  app.footer(
      "Models are read as .bpt (Bezier patches; # begins a comment), .bv (BezierView), .g2 (GoTools), .json (surfaces\n"
      "of every kind; tools/models/FORMAT.md tells the format), .obj (free-form surfaces), .rib (RenderMan), and, where\n"
      "OpenCASCADE was there at the build, .step and .iges; what of them is not read is said as a warning.\n"
      "Meshes are written as .obj, .ply, .stl, .glb and .gltf (glTF 2.0) and read as .obj, .ply and .stl; surfaces are\n"
      "written as .obj (free-form) and .bpt; pictures as .png, and as .exr (numbers: depth, normals, parameters).\n"
      "Surfaces, patches and rays are counted from 0.\n"
      "TESSERA_ISA=sse2|avx2|avx512 in the environment forces an instruction set.\n"
      "Exit status: 0 done, 1 the input is bad or the output cannot be written, 2 the command line is bad.\n"
      "Outputs appear whole or not at all.\n"
      "\nExample:\n  tessera raycast teapot.bpt -o teapot.png");
}

int run(int argc, char** argv) {
  CLI::App app("Tessera: parametric surfaces to points, meshes and ray hits", "tessera");
  tessera::cli::Session session;
  describe(app);
  tessera::cli::add_info(app, session);
  tessera::cli::add_eval(app, session);
  tessera::cli::add_tessellate(app, session);
  tessera::cli::add_raycast(app, session);
  tessera::cli::add_convert(app, session);
  tessera::cli::add_check(app, session);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream output, errors;
    const int status = app.exit(error, output, errors);
    const tessera::Status printed = tessera::cli::print(output.str());
    if (!printed.ok()) {
      complain(printed.message());
      return bad_input;
    }
    std::fputs(errors.str().c_str(), stderr);
    return status == 0 ? success : bad_command_line;
  }
  if (!session.command) {
    complain("expected a command (info, eval, tessellate, raycast, convert, check), found none\nTry tessera --help.");
    return bad_command_line;
  }
  const tessera::Result<tessera::Isa> isa = tessera::default_isa();
  if (!isa) {
    complain(isa.status().message());
    return bad_command_line;
  }
  tessera::cli::catch_signals();
  const tessera::Status status = session.command();
  if (!status.ok() && status.code() != tessera::StatusCode::cancelled) complain(status.message());
  tessera::cli::end_by_signal();
  return status.ok() ? success : bad_input;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    complain(error.what());
    return bad_input;
  }
}
