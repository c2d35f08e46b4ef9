#pragma once
// The file of surfaces that a command is given, and how callables in it become patches.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "console.h"
#include "tessera/model.h"

namespace tessera::cli {

struct ModelFile {
  std::string path;
  FitOptions fit;
};

/// MODEL and --fit-tolerance.
void add_model(CLI::App& command, ModelFile& file);

/// Reads the model; what of the file it does not hold is said on standard error, a line a warning. Errors: those of
/// read_model.
Result<Model> open_model(const ModelFile& file);
/// A line a warning on standard error, of very many the first.
void say_warnings(const std::vector<std::string>& warnings);
/// A model's warnings as an array.
Json warnings_json(const Model& model);

/// Errors name the file.
Result<PatchSet> make_patch_set(const ModelFile& file, const Model& model);

/// A line that says how far fitted callables are off, or nothing where all is exact.
std::string fit_line(const PatchSet& set);
std::string fit_line(const FitError& error);
Json fit_json(const PatchSet& set);
Json fit_json(const FitError& error);

}  // namespace tessera::cli
