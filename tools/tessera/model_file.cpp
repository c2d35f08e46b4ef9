#include "model_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tessera/io.h"
#ifdef TESSERA_HAS_IO_OCCT
#include "tessera/io_occt.h"
#endif

namespace tessera::cli {
namespace {

#ifdef TESSERA_HAS_IO_OCCT
constexpr const char* cad_formats = ", .step, .stp, .iges, .igs";

/// By the component that knows the format.
Result<Model> read_any_model(const std::string& path) { return is_cad_file(path) ? read_cad(path) : read_model(path); }
#else
constexpr const char* cad_formats = "";

Result<Model> read_any_model(const std::string& path) { return read_model(path); }
#endif

}  // namespace

void add_model(CLI::App& command, ModelFile& file) {
  command
      .add_option("MODEL", file.path,
                  std::string("The file of surfaces (.bpt, .bv, .g2, .json, .obj, .rib") + cad_formats + ")")
      ->required()
      ->type_name("FILE");
  command
      .add_option("--fit-tolerance", file.fit.tolerance,
                  "How far patches may lie from surfaces that are given by expressions, in the model's unit "
                  "[1e-6 of the surface's size]")
      ->check([](const std::string& text) {
        double value = 0;
        const bool good = CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value);
        return good ? std::string() : "expected a number above 0, found \"" + text + "\"";
      });
}

void say_warnings(const std::vector<std::string>& warnings) {
  constexpr std::size_t limit = 20;  // lines; the file may be a long list of what is not read
  const std::size_t count = warnings.size();
  for (std::size_t k = 0; k < std::min(count, limit); ++k) {
    std::fprintf(stderr, "tessera: warning: %s\n", warnings[k].c_str());
  }
  if (count > limit) std::fprintf(stderr, "tessera: warning: and %zu more of this file\n", count - limit);
}

Result<Model> open_model(const ModelFile& file) {
  Result<Model> model = read_any_model(file.path);
  if (model) say_warnings(model->warnings);
  return model;
}

Json warnings_json(const Model& model) {
  Json warnings = Json::array();
  for (const std::string& warning : model.warnings) warnings.push_back(warning);
  return warnings;
}

Result<PatchSet> make_patch_set(const ModelFile& file, const Model& model) {
  Result<PatchSet> set = tessera::make_patch_set(model, {}, file.fit);
  if (!set) return in_file(file.path, set.status());
  return set;
}

std::string fit_line(const PatchSet& set) { return fit_line(set.fit_error()); }
std::string fit_line(const FitError& error) {
  if (error.distance == 0 && error.certified) return {};
  return "  callables fitted to within " + readable(error.distance, 3) +
         (error.certified ? ", proven\n" : ", sampled\n");
}

Json fit_json(const PatchSet& set) { return fit_json(set.fit_error()); }
Json fit_json(const FitError& error) { return {{"distance", error.distance}, {"certified", error.certified}}; }

}  // namespace tessera::cli
