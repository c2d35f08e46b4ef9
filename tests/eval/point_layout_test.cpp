// Scattered points into every kind of memory: any count, arrays, records, strides. Nothing else is written.

#include <gtest/gtest.h>

#include "support/points.h"

namespace tessera::test { namespace {

constexpr float canary = -7;

/// One patch, sorted and unsorted ones; several degrees.
std::vector<Samples<float>> kinds_of_samples(Random& random, std::size_t patch_count, std::size_t count) {
  std::vector<Samples<float>> kinds(2, random_samples<float>(random, patch_count, count));
  std::ranges::sort(kinds[1].patch);
  return kinds;
}

/// Every count around the lanes of a vector; the reference takes one sample at a time.
TEST(PointLayout, AnyCount) {
  Random random(321);
  const PatchSet field = set_of(test::wavy_field(2, 2), with_points());
  const PatchSet mixed = set_of(mixed_patches(random, 2), with_points());
  for (const PatchSet* set : {&field, &mixed})
    for (const Isa isa : available_isas())
      for (const std::size_t count : {1, 2, 3, 7, 8, 9, 15, 16, 17, 31, 33, 100, 127, 129, 2047, 2048, 2049, 4500})
        for (const auto& samples : kinds_of_samples(random, set->patch_count(), count)) {
          std::vector<float> positions(3 * count + 5, canary), normals(positions);
          const QuantityViews<float> out{.position = View3<float>::interleaved(positions),
                                         .normal = View3<float>::interleaved(normals)};
          ASSERT_TRUE(evaluate(*set, samples.views(), out, {.isa = isa}).ok());
          for (std::size_t k = 3 * count; k < positions.size(); ++k) {
            ASSERT_EQ(positions[k], canary);
            ASSERT_EQ(normals[k], canary);
          }
          for (std::size_t k = 0; k < count; k += 1 + count / 40) {
            Samples<float> one;
            one.add(samples.patch[k], samples.u[k], samples.v[k]);
            AllBuffers<float> alone = all_outputs(*set, one, {.isa = isa});
            ASSERT_EQ(vector_at(positions, k), read(alone.views().position, 0)) << count << " " << k;
            ASSERT_EQ(vector_at(normals, k), read(alone.views().normal, 0)) << count << " " << k;
          }
        }
}

TEST(PointLayout, ArraysRecordsAndStrides) {
  Random random(322);
  const PatchSet field = set_of(test::wavy_field(3, 2), with_points());
  const PatchSet mixed = set_of(mixed_patches(random, 2), with_points());
  constexpr std::size_t count = 333;
  for (const PatchSet* set : {&field, &mixed})
    for (const auto& samples : kinds_of_samples(random, set->patch_count(), count)) {
      AllBuffers<float> all = all_outputs(*set, samples);
      const QuantityViews<float> expected = all.views();
      std::vector<float> x(count), y(count), z(count), mean(count), records(11 * count, canary);
      const QuantityViews<float> arrays{.position = View3<float>::soa({x, y, z}),
                                        .mean = View1<float>::interleaved(mean)};
      ASSERT_TRUE(evaluate(*set, samples.views(), arrays).ok());
      const QuantityViews<float> in_records{.position = View3<float>::interleaved(records, 11, 1),
                                            .normal = View3<float>::interleaved(records, 11, 4),
                                            .gaussian = View1<float>::interleaved(records, 11, 8)};
      ASSERT_TRUE(evaluate(*set, samples.views(), in_records).ok());
      for (std::size_t k = 0; k < count; ++k) {
        ASSERT_EQ((Vec3{x[k], y[k], z[k]}), read(expected.position, k));
        ASSERT_EQ(mean[k], expected.mean.at(k, 0));
        ASSERT_EQ(read(in_records.position, k), read(expected.position, k));
        ASSERT_EQ(read(in_records.normal, k), read(expected.normal, k));
        ASSERT_EQ(in_records.gaussian.at(k, 0), expected.gaussian.at(k, 0));
        for (const std::size_t gap : {0, 7, 9, 10}) ASSERT_EQ(records[11 * k + gap], canary);
      }
    }
}

/// Samples in records of the caller's: patch numbers apart, parameters as pairs.
TEST(PointLayout, StridedSamples) {
  Random random(323);
  const PatchSet set = set_of(test::wavy_field(3, 2), with_points());
  const Samples<double> samples = random_samples<double>(random, 6, 200);
  std::vector<std::uint32_t> patches(3 * samples.size(), 99);
  std::vector<double> pairs;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    patches[3 * k + 1] = samples.patch[k];
    pairs.insert(pairs.end(), {samples.u[k], samples.v[k]});
  }
  AllBuffers<double> out(samples.size());
  const PatchSamples<double> strided{View1<const std::uint32_t>::interleaved(patches, 3, 1),
                                     View1<const double>::interleaved(pairs, 2, 0),
                                     View1<const double>::interleaved(pairs, 2, 1)};
  ASSERT_TRUE(evaluate(set, strided, out.views()).ok());
  EXPECT_TRUE(out == all_outputs(set, samples));
}

}}  // namespace tessera::test
