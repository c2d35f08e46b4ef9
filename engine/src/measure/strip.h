#pragma once
// Integrals over the part of a patch between a line of constant u and a curve.
//
// The kept part of a patch is the sum, with signs, of the strips between one line of constant u and each of its border
// curves (Green's theorem, with the inner integral done by quadrature too). A strip is the image of a square:
//
//   (s, t) -> (base + s (u(t) - base), v(t)),  with the Jacobian (u(t) - base) v'(t).
//
// There the integrands are analytic up to where a weight vanishes and, for areas, up to where the square of the normal
// does. So a tensor Gauss rule converges geometrically, and its error is at most that of gauss_choice() in each
// direction, with bounds of the integrand for complex s, and for complex t. A square whose rule would need too many
// nodes is halved, the one with the largest bound first. This needs no derivatives, holds for every degree, and reaches
// rounding for all but patches whose normal vanishes, as at poles; there, bounds fall by 4 with each halving.

#include <array>
#include <cstddef>
#include <cstdint>

#include "measure/local_curve.h"
#include "measure/local_net.h"

namespace tessera { inline namespace abi_0_1 {

/// An integrand. r is the position relative to the centre of the moments, n = r_u x r_v.
enum class Integrand : std::uint8_t {
  area,  ///< |n|, and |n| r
  flux,  ///< r . n, times 1, x, y, z, xx, yy, zz, xy, yz, zx: from it follow volumes and moments
};

/// Integrals and bounds of their errors. Areas use the first four.
struct Integrals {
  std::array<double, 10> value{}, error{};
};
inline constexpr int integral_count(Integrand integrand) { return integrand == Integrand::area ? 4 : 10; }
/// The degree of the monomial of an integral.
inline constexpr int moment_degree(int k) { return k == 0 ? 0 : k < 4 ? 1 : 2; }

/// Adds numbers with twice the digits, so that the sum of any number of terms is rounded once.
class ExactSums {
 public:
  void add(const Integrals& terms, double sign);
  void add(const ExactSums& other);
  Integrals sums() const;

 private:
  std::array<double, 10> high_{}, low_{}, error_{};
};

/// A patch that is integrated over.
struct StripPatch {
  LocalNet net;
  Vec3 centre;  ///< of the net, relative to the centre of the moments
};

/// The strip between u = base and a curve.
struct CurveStrip {
  LocalCurve curve;
  double base = 0;
  double sign = 1;        ///< 1 where the strip is added, -1 where it is taken away
  ParameterPoint band{};  ///< how far the true curve may be off in u and in v
  bool is_whole = false;  ///< whether it is all of the patch, whose parts have exact parameters
};

/// How exact integrals are to be.
struct StripLimits {
  double accuracy;        ///< relative to what the integral would be if nothing cancelled
  std::size_t max_cells;  ///< squares of one strip that may be halved
};

/// Adds a bound of the integrals over CurveStrip::band on both sides of its curve.
void add_band(const StripPatch& patch, const CurveStrip& strip, Integrand integrand, ExactSums& sums);

/// Adds the integrals over a strip, without its band.
void add_strip(const StripPatch& patch, const CurveStrip& strip, Integrand integrand, const StripLimits& limits,
               ExactSums& sums);

}}  // namespace tessera::abi_0_1
