#pragma once
// The control points of a patch over a rectangle of its parameters: values inside, and bounds at complex parameters.

#include <array>
#include <vector>

#include "measure/centred_power.h"
#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// Cuts a net [i][j] of numbers or points to a rectangle within [0, 1]^2 by de Casteljau's algorithm.
template <class T>
void cut_net(std::vector<T>& values, int degree_u, int degree_v, const Domain& to);

/// A point of a patch and the derivatives by its parameters.
struct LocalNetPoint {
  Vec3 position, du, dv;
};

/// Bounds of the rounding of LocalNetPoint, over the whole net.
struct NetRounding {
  double position, du, dv;
};

/// Homogeneous Bernstein coefficients over [0, 1]^2, [i][j], of points relative to a centre.
class LocalNet {
 public:
  /// `data_error`: how far each of the patch's control points may be off.
  LocalNet(const BezierPatch& patch, const Vec3& centre, double data_error);
  /// Returns the net over a rectangle within [0, 1]^2.
  LocalNet restricted(const Domain& to) const;

  int degree_u() const { return m_; }
  int degree_v() const { return n_; }
  bool is_rational() const { return is_rational_; }
  NetRounding rounding() const;
  /// The largest ratio of two weights of a row along u, or along v.
  double weight_ratio(bool along_u) const;

  /// The curve of the net along u at one v, and its derivative by v.
  struct Row {
    std::array<Vec3, max_order> points, slopes;
    std::array<double, max_order> weights, weight_slopes;
  };
  Row row(double v) const;
  LocalNetPoint at(const Row& row, double u) const;

 private:
  friend class NetSeries;
  std::size_t index(std::size_t i, std::size_t j) const { return i * (static_cast<std::size_t>(n_) + 1) + j; }

  int m_, n_;
  bool is_rational_;
  double data_error_;
  int cuts_ = 0;  ///< how often the net was cut from a larger one
  std::vector<Vec3> points_;
  std::vector<double> weights_;
};

/// Bounds of a patch where its parameters are complex: z_u = (1 + x) / 2 with |x| <= reach_u, and so on.
class NetSeries {
 public:
  /// `normals`: whether normal() will be called.
  NetSeries(const LocalNet& net, bool normals);

  struct Sizes {
    double position;  ///< the largest |r - middle()|; all are infinite where the weight may vanish
    double du, dv;    ///< the largest |r_u| and |r_v|
  };
  Sizes sizes(double reach_u, double reach_v) const;
  /// Returns a bound of the root of (r_u x r_v)^2 in a simply connected region in which the square does not vanish,
  /// where the root is analytic therefore. Infinite if that is not proven.
  double normal(double reach_u, double reach_v) const;
  /// Returns a bound of |r_u x r_v| for real parameters.
  double real_normal() const;
  /// The point of the middle, relative to the net's centre.
  const Vec3& middle() const { return middle_; }
  /// How far normals are from that of the middle along u alone, and along v: not a bound.
  double normal_turn(bool along_u) const;

 private:
  struct Powers {
    std::array<double, 4 * max_order> u, v;
  };
  static Powers powers(double reach_u, double reach_v, int degree_u, int degree_v);
  /// The least |w|, or nothing above 0.
  double least_weight(const Powers& powers) const;
  /// How far w^3 r_u x r_v is from that of the middle at most, where |w| is at least `least`.
  double turn(double reach_u, double reach_v, double least) const;
  void bound_hull(const LocalNet& net);
  void make_normals(const std::vector<Vec3>& points, const std::vector<double>& weights);

  int m_, n_;            ///< degrees of the points
  int mn_ = 0, nn_ = 0;  ///< degrees of the normals
  Vec3 middle_;
  Sizes real_{};                 ///< for real parameters, from the hull of the control points
  std::vector<double> points_;   ///< |a_ij|, relative to the middle
  std::vector<double> weights_;  ///< |w_ij|; empty for a polynomial patch
  std::vector<double> normals_;  ///< |n_ij| of w^3 r_u x r_v
};

}}  // namespace tessera::abi_0_1
