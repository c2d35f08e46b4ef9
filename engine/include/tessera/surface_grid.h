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

/// The threads that may call a surface's functions.
enum class Calls : std::uint8_t {
  one_thread,  ///< the caller's
  concurrent,  ///< any, several at once
};

/// Writes the positions at (u[i], v[j]) to record i * v.size() + j, with one call of the surface's function per record.
///
/// - `u`, `v`: parameters in the domain, in any order.
/// - `out`: u.size() * v.size() records. Positions are absolute.
///
/// The bytes are the same for any number of threads.
///
/// Errors, with nothing written: invalid_argument (no parameters; one outside the domain or NaN: index; a view that
/// lacks a component or a stride, is misaligned, or shares memory with another), buffer_too_small. Errors, with the
/// output partly written: those of the function (of the first record that has one), non_finite (a position too large
/// for float), cancelled.
Status evaluate(const ParametricSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<double>& out, const Execution& execution = {}, Calls calls = Calls::one_thread);
/// Writes positions in float.
Status evaluate(const ParametricSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<float>& out, const Execution& execution = {}, Calls calls = Calls::one_thread);

/// Writes the positions at (u[i], v[j]) to record i * v.size() + j. Each border curve and each blending function is
/// called once per parameter, from the calling thread: 2 (Nu + Nv) curve calls for a Coons patch, 2 Nu or 2 Nv for a
/// ruled surface.
///
/// - `u`, `v`: parameters in the domain, in any order.
/// - `out`: u.size() * v.size() records. Positions are absolute.
///
/// The bytes are the same for any number of threads, and on AVX2 and AVX-512. They differ from position(surface, u, v)
/// by at most 5 units of 2^-23 (8 of 2^-52 in double) times the largest |g1 C1| + |g2 C2| + |f1 K1| + |f2 K2|, where
/// K_a = D_a - r_a0 g1 - r_a1 g2; a ruled surface has no K.
///
/// Errors: invalid_argument and buffer_too_small (as above), non_finite (that sum may be too large for the precision),
/// cancelled, isa_unavailable, those of functions. Only cancelled leaves anything written. Memory beyond the output:
/// O(Nu + Nv).
template <class T>
Status evaluate(const CoonsPatch& patch, std::span<const double> u, std::span<const double> v, const View3<T>& out,
                const Execution& execution = {});
template <class T>
Status evaluate(const RuledSurface& surface, std::span<const double> u, std::span<const double> v, const View3<T>& out,
                const Execution& execution = {});

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
