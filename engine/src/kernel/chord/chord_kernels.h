#pragma once
// Jobs and kernels of certified plans for a block of patches, lanes = patches: bounds, rates, and border hashes.

#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernel/isa/block_lanes.h"

namespace tessera { inline namespace abi_0_1 { namespace kernel {

/// Bounds on the second derivatives of a block of polynomial patches, over the whole patch, its halves and quarters:
/// see ChordBound. They include the rounding of the packed coefficients.
struct ChordJob {
  const float* net = nullptr;  ///< `[i][j][component][lane]`
  int degree_u = 0, degree_v = 0;
  float* pieces = nullptr;  ///< `[piece of 9][uu, uv, vv][lane]`, in units of `unit`
  float* unit = nullptr;    ///< `[lane]`: a power of two above the largest coefficient
  float* size = nullptr;    ///< `[lane]`: the largest coordinate of a control point, at least 2^-120
  float* hints = nullptr;   ///< `[lane]`: a sum of ChordHint; or null
  /// For may_be_point: the length of sides that welding may make points; none is as short as minus infinity.
  float reach = -std::numeric_limits<float>::infinity();
  bool is_plane = false;  ///< rational patches without hints: all z are 0
};

/// Kinds that a patch may be of, judging by its corners; the first three where that would save cells.
enum ChordHint {
  may_be_sweep = 1,  ///< two opposite sides have parallel chords
  may_be_flat = 2,   ///< the corners lie in a plane
  may_gain = 4,      ///< rational patches: exact numerators may need far fewer cells
  may_be_point = 8,  ///< a side may be no longer than ChordJob::reach from end to end, by its largest coordinate
};
/// The limit of the share of the cells that remain then, by the second derivatives at the corners.
inline constexpr double likely_gain = 0.4;

/// Rational patches up to this degree have their bounds in blocks, in float. `net` then has four components and `unit`
/// is above the coefficients as well. `size` is negative where rounding dominates a bound or weights are too uneven.
inline constexpr int max_rational_degree = 7;

/// Bounds on the second derivatives of rational patches themselves: of scaled sweeps, and by exact numerators of
/// patches up to max_exact_degree; see ChordBound.
struct ExactChordJob {
  /// `[i][j][x, y, z, w][lane]`: w times the point relative to a place near the patch, and w, which is positive and at
  /// most near 1.
  const double* net = nullptr;
  int degree_u = 0, degree_v = 0;
  bool rational = true;         ///< false: all weights are 1, and are not read
  int lanes = block_lanes;      ///< only the first ones are meant; others may be written
  bool any_patch = false;       ///< fill pieces also of patches that are no sweeps
  double* deviation = nullptr;  ///< `[lane]`: how far the patch may lie from a scaled sweep; infinite if it is none
  /// `[piece of 9][uu, uv, vv][lane]` in lengths, of the sweep where there is one; infinite or NaN where there is no
  /// bound. May be null.
  double* pieces = nullptr;
};
inline constexpr int max_exact_degree = 3;

/// Bounds on products of the second derivatives of a block as in ChordJob, up to degree max_product_degree: see
/// SecondDerivatives.
struct ChordProductJob {
  const float* net = nullptr;
  int degree_u = 0, degree_v = 0;
  const float* pieces = nullptr;  ///< results of ChordJob
  const float* unit = nullptr;
  float* products = nullptr;  ///< `[piece of 9][uu_vv, uu_uv, uv_vv][lane]`, in units of unit^2
  float* share = nullptr;     ///< `[lane]`: about the share of the chord's bound that they leave; above 1 if they save
                              ///< nothing
};
inline constexpr int max_product_degree = 5;

/// The rates with the fewest cells that keep a distance, for the patches of a block.
struct RateJob {
  const float* pieces = nullptr;    ///< as in ChordJob
  const float* distance = nullptr;  ///< `[lane]`, in the patch's unit
  int max_rate = 0;
  std::int32_t* rate_u = nullptr;  ///< `[lane]`: 0 where the search failed, which does not prove that there are none
  std::int32_t* rate_v = nullptr;
  float* chord = nullptr;           ///< `[lane]`: the bound that the rates keep, in the patch's unit
  const float* products = nullptr;  ///< as in ChordProductJob, or null
};

/// Hashes of the borders of a block of patches, from the bits of their control points.
struct BorderHashJob {
  const float* net = nullptr;  ///< `[i][j][component][lane]`
  int degree_u = 0, degree_v = 0;
  bool rational = false;
  std::uint32_t* hash = nullptr;  ///< `[side v = 0, u = 1, v = 1, u = 0][lane]`
};

/// Borders of a block of patches, each compared with one that may be the same curve; with 4 components, the same up to
/// a power of two.
struct BorderMatchJob {
  const float* first = nullptr;  ///< first control point of the block's borders, `[component][lane]`
  std::ptrdiff_t step = 0;       ///< to the next control point
  int count = 0, components = 0;
  const float* others = nullptr;        ///< memory of the other borders' control points, one lane of each
  const std::int32_t* place = nullptr;  ///< `[lane]`: offset of the other border's first control point
  std::ptrdiff_t other_step = 0;        ///< to its next control point; negative where it runs the other way
  std::uint32_t* differing = nullptr;   ///< `[lane]`: 0 where all bits are equal
};

struct ChordKernels {
  void (*hash_borders)(const BorderHashJob&);
  void (*match_borders)(const BorderMatchJob&);
  void (*bound_chords)(const ChordJob&);
  void (*bound_rational_chords)(const ChordJob&);
  void (*bound_exact_chords)(const ExactChordJob&);
  void (*bound_products)(const ChordProductJob&);           ///< products only
  void (*bound_rational_products)(const ChordProductJob&);  ///< products only, of rational patches
  void (*share_of_products)(const ChordProductJob&);        ///< share only, of polynomial patches
  void (*find_rates)(const RateJob&);
};

}}}  // namespace tessera::abi_0_1::kernel
