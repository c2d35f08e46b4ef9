// Surfaces that are evaluated without patches write their one output, a position, in every layout, and nothing else.

#include <array>
#include <bit>
#include <functional>
#include <vector>

#include "eval/output_memory.h"
#include "support/errors.h"
#include "tessera/coons_patch.h"
#include "tessera/evaluate.h"
#include "tessera/parametric_surface.h"

namespace tessera::test { namespace {

template <class T, class Surface>
void check_callable(const Surface& surface, const std::function<Vec3(double, double)>& at) {
  const std::vector<double> u{0, 0.25, 1}, v{0, 0.5, 0.75, 1};
  OutputBytes expected(output_count);
  for (const double s : u)
    for (const double t : v) {
      const Vec3 p = at(s, t);
      for (const double x : {p.x, p.y, p.z}) {
        const auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(static_cast<T>(x));
        expected[0].insert(expected[0].end(), bytes.begin(), bytes.end());
      }
    }
  for (const Layout layout : {Layout::arrays, Layout::columns, Layout::records, Layout::gaps})
    for (const Stores stores : {Stores::plain, Stores::streaming}) {
      ViewMemory<T> memory(layout, 1, u.size() * v.size());
      const Status status = evaluate(surface, u, v, memory.views().position, {.stores = stores});
      ASSERT_TRUE(status.ok()) << status.message();
      EXPECT_TRUE(memory.holds(expected, {})) << int(layout);
    }
}

TEST(CallableOutputs, ArePositionsAlone) {
  // Exact in float, however the sums are ordered.
  const auto place = [](double u, double v) { return Vec3{u, v, u * v}; };
  const ParametricSurface saddle = value_of(ParametricSurface::make({.position = place}));
  check_callable<float>(saddle, place);
  check_callable<double>(saddle, place);
  const auto line = [](const Vec3& from, const Vec3& to) { return value_of(Curve::bezier(std::array{from, to})); };
  const Curve c1 = line({0, 0, 0}, {1, 0, 0}), c2 = line({0, 1, 0}, {1, 1, 1});
  const RuledSurface ruled = value_of(RuledSurface::make(c1, c2));
  check_callable<float>(ruled, place);
  check_callable<double>(ruled, place);
  const CoonsPatch coons = value_of(CoonsPatch::make({c1, c2, line({0, 0, 0}, {0, 1, 0}), line({1, 0, 0}, {1, 1, 1})}));
  check_callable<float>(coons, place);
  check_callable<double>(coons, place);
}

}}  // namespace tessera::test
