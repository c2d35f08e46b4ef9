// Callables on grids: every record is the function's own value.

#include "tessera/coons_patch.h"
#include "tessera/evaluate.h"
#include "tessera/parametric_surface.h"

#include <atomic>
#include <thread>

#include "support/errors.h"
#include "support/lecture_surfaces.h"
#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

std::vector<double> parameters(std::size_t count, double from, double to) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k)
    values[k] = k + 1 == count ? to : from + (to - from) * static_cast<double>(k) / static_cast<double>(count);
  return values;
}

template <class T>
void expect_values(Calls calls) {
  const ParametricSurface torus = value_of(generic_surface(Torus{}, Torus::domain));
  const auto u = parameters(57, 0, 2 * pi), v = parameters(31, 0, 2 * pi);
  std::vector<T> memory(4 * u.size() * v.size(), T(-7));
  const auto view = View3<T>::interleaved(std::span(memory), 4, 1);
  ASSERT_TRUE(evaluate(torus, u, v, view, {}, calls).ok());
  for (std::size_t i = 0; i < u.size(); ++i)
    for (std::size_t j = 0; j < v.size(); ++j) {
      const Vec3 p = value_of(torus.position(u[i], v[j]));
      const T* record = &memory[4 * (i * v.size() + j)];
      ASSERT_EQ(record[0], T(-7));
      ASSERT_EQ(record[1], static_cast<T>(p.x));
      ASSERT_EQ(record[2], static_cast<T>(p.y));
      ASSERT_EQ(record[3], static_cast<T>(p.z));
    }
}

TEST(ParametricGrid, EveryRecordIsTheFunction) {
  expect_values<double>(Calls::one_thread);
  expect_values<double>(Calls::concurrent);
  expect_values<float>(Calls::one_thread);
  expect_values<float>(Calls::concurrent);
}

TEST(ParametricGrid, CallsOnceARecordAndFromOneThreadUnlessAllowed) {
  std::size_t calls = 0;
  const auto caller = std::this_thread::get_id();
  const auto counted = [&](double u, double v) {
    ++calls;
    EXPECT_EQ(std::this_thread::get_id(), caller);
    return Vec3{u, v, 0};
  };
  const ParametricSurface surface = value_of(ParametricSurface::make({.position = counted}));
  const auto u = parameters(300, 0, 1), v = parameters(200, 0, 1);
  std::vector<double> memory(3 * u.size() * v.size());
  calls = 0;
  double progress = 0;
  ExecutionReport report;
  const Execution execution{.progress = [&](double share) { progress = share; }, .report = &report};
  ASSERT_TRUE(evaluate(surface, u, v, View3<double>::interleaved(memory), execution).ok());
  EXPECT_EQ(calls, u.size() * v.size());
  EXPECT_EQ(progress, 1);
  EXPECT_EQ(report.tasks, 1u);
}

TEST(ParametricGrid, RefusesBadInput) {
  const ParametricSurface torus = value_of(generic_surface(Torus{}, Torus::domain));
  std::vector<double> memory(12);
  const auto view = View3<double>::interleaved(memory);
  const double two[] = {0, 1}, outside[] = {0, 7}, no_number[] = {not_a_number}, three[] = {0, 1, 2};
  const auto refused = [&](std::span<const double> u, std::span<const double> v, const View3<double>& out,
                           StatusCode code, std::ptrdiff_t index) {
    const Status status = evaluate(torus, u, v, out);
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_EQ(status.index(), index) << status.message();
  };
  refused({}, two, view, StatusCode::invalid_argument, -1);
  refused(two, {}, view, StatusCode::invalid_argument, -1);
  refused(outside, two, view, StatusCode::invalid_argument, 1);
  refused(two, no_number, view, StatusCode::non_finite, 0);
  refused(two, three, view, StatusCode::buffer_too_small, -1);
  refused(two, two, {}, StatusCode::invalid_argument, -1);
  auto unstrided = view;
  unstrided.stride = 0;
  refused(two, two, unstrided, StatusCode::invalid_argument, -1);
  auto overlapping = view;
  overlapping.component[1] = overlapping.component[0];
  refused(two, two, overlapping, StatusCode::invalid_argument, -1);
  auto misaligned = view;
  for (auto*& component : misaligned.component)
    component = reinterpret_cast<double*>(reinterpret_cast<char*>(component) + 1);
  refused(two, two, misaligned, StatusCode::invalid_argument, -1);
  EXPECT_EQ(memory, std::vector<double>(12));
}

TEST(ParametricGrid, TheFirstFailureIsTold) {
  const auto fails = [](double u, double v) { return Vec3{u, v, u >= 0.5 && v >= 0.5 ? not_a_number : 1e300}; };
  const ParametricSurface surface = value_of(
      ParametricSurface::make({.position = [&](double u, double v) { return u + v == 2 ? Vec3{} : fails(u, v); }}));
  const auto u = parameters(64, 0, 1), v = parameters(64, 0, 1);
  std::vector<double> memory(3 * u.size() * v.size());
  for (const Calls calls : {Calls::one_thread, Calls::concurrent}) {
    const Status status = evaluate(surface, u, v, View3<double>::interleaved(memory), {}, calls);
    EXPECT_EQ(status.code(), StatusCode::non_finite);
    EXPECT_NE(status.message().find("(u, v) = (0.5, 0.5)"), std::string::npos) << status.message();
  }
  std::vector<float> floats(memory.size());
  const double inner[] = {0.25};
  const Status status = evaluate(surface, inner, inner, View3<float>::interleaved(floats));
  EXPECT_EQ(status.code(), StatusCode::non_finite);
  EXPECT_NE(status.message().find("too large for float"), std::string::npos);
  const std::atomic<bool> cancel{true};
  for (const Calls calls : {Calls::one_thread, Calls::concurrent})
    EXPECT_EQ(evaluate(surface, u, v, View3<double>::interleaved(memory), {.cancel = &cancel}, calls).code(),
              StatusCode::cancelled);
}

}}  // namespace tessera::test
