#include "base/overloaded.h"
#include "tessera/convert.h"
#include "tessera/guard.h"
#include "tessera/status.h"
#include "tessera/surface.h"

namespace tessera { inline namespace abi_0_1 {

Result<PatchGrid> to_bezier(const Surface& surface, const FitOptions& options) {
  return std::visit(Overloaded{
                        [](const BezierPatch& s) {
                          return guarded([&] { return PatchGrid::make({0, 1}, {0, 1}, {s}); });
                        },
                        [&](const RuledSurface& s) { return to_bezier(s, options); },
                        [&](const CoonsPatch& s) { return to_bezier(s, options); },
                        [&](const ParametricSurface& s) { return to_bezier(s, options); },
                        [](const auto& s) { return to_bezier(s); },
                    },
                    surface);
}

}}  // namespace tessera::abi_0_1
