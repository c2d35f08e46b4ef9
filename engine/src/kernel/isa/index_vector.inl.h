#pragma once
// Whole numbers in vectors.
//
// Needs before it, outside of the instruction set's namespace: kernel/isa/lanes.h.

/// As many indices as a vector holds.
template <class L>
using Indices [[gnu::vector_size(sizeof(std::uint32_t) * L::width)]] = std::uint32_t;
