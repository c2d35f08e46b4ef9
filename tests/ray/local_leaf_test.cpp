// Pieces of patches in float, of any degree: their bounds, and the work of a ray.

#include "ray/leaf/local_leaf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <new>
#include <vector>

#include "base/impl_access.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/ray_scene_impl.h"
#include "ray_support.h"
#include "support/errors.h"
#include "support/random_patches.h"
#include "support/ray_classes.h"
#include "support/ray_proof.h"
#include "tessera/ray_scene.h"

namespace tessera { namespace {

using test::Random;
using test::uniform;

/// A piece as kernels take it, and the room behind it.
struct Local {
  alignas(kernel::RayLeaf) std::byte room[kernel::ray_leaf_bytes(true)];
  kernel::RayLeaf& leaf = *new (room) kernel::RayLeaf;
};

/// Heights over a square, with steps between them of up to `size`.
std::vector<Vec3> hilly_points(Random& random, int m, int n, double size) {
  std::vector<Vec3> points;
  for (int i = 0; i <= m; ++i) {
    for (int j = 0; j <= n; ++j)
      points.push_back({static_cast<double>(i) / m, static_cast<double>(j) / n, uniform(random, 0, size)});
  }
  return points;
}

BezierPatch hilly_patch(Random& random, int m, int n, bool rational, double size = 0.25) {
  const std::vector<Vec3> points = hilly_points(random, m, n, size);
  return rational ? test::rational(m, n, points, test::random_weights(random, m, n, 0.5, 2))
                  : test::polynomial(m, n, points);
}

/// Value and derivatives by u and v of coefficients of Bernstein polynomials, outside of [0,1]^2 too.
struct Point {
  long double value = 0, du = 0, dv = 0;
};

std::vector<long double> bernstein(int degree, long double t) {
  std::vector<long double> row{1};
  for (int n = 1; n <= degree; ++n) {
    row.push_back(0);
    for (std::size_t i = row.size(); i-- > 0;) row[i] = (1 - t) * row[i] + (i > 0 ? t * row[i - 1] : 0);
  }
  return row;
}

std::vector<long double> bernstein_slopes(int degree, long double t) {
  const std::vector<long double> below = bernstein(degree - 1, t);
  std::vector<long double> out(static_cast<std::size_t>(degree) + 1);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = degree * ((i > 0 ? below[i - 1] : 0) - (i < below.size() ? below[i] : 0));
  return out;
}

Point point_of(int m, int n, const std::vector<long double>& net, long double u, long double v) {
  const auto a = bernstein(m, u), b = bernstein(n, v), da = bernstein_slopes(m, u), db = bernstein_slopes(n, v);
  Point out;
  std::size_t k = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j, ++k)
      out.value += a[i] * b[j] * net[k], out.du += da[i] * b[j] * net[k], out.dv += a[i] * db[j] * net[k];
  }
  return out;
}

/// A component of the piece by the coefficients in float.
Point value_of(const kernel::RayLeaf& leaf, std::size_t step, std::size_t component, long double u, long double v) {
  Point out;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const long double c = leaf.coefficients()[(4 * i + j) * step + component];
      const auto x = static_cast<long double>(i), y = static_cast<long double>(j);
      out.value += c * std::pow(u, x) * std::pow(v, y);
      if (i > 0) out.du += c * x * std::pow(u, x - 1) * std::pow(v, y);
      if (j > 0) out.dv += c * y * std::pow(u, x) * std::pow(v, y - 1);
    }
  }
  return out;
}

/// The piece in the leaf's coordinates, homogeneous: the exact values of the kernels' coefficients.
std::vector<long double> local_net(const kernel::RayLeaf& leaf, const std::vector<double>& net, std::size_t size,
                                   bool rational, std::size_t component) {
  const double heaviest =
      rational ? *std::max_element(net.begin() + static_cast<std::ptrdiff_t>(3 * size), net.end()) : 1;
  const float* const axes[3] = {leaf.axis_x, leaf.axis_y, leaf.axis_z};
  std::vector<long double> out(size);
  for (std::size_t k = 0; k < size; ++k) {
    const long double w = rational ? static_cast<long double>(net[3 * size + k]) / heaviest : 1;
    if (component == 3) out[k] = w;
    for (std::size_t i = 0; i < 3 && component < 3; ++i) {
      const long double x = static_cast<long double>(net[i * size + k]) / heaviest;
      out[k] += (x - w * leaf.centre[i]) * axes[i][component];
    }
  }
  return out;
}

std::vector<double> homogeneous_net(const BezierPatch& patch) {
  const std::size_t size = patch.points().size();
  std::vector<double> net((patch.is_rational() ? 4 : 3) * size);
  for (std::size_t k = 0; k < size; ++k) {
    const double w = patch.is_rational() ? patch.weights()[k] : 1;
    const Vec3& p = patch.points()[k];
    net[k] = w * p.x, net[size + k] = w * p.y, net[2 * size + k] = w * p.z;
    if (patch.is_rational()) net[3 * size + k] = w;
  }
  return net;
}

/// The largest share of a bound that a piece's coefficients take up at random places within reach.
double share_of_bounds(const BezierPatch& patch, Random& random) {
  const int m = patch.degree_u(), n = patch.degree_v();
  const std::vector<double> net = homogeneous_net(patch);
  Local local;
  const kernel::RayLeaf& leaf = local.leaf;
  make_local_leaf(NetShape<0, 0>{m, n}, patch.is_rational(), net.data(), local.leaf);
  EXPECT_TRUE(std::isfinite(leaf.noise));
  const std::size_t size = patch.points().size(), step = patch.is_rational() ? 4 : 3;
  long double share = 0;
  for (std::size_t c = 0; c < step; ++c) {
    const std::vector<long double> exact = local_net(leaf, net, size, patch.is_rational(), c);
    for (int draw = 0; draw < 20; ++draw) {
      constexpr double reach = kernel::RayLeaf::reach;
      const double u = draw == 0 ? reach : uniform(random, -reach, reach), v = uniform(random, -reach, reach);
      const Point a = point_of(m, n, exact, u + 0.5L, v + 0.5L), b = value_of(leaf, step, c, u, v);
      share = std::max({share, std::abs(a.value - b.value) / leaf.noise, std::abs(a.du - b.du) / leaf.slope_noise,
                        std::abs(a.dv - b.dv) / leaf.slope_noise});
    }
  }
  return static_cast<double>(share);
}

TEST(LocalLeaf, CoefficientsKeepTheirBoundsAtEveryDegree) {
  Random random(11);
  double largest_cubic = 0, largest = 0;
  for (int m = 1; m <= max_degree; ++m) {
    for (const int n : {1, 2, 3, m, max_degree}) {
      for (const bool rational : {false, true}) {
        const BezierPatch patch = hilly_patch(random, m, n, rational);
        const double share = share_of_bounds(patch, random);
        EXPECT_LE(share, 1) << m << " x " << n << (rational ? ", rational" : "");
        (std::max(m, n) <= 3 ? largest_cubic : largest) =
            std::max(std::max(m, n) <= 3 ? largest_cubic : largest, share);
      }
    }
  }
  EXPECT_GT(largest, 0.2) << "bounds of what is left out say something";
  EXPECT_GT(largest_cubic, 0.001);
}

/// The mean of `Hit::steps` of rays through a patch from random directions.
double mean_steps(const BezierPatch& patch, Random& random) {
  const std::vector<BezierPatch> patches{patch};
  const PatchSet set = test::value_of(PatchSet::make(patches));
  const RayScene scene = test::value_of(RayScene::make(set));
  constexpr int count = 400;
  double steps = 0;
  for (int k = 0; k < count; ++k) {
    const Hit at = test::value_of(scene.resolve(0, uniform(random, 0.01, 0.99), uniform(random, 0.01, 0.99)));
    Ray ray;
    ray.direction = normalized(test::uniform_vector(random, -1, 1));
    ray.origin = at.position - 3 * ray.direction;
    const Hit hit = scene.closest(ray);
    EXPECT_EQ(hit.kind, HitKind::hit);
    steps += hit.steps;
  }
  return steps / count;
}

TEST(LocalLeaf, RandomRaysTakeFewStepsAtEveryDegree) {
  Random random(12);
  for (int degree = 1; degree <= max_degree; ++degree) {
    for (const bool rational : {false, true}) {
      const double steps = mean_steps(hilly_patch(random, degree, degree, rational), random);
      EXPECT_LT(steps, 4) << "degree " << degree << (rational ? ", rational" : "");
    }
  }
}

/// Next to a heavy corner the surface moves 1e4 times its size per unit of the parameters, and turns as quickly.
TEST(LocalLeaf, HitsNextToHeavyCornersAreOnTheRay) {
  const std::vector<test::RayClass> classes = test::ray_classes();
  const auto heavy = std::find_if(classes.begin(), classes.end(),
                                  [](const test::RayClass& of) { return of.name == "weights 1e-3 to 1e3"; });
  ASSERT_NE(heavy, classes.end());
  const PatchSet set = test::value_of(PatchSet::make(heavy->patches));
  const RayScene scene = test::value_of(RayScene::make(set));
  const double size = set.box().diagonal();
  Random random(13);
  for (int k = 0; k < 20000; ++k) {
    const Ray ray = heavy->draw(random);
    const Hit hit = scene.closest(ray);
    if (hit.kind != HitKind::hit) continue;
    const Vec3 point = de_casteljau(heavy->patches[hit.patch], hit.patch_u, hit.patch_v);
    ASSERT_LE(test::distance_from_line(point, ray), 2e-12 * size) << "ray " << k;
  }
}

/// A scene that does not follow edits keeps nothing of a piece but its place and its float net.
TEST(LocalLeaf, MemoryOfAPiece) {
  Random random(34);
  std::vector<BezierPatch> patches;
  for (int k = 0; k < 64; ++k) patches.push_back(test::polynomial(3, 3, hilly_points(random, 3, 3, 0.3)));
  const PatchSet set = test::set_of(patches);
  for (const bool follows : {false, true}) {
    const RayScene scene = test::value_of(RayScene::make(set, {.editable = follows}));
    const LeafNets& nets = *impl_of(scene).exact_source()->tracer().nets;
    const std::size_t pieces = nets.leaves().size(), box = follows ? sizeof(Box3) : 0;
    EXPECT_GT(pieces, 4 * patches.size());
    EXPECT_EQ(nets.boxes().size(), follows ? pieces : 0);
    EXPECT_EQ(nets.memory_bytes(), pieces * (sizeof(Leaf) + kernel::ray_leaf_bytes(false) + box));
    EXPECT_LE(scene.memory_bytes(), pieces * 800);
  }
}

}}  // namespace tessera
