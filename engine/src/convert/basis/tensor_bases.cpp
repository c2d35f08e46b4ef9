#include <string>

#include "convert/basis/bernstein_matrices.h"
#include "tessera/convert.h"
#include "tessera/guard.h"
#include "tessera/status.h"
#include "tessera/tensor_patch.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Matrix to_bernstein(const BasisMatrix& basis) {
  const int size = basis.degree() + 1;
  Matrix matrix(size, size);
  for (int k = 0; k < size; ++k)
    for (int i = 0; i < size; ++i) matrix(k, i) = basis.bernstein_coefficient(k, i);
  return matrix;
}

Matrix from_bernstein(const BasisMatrix& basis) {
  const int size = basis.degree() + 1;
  Matrix matrix(size, size);
  for (int i = 0; i < size; ++i)
    for (int k = 0; k < size; ++k) matrix(i, k) = basis.inverse_coefficient(i, k);
  return matrix;
}

/// Returns M'^{-1} M, from the geometry in one basis to that in another. Requires to.degree() >= from.degree() and a
/// regular `to`.
Matrix conversion(const BasisMatrix& from, const BasisMatrix& to) {
  if (from == to) return Matrix::identity(from.degree() + 1);
  return from_bernstein(to) * (elevation_matrix(from.degree(), to.degree()) * to_bernstein(from));
}

Status check_target(const BasisMatrix& from, const BasisMatrix& to, const std::string& direction) {
  if (to.degree() < from.degree())
    return {StatusCode::unsupported_degree, "a patch of degree " + std::to_string(from.degree()) + " in " + direction +
                                                " has no form of degree " + std::to_string(to.degree())};
  if (from != to && !to.is_regular())
    return {StatusCode::invalid_argument,
            "the basis matrix of " + direction + " is singular: it is no basis to convert to"};
  return {};
}

}  // namespace

Result<TensorPatch> change_basis(const TensorPatch& patch, const BasisMatrix& basis_u, const BasisMatrix& basis_v) {
  return guarded([&]() -> Result<TensorPatch> {
    if (Status status = check_target(patch.basis_u(), basis_u, "u"); !status.ok()) return status;
    if (Status status = check_target(patch.basis_v(), basis_v, "v"); !status.ok()) return status;
    const auto geometry =
        tensor_product(conversion(patch.basis_u(), basis_u), patch.geometry(), conversion(patch.basis_v(), basis_v));
    return TensorPatch::make(basis_u, basis_v, geometry, patch.domain());
  });
}

Result<PatchGrid> to_bezier(const TensorPatch& patch) {
  return guarded([&]() -> Result<PatchGrid> {
    const auto points = tensor_product(to_bernstein(patch.basis_u()), patch.geometry(), to_bernstein(patch.basis_v()));
    Result<BezierPatch> bezier = BezierPatch::polynomial(patch.basis_u().degree(), patch.basis_v().degree(), points);
    if (!bezier) return bezier.status();
    const Domain& d = patch.domain();
    return PatchGrid::make({d.u0, d.u1}, {d.v0, d.v1}, {*std::move(bezier)});
  });
}

}}  // namespace tessera::abi_0_1
