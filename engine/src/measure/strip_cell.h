#pragma once
// One square of a strip: its bounds, and its integrals by a Gauss rule.

#include <optional>
#include <utility>

#include "measure/strip.h"

namespace tessera { inline namespace abi_0_1 {

/// The part of a strip over s in [s0, s1] and a part of its curve.
struct StripSquare {
  LocalCurve curve;
  double s0 = 0, s1 = 1;
  /// For a half: StripCell::magnitude() of both halves together, and whether they are halves in s.
  double whole_magnitude = 0;
  bool is_half_in_s = false;
};

class StripCell {
 public:
  StripCell(const StripPatch& patch, const CurveStrip& strip, const StripSquare& square, Integrand integrand);

  /// Whether the square has no area in the patch's parameters.
  bool is_empty() const { return is_empty_; }
  /// A bound of the integral that needs no quadrature: value and error.
  Integrals crude() const;
  /// Returns crude()'s bound of the integral of the constant moment.
  double magnitude() const { return magnitude_; }
  /// Integrals, and about what that of degree 0 would be if nothing cancelled.
  struct Found {
    Integrals integrals;
    double magnitude = 0;
  };
  /// Integrates with an error of at most `tolerance`, besides rounding; nothing if that takes too many nodes.
  std::optional<Found> integrate(double tolerance);
  /// The halves of the square, across the direction that integrate() found to need it.
  std::pair<StripSquare, StripSquare> halves() const;

 private:
  struct Bound {
    double value;     ///< of the integrand of degree 0, with the Jacobian
    double position;  ///< of |r|
  };
  struct Choice {
    int nodes = 0;
    double error = 0;     ///< of the integral of degree 0
    double position = 0;  ///< of |r|, for those of higher degrees
  };
  void find_window();
  /// Bounds the integrand for s and t in ellipses of these reaches.
  Bound bound(double reach_s, double reach_t) const;
  /// Bounds the integrand itself, where parameters have these reaches.
  Bound integrand_bound(double reach_u, double reach_v) const;
  Choice choose(bool along_s, double tolerance) const;
  bool is_longer_along_s() const;
  /// Adds the sums of a rule, and returns Found::magnitude.
  double sum(int nodes_s, int nodes_t, Integrals& all) const;
  void add_rounding(Integrals& to) const;

  const StripPatch& patch_;
  const CurveStrip& strip_;
  StripSquare square_;
  Integrand integrand_;
  Domain window_;
  bool is_empty_ = false, splits_s_ = false;
  double half_u_ = 0, half_v_ = 0, parameter_area_ = 0, magnitude_ = 0;
  Bound real_{};
  std::optional<LocalNet> net_;
  std::optional<NetSeries> series_;
  std::optional<CurveSeries> curve_;
};

}}  // namespace tessera::abi_0_1
