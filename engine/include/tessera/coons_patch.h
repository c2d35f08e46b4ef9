#pragma once
// Surfaces spanned by their borders: ruled surfaces between two curves, Coons patches between four.
//
// Memory: results own theirs or share it with their copies; arguments are not kept. Threads: any number of calls at
// once on const objects, if the functions of their borders allow it.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "tessera/parametric_surface.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A direction of parameters.
enum class Direction : std::uint8_t { u, v };

/// A ruled surface r(u,v) = ((b - v) C1(u) + (v - a) C2(u)) / (b - a), v in [a, b]; or, with the straight lines along
/// u, the same with D1(v), D2(v) and u. Immutable except for assignment; copies share their curves.
class RuledSurface {
 public:
  /// Makes the ruled surface of two curves.
  ///
  /// - `first`, `second`: curves on the same interval.
  /// - `across`: the interval of the other parameter.
  /// - `straight`: the direction of the straight lines, which run over `across`.
  ///
  /// Errors: invalid_argument (curves on different intervals: says which; an interval that is empty or reversed),
  /// non_finite.
  static Result<RuledSurface> make(const BorderCurve& first, const BorderCurve& second, const Interval& across = {},
                                   Direction straight = Direction::v);

  const BorderCurve& first() const { return data_->first; }    ///< C1, or D1
  const BorderCurve& second() const { return data_->second; }  ///< C2, or D2
  Direction straight() const { return data_->straight; }       ///< the parameter along the straight lines
  Domain domain() const;                                       ///< the curves' interval and `across`
  /// Whether to_bezier() is exact: both borders are Bezier, B-spline or NURBS curves.
  bool is_exact() const;

 private:
  struct Data {
    BorderCurve first, second;
    Interval across;
    Direction straight;
  };
  explicit RuledSurface(Data data);
  std::shared_ptr<const Data> data_;
};

/// The reference evaluator, by the formula above. Errors: those of functions, non_finite (too large a point; (u, v)).
Result<SurfaceJet> evaluate_jet(const RuledSurface& surface, double u, double v);
/// Returns the position alone, with one call of each function. Errors: as above.
Result<Vec3> position(const RuledSurface& surface, double u, double v);

/// The two blending functions of a direction, on [0,1]: f1 + f2 = 1, f1(0) = 1, f1(1) = 0. Immutable except for
/// assignment.
class Blend {
 public:
  static Blend linear();  ///< 1 - t, t: for bilinearly blended patches
  static Blend cubic();   ///< H0, H3: for partially bicubic ones
  /// Makes a blend of two polynomials.
  ///
  /// - `first`, `second`: power coefficients of f1 and f2, lowest first, each at most 1e6 in size; degrees 1 to
  ///   max_degree without leading zeros. The conditions must hold to 1e-12 times the largest coefficient.
  ///
  /// Errors: unsupported_degree, non_finite, invalid_argument (index = the coefficient; or says which condition fails,
  /// and by how much).
  static Result<Blend> polynomial(std::span<const double> first, std::span<const double> second);
  /// Makes a blend of two callables. The conditions are checked at k / 64, k = 0 .. 64, to 1e-9. Errors: as for
  /// polynomial() (says where), invalid_argument (threw).
  static Result<Blend> callable(std::function<double(double)> first, std::function<double(double)> second);

  bool is_polynomial() const { return count_ > 0; }  ///< false for callables
  /// The k-th derivative of f_a is [k][a].
  using Jet = std::array<std::array<double, 2>, 3>;
  /// Returns f1, f2 and their first and second derivatives at t in [0,1]; derivatives of callables by differences. At 0
  /// and 1 the values are exactly 1 and 0. Errors: non_finite, invalid_argument (threw).
  Result<Jet> at(double t) const;
  /// Returns the values alone, with one call of each function. Errors: as for at().
  Result<std::array<double, 2>> values_at(double t) const;
  /// The power coefficients of f1; empty for callables.
  std::span<const double> first() const { return {first_.data(), count_}; }
  std::span<const double> second() const { return {second_.data(), count_}; }  ///< the coefficients of f2

 private:
  Blend() = default;
  std::array<double, max_degree + 1> first_{}, second_{};
  std::size_t count_ = 0;  ///< number of coefficients
  std::array<std::function<double(double)>, 2> callables_;
};

/// The borders C1 = r(u, v0), C2 = r(u, v1), D1 = r(u0, v), D2 = r(u1, v). Both C are on [u0, u1], both D on [v0, v1].
struct CoonsBorders {
  BorderCurve c1, c2, d1, d2;  ///< named as above
};

/// Blends, and the largest gap of the borders.
struct CoonsOptions {
  Blend f = Blend::linear();  ///< along u: weighs D1 and D2
  Blend g = Blend::linear();  ///< along v: weighs C1 and C2
  /// The largest distance of ends that should meet, as a share of the diagonal of the box of the eight ends.
  double closing_tolerance = 1e-9;
};

/// The patch r = [C1 C2] g(t) + f(s)^T [D1; D2] - f(s)^T [[r00, r01], [r10, r11]] g(t), where s and t run over [0,1] as
/// u and v over the domain (Coons 1967; Farin, Curves and Surfaces for CAGD, 5th ed., ch. 22). The corners r_ab are the
/// ends of C1, C2. Immutable except for assignment; copies share everything.
class CoonsPatch {
 public:
  /// Makes a patch from its borders. Errors: invalid_argument (curves on different intervals: says which; a border that
  /// does not close: names the corner, index = 2 a + b, the two curves and the gap), non_finite, those of functions.
  static Result<CoonsPatch> make(const CoonsBorders& borders, const CoonsOptions& options = {});

  const CoonsBorders& borders() const { return data_->borders; }  ///< the argument of make()
  const Blend& f() const { return data_->f; }                     ///< blend along u
  const Blend& g() const { return data_->g; }                     ///< blend along v
  /// The corner r(u_a, v_b).
  const Vec3& corner(int a, int b) const { return data_->corners[static_cast<std::size_t>(2 * a + b)]; }
  Domain domain() const;  ///< [u0, u1] x [v0, v1] of the borders
  /// Whether to_bezier() is exact: borders are Bezier, B-spline or NURBS curves, and blends are polynomials.
  bool is_exact() const;

 private:
  struct Data {
    CoonsBorders borders;
    Blend f, g;
    std::array<Vec3, 4> corners;
  };
  explicit CoonsPatch(Data data);
  std::shared_ptr<const Data> data_;
};

/// The reference evaluator, by the formula above. Errors: those of functions, non_finite (too large a point; (u, v)).
Result<SurfaceJet> evaluate_jet(const CoonsPatch& patch, double u, double v);
/// Returns the position alone, with one call of each function. Errors: as above.
Result<Vec3> position(const CoonsPatch& patch, double u, double v);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
