#pragma once
// Functions of the caller's straight on grids, without a fit.

#include <cstdint>
#include <span>

#include "tessera/execution.h"
#include "tessera/parametric_surface.h"
#include "tessera/views.h"

#pragma GCC visibility push(default)
namespace tessera {

/// Which threads may call a surface's functions.
enum class Calls : std::uint8_t {
  one_thread,  ///< the caller's
  concurrent,  ///< any, several at once
};

/// Positions at (u[i], v[j]), record i * v.size() + j, by one call of the surface's function a record. Parameters lie
/// in the domain, in any order. Positions are absolute. The same bytes for any number of threads. Errors:
/// invalid_argument (no parameters; one outside the domain or NaN: index; a view without three components or a stride),
/// buffer_too_small: then nothing is written; those of the function (of the first record that has one), non_finite (a
/// position too large for float) and cancelled: then the output is partly written.
Status evaluate(const ParametricSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<double>& out, const Execution& execution = {}, Calls calls = Calls::one_thread);
Status evaluate(const ParametricSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<float>& out, const Execution& execution = {}, Calls calls = Calls::one_thread);

}  // namespace tessera
#pragma GCC visibility pop
