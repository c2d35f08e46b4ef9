// Whole numbers in vectors. Included by the units as sample_kernel.inl.h is.

/// As many indices as a vector holds.
template <class L>
using Indices [[gnu::vector_size(sizeof(std::uint32_t) * L::width)]] = std::uint32_t;
