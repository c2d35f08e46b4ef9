#pragma once
// Writes surfaces as Bezier patches, one source file per format. Called by write_model.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/output_file.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {

/// The parts of a surface that are written. Patches are ordered as in a PatchGrid: patch (a, b) is at a *
/// (breaks_v.size() - 1) + b.
struct WrittenSurface {
  std::string_view name;
  std::span<const double> breaks_u, breaks_v;
  std::span<const BezierPatch> patches;
  std::span<const TrimLoop> trims;  ///< in the parameters of breaks_u and breaks_v

  Domain patch_domain(std::size_t patch) const {
    const std::size_t count_v = breaks_v.size() - 1, a = patch / count_v, b = patch % count_v;
    return {breaks_u[a], breaks_u[a + 1], breaks_v[b], breaks_v[b + 1]};
  }
};

/// The warning "surface 3 (rim): 2 trims are not written: <why>".
std::string trims_left_out(std::size_t surface, const WrittenSurface& written, std::string_view why);

/// Writes one surface after the other; adds what the format does not hold to `warnings`. Errors: unsupported (a
/// rational patch for .bpt; index = the surface).
Status write_bpt(std::span<const WrittenSurface> surfaces, OutputFile& out, std::vector<std::string>& warnings);
Status write_obj_freeform(std::span<const WrittenSurface> surfaces, OutputFile& out,
                          std::vector<std::string>& warnings);
Status write_json_model(std::span<const WrittenSurface> surfaces, OutputFile& out, std::vector<std::string>& warnings);

struct SurfaceWriter {
  decltype(&write_bpt) write = nullptr;
};
/// The writer for the extension of `path`. Errors: unsupported, with a list of the known extensions.
Result<SurfaceWriter> surface_writer(const std::filesystem::path& path);

}}  // namespace tessera::abi_0_1
