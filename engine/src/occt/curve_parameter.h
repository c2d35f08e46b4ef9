#pragma once
// How the parameter of a curve in a face follows from OpenCASCADE's.

#include <optional>
#include <vector>

#include "exact/arcs.h"
#include "exact/swept_surface.h"
#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

/// A monotone function of OpenCASCADE's parameter of a curve.
class CurveParameter {
 public:
  /// `range`: of our parameter. `shift`: added to OpenCASCADE's, unless the curve consists of `arcs`, over its angle.
  /// `reversed`: whether our curve runs the other way.
  CurveParameter(const Interval& range, double shift, const std::optional<Arcs>& arcs, bool reversed)
      : range_(range), shift_(shift), arcs_(arcs), reversed_(reversed) {}

  /// States that the curve is a straight line from one point to another of OpenCASCADE's parameters of a surface, along
  /// one of them, at an even pace there, and in ours along arcs of the surface.
  void follow_line(const ParameterPoint& from, const ParameterPoint& to, const Reparametrization& parameters);

  double operator()(double t) const;
  /// OpenCASCADE's parameters within the range at which the function is not smooth, in order.
  std::vector<double> breaks() const;
  /// Whether the parameters are equal within the range; if reversed, whether their sum is that of its ends.
  bool is_plain() const { return !arcs_ && !line_ && shift_ == 0; }
  /// Whether the function is the parameter of these arcs, at an angle within the range; if reversed, the sum as above.
  bool follows(const Arcs& arcs) const;

 private:
  struct Line {
    Arcs arcs;            ///< of the surface
    double from, to;      ///< OpenCASCADE's parameter of the surface at the ends
    double starts, ends;  ///< ours
    double place(double x) const { return from + x * (to - from); }
  };
  double even(double t) const;

  Interval range_;
  double shift_;
  std::optional<Arcs> arcs_;
  bool reversed_;
  std::optional<Line> line_;
};

}}  // namespace tessera::abi_0_1
