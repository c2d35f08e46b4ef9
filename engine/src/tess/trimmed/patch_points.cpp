#include "tess/trimmed/patch_points.h"

#include "basis/bernstein.h"

namespace tessera { inline namespace abi_0_1 {

namespace {

/// Writes the Bernstein values, as bernstein_values() does.
void write_values(int degree, double t, double* values) {
  if (degree == 1)
    values[0] = 1 - t, values[1] = t;
  else
    bernstein_values(degree, t, values);
}

/// Returns the point of a line v = const of control points.
Homogeneous point_of_line(const HomogeneousNet& net, int j, const double* of_u) {
  Homogeneous sum{0, 0, 0, 0};
  const Homogeneous* p = &net.at(0, j);
  for (int i = 0; i <= net.degree_u; ++i, p += net.degree_v + 1) sum = sum + of_u[i] * *p;
  return sum;
}

}  // namespace

void PatchPoints::begin_row(double u) {
  row_u_ = u;
  std::array<double, max_degree + 1> of_u;
  write_values(net_.degree_u, u, of_u.data());
  for (int j = 0; j <= net_.degree_v; ++j) row_[static_cast<std::size_t>(j)] = point_of_line(net_, j, of_u.data());
}

void PatchPoints::begin_row_du(double u) {
  row_du_u_ = u;
  std::array<double, max_degree + 1> lowered;
  bernstein_values(net_.degree_u - 1, u, lowered.data());
  for (int j = 0; j <= net_.degree_v; ++j) {
    Homogeneous du{0, 0, 0, 0};
    for (int i = 0; i < net_.degree_u; ++i)
      du = du + lowered[static_cast<std::size_t>(i)] * (net_.at(i + 1, j) - net_.at(i, j));
    row_du_[static_cast<std::size_t>(j)] = net_.degree_u * du;
  }
}

Vec3 PatchPoints::at(const ParameterPoint& local) {
  const auto is_end = [](double t) { return t == 0 || t == 1; };
  if (is_end(local.u) && is_end(local.v))
    return patch_.point(local.u > 0 ? net_.degree_u : 0, local.v > 0 ? net_.degree_v : 0) - origin_ + Vec3{};
  Homogeneous sum{0, 0, 0, 0};
  if (is_end(local.v) && local.u != row_u_) {  // the other lines would be added with values of 0
    std::array<double, max_degree + 1> of_u;
    write_values(net_.degree_u, local.u, of_u.data());
    sum = sum + point_of_line(net_, local.v > 0 ? net_.degree_v : 0, of_u.data());
    return net_.scale * sum.project();
  }
  if (local.u != row_u_) begin_row(local.u);
  std::array<double, max_degree + 1> of_v;
  write_values(net_.degree_v, local.v, of_v.data());
  for (std::size_t j = 0; j <= static_cast<std::size_t>(net_.degree_v); ++j) sum = sum + of_v[j] * row_[j];
  return net_.scale * sum.project();
}

// For A = w r, A_u - w_u r = w r_u. The components of the net are at most `reach`, so a derivative is off by less than
// `rounding`, and the direction by less than |r_u| + |r_v| of that over |r_u x r_v|.
Vec3 PatchPoints::normal(const ParameterPoint& local) {
  if (local.u != row_u_) begin_row(local.u);
  if (local.u != row_du_u_) begin_row_du(local.u);
  const auto n = static_cast<std::size_t>(net_.degree_v);
  std::array<double, max_degree + 1> of_v, lowered;
  bernstein_values(net_.degree_v, local.v, of_v.data());
  bernstein_values(net_.degree_v - 1, local.v, lowered.data());
  Homogeneous a{0, 0, 0, 0}, du{0, 0, 0, 0}, dv{0, 0, 0, 0};
  for (std::size_t j = 0; j <= n; ++j) {
    a = a + of_v[j] * row_[j];
    du = du + of_v[j] * row_du_[j];
  }
  for (std::size_t j = 0; j < n; ++j) dv = dv + lowered[j] * (row_[j + 1] - row_[j]);
  dv = net_.degree_v * dv;
  const Vec3 r = a.project(), ru = du.vector() - du.w * r, rv = dv.vector() - dv.w * r, normal = cross(ru, rv);
  const int degrees = net_.degree_u + net_.degree_v;
  const double reach = 2 + 2 * max_abs(net_.scaled_origin), rounding = 64 * degrees * degrees * reach * 0x1p-53;
  if (rounding * (length(ru) + length(rv)) < 1e-8 * length(normal)) return normalized(normal);
  return unit_normal(patch_, local.u, local.v).direction;
}

}}  // namespace tessera::abi_0_1
