// Ruled surfaces and Coons patches evaluated directly on grids: values, calls of the borders, layouts, determinism,
// errors.

#include "tessera/coons_patch.h"
#include "tessera/evaluate.h"
#include "tessera/parametric_surface.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

#include "support/borders.h"
#include "support/errors.h"
#include "support/suite_isa.h"
#include "support/ulp.h"

namespace tessera::test { namespace {

std::vector<double> blend_parameters(double from, double to, std::size_t count) {
  std::vector<double> t;
  for (std::size_t k = 0; k < count; ++k)
    t.push_back(k + 1 == count && count > 1 ? to
                                            : from + static_cast<double>(k) * (to - from) / static_cast<double>(count));
  return t;
}

template <class T, class Surface>
std::vector<T> evaluated(const Surface& surface, std::span<const double> u, std::span<const double> v,
                         const Execution& execution = {}) {
  std::vector<T> values(3 * u.size() * v.size(), T(-7));
  const Status status = evaluate(surface, u, v, View3<T>::interleaved(values), execution);
  EXPECT_TRUE(status.ok()) << status.message();
  return values;
}

template <class T>
Vec3 record(const std::vector<T>& values, std::size_t k) {
  return {static_cast<double>(values[3 * k]), static_cast<double>(values[3 * k + 1]),
          static_cast<double>(values[3 * k + 2])};
}

CoonsPatch wavy_patch() {
  const auto u_line = [](double v) {
    return callable([=](double u) { return Vec3{3 + u, v, 0.2 * std::sin(5 * u + v)}; }, {-1, 2});
  };
  const auto v_line = [](double u) {
    return callable([=](double v) { return Vec3{3 + u, v, 0.2 * std::sin(5 * u + v)}; }, {0, 4});
  };
  return coons({u_line(0), u_line(4), v_line(-1), v_line(2)}, Blend::cubic());
}

RuledSurface wavy_ruled(Direction straight) {
  return value_of(RuledSurface::make(callable(
                                         [](double t) {
                                           return Vec3{t, std::sin(t), 1};
                                         },
                                         {-1, 2}),
                                     callable(
                                         [](double t) {
                                           return Vec3{t, 2, std::cos(t)};
                                         },
                                         {-1, 2}),
                                     {1, 3}, straight));
}

// The stated bounds: units of 2^-23 or 2^-52 times |g1 C1| + |g2 C2| + |f1 K1| + |f2 K2|, here below 5 + 2 * 5 + ...
template <class T, class Surface>
void check_accuracy(const Surface& surface) {
  const Domain d = surface.domain();
  const auto u = blend_parameters(d.u0, d.u1, 37), v = blend_parameters(d.v0, d.v1, 53);
  const double size = 8, unit = sizeof(T) == 4 ? float_unit : double_unit;
  for (const Isa isa : available_isas()) {
    const ForcedIsa forced(isa);
    const auto values = evaluated<T>(surface, u, v);
    for (std::size_t i = 0; i < u.size(); ++i)
      for (std::size_t j = 0; j < v.size(); ++j)
        EXPECT_TRUE(within_units(record(values, i * v.size() + j), value_of(position(surface, u[i], v[j])), size * unit,
                                 sizeof(T) == 4 ? 5 : 8))
            << name(isa) << " " << u[i] << " " << v[j];
  }
}

TEST(Transfinite, IsTheScalarEvaluatorToRounding) {
  check_accuracy<float>(wavy_patch());
  check_accuracy<double>(wavy_patch());
  for (const Direction straight : {Direction::u, Direction::v}) {
    check_accuracy<float>(wavy_ruled(straight));
    check_accuracy<double>(wavy_ruled(straight));
  }
  Random random(1);
  const CoonsPatch exact = coons(random_borders(random, {{{3, 2}, {2, 0, true}, {4, 1}, {2, 1, true}}}));
  check_accuracy<float>(exact);
  check_accuracy<double>(exact);
}

TEST(TransfiniteFigures, CoonsPatches) {
  const CoonsBorders borders{callable([](double u) {
                               return Vec3{u, 0, 0};
                             }),
                             callable([](double u) {
                               return Vec3{u, 1, 2 * u};
                             }),
                             callable([](double v) {
                               return Vec3{0, v, 0};
                             }),
                             callable([](double v) {
                               return Vec3{1, v, 2 * v};
                             })};
  const auto t = uniform_parameters(17);
  const auto bilinear = evaluated<double>(coons(borders), t, t),
             cubic = evaluated<double>(coons(borders, Blend::cubic()), t, t);
  for (std::size_t i = 0; i < t.size(); ++i)
    for (std::size_t j = 0; j < t.size(); ++j)
      EXPECT_EQ(record(bilinear, i * t.size() + j), (Vec3{t[i], t[j], 2 * t[i] * t[j]}));
  EXPECT_EQ(record(cubic, 4 * t.size() + 12), (Vec3{0.25, 0.75, 0.392578125}));
}

TEST(Transfinite, CallsEachBorderOnceAParameter) {
  std::atomic<std::size_t> calls = 0;
  const auto counted = [&](auto f) {
    return callable([&calls, f](double t) {
      ++calls;
      return f(t);
    });
  };
  const CoonsPatch patch = coons({counted([](double u) {
                                    return Vec3{u, 0, u * u};
                                  }),
                                  counted([](double u) {
                                    return Vec3{u, 1, 1};
                                  }),
                                  counted([](double v) {
                                    return Vec3{0, v, v};
                                  }),
                                  counted([](double v) {
                                    return Vec3{1, v, 1};
                                  })});
  const auto t = uniform_parameters(1024);
  calls = 0;
  evaluated<float>(patch, t, t);
  EXPECT_EQ(calls, 4096u);
  const RuledSurface ruled = value_of(RuledSurface::make(patch.borders().c1, patch.borders().c2));
  calls = 0;
  evaluated<float>(ruled, std::vector<double>{0, 0.5, 1}, t);
  EXPECT_EQ(calls, 6u);
}

// Every tail, misaligned and strided memory, arrays and records: the same values, and nothing else is written.
template <class T>
void check_blend_layouts() {
  const CoonsPatch patch = wavy_patch();
  const auto u = blend_parameters(-1, 2, 3);
  for (const Isa isa : available_isas()) {
    const ForcedIsa forced(isa);
    for (std::size_t count = 1; count <= 40; ++count) {
      const auto v = blend_parameters(0, 4, count);
      const std::size_t records = 3 * count;
      const auto expected = evaluated<T>(patch, u, v);
      const auto check = [&](std::vector<T>& memory, const View3<T>& view, std::size_t written) {
        ASSERT_TRUE(evaluate(patch, u, v, view).ok());
        for (std::size_t k = 0; k < records; ++k)
          for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(view.at(k, static_cast<int>(c)), expected[3 * k + c]);
        EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(memory, T(-7))), memory.size() - written)
            << name(isa) << " " << count;
      };
      std::vector<T> packed(3 * records + 4, T(-7)), wide(7 * records + 1, T(-7)), arrays(3 * (records + 1), T(-7)),
          backwards(3 * records + 1, T(-7));
      check(packed, View3<T>::interleaved(std::span(packed).subspan(1)), 3 * records);
      check(wide, View3<T>::interleaved(wide, 7, 2), 3 * records);
      const std::span<T> all(arrays);
      check(arrays,
            View3<T>::soa(
                {all.subspan(0, records), all.subspan(records + 1, records), all.subspan(2 * records + 2, records)}),
            3 * records);
      check(backwards, {{&backwards[2], &backwards[1], &backwards[0]}, 3, records}, 3 * records);
    }
  }
}

TEST(Transfinite, AnyLayoutOfFloats) { check_blend_layouts<float>(); }
TEST(Transfinite, AnyLayoutOfDoubles) { check_blend_layouts<double>(); }

template <class T>
std::vector<T> with_threads(const CoonsPatch& patch, Isa isa, int threads, ExecutionReport& report) {
  const ForcedIsa forced(isa);
  const auto u = blend_parameters(-1, 2, 301), v = blend_parameters(0, 4, 777);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  Execution execution;
  execution.report = &report;
  std::vector<T> values;
  arena.execute([&] { values = evaluated<T>(patch, u, v, execution); });
  return values;
}

template <class T>
void compare_blends() {
  const CoonsPatch patch = wavy_patch();
  ExecutionReport report;
  for (const Isa isa : available_isas()) {
    const auto one = with_threads<T>(patch, isa, 1, report);
    EXPECT_EQ(report.isa, isa);
    EXPECT_GT(report.tasks, 2u);
    EXPECT_EQ(one, with_threads<T>(patch, isa, 2, report));
    EXPECT_EQ(one, with_threads<T>(patch, isa, 8, report));
  }
  if (std::ranges::count(available_isas(), Isa::avx512) == 0) GTEST_SKIP() << "this machine lacks AVX-512";
  EXPECT_EQ(with_threads<T>(patch, Isa::avx2, 1, report), with_threads<T>(patch, Isa::avx512, 1, report));
  EXPECT_NE(with_threads<T>(patch, Isa::sse2, 1, report), with_threads<T>(patch, Isa::avx2, 1, report))
      << "SSE2 rounds products: the wrong kernel ran";
}

TEST(Transfinite, TheSameFloatsForAnyThreadsAndUnits) { compare_blends<float>(); }
TEST(Transfinite, TheSameDoublesForAnyThreadsAndUnits) { compare_blends<double>(); }

TEST(Transfinite, ReproducesTheBordersOfConstantV) {
  const CoonsPatch patch = wavy_patch();
  const auto u = blend_parameters(-1, 2, 20);
  const auto values = evaluated<double>(patch, u, std::vector<double>{0, 4});
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_EQ(record(values, 2 * i), value_of(position(patch.borders().c1, u[i])));
    EXPECT_EQ(record(values, 2 * i + 1), value_of(position(patch.borders().c2, u[i])));
  }
}

template <class Surface>
void refused(const Surface& surface, const std::vector<double>& u, const std::vector<double>& v, StatusCode code,
             std::ptrdiff_t index, const char* words, std::size_t room = 100, const Execution& execution = {}) {
  std::vector<float> values(3 * room, -7);
  const Status status = evaluate(surface, u, v, View3<float>::interleaved(values), execution);
  EXPECT_EQ(status.code(), code) << status.message();
  EXPECT_EQ(status.index(), index) << status.message();
  EXPECT_NE(status.message().find(words), std::string::npos) << status.message();
  EXPECT_EQ(std::ranges::count(values, -7.0f), static_cast<std::ptrdiff_t>(values.size())) << "something was written";
}

TEST(Transfinite, RefusesArgumentsAndWritesNothing) {
  const CoonsPatch patch = wavy_patch();
  const auto invalid = StatusCode::invalid_argument;
  refused(patch, {}, {1}, invalid, -1, "no parameters u");
  refused(patch, {0}, {}, invalid, -1, "no parameters v");
  refused(patch, {0, 2.5}, {1}, invalid, 1, "parameter u[1] = 2.5 is not within [-1, 2]");
  refused(patch, {0}, {1, 2, not_a_number}, StatusCode::non_finite, 2, "parameter v[2]");
  refused(wavy_ruled(Direction::u), {0}, {0}, invalid, 0, "parameter u[0]");
  refused(patch, {0, 1}, {1, 2, 3}, StatusCode::buffer_too_small, -1, "2 * 3 records, not 5", 5);
  std::vector<double> memory(30);
  const std::vector<double> one{1};
  EXPECT_EQ(evaluate(patch, one, one, View3<double>{}).code(), invalid);
  EXPECT_EQ(evaluate(patch, one, one, View3<double>{{&memory[0], &memory[1], &memory[2]}, 0, 10}).code(), invalid);
  EXPECT_EQ(evaluate(patch, one, one, View3<double>{{&memory[0], nullptr, &memory[2]}, 3, 10}).code(), invalid);
  const std::atomic<bool> cancel = true;
  Execution execution;
  execution.cancel = &cancel;
  refused(patch, {0}, {1}, StatusCode::cancelled, -1, "cancelled", 100, execution);
}

TEST(Transfinite, RefusesBordersThatFailAndWritesNothing) {
  const auto line = [](const Vec3& a, const Vec3& b) { return callable([=](double t) { return a + t * (b - a); }); };
  const auto broken = callable([](double t) {
    if (t == 0.25) throw std::runtime_error("gone");
    return Vec3{1, t, t == 0.5 ? not_a_number : 0};
  });
  const CoonsPatch patch =
      coons({line({0, 0, 0}, {1, 0, 0}), line({0, 1, 0}, {1, 1, 0}), line({0, 0, 0}, {0, 1, 0}), broken});
  refused(patch, {0, 1}, {0.125, 0.5}, StatusCode::non_finite, -1, "border D2: the curve at t = 0.5");
  refused(patch, {0, 1}, {0.25}, StatusCode::invalid_argument, -1, "border D2: the curve at t = 0.25 threw: gone");
  const auto bad_blend = [](double t) { return t == 0.3 ? not_a_number : 1 - t; };
  const Blend blend = value_of(Blend::callable(bad_blend, [](double t) { return t; }));
  refused(coons(patch.borders(), blend), {0.3}, {0.125}, StatusCode::non_finite, -1, "f1 at t = 0.3");
  refused(value_of(RuledSurface::make(broken, patch.borders().c2)), {0.5}, {0}, StatusCode::non_finite, -1,
          "the first curve");
  const RuledSurface huge = value_of(RuledSurface::make(line({}, {1e39, 0, 0}), line({}, {0, 1e39, 0})));
  refused(huge, {0, 1}, {0, 1}, StatusCode::non_finite, -1, "too large for float");
  EXPECT_EQ(record(evaluated<double>(huge, std::vector<double>{1}, std::vector<double>{1}), 0), (Vec3{0, 1e39, 0}));
}

TEST(Transfinite, TellsItsProgress) {
  std::vector<double> told;
  Execution execution;
  execution.progress = [&](double share) { told.push_back(share); };
  evaluated<float>(wavy_patch(), blend_parameters(-1, 2, 200), blend_parameters(0, 4, 500), execution);
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(told.back(), 1);
}

}}  // namespace tessera::test
