// tessera convert: converts surfaces to Bezier patches in another format.

#include <memory>

#include "batch/batch.h"
#include "commands/commands.h"
#include "console/console.h"
#include "console/output.h"
#include "io/format/output_formats.h"
#include "line/arguments.h"
#include "stages/write.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

struct ConvertOptions {
  LoadOptions load;
  WriteOptions write;
};

Status report(const Job& job, const CommonOptions& common, const Loaded& loaded, const WrittenModel& written,
              const Timings& timings) {
  std::vector<std::string> warnings = loaded.model.warnings;
  warnings.insert(warnings.end(), written.warnings.begin(), written.warnings.end());
  Report report = report_of(job, loaded);
  report.add("surfaces", written.surfaces, counted(written.surfaces, "surface"));
  report.add("patches", written.patches, ", " + counted(written.patches, "patch", "patches"));
  report.add("fit_error", fit_json(written.fit_error), fit_line(written.fit_error));
  report.add("warnings", warnings);
  return report.print(job.output, common, timings);
}

Status run_convert(const Job& job, const ConvertOptions& options, const CommonOptions& common, Timings& timings) {
  Result<OutputFile> out = open_output(job.output);
  if (!out) return out.status();
  const Result<Loaded> loaded = load(job, options.load, With::surfaces, timings);
  if (!loaded) return loaded.status();
  const Result<WrittenModel> written = timings.measure("write", [&] {
    return write_model(loaded->model, format_path(job.output, options.write.format), options.load.fit, *out);
  });
  if (!written) return written.status();
  if (Status status = out->commit(); !status.ok()) return status;
  for (const std::string& warning : written->warnings) warn(warning);
  const Status said = report(job, common, *loaded, *written, timings);
  return said.ok() ? loaded->status() : said;
}

constexpr const char* model_extension = ".obj";

std::string fault_of_model_file(const std::string& path) {
  if (path.empty()) return fault_of_name(path);
  return is_folder(path) || is_stream(path) ? "" : check_model_format(path).message();
}

constexpr const char* convert_footer =
    ".obj and .json keep weights, names, trims and the ranges of parameters. .bpt holds only polynomial patches. A\n"
    "warning names each part of a model that the file does not hold. Several models become one file, or one file each "
    "if\n"
    "the output is a folder (then as .obj) or contains {name}.\n"
    "\nExample:\n"
    "  tessera convert goblet.json -o goblet.obj";

}  // namespace

void add_convert(Command& tool, Session& session) {
  Command& command = tool.add_command("convert", "Write surfaces as Bezier patches in another format");
  const auto options = std::make_shared<ConvertOptions>();
  add_models(command, options->load);
  command
      .add_text("-o,--output", "FILE",
                "The file of surfaces (.bpt, .json, .obj), a folder, a name with {name}, or - for standard output",
                options->write.output)
      .require()
      .check(fault_of_model_file);
  add_stream_format(command, {"bpt", "json", "obj"}, options->write.format);
  add_reading(command, options->load);
  add_batch(command, session.common.batch);
  add_common(command, session.common);
  command.footer = convert_footer;
  command.choose = [options, &session] {
    const std::vector<std::string> listed = listed_files(session.common.batch, options->load.files);
    check_input(options->load);
    check_stream_format(options->write.output, options->write.format);
    const Plan plan = plan_jobs(options->load.files, options->write.output, {"--output", model_extension}, listed);
    check_batch(session.common.batch, plan);
    session.choose(plan, options, run_convert);
  };
}

}  // namespace tessera::cli
