#include "tess/trimmed/patch_points.h"

#include "basis/bernstein.h"

namespace tessera::inline abi_0_1 {

void PatchPoints::begin_row(double u) {
  std::array<double, max_degree + 1> of_u;
  bernstein_values(net_.degree_u, u, of_u.data());
  for (int j = 0; j <= net_.degree_v; ++j) {
    Homogeneous row{0, 0, 0, 0};
    for (int i = 0; i <= net_.degree_u; ++i) row = row + of_u[static_cast<std::size_t>(i)] * net_.at(i, j);
    row_[static_cast<std::size_t>(j)] = row;
  }
}

Vec3 PatchPoints::at(const ParameterPoint& local) {
  const auto is_end = [](double t) { return t == 0 || t == 1; };
  if (is_end(local.u) && is_end(local.v))
    return patch_.point(local.u > 0 ? net_.degree_u : 0, local.v > 0 ? net_.degree_v : 0) - origin_ + Vec3{};
  if (local.u != row_u_) begin_row(row_u_ = local.u);
  std::array<double, max_degree + 1> of_v;
  bernstein_values(net_.degree_v, local.v, of_v.data());
  Homogeneous sum{0, 0, 0, 0};
  for (std::size_t j = 0; j <= static_cast<std::size_t>(net_.degree_v); ++j) sum = sum + of_v[j] * row_[j];
  return net_.scale * sum.project();
}

}  // namespace tessera::inline abi_0_1
