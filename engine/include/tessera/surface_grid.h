#pragma once
// Positions of callable, ruled and Coons surfaces on a grid of parameters, evaluated without Bezier patches.

#include <cstdint>
#include <span>

#include "tessera/coons_patch.h"
#include "tessera/execution.h"
#include "tessera/parametric_surface.h"
#include "tessera/strided_view.h"

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

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

/// Positions at (u[i], v[j]), record i * v.size() + j. Parameters lie in the domain, in any order. Each border curve
/// and each blending function is called once a parameter, from the calling thread: 2 (Nu + Nv) curve calls for a Coons
/// patch, 2 Nu or 2 Nv for a ruled surface. Positions are absolute. Memory beyond the output: O(Nu + Nv). The same
/// bytes for any number of threads, and on AVX2 and AVX-512. From position(surface, u, v) they are at most 5 units of
/// 2^-23 (8 of 2^-52 in double) times the largest |g1 C1| + |g2 C2| + |f1 K1| + |f2 K2|, where K_a = D_a - r_a0 g1 -
/// r_a1 g2; a ruled surface has no K. Errors: invalid_argument (no parameters; one outside the domain or NaN: index; a
/// view without three components or a stride), buffer_too_small, non_finite (that sum may be too large for the
/// precision), cancelled, isa_unavailable, those of functions; nothing is written on any but cancelled.
Status evaluate(const CoonsPatch& patch, std::span<const double> u, std::span<const double> v, const View3<double>& out,
                const Execution& execution = {});
Status evaluate(const CoonsPatch& patch, std::span<const double> u, std::span<const double> v, const View3<float>& out,
                const Execution& execution = {});
Status evaluate(const RuledSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<double>& out, const Execution& execution = {});
Status evaluate(const RuledSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<float>& out, const Execution& execution = {});

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
