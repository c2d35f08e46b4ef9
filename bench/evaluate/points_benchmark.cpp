// Scattered points: points.OUTPUTS.ORDER; the size is the number of samples. Each case checks the values that it timed
// against the reference evaluator before it reports. touch_fraction is the time to touch the three cache lines of each
// sample's patch, measured in the same process around the run, over the best time of one call.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "base/impl_access.h"
#include "block/patch_set_impl.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"
#include "timing.h"

namespace tessera::bench { namespace {

struct Case {
  std::size_t patches;
  std::size_t run;  ///< consecutive samples of one patch; 1: random order
  bool normals;
  Isa isa;
  int threads;

  CaseName name() const {
    const std::string outputs = normals ? "positions+normals." : "positions.";
    return {"points." + outputs + (run == 1 ? "random" : "runs" + std::to_string(run)),
            "bicubic" + std::to_string(patches),
            "3",
            std::to_string(samples()),
            std::string(tessera::name(isa)),
            threads};
  }
  std::size_t samples() const { return std::max<std::size_t>(patches, 400'000); }
};

const PatchSet& field_of(std::size_t patches) {
  static std::map<std::size_t, PatchSet> sets;
  if (const auto found = sets.find(patches); found != sets.end()) return found->second;
  PatchSetOptions options;
  options.blocks = {.float_bernstein = false, .float_points = true};
  const int rows = patches < 1000 ? 10 : patches < 50'000 ? 50 : 250, columns = static_cast<int>(patches) / rows;
  return sets.emplace(patches, test::value_of(PatchSet::make(test::wavy_field(rows, columns), options))).first->second;
}

/// Runs of samples, in random order of patches.
struct Samples {
  std::vector<std::uint32_t> patch;
  std::vector<float> u, v;

  explicit Samples(const Case& c) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> parameter(0, 1);
    for (std::size_t k = 0; k < c.samples(); ++k) {
      patch.push_back(k % c.run == 0 ? static_cast<std::uint32_t>(random() % c.patches) : patch.back());
      u.push_back(std::min(parameter(random), 1.0f));
      v.push_back(std::min(parameter(random), 1.0f));
    }
  }
  PatchSamples<float> views() const {
    return {View1<const std::uint32_t>::interleaved(patch), View1<const float>::interleaved(u),
            View1<const float>::interleaved(v)};
  }
};

/// The best time of several passes that read a value from each of the three cache lines of each sample's patch.
double touch_seconds(const PatchSet& set, const Samples& samples) {
  const float* points = impl_of(set).f32.points.data();
  double best = 1e30;
  for (int pass = 0; pass < 5; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    float sum = 0;
    for (const std::uint32_t patch : samples.patch) {
      const float* p = points + std::size_t{patch} * 48;
      sum += p[0] + p[16] + p[32];
    }
    benchmark::DoNotOptimize(sum);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

bool check_values(const PatchSet& set, const Samples& samples, const QuantityViews<float>& out) {
  const double size = set.box().diagonal();
  for (std::size_t k = 0; k < samples.patch.size(); k += 97) {
    const SurfaceJet jet = evaluate_jet(set.patch(samples.patch[k]), samples.u[k], samples.v[k]);
    const auto read = [&](const View3<float>& view) { return Vec3{view.at(k, 0), view.at(k, 1), view.at(k, 2)}; };
    if (!(max_abs(read(out.position) - (jet.position - set.origin())) <= 1e-6 * size)) return false;
    const Vec3 normal = normalized(cross(jet.du, jet.dv));
    if (!out.normal.empty() && !(max_abs(read(out.normal) - normal) <= 1e-3)) return false;
  }
  return true;
}

void run(benchmark::State& state, const Case& c) {
  const PatchSet& set = field_of(c.patches);
  const Samples samples(c);
  std::vector<float> positions(3 * c.samples()), normals(c.normals ? positions.size() : 0);
  QuantityViews<float> out{.position = View3<float>::interleaved(positions)};
  if (c.normals) out.normal = View3<float>::interleaved(normals);
  const double touch_before = touch_seconds(set, samples);
  ExecutionReport report;
  Execution execution;
  execution.report = &report;
  const auto best =
      time_calls(state, c.threads, [&] { return evaluate(set, samples.views(), out, {.isa = c.isa}, execution); });
  if (!best) return;
  if (report.isa != c.isa) return state.SkipWithError("another instruction set ran than was asked for");
  if (!check_values(set, samples, out)) return state.SkipWithError("the timed values differ from the reference");
  report_rates(state, *best, static_cast<double>(c.samples()));
  if (c.threads == 1) state.counters["touch_fraction"] = std::min(touch_before, touch_seconds(set, samples)) / *best;
}

void add(const Case& c) {
  const bool quick = c.patches == 5'000 && (c.run == 1 || c.run == 40);
  add_case(c.name(), quick ? quick_on_fastest(c.isa) : Part::full, [c](benchmark::State& state) { run(state, c); });
}

const bool registered = [] {
  for (const Isa isa : available_isas())
    for (const bool normals : {false, true}) {
      for (const std::size_t patches : {100, 5'000, 100'000, 1'000'000}) add({patches, 1, normals, isa, 1});
      for (const std::size_t length : {8, 40, 100}) add({5'000, length, normals, isa, 1});
      add({100'000, 1, normals, isa, 2});
    }
  return true;
}();

}}  // namespace tessera::bench
