// Control nets in the kernels of each ISA, against plain loops: the same bits, at every size.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <vector>

#include "base/aligned.h"
#include "kernel/kernel_table.h"

namespace tessera::test {
namespace {

constexpr std::size_t lanes = kernel::block_lanes;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<double> numbers(std::size_t count) {
  std::mt19937 random(static_cast<unsigned>(count));
  std::uniform_real_distribution<double> uniform(-100, 100);
  std::vector<double> result(count);
  for (double& x : result) x = uniform(random);
  return result;
}

/// Of the smallest patch, of the degrees between, and of one more point than whole vectors hold.
const std::vector<std::size_t> net_sizes = {12, 18, 27, 36, 48, 75, 108, 768};

struct Nets {
  explicit Nets(std::size_t net_size) : size(net_size), memory(numbers(lanes * (size + 1))) {
    for (std::size_t l = 0; l < lanes; ++l) lane[l] = &memory[l * (size + 1)];  // most not aligned
  }
  std::size_t size;
  std::vector<double> memory;
  std::array<const double*, lanes> lane;
};

template <class T>
void check_packing(void (*pack)(const kernel::PackJob<T>&), const Nets& nets) {
  const double shift[] = {1e-3, -7, 0.1};
  AlignedVector<T> out((nets.size + 1) * lanes, T(-1));
  pack({nets.lane.data(), nets.size, {shift[0], shift[1], shift[2]}, out.data()});
  for (std::size_t k = 0; k <= nets.size; ++k)
    for (std::size_t l = 0; l < lanes; ++l)
      ASSERT_EQ(out[k * lanes + l], k < nets.size ? static_cast<T>(nets.lane[l][k] + shift[k % 3]) : T(-1))
          << k << " " << l;
}

TEST(NetKernels, PackEveryLane) {
  for (const Isa isa : available_isas())
    for (const std::size_t size : net_sizes) {
      SCOPED_TRACE(std::string(name(isa)) + ", " + std::to_string(size));
      check_packing(kernel::kernels(isa).pack_f32, Nets(size));
      check_packing(kernel::kernels(isa).pack_f64, Nets(size));
    }
}

TEST(NetKernels, BoundEveryLane) {
  for (const Isa isa : available_isas())
    for (const std::size_t size : net_sizes) {
      SCOPED_TRACE(std::string(name(isa)) + ", " + std::to_string(size));
      const Nets nets(size);
      kernel::NetBoxes boxes;
      kernel::kernels(isa).bound_nets(nets.lane.data(), size, boxes);
      for (std::size_t l = 0; l < lanes; ++l)
        for (std::size_t c = 0; c < 3; ++c) {
          double lower = infinity, upper = -infinity;
          for (std::size_t k = c; k < size; k += 3) {
            lower = std::min(lower, nets.lane[l][k]);
            upper = std::max(upper, nets.lane[l][k]);
          }
          ASSERT_EQ(boxes.lower[c][l], lower);
          ASSERT_EQ(boxes.upper[c][l], upper);
        }
    }
}

TEST(NetKernels, BoundPointsExtendsBounds) {
  for (const Isa isa : available_isas())
    for (std::size_t count = 0; count <= 150; count += 3) {
      SCOPED_TRACE(std::string(name(isa)) + ", " + std::to_string(count));
      const std::vector<double> points = numbers(count + 1);
      kernel::PointBounds bounds, expected;
      for (std::size_t k = 0; k < kernel::PointBounds::run; ++k) {
        expected.lower[k] = bounds.lower[k] = k % 3 == 0 ? -90 : k % 3 == 1 ? infinity : 3;
        expected.upper[k] = bounds.upper[k] = k % 3 == 0 ? -90 : k % 3 == 1 ? -infinity : 3;
      }
      for (std::size_t k = 0; k < count; ++k) {
        double &low = expected.lower[k % kernel::PointBounds::run],
               &high = expected.upper[k % kernel::PointBounds::run];
        low = std::min(low, points[k + 1]);
        high = std::max(high, points[k + 1]);
      }
      kernel::kernels(isa).bound_points(points.data() + 1, count, bounds);
      EXPECT_TRUE(std::ranges::equal(bounds.lower, expected.lower));
      EXPECT_TRUE(std::ranges::equal(bounds.upper, expected.upper));
    }
}

TEST(NetKernels, CombineRowsInOrder) {
  const std::vector<double> weights = numbers(16);
  for (const Isa isa : available_isas())
    for (std::size_t count = 1; count <= 16; ++count)
      for (std::size_t width = 1; width <= 40; ++width) {
        const std::size_t stride = width + count % 3;
        const std::vector<double> rows = numbers(count * stride);
        std::vector<double> out(width + 1, -1), expected(width + 1, -1);
        for (std::size_t x = 0; x < width; ++x) {
          double sum = weights[0] * rows[x];
          for (std::size_t k = 1; k < count; ++k) sum += weights[k] * rows[k * stride + x];
          expected[x] = sum;
        }
        kernel::kernels(isa).combine({weights.data(), count, rows.data(), stride, width, out.data()});
        ASSERT_EQ(out, expected) << name(isa) << ", " << count << " rows of " << width;
      }
}

}  // namespace
}  // namespace tessera::test
