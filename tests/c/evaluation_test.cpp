// Evaluation through C: grids and scattered points, with the values of the reference.

#include <random>

#include "c/c_objects.h"
#include "tessera/model.h"

namespace tessera::test { namespace {

TEST(CEvaluate, GridsInFloatAndDouble) {
  const std::vector<BezierPatch> patches = wavy_field(2, 3);
  const Handle<tsr_set> set = set_of(patches, TSR_SET_DOUBLE);
  tsr_set_info info = sized<tsr_set_info>();
  ASSERT_C(tsr_set_describe(set.get(), &info));
  const std::vector<double> u{0, 0.25, 1}, v{0.5, 0.75};
  std::vector<double> position(3 * 36), normal(3 * 36), mean(36);
  std::vector<float> floats(3 * 36);
  tsr_jets jets = sized<tsr_jets>();
  jets.position = out_of(floats, 3);
  ASSERT_C(tsr_set_grid(set.get(), u.data(), 3, v.data(), 2, &jets, nullptr));
  jets = sized<tsr_jets>();
  jets.is_double = 1;
  jets.position = out_of(position, 3), jets.normal = out_of(normal, 3), jets.mean = out_of(mean, 1);
  ASSERT_C(tsr_set_grid(set.get(), u.data(), 3, v.data(), 2, &jets, nullptr));
  for (std::size_t k = 0; k < 36; ++k) {
    const SurfaceJet jet = evaluate_jet(patches[k / 6], u[k % 6 / 2], v[k % 2]);
    const Vec3 wanted = jet.position, unit = normalized(cross(jet.du, jet.dv));
    EXPECT_NEAR(position[3 * k + 2], wanted.z, 1e-14);
    EXPECT_NEAR(floats[3 * k] + info.origin[0], wanted.x, 1e-6);
    EXPECT_NEAR(normal[3 * k], unit.x, 1e-13);
    EXPECT_NE(mean[k], 0);
  }
}

TEST(CEvaluate, GridsHaveALeastTime) {
  const Handle<tsr_set> set = set_of(wavy_field(2, 3), TSR_SET_DOUBLE);
  tsr_limits_info limits = sized<tsr_limits_info>();
  limits.float_operations_per_second = 1e30, limits.double_operations_per_second = 1e30;
  limits.store_bytes_per_second = 1000;
  std::vector<float> positions(3 * 6 * 20);
  tsr_jets jets = sized<tsr_jets>();
  jets.position = out_of(positions, 3);
  double stores = 0, operations = 0;
  ASSERT_C(tsr_set_grid_limit(set.get(), 5, 4, &jets, &limits, &stores));
  EXPECT_DOUBLE_EQ(stores, 4.0 * static_cast<double>(positions.size()) / 1000);
  limits.store_bytes_per_second = 1e30, limits.float_operations_per_second = 1e6;
  ASSERT_C(tsr_set_grid_limit(set.get(), 5, 4, &jets, &limits, &operations));
  EXPECT_GT(operations, 3 * 120 * 3 / 1e6);  // each coordinate takes some multiply-adds
  EXPECT_LT(operations, 3 * 120 * 64 / 1e6);
  expect_c_error(tsr_set_grid_limit(set.get(), 5, 4, &jets, nullptr, &stores), TSR_INVALID_ARGUMENT, "limits");
  expect_c_error(tsr_set_grid_limit(set.get(), 0, 4, &jets, &limits, &stores), TSR_INVALID_ARGUMENT, "");
  EXPECT_NE(tsr_set_grid_limit(set.get(), SIZE_MAX, 4, &jets, &limits, &stores), TSR_OK);
  limits.store_bytes_per_second = 0;
  expect_c_error(tsr_set_grid_limit(set.get(), 5, 4, &jets, &limits, &stores), TSR_INVALID_ARGUMENT, "above 0");
}

TEST(CEvaluate, ScatteredPointsOfSurfaces) {
  const std::vector<BezierPatch> patches = wavy_field(2, 3);
  const Handle<tsr_set> set = set_of(patches, TSR_SET_POINTS);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const std::size_t count = 1000;
  std::vector<std::uint32_t> surface(count);
  std::vector<double> u(count), v(count), position(3 * count), duv(3 * count);
  for (std::size_t k = 0; k < count; ++k)
    surface[k] = static_cast<std::uint32_t>(random() % 6), u[k] = unit(random), v[k] = unit(random);
  const tsr_in surfaces = in_of(surface, 1), at_u = in_of(u, 1), at_v = in_of(v, 1);
  tsr_jets jets = sized<tsr_jets>();
  jets.is_double = 1, jets.position = out_of(position, 3), jets.duv = out_of(duv, 3);
  ASSERT_C(tsr_set_evaluate(set.get(), &surfaces, &at_u, &at_v, &jets, nullptr));
  const Handle<tsr_set> unprepared = set_of(patches);
  std::vector<double> same(3 * count);
  tsr_jets again = sized<tsr_jets>();
  again.is_double = 1, again.position = out_of(same, 3);
  ASSERT_C(tsr_set_evaluate(unprepared.get(), &surfaces, &at_u, &at_v, &again, nullptr));
  EXPECT_EQ(same, position);
  for (std::size_t k = 0; k < count; ++k) {
    const SurfaceJet jet = evaluate_jet(patches[surface[k]], u[k], v[k]);
    EXPECT_NEAR(position[3 * k + 2], jet.position.z, 1e-14);
    EXPECT_NEAR(duv[3 * k + 2], jet.duv.z, 1e-12);
  }
  surface[500] = 6;
  expect_c_error(tsr_set_evaluate(set.get(), &surfaces, &at_u, &at_v, &jets, nullptr), TSR_INVALID_ARGUMENT, "surface",
                 500);
  surface[500] = 0, u[7] = 1.5;
  expect_c_error(tsr_set_evaluate(set.get(), &surfaces, &at_u, &at_v, &jets, nullptr), TSR_INVALID_ARGUMENT, "1.5", 7);
}

TEST(CEvaluate, WhatTheSetLacks) {
  const Handle<tsr_set> set = set_of(wavy_field(1, 1));
  const std::vector<double> u{0.5};
  std::vector<double> position(3);
  tsr_jets jets = sized<tsr_jets>();
  jets.is_double = 1, jets.position = out_of(position, 3);
  expect_c_error(tsr_set_grid(set.get(), u.data(), 1, u.data(), 1, &jets, nullptr), TSR_UNSUPPORTED, "double");
  const tsr_in at = in_of(u, 1);
  ASSERT_C(tsr_set_evaluate(set.get(), nullptr, &at, &at, &jets, nullptr));  // packed at this call
  jets.is_double = 0;
  expect_c_error(tsr_set_evaluate(set.get(), nullptr, &at, &at, &jets, nullptr), TSR_UNSUPPORTED, "is_double");
}

}}  // namespace tessera::test
