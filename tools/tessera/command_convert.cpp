// tessera convert: surfaces to Bezier patches in another format.

#include <memory>

#include "arguments.h"
#include "commands.h"
#include "console.h"
#include "io/formats.h"
#include "model_file.h"

namespace tessera::cli {
namespace {

struct Options {
  ModelFile model;
  std::string output;
  bool json = false;
};

Status report(const Options& options, const Model& model, const WrittenModel& written) {
  if (options.json) {
    Json warnings = warnings_json(model);
    for (const std::string& warning : written.warnings) warnings.push_back(warning);
    return print_json(Json{{"output", options.output},
                           {"surfaces", written.surfaces},
                           {"patches", written.patches},
                           {"fit_error", fit_json(written.fit_error)},
                           {"warnings", warnings}});
  }
  return print(options.output + ": " + std::to_string(written.surfaces) + " surfaces, " +
               std::to_string(written.patches) + " patches\n" + fit_line(written.fit_error));
}

Status run_convert(const Options& options) {
  Result<OutputFile> out = open_output(options.output);
  if (!out) return out.status();
  const Result<Model> model = open_model(options.model);
  if (!model) return model.status();
  const Result<WrittenModel> written = write_model(*model, options.output, options.model.fit, *out);
  if (!written) return written.status();
  if (Status status = out->commit(); !status.ok()) return status;
  say_warnings(written->warnings);
  return report(options, *model, *written);
}

}  // namespace

void add_convert(CLI::App& app, Session& session) {
  CLI::App* const command = app.add_subcommand("convert", "Write surfaces as Bezier patches in another format");
  const auto options = std::make_shared<Options>();
  add_model(*command, options->model);
  command->add_option("-o,--output", options->output, "The surfaces to be written (.bpt, .obj)")
      ->required()
      ->type_name("SURFACES")
      ->check([](const std::string& path) { return check_model_format(path).message(); });
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      ".obj keeps weights, names, trims and the ranges of parameters; .bpt holds polynomial patches alone.\n"
      "What the file does not hold is said as a warning.\n"
      "\nExample:\n  tessera convert goblet.json -o goblet.obj");
  command->callback([options, &session] {
    refuse_overwriting("--output", options->output, {options->model.path});
    session.command = [options] { return run_convert(*options); };
  });
}

}  // namespace tessera::cli
