// Square tiles between rows and lanes. Included by isa_*.cpp as sample_kernel.inl.h is.

/// Vector l of the tile becomes value l of each of the `width` rows, which lie at rows + offsets[k].
template <class L, class Offset>
[[gnu::always_inline]] inline void load_transposed(const typename L::Scalar* rows, const Offset* offsets,
                                                   typename L::Batch (&tile)[L::width]) {
#pragma GCC unroll 16
  for (int k = 0; k < L::width; ++k) tile[k] = L::load(rows + offsets[k]);
  L::transpose(tile);
}
