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

Vec3 PatchPoints::sum(const double* of_v) const {
  Homogeneous sum{0, 0, 0, 0};
  for (std::size_t j = 0; j <= static_cast<std::size_t>(net_.degree_v); ++j) sum = sum + of_v[j] * row_[j];
  return net_.scale * sum.project();
}

Vec3 PatchPoints::at(const ParameterPoint& local) {
  std::array<double, max_degree + 1> of_v;
  bernstein_values(net_.degree_v, local.v, of_v.data());
  begin_row(local.u);
  return sum(of_v.data());
}

void PatchPoints::set_lines(std::span<const double> lines) {
  of_lines_.resize(lines.size() * values_per_line);
  for (std::size_t j = 0; j < lines.size(); ++j)
    bernstein_values(net_.degree_v, lines[j], &of_lines_[j * values_per_line]);
}

}  // namespace tessera::inline abi_0_1
