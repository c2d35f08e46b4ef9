// libFuzzer: for any bytes, a reader must return a model, a mesh or an error, in time and memory that the length of the
// input bounds (see the limits in CMakeLists.txt). A model or mesh must be usable.

#include <cmath>
#include <cstdlib>

#include "io/file/gzip.h"
#include "io/file/zip.h"
#include "io/mesh/mesh_formats.h"
#include "io/step/read_step.h"
#include "tessera/io.h"

namespace {

using namespace tessera;

void require(bool holds) {
  if (!holds) std::abort();
}

/// Evaluation may fail only for these kinds, unless their placement exceeds the range of numbers: functions or their
/// differences may not be finite.
bool may_have_functions(const Surface& surface) {
  return std::holds_alternative<ParametricSurface>(surface) || std::holds_alternative<RuledSurface>(surface) ||
         std::holds_alternative<CoonsPatch>(surface);
}

[[maybe_unused]] void use(const Model& model) {
  require(!model.surfaces.empty());
  for (const ModelSurface& surface : model.surfaces) {
    const Domain d = domain(surface.surface);
    require(d.u0 < d.u1 && d.v0 < d.v1 && !kind_name(surface.surface).empty());
    const Result<SurfaceJet> jet = evaluate_jet(surface, d.u_at(0.5), d.v_at(0.5));
    const bool placed_too_far = jet.status().code() == StatusCode::non_finite && surface.placement != Affine{};
    require(jet ? is_finite(jet->position) : placed_too_far || may_have_functions(surface.surface));
    for (const TrimLoop& loop : *surface.trims) require(!loop.curves.empty());
  }
}

[[maybe_unused]] void use(const Mesh& mesh) {
  for (const auto index : mesh.indices) require(index < mesh.vertex_count());
}

[[maybe_unused]] void use(const std::string& text) { require(!text.empty()); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto result = TESSERA_FUZZ_PARSER(bytes, "fuzz");
  if (result.ok()) {
    use(*result);
  } else {
    require(!result.status().message().empty());
    require(result.status().code() != StatusCode::internal && result.status().code() != StatusCode::out_of_memory);
  }
  return 0;
}
