// Exact signs of triangles.

#include "tess/trimmed/orientation.h"

#include "tess_trim/plane_reference.h"

namespace tessera::test {
namespace {

int exact_sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

TEST(Orientation, OfPointsNearALineHasTheSignOfIntegers) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int64_t> place(-(std::int64_t{1} << 49), std::int64_t{1} << 49), step(-2, 2),
      share(-3, 4);
  int zeros = 0, undecided = 0;
  for (int k = 0; k < 200000; ++k) {
    const double u = double(place(random) >> (k % 4)), v = double(place(random) >> (k % 4));
    const double du = double(place(random) >> (3 + k % 5)), dv = double(place(random) >> (3 + k % 5));
    const double t = double(share(random));
    const ParameterPoint a{u, v}, b{u + du, v + dv};
    const ParameterPoint c{u + t * du + double(step(random)), v + t * dv + double(step(random))};
    const int wanted = side(a, b, c);
    ASSERT_EQ(exact_sign(orientation(a, b, c)), wanted);
    ASSERT_EQ(exact_sign(orientation(b, a, c)), -wanted);
    ASSERT_EQ(exact_sign(orientation_exactly(a, b, c)), wanted);
    const double plain = (a.u - c.u) * (b.v - c.v) - (a.v - c.v) * (b.u - c.u);
    zeros += wanted == 0;
    undecided += exact_sign(plain) != wanted;
  }
  EXPECT_GT(zeros, 1000);
  EXPECT_GT(undecided, 100) << "the cases are not hard enough: plain double decides them";
}

TEST(Orientation, DecidesUnitsInTheLastPlace) {
  const ParameterPoint a{0.1, 0.1}, b{0.7, 0.7};
  for (const double at : {0.3, 0.5, 0.9, 1e9, -1e-9}) {
    EXPECT_EQ(orientation(a, b, {at, at}), 0);
    EXPECT_GT(orientation(a, b, {at, std::nextafter(at, 2e9)}), 0);
    EXPECT_LT(orientation(a, b, {at, std::nextafter(at, -1)}), 0);
  }
}

}  // namespace
}  // namespace tessera::test
