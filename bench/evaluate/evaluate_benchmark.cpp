// Grids of many patches: evaluate/OUTPUTS/LAYOUT/SET/SIZE/ISA/THREADS. Each case checks the values that it timed against the reference
// evaluator before it reports; limit_fraction is the time at the machine's limits, measured in the same process around the run,
// over the best time of one call.

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "base/aligned.h"
#include "sets.h"
#include "tessera/evaluate.h"
#include "tessera/limits.h"

namespace tessera::bench {
namespace {

enum class Layout { blocks, interleaved };

struct Case {
  const char* set_name;
  int size;  ///< parameters a side
  GridOutputs outputs;
  Layout layout;
  Isa isa;
  int threads;

  std::string name() const {
    const std::string grid = std::to_string(size) + "x" + std::to_string(size);
    const std::string what = outputs.du ? "positions+du+dv" : outputs.normal ? "positions+normals" : "positions";
    return "evaluate/" + what + "/" + (layout == Layout::blocks ? "blocks/" : "interleaved/") + set_name + "/" + grid + "/" +
           std::string(tessera::name(isa)) + "/" + std::to_string(threads);
  }
};

/// Memory for every output of one case, in either layout.
class Outputs {
 public:
  Outputs(const GridPlan& plan, const Case& c) : layout_(c.layout) {
    const std::size_t values = layout_ == Layout::blocks ? plan.block_capacity() : 3 * plan.capacity();
    const bool wanted[] = {c.outputs.position, c.outputs.du, c.outputs.dv, c.outputs.normal};
    for (int k = 0; k < 4; ++k)
      if (wanted[k]) memory_[k].assign(values, 0);
  }

  Status evaluate(const PatchSet& set, const GridPlan& plan, const Execution& execution) {
    if (layout_ == Layout::blocks)
      return tessera::evaluate(set, plan, GridBlocks<float>{memory_[0], memory_[1], memory_[2], memory_[3]}, execution);
    const auto view = [&](int k) { return memory_[k].empty() ? View3<float>{} : View3<float>::interleaved(memory_[k]); };
    return tessera::evaluate(set, plan, GridViews<float>{view(0), view(1), view(2), view(3)}, execution);
  }

  /// Vector `output` (0 position .. 3 normal) of one sample, or nothing if it is not wanted.
  bool read(const PatchSet& set, const GridPlan& plan, int output, std::size_t patch, std::size_t sample, Vec3& value) const {
    const auto& memory = memory_[output];
    if (memory.empty()) return false;
    const std::size_t samples = plan.count_u() * plan.count_v();
    if (layout_ == Layout::interleaved) {
      const float* p = memory.data() + 3 * (patch * samples + sample);
      value = {p[0], p[1], p[2]};
    } else {
      const PatchSet::Slot slot = set.slot(patch);
      const float* p = memory.data() + (slot.block * samples + sample) * 3 * PatchSet::lanes + slot.lane;
      value = {p[0], p[PatchSet::lanes], p[2 * PatchSet::lanes]};
    }
    return true;
  }

 private:
  Layout layout_;
  AlignedVector<float> memory_[4];
};

/// Every sample of 50 patches against the reference evaluators, far looser than the tests and far tighter than a wrong answer.
bool check_values(const PatchSet& set, const GridPlan& plan, const std::vector<double>& t, const Outputs& out) {
  const double tolerance = 1e-5 * set.box().diagonal();
  const std::size_t step = std::max<std::size_t>(1, set.patch_count() / 50);
  for (std::size_t patch = 0; patch < set.patch_count(); patch += step) {
    for (std::size_t sample = 0; sample < t.size() * t.size(); ++sample) {
      const double u = t[sample / t.size()], v = t[sample % t.size()];
      const SurfaceJet jet = evaluate_jet(set.patch(patch), u, v);
      const UnitNormal normal = unit_normal(set.patch(patch), u, v);
      const Vec3 expected[] = {jet.position - set.origin(), jet.du, jet.dv, normal.direction};
      const bool conditioned = normal.kind == NormalKind::regular && length(cross(jet.du, jet.dv)) > 1e-3 * dot(jet.du, jet.du);
      Vec3 value;
      for (int k = 0; k < 4; ++k) {
        if (!out.read(set, plan, k, patch, sample, value) || (k == 3 && !conditioned)) continue;
        if (!(max_abs(value - expected[k]) <= (k == 3 ? 1e-3 : tolerance))) return false;
      }
    }
  }
  return true;
}

/// The best rates of two measurements, before and after the run: a disturbed one must not flatter us.
Limits best_of(const Limits& a, const Limits& b) {
  Limits best = a;
  best.float_operations_per_second = std::max(a.float_operations_per_second, b.float_operations_per_second);
  best.store_bytes_per_second = std::max(a.store_bytes_per_second, b.store_bytes_per_second);
  return best;
}

void run(benchmark::State& state, const Case& c) {
  const PatchSet& set = set_named(c.set_name);
  const std::vector<double> t = uniform_parameters(c.size);
  auto plan = GridPlan::make(set, t, t, {.isa = c.isa});
  if (!plan) return state.SkipWithError(plan.status().message().c_str());
  Outputs out(*plan, c);
  const Work work = plan->work(c.outputs);
  const LimitsOptions limits_options{.isa = c.isa, .store_bytes = static_cast<std::size_t>(work.bytes_written)};
  const auto limits_before = measure_limits(limits_options);

  ExecutionReport report;
  Execution execution;
  execution.report = &report;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(c.threads));
  tbb::task_arena arena(c.threads);
  double best = 1e30;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    Status status;
    arena.execute([&] { status = out.evaluate(set, *plan, execution); });
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!status.ok()) return state.SkipWithError(status.message().c_str());
    state.SetIterationTime(seconds);
    best = std::min(best, seconds);
  }
  const auto limits_after = measure_limits(limits_options);
  if (!limits_before || !limits_after) return state.SkipWithError("the machine's limits could not be measured");
  if (report.isa != c.isa) return state.SkipWithError("another instruction set ran than was asked for");
  if (!check_values(set, *plan, t, out)) return state.SkipWithError("the timed values differ from the reference");
  state.counters["points_per_second"] = static_cast<double>(plan->capacity()) / best;
  state.counters["bytes_per_second"] = work.bytes_written / best;
  if (c.threads == 1) state.counters["limit_fraction"] = seconds_at_limit(best_of(*limits_before, *limits_after), work) / best;
}

void add(const Case& c) {
  benchmark::RegisterBenchmark(c.name().c_str(), [c](benchmark::State& state) { run(state, c); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

const bool registered = [] {
  const GridOutputs positions{}, normals{.normal = true}, tangents{.du = true, .dv = true};
  for (const Isa isa : available_isas()) {
    for (const GridOutputs& outputs : {positions, normals, tangents})
      for (const Layout layout : {Layout::blocks, Layout::interleaved})
        for (const int size : {9, 33}) {
          add({"teapot", size, outputs, layout, isa, 1});
          add({"bicubic20000", size, outputs, layout, isa, 1});
        }
    for (const Layout layout : {Layout::blocks, Layout::interleaved}) add({"bicubic20000", 33, positions, layout, isa, 2});
  }
  return true;
}();

}  // namespace
}  // namespace tessera::bench
