// Winding numbers of real open models are the solid angles of their triangles.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "query/winding_case.h"
#include "tessera/io.h"
#include "tessera/tessellate.h"

namespace tessera::test { namespace {

/// The share of the sphere that a triangle covers, seen from the origin (van Oosterom and Strackee 1983).
double triangle_share(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double x = length(a), y = length(b), z = length(c);
  const double below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y;
  return std::atan2(dot(a, cross(b, c)), below) / (2 * std::numbers::pi);
}

/// The number by triangles, each turned as its patch is.
double number_by(const Mesh& mesh, std::span<const std::int8_t> signs, const Vec3& point) {
  double sum = 0;
  const auto at = [&](std::size_t corner) {
    const double* const p = mesh.model_positions.data() + 3 * mesh.indices[corner];
    return Vec3{p[0], p[1], p[2]} - point;
  };
  for (std::size_t k = 0; k < mesh.triangle_count(); ++k)
    sum += signs[mesh.patches[k]] * triangle_share(at(3 * k), at(3 * k + 1), at(3 * k + 2));
  return sum;
}

void compare(const std::string& name, std::size_t least_inside) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) GTEST_SKIP() << "TESSERA_TEST_DATA names no folder of test data";
  const WindingCase model(value_of(read_model(std::filesystem::path(data) / name)));
  ASSERT_FALSE(model.solid.is_closed());
  const double size = model.set.box().diagonal();
  const Mesh mesh =
      value_of(tessellate(model.set, {.tolerance = 1e-5 * size, .precision = Precision::double_precision}));
  ASSERT_TRUE(mesh.has_patches());
  const PointScene near = value_of(PointScene::make(model.set));
  Random random(1);
  double most = 0, spread = 0;
  std::size_t inside = 0;
  const Box3 box = model.set.box();
  for (int k = 0; k < 60; ++k) {
    const Vec3 share = uniform_vector(random, -0.6, 0.6), extent = box.upper - box.lower;
    const Vec3 point = box.centre() + Vec3{share.x * extent.x, share.y * extent.y, share.z * extent.z};
    if (near.nearest(point).distance < 1e-3 * size) continue;
    const double number = model.at(point);
    most = std::max(most, std::abs(number - number_by(mesh, model.winding.orientation().signs, point)));
    spread = std::max(spread, spread_of(model, point, random, 10));
    inside += std::abs(number) > 0.5;
  }
  std::printf(
      "%s: %zu patches, %zu open borders, %zu arcs, %zu triangles; %.1e off them, %.1e by direction, %zu inside\n",
      name.c_str(), model.set.patch_count(), model.solid.open_borders(), model.winding.orientation().arcs.size(),
      mesh.triangle_count(), most, spread, inside);
  EXPECT_LE(most, 1e-4);
  EXPECT_LE(spread, 1e-7);
  EXPECT_GE(inside, least_inside);
}

TEST(WindingModels, OfATeapot) { compare("classic_teaset/cgjs_teapot.bpt", 10); }
TEST(WindingModels, OfTrimmedFacesWithGaps) { compare("g2_gotools/splipy_winglet_from_step.g2", 0); }
TEST(WindingModels, OfASplineSurface) { compare("obj_freeform_files/k3d_nurbs.obj", 5); }

}}  // namespace tessera::test
