#include "ray/leaf/local_leaf.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/infinity.h"
#include "ray/net/cubic_net.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double unit = 0x1p-24;  // rounding of float
constexpr double reach = kernel::RayLeaf::reach;
// Bounds the error in float of a component of a ray's point near the scene: its start rounds by 2^-24, its direction by
// 2^-25 over 3.5, the centre less the start by 2^-23, the product by 2^-23; with a margin.
constexpr double ray_rounding = 5e-7;

/// Powers of `reach` by exponent.
constexpr std::array<double, 7> reach_powers = [] {
  std::array<double, 7> out{1};
  for (std::size_t k = 1; k < out.size(); ++k) out[k] = reach * out[k - 1];
  return out;
}();

class LeafMaker {
 public:
  LeafMaker(const NetShape<0, 0>& shape, bool rational, const double* net, kernel::RayLeaf& leaf)
      : shape_(shape), rational_(rational), net_(net), leaf_(leaf) {}

  void make() {
    set_frame();
    to_local();
    set_box();
    if (regular_) set_coefficients();
  }

 private:
  double weight(int k) const { return rational_ ? scale_ * net_[3 * shape_.size() + k] : 1; }
  Vec3 point(int i, int j) const {
    const int k = i * shape_.columns() + j, size = shape_.size();
    const double w = rational_ ? net_[3 * size + k] : 1;
    return {net_[k] / w, net_[size + k] / w, net_[2 * size + k] / w};
  }

  /// Sets the frame from the corners: u and v along the mean sides, the third axis as long as their geometric mean.
  void set_frame() {
    const int m = shape_.m(), n = shape_.n();
    if (rational_) scale_ = 1 / *std::max_element(net_ + 3 * shape_.size(), net_ + 4 * shape_.size());
    const Vec3 a = point(0, 0), b = point(m, 0), c = point(0, n), d = point(m, n);
    const Vec3 centre = 0.25 * (a + b + c + d);
    Vec3 u = 0.5 * ((b - a) + (d - c)), v = 0.5 * ((c - a) + (d - b));
    const double long_u = length(u), long_v = length(v);
    Vec3 w = cross(u, v);
    const double area = length(w);
    regular_ = area > 1e-2 * long_u * long_v && std::min(long_u, long_v) > 1e-3 * std::max(long_u, long_v) &&
               std::min(long_u, long_v) > 1e-5;
    if (regular_) {
      w = (std::sqrt(long_u * long_v) / area) * w;
    } else {
      u = {1, 0, 0}, v = {0, 1, 0}, w = {0, 0, 1};
    }
    const double volume = dot(u, cross(v, w));
    const Vec3 rows[3] = {(1 / volume) * cross(v, w), (1 / volume) * cross(w, u), (1 / volume) * cross(u, v)};
    leaf_.centre[0] = static_cast<float>(centre.x), leaf_.centre[1] = static_cast<float>(centre.y);
    leaf_.centre[2] = static_cast<float>(centre.z);
    for (std::size_t k = 0; k < 3; ++k) {
      leaf_.axis_x[k] = static_cast<float>(rows[k].x), leaf_.axis_y[k] = static_cast<float>(rows[k].y);
      leaf_.axis_z[k] = static_cast<float>(rows[k].z);
    }
  }

  /// Computes the net in the frame as rounded to float.
  void to_local() {
    const int size = shape_.size();
    for (int k = 0; k < size; ++k) {
      const double w = weight(k);
      const double x = scale_ * net_[k] - w * static_cast<double>(leaf_.centre[0]);
      const double y = scale_ * net_[size + k] - w * static_cast<double>(leaf_.centre[1]);
      const double z = scale_ * net_[2 * size + k] - w * static_cast<double>(leaf_.centre[2]);
      for (std::size_t c = 0; c < 3; ++c)
        local_[c][static_cast<std::size_t>(k)] = x * leaf_.axis_x[c] + y * leaf_.axis_y[c] + z * leaf_.axis_z[c];
      local_[3][static_cast<std::size_t>(k)] = w;
    }
  }

  void set_box() {
    double gain = 0, extent = 0, size = 0;
    lightest_ = infinity;
    double low[3], high[3];
    for (std::size_t c = 0; c < 3; ++c) {
      gain = std::max<double>(gain, std::abs(leaf_.axis_x[c]) + std::abs(leaf_.axis_y[c]) + std::abs(leaf_.axis_z[c]));
      low[c] = infinity, high[c] = -infinity;
      for (std::size_t k = 0; k < static_cast<std::size_t>(shape_.size()); ++k) {
        const double x = local_[c][k] / local_[3][k];
        low[c] = std::min(low[c], x), high[c] = std::max(high[c], x);
        lightest_ = std::min(lightest_, local_[3][k]);
      }
      extent = std::max({extent, -low[c], high[c]});
    }
    for (int i = 0; i <= shape_.m(); ++i) {
      for (int j = 0; j <= shape_.n(); ++j) {
        const Vec3 p = point(i, j);
        size = std::max(
            {size, std::abs(p.x - leaf_.centre[0]), std::abs(p.y - leaf_.centre[1]), std::abs(p.z - leaf_.centre[2])});
      }
    }
    // For a point of the ray next to the piece: the ray's own rounding, and that of the products with the axes.
    largest_ = std::max(extent, 2 * gain * size);
    line_noise_ = gain * (ray_rounding + 16 * unit * size) + 32 * unit * (1 + extent);
    leaf_.lower[3] = leaf_.upper[3] = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      leaf_.lower[c] = static_cast<float>(low[c] - 2 * line_noise_);
      leaf_.upper[c] = static_cast<float>(high[c] + 2 * line_noise_);
    }
    leaf_.noise = static_cast<float>(infinity), leaf_.slope_noise = 0;
    leaf_.spread = 1e30f;  // no coordinate bounds a parameter
    leaf_.lightest = static_cast<float>(lightest_ * (1 - 2 * unit));
  }

  void set_coefficients() {
    double spread = std::max(parameter_error(0), parameter_error(1));
    leaf_.spread = static_cast<float>(1.001 * spread / lightest_ + 2 * line_noise_ + 8 * unit);
    const CubicNet cubic = cubic_net(shape_, local_);
    const auto& power = cubic.power;
    const std::size_t step = rational_ ? 4 : 3;
    float* out = leaf_.coefficients();
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        for (std::size_t c = 0; c < step; ++c) out[(4 * i + j) * step + c] = static_cast<float>(power[c][i][j]);
      }
    }
    if (!rational_) out[16 * step] = 0;  // read with the last point
    double value = 0, slope = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      const double sum = bound(power[c], 0, 0);
      value = std::max(value, sum);
      slope = std::max({slope, bound(power[c], 1, 0), bound(power[c], 0, 1)});
      leaf_.bend_uu[c] = static_cast<float>(1.001 * bound(power[c], 2, 0));
      leaf_.bend_uv[c] = static_cast<float>(1.001 * bound(power[c], 1, 1));
      leaf_.bend_vv[c] = static_cast<float>(1.001 * bound(power[c], 0, 2));
    }
    // Horner's scheme rounds six times, coefficients once, products and differences with the ray's point a few times.
    leaf_.noise = static_cast<float>(2 * line_noise_ + 16 * unit * (value + largest_ * (1 + value)) +
                                     1.001 * left_out(cubic.value_error));
    leaf_.slope_noise = static_cast<float>(32 * unit * slope * (1 + largest_) + 1.001 * left_out(cubic.slope_error));
  }

  /// Returns the error of a coordinate less the weight times the ray's, if components have errors of `error`.
  double left_out(const std::array<double, 4>& error) const {
    return std::max({error[0], error[1], error[2]}) + largest_ * error[3];
  }

  /// Bounds |coordinate - parameter| times the weight, by the hull of their difference, a degree higher.
  double parameter_error(std::size_t c) const {
    const int m = shape_.m(), n = shape_.n(), degree = c == 0 ? m : n, lines = c == 0 ? n : m;
    double largest = 0;
    for (int line = 0; line <= lines; ++line) {
      const auto at = [&](std::size_t component, int k) {
        return local_[component]
                     [static_cast<std::size_t>(c == 0 ? k * shape_.columns() + line : line * shape_.columns() + k)];
      };
      for (int k = 0; k <= degree + 1; ++k) {
        const double share = static_cast<double>(k) / (degree + 1);
        double sum = 0;
        if (k > 0) sum += share * (at(c, k - 1) - 0.5 * at(3, k - 1));
        if (k <= degree) sum += (1 - share) * (at(c, k) + 0.5 * at(3, k));
        largest = std::max(largest, std::abs(sum));
      }
    }
    return largest;
  }

  /// Bounds the derivative of the given order, for parameters within reach.
  static double bound(const CubicNet::Power& power, int order_u, int order_v) {
    const auto falling = [](int k, int order) { return order == 0 ? 1 : order == 1 ? k : k * (k - 1); };
    double sum = 0;
    for (int i = order_u; i < 4; ++i) {
      for (int j = order_v; j < 4; ++j) {
        sum += std::abs(power[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]) * falling(i, order_u) *
               falling(j, order_v) * reach_powers[static_cast<std::size_t>(i - order_u + j - order_v)];
      }
    }
    return sum;
  }

  const NetShape<0, 0> shape_;
  bool rational_, regular_ = false;
  const double* net_;
  kernel::RayLeaf& leaf_;
  double scale_ = 1, lightest_ = 1, line_noise_ = 0;
  double largest_ = 0;  // largest coordinate of the piece or of the ray's point nearest to the centre
  FourNets local_;
};

}  // namespace

void make_local_leaf(const NetShape<0, 0>& shape, bool rational, const double* net, kernel::RayLeaf& leaf) {
  LeafMaker(shape, rational, net, leaf).make();
}

}}  // namespace tessera::abi_0_1
