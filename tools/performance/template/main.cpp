// speed: times calls, checks their results, and prints the JSON that tools/perf track reads. Copy it, and replace the
// cases in main() by your own calls. engine/docs/tracking-speed.md explains the fields.

#include <tessera/tessera.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

struct Case {
  std::string name;
  double items = 0;           ///< done by one call
  double seconds = 0;         ///< of the shortest call
  double limit_fraction = 0;  ///< share of the machine's limit; 0 if unknown
  std::string error;          ///< empty if the timed result was right
};

/// The shortest of several calls. Other programs only ever make a call longer. The first call warms up.
double shortest(const auto& call) {
  using Clock = std::chrono::steady_clock;
  call();
  double least = 1e30;
  for (int k = 0; k < 7; ++k) {
    const auto begin = Clock::now();
    call();
    least = std::min(least, std::chrono::duration<double>(Clock::now() - begin).count());
  }
  return least;
}

/// Patches of the surface z = x y over the unit squares of [0, n] x [0, n].
tessera::PatchSet make_saddle(int n) {
  std::vector<tessera::BezierPatch> patches;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      std::vector<tessera::Vec3> points;
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) points.push_back({a + i / 3.0, b + j / 3.0, (a + i / 3.0) * (b + j / 3.0)});
      patches.push_back(value_or_throw(tessera::BezierPatch::polynomial(3, 3, points)));
    }
  return value_or_throw(tessera::PatchSet::make(patches));
}

/// Grids of `rate` x `rate` points with positions and normals, on one thread or on those of the caller's arena.
Case evaluate_grids(const tessera::PatchSet& set, int rate) {
  const auto parameters = tessera::uniform_parameters(rate);
  const auto plan = value_or_throw(tessera::GridPlan::make(set, parameters, parameters));
  std::vector<float> memory(6 * plan.capacity());
  tessera::QuantityViews<float> views;
  views.position = tessera::View3<float>::interleaved(memory, 6, 0);
  views.normal = tessera::View3<float>::interleaved(memory, 6, 3);

  Case found;
  found.name = "grids/" + std::to_string(rate);
  found.items = static_cast<double>(plan.capacity());
  found.seconds = shortest([&] { throw_if_failed(evaluate(set, plan, views)); });

  const auto limits =
      value_or_throw(tessera::measure_limits({.isa = plan.isa(), .store_bytes = memory.size() * sizeof(float)}));
  const tessera::Work work = plan.work({.position = true, .normal = true});
  found.limit_fraction = tessera::seconds_at_limit(limits, work) / found.seconds;

  for (std::size_t k = 0; k < plan.capacity(); ++k) {  // z = x y, within the precision of float
    const auto component = [&](int c) { return static_cast<double>(views.position.at(k, c)); };
    const double x = component(0) + set.origin().x, y = component(1) + set.origin().y,
                 z = component(2) + set.origin().z;
    if (!(std::abs(z - x * y) < 1e-2)) found.error = "a point is not on the surface";
  }
  return found;
}

void print(const Case& found, bool last) {
  std::printf("  {\"name\": \"%s\", \"items_per_second\": %.6g", found.name.c_str(), found.items / found.seconds);
  if (found.limit_fraction > 0) std::printf(", \"limit_fraction\": %.3g", found.limit_fraction);
  if (!found.error.empty()) std::printf(", \"error_occurred\": true, \"error_message\": \"%s\"", found.error.c_str());
  std::printf("}%s\n", last ? "" : ",");
}

}  // namespace

int main() try {
  const tessera::PatchSet set = make_saddle(20);
  const std::vector<Case> cases = {evaluate_grids(set, 9), evaluate_grids(set, 33)};

  // An error if the environment asks for one that is not there.
  const std::string isa(name(value_or_throw(tessera::default_isa())));
  std::printf("{\"context\": {\"compiler\": \"%s\", \"build_type\": \"%s\", \"isa\": \"%s\"},\n \"benchmarks\": [\n",
              SPEED_COMPILER, SPEED_BUILD_TYPE, isa.c_str());
  for (const Case& found : cases) print(found, &found == &cases.back());
  std::printf(" ]}\n");
  return std::fflush(stdout) == 0 ? 0 : 1;
} catch (const tessera::StatusError& error) {
  std::fprintf(stderr, "speed: %s\n", error.what());
  return 1;
}
