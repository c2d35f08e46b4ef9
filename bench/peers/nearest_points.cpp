// Nearest points of a bicubic B-spline surface by Tessera and by every peer that was found, one thread each, taking
// turns. Before a rate is printed, the distances are compared point by point. One that is larger than another program's
// is wrong: a nearer point was missed.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "peers/interleaved.h"
#include "peers/nearest_task.h"
#include "peers/results.h"
#include "peers/uniform_set.h"
#include "support/random_patches.h"
#include "tessera/nearest_points.h"

namespace tessera::bench { namespace {

using test::value_of;

constexpr int spans = 60;
constexpr std::size_t point_count = 20000;

constexpr std::pair<const char*, const char*> packages[] = {{"SISL", "libsisl-dev"},
                                                            {"OpenCASCADE", "libocct-modeling-algorithms-dev"}};

/// Waves of height 1/2 over about 60 x 60.
std::vector<Vec3> net_of() {
  std::vector<Vec3> net;
  for (int i = 0; i < spans + 3; ++i)
    for (int j = 0; j < spans + 3; ++j)
      net.push_back(
          {1.0 * i, 1.0 * j, 0.35 * std::sin(0.9 * i) * std::cos(0.7 * j) + 0.15 * std::sin(1.9 * i + 1.0 * j)});
  return net;
}

std::vector<Vec3> points_of(const PatchSet& set, bool near) {
  test::Random random(1);
  const Box3 box = set.box();
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < point_count; ++k) {
    const Vec3 share{test::uniform(random, 0, 1), test::uniform(random, 0, 1), test::uniform(random, 0, 1)};
    const Vec3 size = box.upper - box.lower;
    points.push_back(box.lower + Vec3{share.x * size.x, share.y * size.y, share.z * size.z});
    if (!near) continue;
    const SurfaceJet jet = evaluate_jet(set.patch(random() % set.patch_count()), share.x, share.y);
    points.back() = jet.position + (0.02 * share.z - 0.01) * normalized(cross(jet.du, jet.dv));
  }
  return points;
}

class Search {
 public:
  Search(const NearestTask& task, const PatchSet& set)
      : task_(task), scene_(value_of(PointScene::make(set))), found_(task.points.size()) {}
  double run() {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    tbb::task_arena arena(1);
    Status status;
    const double seconds =
        arena.execute([&] { return seconds_of([&] { status = scene_.nearest(task_.points, found_); }); });
    return status.ok() ? seconds : -1;
  }
  double distance(std::size_t point) const { return found_[point].distance; }
  bool all_certified() const {
    return std::ranges::all_of(found_, [](const NearestPoint& one) { return one.flags.certified; });
  }

 private:
  const NearestTask& task_;
  PointScene scene_;
  std::vector<NearestPoint> found_;
};

/// The differences from Tessera's distances: how many points of those that both have are nearer there, how many farther
/// or not found.
struct Difference {
  std::size_t points = 0, nearer = 0, farther = 0;
};
Difference difference(const NearestTask& task, const NearestRun& run, const Search& own) {
  const double equal = 1e-7 * task.size;
  Difference out;
  for (std::size_t k = 0; k < task.points.size(); k += run.step, ++out.points) {
    const double beyond = run.distance(k) - own.distance(k);
    out.nearer += beyond < -equal, out.farther += !(beyond <= equal);
  }
  return out;
}

int compare(NearestTask& task, const PatchSet& set, bool near) {
  task.points = points_of(set, near);
  Search own(task, set);
  std::vector<NearestRun> runs;
  for (const NearestPeer& peer : nearest_peers()) runs.push_back(peer.run(task));
  std::vector<FunctionRef<double()>> tasks;
  const auto run_own = [&] { return own.run(); };
  tasks.emplace_back(run_own);
  for (const NearestRun& run : runs) tasks.emplace_back(run.seconds);
  const std::vector<double> seconds = best_interleaved(3, tasks);
  if (!(seconds[0] >= 0) || !own.all_certified()) return std::fputs("Tessera found no certified points\n", stderr), 1;
  const char* const what = near ? "nearest points, near the surface" : "nearest points, anywhere in the box";
  std::printf("\n%s: %d x %d spans, one thread\n", what, spans, spans);
  const double own_rate = double(point_count) / seconds[0];
  std::printf("%-24s %-28s %10.5g\n", "Tessera " TESSERA_VERSION, "certified", 1e-3 * own_rate);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const NearestRun& run = runs[k];
    const Difference d = difference(task, run, own);
    const double rate = double(d.points) / seconds[k + 1];
    std::printf("%-24s %-28s %10.5g %9zu %9zu %9zu   %8.4g\n", run.program.c_str(), run.way.c_str(), 1e-3 * rate,
                d.points, d.nearer, d.farther, own_rate / rate);
    add_result({what, run.program, run.way, rate, "certified", own_rate / rate});
    if (d.nearer > 0) return std::fprintf(stderr, "%s found points that are nearer\n", run.program.c_str()), 1;
  }
  return 0;
}

int run() {
  for (const auto& package : packages) {
    const auto is_it = [&](const NearestPeer& peer) { return peer.name == package.first; };
    if (std::none_of(nearest_peers().begin(), nearest_peers().end(), is_it))
      std::printf("left out: %s is not installed (%s)\n", package.first, package.second);
  }
  std::puts(
      "best processor time of several; points of which the other program's distance is smaller, and larger or missing, "
      "by more than 1e-7 of the size");
  std::printf("%-24s %-28s %10s %9s %9s %9s   %s\n", "", "", "k points/s", "points", "nearer", "farther",
              "Tessera is faster by");
  NearestTask task{.spans = spans, .net = net_of(), .points = {}};
  const PatchSet set = uniform_set(task.net, spans);
  task.size = set.box().diagonal();
  const int failed = compare(task, set, true);
  return failed != 0 ? failed : compare(task, set, false);
}

}}  // namespace tessera::bench

int main() {
  try {
    return tessera::bench::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "nearest_points: %s\n", error.what());
    return 1;
  }
}
