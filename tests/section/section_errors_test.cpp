// Input that sections cannot use, limits, threads, cancellation.

#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <bit>
#include <cstring>

#include "section/section_checks.h"
#include "support/errors.h"
#include "support/torus.h"

namespace tessera::test { namespace {

const PatchSet& ring() {
  static const PatchSet set = value_of(PatchSet::make(Torus(12).patches(true)));
  return set;
}

std::vector<double> layers(std::size_t count) {
  std::vector<double> offsets;
  for (std::size_t k = 0; k < count; ++k) offsets.push_back(-0.5 + (double(k) + 0.5) / double(count));
  return offsets;
}

TEST(SectionErrors, PlanesAndOptionsAreChecked) {
  const double bad[] = {0.1, not_a_number, 0.3}, far[] = {0.1, 0.2, infinity};
  using enum StatusCode;
  expect_refused(make_section(ring(), {{0, 0, 0}, 0}), invalid_argument, -1, "finite and not zero");
  expect_refused(make_section(ring(), {{0, not_a_number, 1}, 0}), invalid_argument, -1, "finite and not zero");
  expect_refused(make_section(ring(), {{infinity, 0, 1}, 0}), invalid_argument, -1, "finite and not zero");
  expect_refused(make_sections(ring(), {0, 0, 1}, bad), invalid_argument, 1, "offset 1 must be finite, found nan");
  expect_refused(make_sections(ring(), {0, 0, 1}, far), invalid_argument, 2, "offset 2 must be finite, found inf");
  for (const double tolerance : {0.0, -1.0, not_a_number, infinity})
    expect_refused(make_section(ring(), {}, {.tolerance = tolerance}), invalid_argument, -1, "tolerance");
  expect_refused(make_section(ring(), {}, {.contact = -1}), invalid_argument, -1, "contact");
  expect_refused(make_section(ring(), {}, {.max_gap = not_a_number}), invalid_argument, -1, "gap");
}

TEST(SectionErrors, NoPlanesAndPlanesThatMiss) {
  const Sections none = value_of(make_sections(ring(), {0, 0, 1}, {}));
  EXPECT_TRUE(none.planes.empty() && none.polylines.empty() && none.points.empty());
  const std::vector<double> beside{-3, 7, 1e300, -1e300};
  const Sections missed = value_of(make_sections(ring(), {0, 0, 1}, beside));
  ASSERT_EQ(missed.planes.size(), 4u);
  for (const PlaneSection& plane : missed.planes) {
    EXPECT_EQ(plane.polyline_count, 0u);
    EXPECT_EQ(plane.contact_count, 0u);
  }
}

TEST(SectionErrors, TheNumberOfPointsHasALimit) {
  const Sections made = value_of(make_sections(ring(), {0, 0, 1}, layers(20), {.tolerance = 1e-4}));
  const std::size_t count = made.points.size();
  EXPECT_TRUE(make_sections(ring(), {0, 0, 1}, layers(20), {.tolerance = 1e-4, .max_points = count}).ok());
  expect_refused(make_sections(ring(), {0, 0, 1}, layers(20), {.tolerance = 1e-4, .max_points = count - 1}),
                 StatusCode::invalid_argument, -1, "max_points");
  // A tolerance that would take more points than memory ends at once.
  expect_refused(make_section(ring(), {}, {.tolerance = 1e-300}), StatusCode::invalid_argument, -1, "max_points");
}

/// All bytes of the lists.
std::string bytes_of(const Sections& sections) {
  std::string bytes;
  const auto add = [&](const auto& value) {
    bytes.append(std::bit_cast<std::array<char, sizeof value>>(value).data(), sizeof value);
  };
  for (const SectionPoint& p : sections.points)
    add(p.position.x), add(p.position.y), add(p.position.z), add(p.u), add(p.v), add(p.patch), add(p.bridges_gap);
  for (const SectionPolyline& p : sections.polylines) add(p.first), add(p.count), add(p.closed), add(p.length);
  for (const PlaneSection& p : sections.planes)
    add(p.offset), add(p.bound), add(p.length), add(p.largest_gap), add(p.open_count);
  for (const SectionContact& c : sections.contacts)
    add(c.position.x), add(c.position.y), add(c.position.z), add(c.patch);
  return bytes;
}

TEST(SectionErrors, AnyNumberOfThreadsGivesTheSameBytes) {
  std::string expected;
  for (const int threads : {1, 2, 3, 8}) {
    oneapi::tbb::task_arena(threads).execute([&] {
      const std::string bytes =
          bytes_of(value_of(make_sections(ring(), {0.3, 0.2, 1}, layers(97), {.tolerance = 1e-4})));
      if (expected.empty()) expected = bytes;
      EXPECT_EQ(bytes == expected, true) << threads;
    });
  }
  EXPECT_GT(expected.size(), 10000u);
}

TEST(SectionErrors, CancellationAndProgress) {
  std::atomic<bool> cancel = true;
  expect_refused(make_sections(ring(), {0, 0, 1}, layers(50), {}, {.cancel = &cancel}), StatusCode::cancelled, -1, "");
  cancel = false;
  double last = 0;
  const Execution execution{.cancel = &cancel, .progress = [&](double done) {
                              EXPECT_GT(done, last);
                              last = done;
                            }};
  EXPECT_TRUE(make_sections(ring(), {0, 0, 1}, layers(50), {}, execution).ok());
  EXPECT_EQ(last, 1);
  const Execution at_half{.cancel = &cancel, .progress = [&](double done) { cancel = done > 0.5; }};
  expect_refused(make_sections(ring(), {0, 0, 1}, layers(50), {}, at_half), StatusCode::cancelled, -1, "");
}

TEST(SectionErrors, FarFromTheOriginNothingIsLost) {
  std::vector<BezierPatch> moved;
  const Vec3 far{4e6, -3e6, 1e6};
  for (const BezierPatch& patch : Torus(12).patches(false)) {
    std::vector<Vec3> points;
    for (const Vec3& p : patch.points()) points.push_back(p + far);
    moved.push_back(value_of(BezierPatch::polynomial(3, 3, points)));
  }
  const PatchSet set = value_of(PatchSet::make(moved));
  const Vec3 normal = normalized({1, 1, 2});
  const Sections made = value_of(make_section(set, {normal, dot(normal, far)}, {.tolerance = 1e-4}));
  const Sections near =
      value_of(make_section(value_of(PatchSet::make(Torus(12).patches(false))), {normal, 0}, {.tolerance = 1e-4}));
  EXPECT_EQ(made.planes[0].open_count, 0u);
  EXPECT_EQ(made.polylines.size(), near.polylines.size());
  EXPECT_NEAR(made.planes[0].length, near.planes[0].length, 1e-4);
  for (const SectionPoint& p : made.points) EXPECT_NEAR(dot(normal, p.position - far), 0, 1e-8);
}

TEST(SectionErrors, PatchesInThePlaneEndAtOnce) {
  // Weights that are no products, and heights that differ by less than the contact: no slope is proven.
  std::vector<Vec3> points;
  std::vector<double> weights;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      points.push_back({double(i), double(j), 1 + 1e-12 * ((i * 7 + j * 5) % 3)});
      weights.push_back(1 + 0.1 * ((i * 3 + j * j) % 4));
    }
  const PatchSet set = value_of(PatchSet::make(std::vector{value_of(BezierPatch::rational(3, 3, points, weights))}));
  const Sections made = value_of(make_section(set, {{0, 0, 1}, 1}, {.contact = 1e-9}));
  EXPECT_EQ(made.polylines.size(), 0u);
  EXPECT_EQ(made.contacts.size(), 0u);
  EXPECT_EQ(made.coplanar.size(), 1u);
  EXPECT_TRUE(made.unproven.empty());
}

TEST(SectionErrors, PatchesThatArePointsOrLines) {
  const std::vector<Vec3> point(4, Vec3{1, 2, 3}), thin{{0, 0, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, 1}};
  for (const std::vector<Vec3>& points : {point, thin}) {
    const PatchSet set = value_of(PatchSet::make(std::vector{value_of(BezierPatch::polynomial(1, 1, points))}));
    for (const double z : {0.0, 0.5, 3.0}) {
      const Result<Sections> made = make_section(set, {{0, 0, 1}, z});
      ASSERT_TRUE(made.ok());
      EXPECT_EQ(made->polylines.size(), 0u);
    }
    EXPECT_TRUE(make_section(set, {{1, 0, 0}, 0}).ok());
  }
}

}}  // namespace tessera::test
