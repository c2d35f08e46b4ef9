#pragma once
// Vectors of whole numbers, as many as L has lanes.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h.

/// A vector with as many indices as L has lanes.
template <class L>
using Indices [[gnu::vector_size(sizeof(std::uint32_t) * L::width)]] = std::uint32_t;
