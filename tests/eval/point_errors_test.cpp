// Bad input gives a Status that names the fault, and not a byte is written.

#include <gtest/gtest.h>

#include <limits>

#include "support/points.h"

namespace tessera::test { namespace {

class PointErrors : public ::testing::Test {
 protected:
  Random random_{331};
  PatchSet set_ = set_of(wavy_field(2, 3), with_points());
  Samples<float> samples_ = random_samples<float>(random_, 6, 5000);
  std::vector<float> positions_ = std::vector<float>(3 * 5000, -7), normals_ = positions_;

  QuantityViews<float> views() {
    return {.position = View3<float>::interleaved(positions_), .normal = View3<float>::interleaved(normals_)};
  }
  /// The status of a call that must fail and leave memory alone.
  Status refused(const PatchSamples<float>& samples, const QuantityViews<float>& out,
                 const PointOptions& options = {}) {
    const Status status = evaluate(set_, samples, out, options);
    EXPECT_FALSE(status.ok());
    for (const float x : positions_) EXPECT_EQ(x, -7);
    for (const float x : normals_) EXPECT_EQ(x, -7);
    return status;
  }
  Status refused(const PointOptions& options = {}) { return refused(samples_.views(), views(), options); }
};

TEST_F(PointErrors, PatchesOutOfRange) {
  samples_.patch[4321] = 6;
  samples_.patch[4999] = 4000000000u;
  const Status status = refused();
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_EQ(status.index(), 4321);
  EXPECT_NE(status.message().find("no patch 6"), std::string::npos) << status.message();
}

TEST_F(PointErrors, ParametersOutOfRange) {
  for (const float t : {-0.001f, 1.0001f, 1e30f, -1e-30f}) {
    const float before = samples_.v[4900];
    samples_.v[4900] = t;
    const Status status = refused();
    EXPECT_EQ(status.code(), StatusCode::invalid_argument);
    EXPECT_EQ(status.index(), 4900);
    EXPECT_NE(status.message().find("v = "), std::string::npos) << status.message();
    samples_.v[4900] = before;
  }
}

TEST_F(PointErrors, ParametersThatAreNoNumbers) {
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  for (const OutsideDomain outside : {OutsideDomain::error, OutsideDomain::clamp, OutsideDomain::extrapolate})
    for (const float t : {nan, infinity, -infinity}) {
      samples_.u[17] = t;
      samples_.u[4000] = nan;
      const Status status = refused({.outside = outside});
      EXPECT_EQ(status.code(), StatusCode::non_finite);
      EXPECT_EQ(status.index(), 17);
    }
}

TEST_F(PointErrors, Clamping) {
  samples_.u[3] = -5;
  samples_.v[4] = 1.5f;
  Samples<float> inside = samples_;
  inside.u[3] = 0;
  inside.v[4] = 1;
  EXPECT_TRUE(all_outputs(set_, samples_, {.outside = OutsideDomain::clamp}) == all_outputs(set_, inside));
}

TEST_F(PointErrors, Extrapolation) {
  const std::vector<double> outside{-0.5, 1.25, 2, 0.5, -1};
  Samples<double> samples;
  for (const double u : outside)
    for (const double v : outside) samples.add(2, u, v);
  AllBuffers<double> out = all_outputs(set_, samples, {.outside = OutsideDomain::extrapolate});
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const SurfaceJet jet = evaluate_jet(set_.patch(2), samples.u[k], samples.v[k]);
    EXPECT_LT(max_abs(read(out.views().position, k) - jet.position), 1e-11);
    EXPECT_LT(max_abs(read(out.views().duv, k) - jet.duv), 1e-11);
  }
}

TEST_F(PointErrors, Views) {
  const auto code_with = [&](auto change) {
    QuantityViews<float> out = views();
    change(out);
    return refused(samples_.views(), out).code();
  };
  EXPECT_EQ(code_with([](auto& out) { out.normal.size = 4999; }), StatusCode::buffer_too_small);
  EXPECT_EQ(code_with([](auto& out) { out.position.stride = 0; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_with([](auto& out) { out.position.stride = -3; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_with([](auto& out) { out.position.stride = std::ptrdiff_t{1} << 61; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_with([](auto& out) { out.position.component[2] = nullptr; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_with([](auto& out) { out.position.component[0] = nullptr; }), StatusCode::invalid_argument);
  EXPECT_EQ(code_with([](auto& out) {
              for (float*& c : out.position.component) c = reinterpret_cast<float*>(reinterpret_cast<char*>(c) + 1);
            }),
            StatusCode::invalid_argument);
  EXPECT_EQ(code_with([](auto& out) { out = {}; }), StatusCode::invalid_argument);
}

TEST_F(PointErrors, SharedMemory) {
  const auto message_with = [&](auto change) {
    QuantityViews<float> out = views();
    change(out);
    return refused(samples_.views(), out).message();
  };
  EXPECT_NE(message_with([](auto& out) { out.normal = out.position; }).find("share memory"), std::string::npos);
  EXPECT_NE(message_with([](auto& out) { out.position.component[1] = out.position.component[0]; }).find("share"),
            std::string::npos);
  EXPECT_NE(message_with([](auto& out) {  // the end of one is the beginning of the other
              out.position.stride = out.normal.stride = 1;
              out.position.component[1] = out.position.component[2] = out.position.component[0] + 4999;
            })
                .find("share"),
            std::string::npos);
  // Outputs that overlap the parameters that they are computed from.
  PatchSamples<float> own = samples_.views();
  own.u = View1<const float>::interleaved(positions_);
  EXPECT_NE(refused(own, views()).message().find("share"), std::string::npos);
  // Fields of one record are not shared memory, and neither are neighbours.
  std::vector<float> records(6 * 5000);
  EXPECT_TRUE(evaluate(set_, samples_.views(),
                       {.position = View3<float>::interleaved(records, 6, 0),
                        .normal = View3<float>::interleaved(records, 6, 3)})
                  .ok());
}

TEST_F(PointErrors, LengthsBlocksAndOptions) {
  PatchSamples<float> samples = samples_.views();
  samples.v.size = 10;
  EXPECT_EQ(refused(samples, views()).code(), StatusCode::count_mismatch);
  samples = samples_.views();
  samples.u.stride = 0;
  EXPECT_EQ(refused(samples, views()).code(), StatusCode::invalid_argument);
  samples.u = {};
  EXPECT_FALSE(refused(samples, views()).ok());
  EXPECT_EQ(refused({.geometry = {.min_sine = 1}}).code(), StatusCode::invalid_argument);
  EXPECT_EQ(refused({.geometry = {.umbilic_tolerance = std::nan("")}}).code(), StatusCode::invalid_argument);
}

TEST_F(PointErrors, NoSamplesAreNoError) {
  EXPECT_TRUE(evaluate(set_, PatchSamples<float>{}, views()).ok());
  EXPECT_EQ(positions_[0], -7);
}

}}  // namespace tessera::test
