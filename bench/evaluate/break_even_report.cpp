// Finds how many points make a second thread worthwhile, for grids of 9 x 9 points and for scattered points, with more
// and more patches. Compares all points on one thread, two halves on two threads, and the library's own division with
// two threads available. Halves are timed hot, with a worker still awake from the call before, and cold, after it has
// slept. Prints a row per size in microseconds, then the size from which on halves are faster, and the one from which
// on the library uses a second thread.
// Usage: tessera_break_even_report [SECONDS for each size, 0.03 by default]

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <span>
#include <thread>
#include <vector>

#include "base/aligned.h"
#include "base/function_ref.h"
#include "parallel/parallel_for.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"

namespace {

using namespace tessera;
using Clock = std::chrono::steady_clock;

constexpr int size = 9, row = 16;  // points along a patch, patches in a row of the field

struct Kind {
  const char* name;
  bool points, normals, blocks;
};
constexpr Kind kinds[] = {
    {"positions in blocks", false, false, true},    {"positions + normals in blocks", false, true, true},
    {"positions interleaved", false, false, false}, {"positions + normals interleaved", false, true, false},
    {"scattered positions", true, false, false},    {"scattered positions + normals", true, true, false}};

void must(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "%s\n", status.message().c_str());
  std::exit(1);
}

/// Some patches, the points to evaluate, and memory for the results.
class Part {
 public:
  Part(const Kind& kind, std::span<const BezierPatch> patches)
      : kind_(kind),
        set_(test::value_of(PatchSet::make(patches, {.blocks = {.float_points = kind.points}}))),
        plan_(test::value_of(GridPlan::make(set_, uniform_parameters(size), uniform_parameters(size)))) {
    const std::size_t width = kind.normals ? 6 : 3;
    memory_.resize(kind.blocks ? plan_.block_capacity() : plan_.capacity() * width);
    if (kind.blocks && kind.normals) normals_.resize(memory_.size());
    if (!kind.blocks) views_.position = View3<float>::interleaved(memory_, width);
    if (!kind.blocks && kind.normals) views_.normal = View3<float>::interleaved(memory_, width, 3);
    for (std::size_t k = 0; kind.points && k < points(); ++k) {
      const std::size_t at = k * 2654435761U % points();
      patch_.push_back(static_cast<std::uint32_t>(at / (size * size)));
      u_.push_back(static_cast<float>(at % size) / size);
      v_.push_back(static_cast<float>(at / size % size) / size);
    }
  }
  std::size_t points() const { return plan_.capacity(); }
  /// Evaluates; returns whether the work was cut into tasks.
  bool evaluate() {
    ExecutionReport report;
    Execution execution;
    execution.report = &report;
    if (kind_.points) {
      const PatchSamples<float> samples{View1<const std::uint32_t>::interleaved(patch_),
                                        View1<const float>::interleaved(u_), View1<const float>::interleaved(v_)};
      must(tessera::evaluate(set_, samples, views_, {}, execution));
    } else if (kind_.blocks) {
      must(tessera::evaluate(set_, plan_, QuantityBlocks<float>{.position = memory_, .normal = normals_}, execution));
    } else {
      must(tessera::evaluate(set_, plan_, views_, execution));
    }
    return report.tasks > 1;
  }

 private:
  const Kind& kind_;
  PatchSet set_;
  GridPlan plan_;
  AlignedVector<float> memory_, normals_;
  QuantityViews<float> views_;
  std::vector<std::uint32_t> patch_;
  std::vector<float> u_, v_;
};

/// The shortest of many calls in microseconds, each after a pause.
double shortest(double seconds, std::chrono::milliseconds pause, FunctionRef<void()> call) {
  double best = std::numeric_limits<double>::infinity();
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (int k = 0; k < 5 || Clock::now() < end; ++k) {
    if (pause.count() > 0) std::this_thread::sleep_for(pause);
    const auto start = Clock::now();
    call();
    best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return 1e6 * best;
}

struct Times {
  double serial, hot, cold, own;
  bool cut;  ///< whether the library used two threads
};

Times measure(const Kind& kind, const std::vector<BezierPatch>& patches, double seconds) {
  const std::span all(patches);
  Part whole(kind, all), first(kind, all.first(all.size() / 2)), second(kind, all.subspan(all.size() / 2));
  const auto halves = [&] {
    must(parallel_for(2, 1, {}, [&](std::size_t begin, std::size_t) { (begin == 0 ? first : second).evaluate(); }));
  };
  Times times{};
  using std::chrono::milliseconds;
  tbb::task_arena alone(1), together(2);
  alone.execute([&] { times.serial = shortest(seconds, milliseconds(0), [&] { whole.evaluate(); }); });
  together.execute([&] {
    times.hot = shortest(seconds, milliseconds(0), halves);
    times.own = shortest(seconds, milliseconds(0), [&] { times.cut = whole.evaluate(); });
    times.cold = shortest(5 * seconds, milliseconds(5), halves);
  });
  return times;
}

/// The smallest size from which on `pays` holds; 0 if there is none.
std::size_t crossing(const std::vector<std::pair<std::size_t, Times>>& rows, FunctionRef<bool(const Times&)> pays) {
  std::size_t from = 0;
  for (auto r = rows.rbegin(); r != rows.rend() && pays(r->second); ++r) from = r->first;
  return from;
}

void report(const Kind& kind, double seconds) {
  std::printf("\n%s\n%10s %10s %10s %10s %10s %6s\n", kind.name, "points", "serial", "2 hot", "2 cold", "library",
              "tasks");
  std::vector<std::pair<std::size_t, Times>> rows;
  for (int rows_of_patches = 2; rows_of_patches <= 192; rows_of_patches += std::max(2, rows_of_patches / 4 * 2)) {
    const std::vector<BezierPatch> patches = test::wavy_field(rows_of_patches, row);
    const Times t = measure(kind, patches, seconds);
    rows.emplace_back(patches.size() * size * size, t);
    std::printf("%10zu %10.2f %10.2f %10.2f %10.2f %6s\n", rows.back().first, t.serial, t.hot, t.cold, t.own,
                t.cut ? "many" : "one");
  }
  constexpr double gain = 0.9;
  std::printf(
      "halves take less than %.0f%% of one thread's time from %zu points on (hot), %zu (cold); the library cuts from "
      "%zu on\n",
      100 * gain, crossing(rows, [](const Times& t) { return t.hot < gain * t.serial; }),
      crossing(rows, [](const Times& t) { return t.cold < gain * t.serial; }),
      crossing(rows, [](const Times& t) { return t.cut; }));
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 0.03;
  for (const Kind& kind : kinds) report(kind, seconds);
}
