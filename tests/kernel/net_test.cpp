// Compares control nets in the kernels of each ISA with plain loops: the same bits, at every size.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/aligned.h"
#include "kernel/table/kernel_table.h"

namespace tessera::test { namespace {

constexpr std::size_t lanes = kernel::block_lanes;
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<double> numbers(std::size_t count) {
  std::mt19937 random(static_cast<unsigned>(count));
  std::uniform_real_distribution<double> uniform(-100, 100);
  std::vector<double> result(count);
  for (double& x : result) x = uniform(random);
  return result;
}

/// The lowest, the highest, and some between: nets of whole vectors and of some points more.
const std::vector<std::array<int, 2>> net_degrees = {{1, 1}, {1, 2}, {2, 2}, {3, 2}, {3, 3}, {4, 4}, {5, 5}, {15, 15}};

struct Nets {
  explicit Nets(const std::array<int, 2>& net_degree)
      : degree(net_degree),
        size(3 * static_cast<std::size_t>((degree[0] + 1) * (degree[1] + 1))),
        memory(numbers(lanes * (size + 1))) {
    for (std::size_t l = 0; l < lanes; ++l) lane[l] = &memory[l * (size + 1)];  // most not aligned
  }
  std::array<int, 2> degree;
  std::size_t size;
  std::vector<double> memory;
  std::array<const double*, lanes> lane;
};

void expect_boxes(const Nets& nets, const kernel::NetBoxes& boxes) {
  for (std::size_t l = 0; l < lanes; ++l)
    for (std::size_t c = 0; c < 3; ++c) {
      double lower = infinity, upper = -infinity;
      for (std::size_t k = c; k < nets.size; k += 3) {
        lower = std::min(lower, nets.lane[l][k]);
        upper = std::max(upper, nets.lane[l][k]);
      }
      ASSERT_EQ(boxes.lower[c][l], lower);
      ASSERT_EQ(boxes.upper[c][l], upper);
    }
}

template <class T>
using Pack = void (*)(const kernel::PackJob<T>&, kernel::PackedNets&);

/// Memory of a job for some nets.
template <class T>
struct Packing {
  explicit Packing(const Nets& of)
      : nets(of), out((nets.size + 1) * lanes, T(-1)), thresholds(2 * lanes, T(-1)), memory(nets.memory.size(), -1) {
    for (std::size_t l = 0; l < lanes; ++l) copies[l] = &memory[l * (nets.size + 1)];
  }
  kernel::PackJob<T> job(bool copying) {
    return {.nets = nets.lane.data(),
            .degree_u = nets.degree[0],
            .degree_v = nets.degree[1],
            .origin = {origin[0], origin[1], origin[2]},
            .out = out.data(),
            .copies = copying ? copies.data() : nullptr,
            .thresholds = thresholds.data(),
            .noise = 1e-4,
            .longest = 3,
            .min_threshold = 1e-3};
  }

  static constexpr double origin[] = {-1e-3, 7, -0.1};
  const Nets& nets;
  AlignedVector<T> out, thresholds;
  std::vector<double> memory;
  std::array<double*, lanes> copies;
};

template <class T>
void expect_thresholds(const Packing<T>& packing, const kernel::PackedNets& found) {
  for (std::size_t l = 0; l < lanes; ++l) {
    double largest = 0, squared[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const double low = found.boxes.lower[c][l], high = found.boxes.upper[c][l], from = Packing<T>::origin[c];
      largest = std::max({largest, std::abs(low - from), std::abs(high - from)});
      squared[c] = (high - low) * (high - low);
    }
    const double noise = 1e-4 * largest, length = 4 * noise * (3 * std::sqrt(squared[0] + squared[1] + squared[2]));
    EXPECT_EQ(found.largest[l], largest);
    EXPECT_EQ(packing.thresholds[l], static_cast<T>(std::max(length * length, 1e-3)));
    EXPECT_EQ(packing.thresholds[lanes + l], static_cast<T>(noise));
  }
}

template <class T>
void check_packing(Pack<T> pack, const Nets& nets) {
  Packing<T> packing(nets);
  for (const bool copying : {false, true}) {
    kernel::PackedNets found;
    pack(packing.job(copying), found);
    EXPECT_FALSE(found.edges_may_be_points);
    for (std::size_t k = 0; k <= nets.size; ++k)
      for (std::size_t l = 0; l < lanes; ++l) {
        const bool inside = k < nets.size;
        ASSERT_EQ(packing.out[k * lanes + l],
                  inside ? static_cast<T>(nets.lane[l][k] - Packing<T>::origin[k % 3]) : T(-1))
            << k << " " << l;
        ASSERT_EQ(packing.copies[l][k], inside && copying ? nets.lane[l][k] : -1);
      }
    expect_boxes(nets, found.boxes);
    expect_thresholds(packing, found);
  }
}

TEST(NetKernels, PackEveryLane) {
  for (const Isa isa : available_isas())
    for (const auto& degree : net_degrees) {
      SCOPED_TRACE(std::string(name(isa)) + ", " + std::to_string(degree[0]) + " x " + std::to_string(degree[1]));
      check_packing(kernel::kernels(isa).pack_f32, Nets(degree));
      check_packing(kernel::kernels(isa).pack_f64, Nets(degree));
    }
}

/// Collapses an edge of one lane to a point, or, if `nearly`, all but its last component.
void collapse_edge(Nets& nets, std::size_t lane, int edge, bool nearly) {
  const int m = nets.degree[0], n = nets.degree[1];
  const bool along_u = edge >= 2;
  const int first = edge == 0 || edge == 2 ? 0 : along_u ? n : m * (n + 1);
  double* net = &nets.memory[lane * (nets.size + 1)];
  for (int k = 1; k <= (along_u ? m : n); ++k)
    for (int c = 0; c < (nearly ? 2 : 3); ++c) net[3 * (first + k * (along_u ? n + 1 : 1)) + c] = net[3 * first + c];
}

template <class T>
bool tells_of_points(Pack<T> pack, const Nets& nets) {
  Packing<T> packing(nets);
  kernel::PackedNets found;
  pack(packing.job(false), found);
  return found.edges_may_be_points;
}

TEST(NetKernels, PackTellsOfEdgesThatArePoints) {
  for (const Isa isa : available_isas())
    for (const auto& degree : net_degrees)
      for (std::size_t lane = 0; lane < lanes; ++lane)
        for (int edge = 0; edge < 4; ++edge)
          for (const bool nearly : {false, true}) {
            Nets nets(degree);
            collapse_edge(nets, lane, edge, nearly);
            EXPECT_EQ(tells_of_points(kernel::kernels(isa).pack_f32, nets), !nearly);
            EXPECT_EQ(tells_of_points(kernel::kernels(isa).pack_f64, nets), !nearly);
          }
}

TEST(NetKernels, BoundEveryLane) {
  for (const Isa isa : available_isas())
    for (const auto& degree : net_degrees) {
      SCOPED_TRACE(std::string(name(isa)) + ", " + std::to_string(degree[0]) + " x " + std::to_string(degree[1]));
      const Nets nets(degree);
      kernel::NetBoxes boxes;
      kernel::kernels(isa).bound_nets(nets.lane.data(), nets.size, boxes);
      expect_boxes(nets, boxes);
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

}}  // namespace tessera::test
