#pragma once
// Tensor-product patches over polynomial bases, chosen per direction: Bezier, power, Hermite, uniform B-spline,
// Catmull-Rom, or the user's matrix. Graphs z = sum a_ij x^i y^j over a rectangle.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once.

#include <memory>
#include <span>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A basis of the polynomials of one degree on [0,1], given by the matrix M that turns the geometry of a curve into its
/// power coefficients: r(t) = [1 t .. t^n] M G, with the blending functions f_i(t) = sum_k t^k M_ki. Immutable except
/// for assignment; copies share the matrix.
class BasisMatrix {
 public:
  /// Makes the Bernstein polynomials. Errors: unsupported_degree, as for all makers with a degree.
  static Result<BasisMatrix> bezier(int degree);
  /// Makes the monomials: M is the identity. Errors: unsupported_degree.
  static Result<BasisMatrix> power(int degree);
  /// Makes the cubic Hermite polynomials in the order position 0, tangent 0, tangent 1, position 1. Tangents are
  /// derivatives by the local parameter, which runs over [0,1]. Errors: out_of_memory.
  static Result<BasisMatrix> hermite();
  /// Makes one span of the uniform B-spline; f_0 is the function that ends with the span (cubic: (1-t)^3/6 first, t^3/6
  /// last). Errors: unsupported_degree.
  static Result<BasisMatrix> uniform_b_spline(int degree);
  /// Makes the Catmull-Rom cubics of four points, from the second to the third; a tangent is half the chord of its
  /// neighbours. Errors: out_of_memory. Source: Catmull and Rom, A class of local interpolating splines, 1974.
  static Result<BasisMatrix> catmull_rom();
  /// Makes a basis from a matrix. A singular matrix serves to evaluate and to convert from, not to convert to.
  ///
  /// - `degree`: 1 to max_degree.
  /// - `entries`: (degree + 1)^2 finite entries M_ki, row by row; row k has the coefficients of t^k.
  ///
  /// Errors: unsupported_degree, count_mismatch, non_finite (index = the entry).
  static Result<BasisMatrix> custom(int degree, std::span<const double> entries);

  int degree() const { return data_->degree; }  ///< degree of the polynomials; there are degree + 1
  /// Returns M_ki: the coefficient of t^k in f_i.
  double power_coefficient(int k, int i) const { return data_->power[index(k, i)]; }
  /// Returns the coefficient of B_{k,n} in f_i: an entry of M_B^{-1} M, which turns geometry into Bezier points.
  double bernstein_coefficient(int k, int i) const { return data_->bernstein[index(k, i)]; }
  /// Whether other bases can be converted to this one: M has an inverse, up to the rounding of its entries.
  bool is_regular() const { return !data_->from_bernstein.empty(); }
  /// Returns the entry [i][k] of M^{-1} M_B, which turns Bezier points into geometry. is_regular() must be true.
  double inverse_coefficient(int i, int k) const { return data_->from_bernstein[index(i, k)]; }

  /// Compares the matrices.
  bool operator==(const BasisMatrix& other) const;

 private:
  struct Data {
    int degree;
    std::vector<double> power, bernstein, from_bernstein;
    friend bool operator==(const Data&, const Data&) = default;
  };
  explicit BasisMatrix(Data data);
  std::size_t index(int k, int i) const { return static_cast<std::size_t>(k * (degree() + 1) + i); }

  std::shared_ptr<const Data> data_;
};

/// A tensor-product patch r(u,v) = U M_u G M_v^T V^T, U = [1 s .. s^m], V = [1 t .. t^n], where s and t run over [0,1]
/// as u and v run over the domain. G holds points, tangents or twists, as the bases require; tangents are derivatives
/// by s and t. Immutable except for assignment; copies share everything.
class TensorPatch {
 public:
  /// Makes a patch from two bases of degrees m and n.
  ///
  /// - `geometry`: (m + 1) * (n + 1) finite vectors [i][j], i along u.
  ///
  /// Errors: count_mismatch, non_finite (index = the offending element), invalid_argument (the domain).
  static Result<TensorPatch> make(const BasisMatrix& basis_u, const BasisMatrix& basis_v,
                                  std::span<const Vec3> geometry, const Domain& domain = {});

  const BasisMatrix& basis_u() const { return data_->basis_u; }       ///< basis along u
  const BasisMatrix& basis_v() const { return data_->basis_v; }       ///< basis along v
  std::span<const Vec3> geometry() const { return data_->geometry; }  ///< `[i][j]`
  /// Returns the element [i][j], 0 <= i <= degree along u, 0 <= j <= degree along v.
  const Vec3& element(int i, int j) const {
    return data_->geometry[static_cast<std::size_t>(i * (basis_v().degree() + 1) + j)];
  }
  const Domain& domain() const { return data_->domain; }  ///< rectangle on which it is evaluated

 private:
  struct Data {
    BasisMatrix basis_u, basis_v;
    std::vector<Vec3> geometry;
    Domain domain;
  };
  explicit TensorPatch(Data data);
  std::shared_ptr<const Data> data_;
};

/// Evaluates sum f_i(s) g_j(t) g_ij in long double: the reference evaluator, for any finite (u,v). Blending functions
/// are in Bernstein form, because powers cancel. Derivatives are by u and v of the domain.
SurfaceJet evaluate_jet(const TensorPatch& patch, double u, double v);

/// Returns the same surface in other bases, of the same degrees or higher ones: G' = M'^{-1} M G (..)^T. It is exact up
/// to rounding, which the new bases' condition magnifies. A direction whose basis does not change keeps its numbers.
///
/// Errors: unsupported_degree (a degree below the patch's), invalid_argument (a singular basis), non_finite.
Result<TensorPatch> change_basis(const TensorPatch& patch, const BasisMatrix& basis_u, const BasisMatrix& basis_v);

/// The graph (x, y, sum a_ij x^i y^j) with x = u and y = v over a rectangle. Immutable except for assignment; copies
/// share everything.
class ExplicitPolynomial {
 public:
  /// Makes a graph.
  ///
  /// - `degree_x`, `degree_y`: 0 to max_degree.
  /// - `coefficients`: a_ij is coefficients[i * (degree_y + 1) + j], finite.
  /// - `rectangle`: finite, u0 < u1 and v0 < v1.
  ///
  /// Errors: unsupported_degree, count_mismatch, non_finite (index = the coefficient), invalid_argument.
  static Result<ExplicitPolynomial> make(int degree_x, int degree_y, std::span<const double> coefficients,
                                         const Domain& rectangle);

  int degree_x() const { return data_->degree_x; }
  int degree_y() const { return data_->degree_y; }
  const Domain& rectangle() const { return data_->rectangle; }  ///< range of x and y
  /// Returns the coefficient of x^i y^j.
  double coefficient(int i, int j) const {
    return data_->coefficients[static_cast<std::size_t>(i * (degree_y() + 1) + j)];
  }

 private:
  struct Data {
    int degree_x, degree_y;
    std::vector<double> coefficients;
    Domain rectangle;
  };
  explicit ExplicitPolynomial(Data data);
  std::shared_ptr<const Data> data_;
};

/// Returns position and derivatives at x = u, y = v, inside the rectangle or not: the reference evaluator. Sums carry
/// 106 bits, so powers that cancel far from zero lose nothing while they are below 2^50 times the result.
SurfaceJet evaluate_jet(const ExplicitPolynomial& surface, double u, double v);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
