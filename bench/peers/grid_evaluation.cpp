// Grids of a bicubic B-spline surface by Tessera and by every peer that was found: positions, and positions + r_u +
// r_v, of a size that fits the cache and of one that does not, one thread each, taking turns. Before a rate is printed,
// the answers are compared point by point with Tessera's in double, and these with the reference evaluator.

#include <cmath>
#include <cstdio>
#include <exception>
#include <string_view>

#include "peers/grid_tessera.h"
#include "peers/interleaved.h"
#include "peers/results.h"

namespace tessera::bench { namespace {

struct Package {
  const char *peer, *name;
};
constexpr Package packages[] = {
    {"OpenSubdiv", "libosd-dev"}, {"OpenCASCADE", "libocct-modeling-data-dev"}, {"SISL", "libsisl-dev"}};

GridTask task_of(int spans, int per_span, bool tangents) {
  GridTask task{spans, per_span, tangents, {}, {}};
  for (int i = 0; i < task.side(); ++i)
    for (int j = 0; j < task.side(); ++j)
      task.net.push_back({1.0 * i, 1.0 * j, 2 * std::sin(0.7 * i) * std::cos(0.9 * j) + 0.3 * std::sin(5.0 * i * j)});
  for (int k = 0; k < per_span; ++k) task.local.push_back((k + 0.5) / per_span);
  return task;
}

double apart(const GridValue& a, const GridValue& b) {
  return std::fmax(max_abs(a.position - b.position), std::fmax(max_abs(a.du - b.du), max_abs(a.dv - b.dv)));
}

/// Calls visit(i, j) for every point of a small grid, and for about 20,000 points spread over a large one.
template <class Visit>
void for_each_sample(const GridTask& task, Visit visit) {
  const std::size_t step = std::max<std::size_t>(1, task.points() / 20'000) | 1;
  for (std::size_t k = 0; k < task.points(); k += step) visit(k / task.count(), k % task.count());
}

/// The largest difference of two answers, over the surface's size.
double difference(const GridTask& task, const GridRun& a, const GridRun& b) {
  double largest = 0;
  for_each_sample(task, [&](std::size_t i, std::size_t j) {
    const double d = apart(a.read(i, j), b.read(i, j));
    largest = std::fmax(largest, d == d ? d : 1e300);
  });
  return largest / task.side();
}

/// Checks Tessera's own answer against the reference evaluator.
bool is_right(const GridTask& task, const GridRun& ours) {
  const BSplineSurface surface = surface_of(task);
  double largest = 0;
  for_each_sample(task, [&](std::size_t i, std::size_t j) {
    const SurfaceJet jet = evaluate_jet(surface, task.parameter(i), task.parameter(j));
    const GridValue expected{jet.position, task.tangents ? jet.du : Vec3{}, task.tangents ? jet.dv : Vec3{}};
    largest = std::fmax(largest, apart(ours.read(i, j), expected));
  });
  return largest <= 1e-13 * task.side();
}

/// Adds rows to the table of all comparisons: each peer beside Tessera's ways in the same precision.
void report(const GridTask& task, const std::vector<GridRun>& runs, const std::vector<double>& seconds,
            std::size_t own) {
  const std::string what = std::string(task.tangents ? "positions + du + dv" : "positions") + " of grids, " +
                           std::to_string(task.per_span) + " x " + std::to_string(task.per_span) + " points per span";
  for (std::size_t k = own; k < runs.size(); ++k)
    for (std::size_t mine = 0; mine < own; ++mine)
      if (runs[mine].in_double == runs[k].in_double)
        add_result({what, runs[k].program, runs[k].way + (runs[k].in_double ? ", double" : ", float"),
                    static_cast<double>(task.points()) / seconds[k], runs[mine].way, seconds[k] / seconds[mine],
                    mine % 2 == 0});
}

/// Runs every program once, compares, times, prints. False if an answer is wrong.
bool compare(const GridTask& task) {
  std::vector<GridRun> runs = tessera_runs(task);
  const std::size_t own = runs.size();
  for (const GridPeer& peer : grid_peers())
    for (GridRun& run : peer.runs(task)) runs.push_back(std::move(run));
  for (const GridRun& run : runs)
    if (!(run.seconds() >= 0)) return std::fprintf(stderr, "%s did not evaluate\n", run.program.c_str()), false;
  const GridRun& ours = runs[2];  // in double, blocks
  if (!is_right(task, ours)) return std::fputs("Tessera differs from the reference evaluator\n", stderr), false;

  std::vector<double> differences;
  for (const GridRun& run : runs) {
    differences.push_back(difference(task, run, ours));
    if (!(differences.back() <= (run.in_double ? 1e-12 : 4e-6)))
      return std::fprintf(stderr, "%s, %s: differs by %.1e of the size\n", run.program.c_str(), run.way.c_str(),
                          differences.back()),
             false;
  }
  std::vector<FunctionRef<double()>> tasks;
  for (const GridRun& run : runs) tasks.emplace_back(run.seconds);
  const auto seconds = best_interleaved(task.points() < 1'000'000 ? 10 : 3, tasks);

  const auto points = static_cast<double>(task.points());
  std::printf("\n%s: %d x %d spans, %d x %d points each (%.3g M), one thread\n",
              task.tangents ? "positions + du + dv" : "positions", task.spans, task.spans, task.per_span, task.per_span,
              1e-6 * points);
  std::printf("%-20s %-26s %-6s %10s %12s   %s\n", "", "", "", "M points/s", "difference",
              "Tessera is faster by: float blocks, xyz, double blocks, xyz");
  for (std::size_t k = 0; k < runs.size(); ++k) {
    std::printf("%-20s %-26s %-6s %10.2f %12.1e  ", runs[k].program.c_str(), runs[k].way.c_str(),
                runs[k].in_double ? "double" : "float", 1e-6 * points / seconds[k], differences[k]);
    for (std::size_t mine = 0; mine < own && k >= own; ++mine) std::printf(" %7.1f", seconds[k] / seconds[mine]);
    std::printf("\n");
  }
  std::fflush(stdout);
  report(task, runs, seconds, own);
  return true;
}

int run() {
  for (const auto& [peer, package] : packages) {
    bool found = false;
    for (const GridPeer& other : grid_peers()) found = found || other.name == peer;
    if (!found) std::printf("left out: %s is not installed (%s)\n", peer, package);
  }
  std::puts("best processor time of several; differences: the largest from Tessera in double, over the surface's size");
  for (const auto& [spans, per_span] : {std::pair{16, 9}, std::pair{100, 33}})
    for (const bool tangents : {false, true})
      if (!compare(task_of(spans, per_span, tangents))) return 1;
  return 0;
}

}}  // namespace tessera::bench

int main() {
  try {
    return tessera::bench::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "grid_evaluation: %s\n", error.what());
    return 1;
  }
}
