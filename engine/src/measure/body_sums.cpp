#include "measure/body_sums.h"

#include <algorithm>
#include <cmath>

#include "basis/symmetric_eigen.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double unit = 0x1p-50;  // a few roundings

std::array<double, 3> coordinates(const Vec3& p) { return {p.x, p.y, p.z}; }

/// The places of x x, y y, z z, x y, y z, z x among the moments, and their factors.
struct SecondMoment {
  std::size_t place, a, b;
};
constexpr std::array<SecondMoment, 6> second_moments{
    {{4, 0, 0}, {5, 1, 1}, {6, 2, 2}, {7, 0, 1}, {8, 1, 2}, {9, 2, 0}}};

/// The second moments about the centroid: those about the centre, less m_a m_b / m_0.
Integrals central(const Integrals& m) {
  Integrals all = m;
  const double mass = m.value[0], least = mass - m.error[0];
  for (const auto& [place, a, b] : second_moments) {
    const double x = m.value[1 + a], y = m.value[1 + b], ex = m.error[1 + a], ey = m.error[1 + b];
    const double taken = x * y / mass;
    all.value[place] -= taken;
    all.error[place] += (std::abs(x) * ey + std::abs(y) * ex + ex * ey) / least + std::abs(taken) * m.error[0] / least +
                        unit * (std::abs(m.value[place]) + std::abs(taken));
  }
  return all;
}

/// How much the rounding of a determinant may grow relative to it.
double condition_of(const Affine& map) {
  const double product = length(map.columns[0]) * length(map.columns[1]) * length(map.columns[2]);
  const double determinant = std::abs(map.determinant());
  return determinant > 0 ? product / determinant : 1;
}

void set_axes(Inertia& inertia) {
  const SymmetricEigen eigen = symmetric_eigen(inertia.xx, inertia.yy, inertia.zz, inertia.xy, inertia.yz, inertia.zx);
  std::array<std::size_t, 3> order{0, 1, 2};
  std::ranges::sort(order, {}, [&](std::size_t k) { return std::pair(eigen.values[k], k); });
  for (std::size_t k = 0; k < 3; ++k) {
    inertia.moments[k] = eigen.values[order[k]];
    inertia.axes[k] = eigen.vectors[order[k]];
  }
  if (dot(cross(inertia.axes[0], inertia.axes[1]), inertia.axes[2]) < 0) inertia.axes[2] = -inertia.axes[2];
  // A matrix whose entries are off by e moves eigenvalues by at most its Frobenius norm, 3 e (Weyl).
  const double largest = std::max(std::abs(inertia.moments[0]), std::abs(inertia.moments[2]));
  inertia.moments_error = 3 * inertia.error + 64 * unit * largest;
}

Inertia inertia_of(const Integrals& moments) {
  const Integrals s = central(moments);
  Inertia inertia{.xx = s.value[5] + s.value[6], .yy = s.value[4] + s.value[6], .zz = s.value[4] + s.value[5]};
  inertia.xy = -s.value[7], inertia.yz = -s.value[8], inertia.zx = -s.value[9];
  double square = 0, product = 0;
  for (std::size_t k = 4; k < 7; ++k) square = std::max(square, s.error[k] + unit * std::abs(s.value[k]));
  for (std::size_t k = 7; k < 10; ++k) product = std::max(product, s.error[k]);
  inertia.error = std::max(2 * square, product);
  set_axes(inertia);
  return inertia;
}

}  // namespace

MeasuredPoint centroid_of(const Integrals& m, const Vec3& centre, const Box3& box) {
  const double least = m.value[0] - m.error[0];
  if (!(least > 0)) return {box.empty() ? Vec3{} : box.centre(), box.diagonal()};
  const Vec3 offset = (1 / m.value[0]) * Vec3{m.value[1], m.value[2], m.value[3]};
  const double error = (std::max({m.error[1], m.error[2], m.error[3]}) + max_abs(offset) * m.error[0]) / least;
  const Vec3 point = centre + offset;
  return {point, error + unit * (max_abs(point) + max_abs(offset))};
}

Integrals moved_area(const Integrals& area, const Vec3& from, const Vec3& to) {
  Integrals all = area;
  const std::array<double, 3> by = coordinates(from - to);
  const double rounding = unit * (max_abs(from) + max_abs(to));
  for (std::size_t k = 0; k < 3; ++k) {
    all.value[1 + k] += area.value[0] * by[k];
    all.error[1 + k] +=
        area.error[0] * std::abs(by[k]) + std::abs(area.value[0]) * rounding + unit * std::abs(all.value[1 + k]);
  }
  return all;
}

Integrals volume_moments(const Integrals& flux) {
  Integrals all = flux;
  for (int k = 0; k < 10; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double divergence = 3 + moment_degree(k);
    all.value[at] /= divergence;
    all.error[at] = all.error[at] / divergence + unit * std::abs(all.value[at]);
  }
  return all;
}

BodyMeasures body_of(const Integrals& moments, const Vec3& centre, const Box3& box) {
  BodyMeasures body;
  body.volume = {moments.value[0], moments.error[0]};
  body.centroid = centroid_of(moments, centre, box);
  if (moments.value[0] - moments.error[0] > 0) {
    body.inertia = inertia_of(moments);
  } else {
    const double size = box.diagonal();
    body.inertia.error = 2 * size * size * (std::abs(moments.value[0]) + moments.error[0]);
    body.inertia.moments_error = 3 * body.inertia.error;
    body.inertia.axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  }
  return body;
}

Integrals moments_of(const BodyMeasures& body, const Vec3& centre) {
  Integrals all;
  const Inertia& i = body.inertia;
  const double mass = body.volume.value, most = mass + body.volume.error;
  const std::array<double, 3> c = coordinates(body.centroid.value - centre);
  const std::array<double, 6> s{
      0.5 * (i.yy + i.zz - i.xx), 0.5 * (i.xx + i.zz - i.yy), 0.5 * (i.xx + i.yy - i.zz), -i.xy, -i.yz, -i.zx};
  const double off = body.centroid.error + unit * (max_abs(body.centroid.value) + max_abs(centre));
  all.value[0] = mass, all.error[0] = body.volume.error;
  for (std::size_t k = 0; k < 3; ++k) {
    all.value[1 + k] = mass * c[k];
    all.error[1 + k] = most * off + body.volume.error * std::abs(c[k]);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const auto& [place, a, b] = second_moments[k];
    all.value[place] = s[k] + mass * c[a] * c[b];
    all.error[place] = 1.5 * i.error + most * off * (std::abs(c[a]) + std::abs(c[b]) + off) +
                       body.volume.error * std::abs(c[a] * c[b]) + unit * std::abs(all.value[place]);
  }
  return all;
}

BodyMeasures placed(const BodyMeasures& body, const Affine& map) {
  if (map == Affine{}) return body;
  const double factor = std::abs(map.determinant());
  std::array<std::array<double, 3>, 3> a;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::array<double, 3> column = coordinates(map.columns[k]);
    for (std::size_t row = 0; row < 3; ++row) a[row][k] = column[row];
  }
  // Relative to the image of the centroid, the moments of degree 1 vanish, up to their errors.
  const Integrals own = moments_of(body, body.centroid.value);
  const std::array<std::array<std::size_t, 3>, 3> place{{{4, 7, 9}, {7, 5, 8}, {9, 8, 6}}};
  const double rounding = 64 * unit;
  Integrals image;
  image.value[0] = factor * own.value[0];
  image.error[0] = factor * own.error[0] + rounding * std::abs(image.value[0]) * condition_of(map);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l) image.error[1 + k] += factor * std::abs(a[k][l]) * own.error[1 + l];
  for (const auto& [at, row, column] : second_moments)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l) {
        const double scale = factor * a[row][k] * a[column][l];
        image.value[at] += scale * own.value[place[k][l]];
        image.error[at] += std::abs(scale) *
                           (own.error[place[k][l]] + rounding * condition_of(map) * std::abs(own.value[place[k][l]]));
      }
  BodyMeasures result = body_of(image, map.point(body.centroid.value), {});
  result.centroid.error += unit * (max_abs(body.centroid.value) * map.norm_bound() + max_abs(map.translation));
  result.gap = body.gap * map.norm_bound(), result.proven = body.proven;
  result.instance = body.instance, result.shape = body.shape, result.solid = body.solid, result.shell = body.shell;
  return result;
}

Result<BodyMeasures> total_of(std::span<const BodyMeasures> bodies) {
  return guarded([&]() -> Result<BodyMeasures> {
    if (bodies.empty()) return Status(StatusCode::invalid_argument, "there are no bodies to add up");
    Box3 box;
    for (const BodyMeasures& body : bodies) box.extend(body.centroid.value);
    ExactSums sums;
    double gap = 0;
    bool proven = true;
    for (const BodyMeasures& body : bodies) {
      sums.add(moments_of(body, box.centre()), 1);
      gap = std::max(gap, body.gap);
      proven = proven && body.proven;
    }
    BodyMeasures total = body_of(sums.sums(), box.centre(), box);
    total.gap = gap, total.proven = proven;
    return total;
  });
}

}}  // namespace tessera::abi_0_1
