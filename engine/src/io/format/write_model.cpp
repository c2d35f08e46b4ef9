// Converts surfaces to patches and writes them.

#include <algorithm>
#include <string>
#include <utility>

#include "io/format/output_formats.h"
#include "io/spline/model_formats.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

/// The patches of a surface, and loops in their parameters.
struct Converted {
  PatchGrid grid;
  Shared<std::vector<TrimLoop>> trims;
};

void add(WrittenModel& facts, const PatchGrid& grid) {
  facts.patches += grid.patches().size();
  facts.fit_error.distance = std::max(facts.fit_error.distance, grid.fit_error().distance);
  facts.fit_error.certified = facts.fit_error.certified && grid.fit_error().certified;
}

Result<WrittenModel> write(const Model& model, const fs::path& path, const FitOptions& fit, OutputFile& out) {
  const Result<SurfaceWriter> writer = surface_writer(path);
  if (!writer) return writer.status();
  if (model.surfaces.empty())
    return Status(StatusCode::invalid_argument, path.string() + ": the model has no surfaces");
  WrittenModel facts;
  std::vector<Converted> all;
  all.reserve(model.surfaces.size());
  std::vector<WrittenSurface> surfaces;
  for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
    const ModelSurface& surface = model.surfaces[k];
    Result<PatchGrid> grid = to_bezier(surface, fit);
    if (!grid) return in_surface(model, k, grid.status());
    Result<Shared<std::vector<TrimLoop>>> trims = grid_trims(surface);
    if (!trims) return in_surface(model, k, trims.status());
    const Converted& converted = all.emplace_back(Converted{*std::move(grid), *std::move(trims)});
    add(facts, converted.grid);
    surfaces.push_back({*surface.name, converted.grid.breaks_u(), converted.grid.breaks_v(), converted.grid.patches(),
                        *converted.trims});
  }
  if (Status status = writer->write(surfaces, out, facts.warnings); !status.ok()) {
    const Status named = in_surface(model, static_cast<std::size_t>(status.index()), status);
    return Status(named.code(), path.string() + ": " + named.message(), named.index());
  }
  facts.surfaces = surfaces.size();
  return facts;
}

/// Writes to the file that `open` makes, and commits it.
template <class Open>
Result<WrittenModel> write_model_to(const Model& model, const fs::path& path, const FitOptions& fit, const Open& open) {
  return guarded([&]() -> Result<WrittenModel> {
    if (Status status = check_model_format(path); !status.ok()) return status;
    Result<OutputFile> out = open();
    if (!out) return out.status();
    Result<WrittenModel> facts = write(model, path, fit, *out);
    if (!facts) return facts;
    if (Status status = out->commit(); !status.ok()) return status;
    return facts;
  });
}

}  // namespace

std::string trims_left_out(std::size_t surface, const WrittenSurface& written, std::string_view why) {
  const std::size_t loops = written.trims.size();
  return "surface " + std::to_string(surface) + (written.name.empty() ? "" : " (" + std::string(written.name) + ")") +
         ": " + std::to_string(loops) + (loops == 1 ? " trim is" : " trims are") + " not written: " + std::string(why);
}

Result<WrittenModel> write_model(const Model& model, const fs::path& path, const FitOptions& fit, OutputFile& out) {
  return guarded([&] { return write(model, path, fit, out); });
}

Result<WrittenModel> write_model(const Model& model, const fs::path& path, const FitOptions& fit) {
  return write_model_to(model, path, fit, [&] { return OutputFile::make(path); });
}

Result<WrittenModel> write_model_bytes(const Model& model, const fs::path& name, std::string& bytes,
                                       const FitOptions& fit) {
  return write_model_to(model, name, fit, [&] { return OutputFile::memory(bytes, name); });
}

}}  // namespace tessera::abi_0_1
