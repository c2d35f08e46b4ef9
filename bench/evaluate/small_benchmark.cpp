// One part, one face: few patches, evaluated by themselves. small.plan makes the plan of a grid, small.grid evaluates
// positions and normals patch after patch. An item is a call. Each case checks the points that it timed.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "base/aligned.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"
#include "timing.h"

namespace tessera::bench { namespace {

constexpr std::size_t size = 9;
/// Calls that are timed together: one is shorter than the clock's steps allow.
constexpr int together = 256;

struct Case {
  int patches;
  bool plan;  ///< the plan alone
  Isa isa;

  CaseName name() const {
    return {plan ? "small.plan" : "small.grid",
            "bicubic" + std::to_string(patches),
            "3",
            square(size),
            std::string(tessera::name(isa)),
            1};
  }
};

bool check_values(const PatchSet& set, const std::vector<double>& t, const QuantityViews<float>& out) {
  for (std::size_t patch = 0; patch < set.patch_count(); ++patch)
    for (std::size_t k = 0; k < size * size; ++k) {
      const SurfaceJet jet = evaluate_jet(set.patch(patch), t[k / size], t[k % size]);
      const auto read = [&](const View3<float>& view) {
        const std::size_t at = patch * size * size + k;
        return Vec3{view.at(at, 0), view.at(at, 1), view.at(at, 2)};
      };
      if (!(max_abs(read(out.position) - (jet.position - set.origin())) <= 1e-6 * set.box().diagonal())) return false;
      if (!(max_abs(read(out.normal) - normalized(cross(jet.du, jet.dv))) <= 1e-3)) return false;
    }
  return true;
}

void run(benchmark::State& state, const Case& c) {
  const PatchSet set = test::value_of(PatchSet::make(test::wavy_field(1, c.patches)));
  const std::vector<double> t = uniform_parameters(size);
  GridPlan plan = test::value_of(GridPlan::make(set, t, t, {.isa = c.isa}));
  AlignedVector<float> records(6 * plan.capacity());
  const QuantityViews<float> out{.position = View3<float>::interleaved(records, 6, 0),
                                 .normal = View3<float>::interleaved(records, 6, 3)};
  const auto call = [&] {
    if (!c.plan) return evaluate(set, plan, out);
    auto made = GridPlan::make(set, t, t, {.isa = c.isa});
    if (made) plan = *std::move(made);
    return made.status();
  };
  const auto best = time_calls(state, 1, [&] {
    Status status;
    for (int k = 0; k < together && status.ok(); ++k) status = call();
    return status;
  });
  if (!best) return;
  if (c.plan && !evaluate(set, plan, out).ok()) return state.SkipWithError("the timed plan cannot be evaluated");
  if (!check_values(set, t, out)) return state.SkipWithError("the timed values differ from the reference");
  report_rates(state, *best, together);
}

const bool registered = [] {
  for (const Isa isa : available_isas())
    for (const bool plan : {true, false})
      for (const int patches : {1, 4, 16, 64}) {
        const Case c{patches, plan, isa};
        add_case(c.name(), patches == 4 ? quick_on_fastest(isa) : Part::full,
                 [c](benchmark::State& state) { run(state, c); });
      }
  return true;
}();

}}  // namespace tessera::bench
