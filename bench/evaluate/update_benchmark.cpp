// Animation: control points in, grids of the touched patches out, patch after patch, or with ".blocks"
// block-interleaved: update.OUTPUTS.SHARE. Each case checks what it timed against evaluation of a new set. The limit is
// the time that the stores take: GridPlan::work() for the touched patches.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "base/aligned.h"
#include "suite.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"
#include "timing.h"

namespace tessera::bench { namespace {

constexpr int rows = 100, columns = 100, size = 9;

struct Case {
  std::size_t step;  ///< every step-th patch is touched
  bool normals;
  Isa isa;
  int threads;
  bool blocks = false;

  std::size_t touched() const { return rows * columns / step; }
  CaseName name() const {
    const std::string share = step == 1 ? "all" : "one_in_" + std::to_string(step);
    return {"update.positions" + std::string(normals ? "+normals." : ".") + (blocks ? "blocks." : "") + share,
            "bicubic10000",
            "3",
            square(size),
            std::string(tessera::name(isa)),
            threads};
  }
};

/// Two shapes of the field, used alternately, as edits.
struct Animation {
  std::vector<std::uint32_t> patch;
  std::vector<Vec3> points[2];

  Animation(const Case& c, const std::vector<BezierPatch>& patches) {
    for (std::size_t k = 0; k < c.touched(); ++k) {
      patch.push_back(static_cast<std::uint32_t>(k * c.step));
      for (const Vec3& point : patches[k * c.step].points()) {
        points[0].push_back(point + Vec3{0, 0, 0.1 * point.x});
        points[1].push_back(point);
      }
    }
  }
  PatchEdits edits(std::size_t turn) const { return {patch, points[turn % 2]}; }
};

/// Memory for either layout.
class Outputs {
 public:
  Outputs(const GridPlan& plan, const Case& c)
      : blocks_(c.blocks),
        first_(c.blocks ? plan.block_capacity() : plan.capacity() * (c.normals ? 6 : 3)),
        second_(c.blocks && c.normals ? first_.size() : 0) {
    if (blocks_) return;
    views_.position = View3<float>::interleaved(first_, c.normals ? 6 : 3);
    if (c.normals) views_.normal = View3<float>::interleaved(first_, 6, 3);
  }
  QuantityBlocks<float> in_blocks() { return {.position = first_, .normal = second_}; }
  Status evaluate(const PatchSet& set, const GridPlan& plan) {
    return blocks_ ? tessera::evaluate(set, plan, in_blocks()) : tessera::evaluate(set, plan, views_);
  }
  Status update(GridUpdate& update, PatchSet& set, const GridPlan& plan, const PatchEdits& edits,
                const Execution& execution) {
    return blocks_ ? update.run(set, plan, edits, in_blocks(), execution)
                   : update.run(set, plan, edits, views_, execution);
  }
  bool operator==(const Outputs& other) const { return first_ == other.first_ && second_ == other.second_; }

 private:
  bool blocks_;
  AlignedVector<float> first_, second_;
  QuantityViews<float> views_;
};

/// Compares the outputs with those of a new set of the same patches.
bool check_values(const PatchSet& set, const GridPlan& plan, const Case& c, const Outputs& outputs) {
  std::vector<BezierPatch> patches;
  for (std::size_t k = 0; k < set.patch_count(); ++k) patches.push_back(set.patch(k));
  const auto fresh = PatchSet::make(patches, {.origin = set.origin()});
  Outputs expected(plan, c);
  return fresh && expected.evaluate(*fresh, plan).ok() && expected == outputs;
}

void run(benchmark::State& state, const Case& c) {
  const std::vector<BezierPatch> patches = test::wavy_field(rows, columns);
  PatchSet set = test::value_of(PatchSet::make(patches));
  const std::vector<double> t = uniform_parameters(size);
  const GridPlan plan = test::value_of(GridPlan::make(set, t, t, {.isa = c.isa}));
  GridUpdate update = test::value_of(GridUpdate::make(set));
  const Animation animation(c, patches);
  Outputs outputs(plan, c);
  if (const Status status = outputs.evaluate(set, plan); !status.ok())
    return state.SkipWithError(status.message().c_str());
  Work work = plan.work({.position = true, .normal = c.normals});
  for (double* amount : {&work.lane_operations, &work.bytes_written, &work.bytes_read})
    *amount /= static_cast<double>(c.step);
  const LimitsAround around(c.isa, work.bytes_written);
  ExecutionReport report;
  Execution execution;
  execution.report = &report;
  std::size_t turn = 0;
  const auto best = time_calls(state, c.threads,
                               [&] { return outputs.update(update, set, plan, animation.edits(turn++), execution); });
  const auto limits = around.best(state);
  if (!best || !limits) return;
  if (report.isa != c.isa) return state.SkipWithError("another instruction set ran than was asked for");
  if (!check_values(set, plan, c, outputs)) return state.SkipWithError("the timed values differ from a new set's");
  report_rates(state, *best, static_cast<double>(c.touched()) * size * size, work.bytes_written);
  if (c.threads == 1) report_limit(state, *best, *limits, work);
}

void add(const Case& c) {
  add_case(c.name(), c.step == 1 ? quick_on_fastest(c.isa) : Part::full,
           [c](benchmark::State& state) { run(state, c); });
}

const bool registered = [] {
  for (const Isa isa : available_isas())
    for (const bool normals : {false, true}) {
      for (const bool blocks : {false, true}) {
        for (const std::size_t step : {1, 2, 20, 500}) add({step, normals, isa, 1, blocks});
        add({1, normals, isa, 2, blocks});
      }
    }
  return true;
}();

}}  // namespace tessera::bench
