#pragma once
// Ruled surfaces and Coons patches straight on grids: border curves are sampled once, the rest is SIMD blending.

#include <span>

#include "tessera/coons_patch.h"
#include "tessera/execution.h"
#include "tessera/ruled_surface.h"
#include "tessera/views.h"

namespace tessera {

/// Positions at (u[i], v[j]), record i * v.size() + j. Parameters lie in the domain, in any order. Each border curve is
/// called once a parameter: 2 (Nu + Nv) calls for a Coons patch, 2 Nu or 2 Nv for a ruled surface. Positions are absolute. The
/// same bytes for any number of threads and on AVX2 and AVX-512. Errors: invalid_argument (no parameters; one outside the
/// domain: index), non_finite, buffer_too_small, cancelled, those of functions; nothing is written on any but cancelled.
/// Memory beyond the output: O(Nu + Nv).
Status evaluate(const CoonsPatch& patch, std::span<const double> u, std::span<const double> v, const View3<double>& out,
                const Execution& execution = {});
Status evaluate(const CoonsPatch& patch, std::span<const double> u, std::span<const double> v, const View3<float>& out,
                const Execution& execution = {});
Status evaluate(const RuledSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<double>& out, const Execution& execution = {});
Status evaluate(const RuledSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<float>& out, const Execution& execution = {});

}  // namespace tessera
