#pragma once
// The first stage: files become one model, and its surfaces patches.

#include <string>
#include <vector>

#include "batch/jobs.h"
#include "console/report.h"
#include "tessera/cad.h"
#include "tessera/model.h"

namespace tessera::cli {

struct LoadOptions {
  std::vector<std::string> files;  ///< names and patterns from the command line
  std::string input_format;        ///< of standard input, without the dot
  FitOptions fit;
  StepReader step_reader = CadOptions().step_reader;
};
/// Throws UsageError if standard input has no format, or is there twice.
void check_input(const LoadOptions& options);
/// Throws UsageError if a model is standard input, which the processes of a team cannot share.
void check_input_of_team(const LoadOptions& options);
/// Adds MODEL... and --input-format.
void add_models(Command& command, LoadOptions& options);
/// Adds one MODEL and --input-format.
void add_model(Command& command, LoadOptions& options);
/// Adds --fit-tolerance, --step-reader and --cad-reader.
void add_reading(Command& command, LoadOptions& options);

/// The extensions of files that can be read: ".bpt, .bv, ...".
std::string model_formats();

/// The files of a job as one model; the number of a surface counts on from file to file.
struct Loaded {
  Model model;
  std::vector<std::string> files;                      ///< the files that were read
  std::vector<std::size_t> first;                      ///< the first surface of each file
  std::vector<PatchGrid> grids;                        ///< if requested, and unless are_patches() of a single file
  std::vector<std::pair<std::string, Status>> failed;  ///< the other files, and their errors, which are already printed
  bool all_have_shapes = true;                         ///< whether all surfaces are faces of the model's instances
  FitOptions fit;                                      ///< how its surfaces become patches

  std::size_t trimmed() const;  ///< number of surfaces with trims
  /// `status` as "part.obj: surface 3 (rim): ...", the surface counted within its file.
  Status in_surface(std::size_t surface, const Status& status) const;
  /// A message that begins with "surface 3 (rim): ", as surfaces of a model or faces of a shape are counted, with the
  /// place in the file instead. `first_surface` is the model's surface that is counted as 0.
  Status in_place(std::size_t first_surface, const Status& status) const;
  /// Ok; an error, already printed, if a file has failed.
  Status status() const;
};

enum class With { surfaces, patches, shapes };  ///< shapes: as surfaces if all files have shapes, or else as patches

/// Reads the files of a job one after the other, and converts their surfaces, on all threads. Prints a warning on
/// standard error for each part of a file that is not read, and leaves out files that fail. Errors: those of the only
/// file, or of the last one if all of several fail.
Result<Loaded> load(const Job& job, const LoadOptions& options, With with, Timings& timings);

/// Prints a warning about each part of a file that is not read.
void say_warnings(const std::vector<std::string>& warnings);

/// Whether all surfaces are patches as they stand, without a placement or trims, and are packed without grids.
bool are_patches(const Model& model);

/// Converts the surfaces of a model that load() has left as they are. Errors name file and surface.
Status add_patches(Loaded& loaded, Timings& timings);

/// Begins the report of a job with the files, the files that failed, and the output.
Report report_of(const Job& job, const Loaded& loaded);
/// Adds the end of a report, without words: the number of surfaces and patches, the fit error, warnings.
void add_model_facts(Report& report, const Loaded& loaded, std::size_t patches, const FitError& error);

/// A line with the error of fitted callables, begun by the end of the line before; empty if all is exact.
std::string fit_line(const FitError& error);
Json fit_json(const FitError& error);

}  // namespace tessera::cli
