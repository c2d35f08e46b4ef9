#include "tessera/tensor_patch.h"

#include <array>
#include <string>

#include "basis/bernstein.h"
#include "surface/net/checks.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using Real = long double;

/// The blending functions of a basis and their derivatives at one local parameter.
struct Blending {
  Blending(const BasisMatrix& basis, double t) {
    const int n = basis.degree();
    std::array<Real, max_degree + 1> bernstein[3];
    bernstein_values<Real>(n, t, bernstein[0].data());
    bernstein_derivatives<Real>(n, t, bernstein[1].data());
    bernstein_second_derivatives<Real>(n, t, bernstein[2].data());
    for (int order = 0; order < 3; ++order)
      for (int i = 0; i <= n; ++i) {
        Real sum = 0;
        for (int k = 0; k <= n; ++k)
          sum += bernstein[order][static_cast<std::size_t>(k)] * basis.bernstein_coefficient(k, i);
        values[order][static_cast<std::size_t>(i)] = sum;
      }
  }
  std::array<Real, max_degree + 1> values[3];
};

/// Returns the derivative of order a in s and b in t, times `factor`.
Vec3 blended(const TensorPatch& patch, const Blending& f, const Blending& g, int a, int b, Real factor) {
  Real x = 0, y = 0, z = 0;
  for (int i = 0; i <= patch.basis_u().degree(); ++i)
    for (int j = 0; j <= patch.basis_v().degree(); ++j) {
      const Real weight = f.values[a][static_cast<std::size_t>(i)] * g.values[b][static_cast<std::size_t>(j)];
      const Vec3& p = patch.element(i, j);
      x += weight * p.x;
      y += weight * p.y;
      z += weight * p.z;
    }
  return {static_cast<double>(factor * x), static_cast<double>(factor * y), static_cast<double>(factor * z)};
}

}  // namespace

TensorPatch::TensorPatch(Data data) : data_(std::make_shared<const Data>(std::move(data))) {}

Result<TensorPatch> TensorPatch::make(const BasisMatrix& basis_u, const BasisMatrix& basis_v,
                                      std::span<const Vec3> geometry, const Domain& domain) {
  return guarded([&]() -> Result<TensorPatch> {
    const std::size_t rows = static_cast<std::size_t>(basis_u.degree()) + 1;
    const std::size_t columns = static_cast<std::size_t>(basis_v.degree()) + 1;
    if (geometry.size() != rows * columns)
      return Status(StatusCode::count_mismatch, "bases of degree " + std::to_string(basis_u.degree()) + " and " +
                                                    std::to_string(basis_v.degree()) + " need a geometry of " +
                                                    std::to_string(rows) + " x " + std::to_string(columns) +
                                                    " elements, found " + std::to_string(geometry.size()));
    if (Status status = check_vectors(geometry, columns, "geometry element"); !status.ok()) return status;
    if (Status status = check_domain(domain); !status.ok()) return status;
    return TensorPatch({basis_u, basis_v, {geometry.begin(), geometry.end()}, domain});
  });
}

SurfaceJet evaluate_jet(const TensorPatch& patch, double u, double v) {
  const Domain& d = patch.domain();
  const Blending f(patch.basis_u(), d.local_u(u)), g(patch.basis_v(), d.local_v(v));
  const Real a = 1 / (static_cast<Real>(d.u1) - d.u0), b = 1 / (static_cast<Real>(d.v1) - d.v0);  // chain rule
  return {blended(patch, f, g, 0, 0, 1),     blended(patch, f, g, 1, 0, a),     blended(patch, f, g, 0, 1, b),
          blended(patch, f, g, 2, 0, a * a), blended(patch, f, g, 1, 1, a * b), blended(patch, f, g, 0, 2, b * b)};
}

}}  // namespace tessera::abi_0_1
