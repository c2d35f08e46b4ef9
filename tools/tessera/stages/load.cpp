#include "stages/load.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "console/output.h"
#include "console/progress.h"
#include "line/arguments.h"
#include "tessera/cad.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

/// Reads a file, or standard input. An interrupt ends the program that reads CAD files.
Result<Model> read_any_model(const std::string& path, const LoadOptions& options) {
  ModelReadOptions read{.format = {}, .cad = {.cancel = &interrupted(), .step_reader = options.step_reader}};
  if (path != stream_name) return read_model(path, read);
  constexpr std::string_view device = "/dev/stdin", name = "standard input";
  const Result<std::string> bytes = read_file(device);
  if (!bytes) return Status(bytes.status().code(), std::string(name) + bytes.status().message().substr(device.size()));
  read.format = options.input_format;
  return parse_model(*bytes, name, read);
}

constexpr std::array<std::pair<const char*, StepReader>, 3> step_readers{
    {{"tessera", StepReader::tessera}, {"opencascade", StepReader::opencascade}, {"either", StepReader::either}}};

std::size_t count_trimmed(std::span<const ModelSurface> surfaces) {
  return static_cast<std::size_t>(std::count_if(surfaces.begin(), surfaces.end(),
                                                [](const ModelSurface& surface) { return !surface.trims->empty(); }));
}

/// Converts surfaces on all threads; if several fail, reports the first one.
Result<std::vector<PatchGrid>> convert(const Model& model, const FitOptions& fit) {
  const std::size_t count = model.surfaces.size();
  std::vector<std::optional<Result<PatchGrid>>> results(count);
  PartsProgress progress("converting", count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
    if (interrupted()) return;
    results[k].emplace(to_bezier(model.surfaces[k], fit));
    progress.tell(k, 1);
  });
  std::vector<PatchGrid> grids;
  grids.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (!results[k]) return Status(StatusCode::cancelled, "interrupted");
    if (!*results[k]) return in_surface(model, k, results[k]->status());
    grids.push_back(*std::move(*results[k]));
  }
  return grids;
}

/// Adds the surfaces and shapes of another file.
void append(Model& model, Model&& other) {
  const auto move = [](auto& to, auto& from) { std::move(from.begin(), from.end(), std::back_inserter(to)); };
  for (Instance& instance : other.instances) {
    instance.shape += static_cast<std::uint32_t>(model.shapes.size());
    instance.first_surface += model.surfaces.size();
  }
  move(model.surfaces, other.surfaces);
  move(model.warnings, other.warnings);
  move(model.shapes, other.shapes);
  move(model.instances, other.instances);
  if (model.unit != other.unit) model.unit.clear();
  if (model.file_unit != other.file_unit) model.file_unit.clear();
}

/// Leaves a model's surfaces without edges: files without shapes are meshed with it, so its shapes would not be all.
void drop_shapes(Model& model) {
  model.shapes.clear();
  model.instances.clear();
  for (ModelSurface& surface : model.surfaces) {
    if (std::ranges::all_of(*surface.trims, [](const TrimLoop& loop) { return loop.coedges.empty(); })) continue;
    std::vector<TrimLoop> loops = *surface.trims;
    for (TrimLoop& loop : loops) loop.coedges.clear();
    surface.trims = std::move(loops);
  }
}

/// Reads one file of a job and adds it to `loaded`.
Status add_file(const Job& job, const std::string& file, const LoadOptions& options, With with, Timings& timings,
                Loaded& loaded) {
  Result<Model> model = timings.measure("read", [&] { return read_any_model(file, options); });
  if (!model) return model.status();
  say_warnings(model->warnings);
  const bool has_shapes = !model->instances.empty();
  if (with == With::patches || (with == With::shapes && !has_shapes)) {
    const auto phase = timings.phase("convert");
    if (job.inputs.size() > 1 || !are_patches(*model)) {
      Result<std::vector<PatchGrid>> grids = convert(*model, options.fit);
      if (!grids) return in_file(file, grids.status());
      std::move(grids->begin(), grids->end(), std::back_inserter(loaded.grids));
    }
  }
  loaded.all_have_shapes &= has_shapes;
  loaded.files.push_back(file);
  loaded.first.push_back(loaded.model.surfaces.size());
  if (loaded.files.size() == 1)
    loaded.model = *std::move(model);
  else
    append(loaded.model, *std::move(model));
  return {};
}

std::vector<std::string> model_format_names() {
  std::vector<std::string> names;
  std::istringstream list(model_formats());
  for (std::string name; list >> name;) names.push_back(name.substr(1, name.find(',') - 1));
  return names;
}

void add_input_format(Command& command, LoadOptions& options) {
  command.add_choice("--input-format", model_format_names(), "Format of standard input, for MODEL -",
                     [&options](const std::string& name) { options.input_format = name; });
}

}  // namespace

std::string model_formats() {
  return ".bpt, .bv, .g2, .json, .obj, .rib, .step, .stp, .p21, .stpz, .iges, .igs, .brep, .brp";
}

void add_models(Command& command, LoadOptions& options) {
  command
      .add_words("MODEL", "FILE",
                 "Files with surfaces (" + model_formats() + "), patterns of their names, or - for standard input",
                 options.files)
      .check(fault_of_name);
  add_input_format(command, options);
}

void add_model(Command& command, LoadOptions& options) {
  command
      .add("MODEL", "FILE", "The file with surfaces (" + model_formats() + "), or - for standard input",
           [&options](const std::string& file) { options.files = {file}; })
      .require()
      .check(fault_of_name);
  add_input_format(command, options);
}

void check_input(const LoadOptions& options) {
  const auto streams = std::count(options.files.begin(), options.files.end(), stream_name);
  if (streams > 1) throw UsageError("MODEL", "- is there " + std::to_string(streams) + " times; give it once");
  if (streams > 0 && options.input_format.empty()) throw UsageError("MODEL", "- needs --input-format NAME");
  if (streams == 0 && !options.input_format.empty())
    throw UsageError("--input-format", "is for MODEL - only; the extension of a file decides its format");
}

void check_input_of_team(const LoadOptions& options) {
  if (std::ranges::find(options.files, stream_name) != options.files.end())
    throw UsageError("MODEL", "processes cannot share standard input: name a file");
}

void add_reading(Command& command, LoadOptions& options) {
  command.add_length("--fit-tolerance", "LENGTH",
                     "Largest distance of patches from surfaces that are written as expressions, in the model's unit "
                     "[1e-6 of the surface's size]",
                     [&options](double length) { options.fit.tolerance = length; });
  std::vector<std::string> readers;
  for (const auto& [name, reader] : step_readers) readers.emplace_back(name);
  const auto usual = std::ranges::find(step_readers, options.step_reader, &std::pair<const char*, StepReader>::second);
  command.add_choice("--step-reader", readers,
                     "Who reads STEP files: tessera itself, the CAD reader by OpenCASCADE, or the CAD reader where "
                     "tessera fails or warns [" +
                         std::string(usual->first) + "]",
                     [&options](const std::string& name) {
                       for (const auto& [known, reader] : step_readers)
                         if (name == known) options.step_reader = reader;
                     });
  command
      .add("--cad-reader", "FILE", "Program that reads IGES and BREP files [the tessera-cad-reader beside tessera]",
           [](const std::string& file) { ::setenv("TESSERA_CAD_READER", file.c_str(), 1); })
      .check(fault_of_name);
}

std::size_t Loaded::trimmed() const { return count_trimmed(model.surfaces); }

Status Loaded::in_surface(std::size_t surface, const Status& status) const {
  const auto after = std::upper_bound(first.begin(), first.end(), surface);
  const auto file = static_cast<std::size_t>(after - first.begin()) - 1;
  const std::string& name = *model.surfaces[surface].name;
  return Status(status.code(), files[file] + ": surface " + std::to_string(surface - first[file]) +
                                   (name.empty() ? "" : " (" + name + ")") + ": " + status.message());
}

Status Loaded::in_place(std::size_t first_surface, const Status& status) const {
  if (status.index() == Status::no_index) return in_file(files[0], status);
  const std::size_t surface = first_surface + static_cast<std::size_t>(status.index());
  const std::string& message = status.message();
  const std::string& name = *model.surfaces[surface].name;
  const std::string prefix =
      "surface " + std::to_string(status.index()) + (name.empty() ? "" : " (" + name + ")") + ": ";
  return in_surface(surface, {status.code(), message.substr(message.starts_with(prefix) ? prefix.size() : 0)});
}

Status Loaded::status() const { return failed.empty() ? Status() : already_said(failed.back().second.code()); }

Result<Loaded> load(const Job& job, const LoadOptions& options, With with, Timings& timings) {
  Loaded loaded;
  loaded.fit = options.fit;
  for (const std::string& file : job.inputs) {
    const Status status = add_file(job, file, options, with, timings, loaded);
    if (status.ok()) continue;
    if (job.inputs.size() == 1 || status.code() == StatusCode::cancelled || interrupted()) return status;
    complain(status.message());
    loaded.failed.emplace_back(file, status);
  }
  if (!loaded.all_have_shapes) drop_shapes(loaded.model);
  if (!loaded.files.empty()) return loaded;
  return Status(loaded.failed.back().second.code(),
                "none of the " + std::to_string(loaded.failed.size()) + " models can be used");
}

void say_warnings(const std::vector<std::string>& warnings) {
  constexpr std::size_t limit = 20;  // lines; a file may hold a long list of unread parts
  const std::size_t count = warnings.size();
  for (std::size_t k = 0; k < std::min(count, limit); ++k) warn(warnings[k]);
  if (count > limit) warn("and " + std::to_string(count - limit) + " more warnings of this file");
}

bool are_patches(const Model& model) {
  constexpr std::size_t surfaces_per_task = 4096;
  std::atomic<bool> is_other = false;
  using Range = tbb::blocked_range<std::size_t>;
  tbb::parallel_for(Range(0, model.surfaces.size(), surfaces_per_task), [&](const Range& range) {
    for (std::size_t k = range.begin(); k < range.end() && !is_other; ++k) {
      const ModelSurface& surface = model.surfaces[k];
      if (!std::holds_alternative<BezierPatch>(surface.surface) || !surface.trims->empty() ||
          surface.placement != Affine{})
        is_other = true;
    }
  });
  return !is_other;
}

Status add_patches(Loaded& loaded, Timings& timings) {
  if (loaded.grids.size() == loaded.model.surfaces.size()) return {};
  const auto phase = timings.phase("convert");
  if (are_patches(loaded.model)) return loaded.grids.clear(), Status();
  Result<std::vector<PatchGrid>> grids = convert(loaded.model, loaded.fit);
  if (!grids) return loaded.in_place(0, grids.status());
  loaded.grids = *std::move(grids);
  return {};
}

Report report_of(const Job& job, const Loaded& loaded) {
  Json failed = Json::array();
  for (const auto& [file, status] : loaded.failed)
    failed.push_back({{"file", file}, {"code", std::string(name(status.code()))}, {"message", status.message()}});
  Report report;
  report.add("models", loaded.files);
  report.add("failed", failed);
  report.add("output", job.output, job.output.empty() ? "" : job.output + ": ");
  return report;
}

void add_model_facts(Report& report, const Loaded& loaded, std::size_t patches, const FitError& error) {
  report.add("surfaces", loaded.model.surfaces.size());
  report.add("patches", patches);
  report.add("trimmed_surfaces", loaded.trimmed());
  report.add("fit_error", fit_json(error));
  report.add("warnings", loaded.model.warnings);
}

std::string fit_line(const FitError& error) {
  if (error.distance == 0 && error.certified) return {};
  return "\n  functions fitted to within " + readable(error.distance, 3) + (error.certified ? ", proven" : ", sampled");
}

Json fit_json(const FitError& error) { return {{"distance", error.distance}, {"certified", error.certified}}; }

}  // namespace tessera::cli
