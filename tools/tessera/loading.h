#pragma once
// The surfaces that a command works on: read from one file or from several, as one model, and turned into patches.

#include <string>
#include <vector>

#include "jobs.h"
#include "tessera/model.h"

namespace CLI {
class App;
}

namespace tessera::cli {

/// The options of the command line for models.
struct ModelOptions {
  std::vector<std::string> files;  ///< names and patterns, as given
  FitOptions fit;
};
/// MODEL... and --fit-tolerance.
void add_models(CLI::App& command, ModelOptions& options);

/// The extensions that are read: ".bpt, .bv, ...".
std::string model_formats();

/// The files of a job as one model: surfaces are counted on from file to file.
struct Loaded {
  Model model;
  std::vector<std::string> files;                      ///< the files that were read
  std::vector<std::size_t> first;                      ///< the first surface of each file
  std::vector<PatchGrid> grids;                        ///< the patches of each surface, on request
  std::vector<std::pair<std::string, Status>> failed;  ///< the other files, and why; complained of already

  std::size_t trimmed() const;  ///< surfaces with trims, which are not honoured
  /// `status` as "part.obj: surface 3 (rim): ...", the surface counted within its file.
  Status in_surface(std::size_t surface, const Status& status) const;
  /// Ok, or already said if a file has failed.
  Status status() const;
};

enum class With { surfaces, patches };

/// Reads the files of a job, a file after the other, and converts their surfaces, on all threads. What of a file is not
/// read is said on standard error, a line a warning. Of several files those that fail are complained of and left out.
/// Errors: those of the only file, or of the last one if all of several fail.
Result<Loaded> load(const Job& job, const FitOptions& fit, With with, Timings& timings);

/// The set of all patches. Errors name file and surface.
Result<PatchSet> pack(const Loaded& loaded, Timings& timings);

/// The beginning of every job's report in JSON: the files, and the files that failed.
Json files_json(const Loaded& loaded);
/// And ends with: how many surfaces are trimmed, the fit error, warnings.
void add_model_facts(Json& object, const Loaded& loaded, const PatchSet& set);
Json warnings_json(const Model& model);

/// "12 surfaces are trimmed: trims not honoured yet", or nothing.
std::string trims_text(std::size_t trimmed);

/// A line that says how far fitted callables are off, or nothing where all is exact.
std::string fit_line(const FitError& error);
std::string fit_line(const PatchSet& set);
Json fit_json(const FitError& error);
Json fit_json(const PatchSet& set);

}  // namespace tessera::cli
