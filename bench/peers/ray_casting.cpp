// The closest hits of a camera's rays on a bicubic B-spline surface by Tessera and by every peer that was found, one
// thread each, taking turns. Before a rate is printed, the answers are compared ray by ray with Tessera's exact mode,
// and these with the tests' ray caster, which shares no code with it.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "peers/interleaved.h"
#include "peers/ray_tessera.h"
#include "peers/results.h"
#include "peers/uniform_set.h"
#include "support/reference_rays.h"

namespace tessera::bench { namespace {

using test::value_of;

constexpr int spans = 16, pixels = 512;

constexpr std::pair<const char*, const char*> packages[] = {{"Embree", "libembree-dev"},
                                                            {"SISL", "libsisl-dev"},
                                                            {"OpenCASCADE", "libocct-modeling-algorithms-dev"},
                                                            {"POV-Ray", "povray"}};

/// Waves of height 1 over about 16 x 16.
std::vector<Vec3> net_of() {
  std::vector<Vec3> net;
  for (int i = 0; i < spans + 3; ++i)
    for (int j = 0; j < spans + 3; ++j)
      net.push_back({1.0 * i, 1.0 * j, 0.6 * std::sin(0.9 * i + 0.3 * j) + 0.4 * std::cos(0.7 * j - 0.2 * i)});
  return net;
}

/// Looks from above at a slant, so that waves hide waves.
RayCamera camera_of(const Box3& box) {
  const Vec3 back = normalized({0.5, -0.9, 0.45}), right = normalized({0.9, 0.5, 0}), up = cross(back, right);
  return {box.centre() + 1.3 * box.diagonal() * back, -back, 0.75 * right, 0.75 * up, pixels};
}

/// Checks some hundred rays of the truth against the tests' ray caster. False if one differs.
bool is_right(const RayTask& task, const RayRun& truth) {
  std::vector<BezierPatch> patches;
  for (std::size_t k = 0; k < task.set.patch_count(); ++k) patches.push_back(task.set.patch(k));
  for (std::size_t k = 0; k < task.camera.rays(); k += 409) {
    const test::ReferenceHit expected = test::reference_closest(patches, task.camera.ray(k));
    const double t = truth.t(k);
    if (expected.hit() != std::isfinite(t) || (expected.hit() && !(std::abs(t - expected.t) <= 1e-9 * task.size)))
      return false;
  }
  return true;
}

/// The difference from the truth: the share of rays that hit where it misses or miss where it hits, and, over rays that
/// hit the same sheet (within a hundredth of the size), the median and the largest distance along the ray over the
/// size.
struct Difference {
  double wrong = 0, median = 0, largest = 0;
};
Difference difference(const RayTask& task, const RayRun& run, const RayRun& truth) {
  std::vector<double> apart;
  double wrong = 0, rays = 0;
  for (std::size_t k = 0; k < task.camera.rays(); k += run.step, ++rays) {
    const double a = run.t(k), b = truth.t(k);
    const double d = std::abs(a - b) * length(task.camera.ray(k).direction) / task.size;
    if (std::isinf(a) && std::isinf(b)) continue;
    d <= 0.01 ? apart.push_back(d) : static_cast<void>(++wrong);
  }
  if (apart.empty()) return {1, 1, 1};
  std::sort(apart.begin(), apart.end());
  return {wrong / rays, apart[apart.size() / 2], apart.back()};
}

/// Whether a program intersects the surface itself, in double.
bool is_exact(const RayRun& run) { return run.program.starts_with("SISL") || run.program.starts_with("OpenCASCADE"); }

/// Exact programs must reach double's precision, facets theirs; silhouettes may differ.
bool is_acceptable(const Difference& d, const RayRun& run) {
  if (is_exact(run)) return d.wrong <= 0.02 && d.median <= 1e-9;
  return d.wrong <= 0.01 && d.median <= 1e-3;
}

void print(const RayTask& task, const std::vector<RayRun>& runs, const std::vector<double>& seconds,
           const std::vector<Difference>& differences, std::size_t own) {
  std::printf("\nclosest hits: %d x %d spans, %zu camera rays, facets of %d x %d per span, one thread\n", spans, spans,
              task.camera.rays(), facets_per_side, facets_per_side);
  std::printf("%-20s %-20s %10s %9s %10s %10s   %s\n", "", "", "k rays/s", "wrong", "median", "largest",
              "Tessera is faster by: exact, refined, facets");
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto rate = [&](std::size_t n) {
      return std::ceil(static_cast<double>(task.camera.rays()) / static_cast<double>(runs[n].step)) / seconds[n];
    };
    std::printf("%-20s %-20s %10.5g %8.3f%% %10.1e %10.1e  ", runs[k].program.c_str(), runs[k].way.c_str(),
                1e-3 * rate(k), 100 * differences[k].wrong, differences[k].median, differences[k].largest);
    for (std::size_t mine = 0; mine < own && k >= own; ++mine) {
      std::printf(" %8.3g", rate(mine) / rate(k));
      // Programs that use facets are compared with Tessera's facets, programs that find all roots with its exact mode.
      const bool main = is_exact(runs[k]) ? mine == 0 : mine == 2;
      add_result({"closest hits of camera rays", runs[k].program, runs[k].way, rate(k), runs[mine].way,
                  rate(mine) / rate(k), main});
    }
    std::printf("\n");
  }
}

int run() {
  for (const auto& package : packages) {
    const auto is_it = [&](const RayPeer& peer) { return peer.name == package.first; };
    if (std::none_of(ray_peers().begin(), ray_peers().end(), is_it))
      std::printf("left out: %s is not installed (%s)\n", package.first, package.second);
  }
  std::puts(
      "best processor time of several; against Tessera's exact mode: rays that hit where it misses, miss where it hits "
      "or are "
      "another sheet's, and distances along the ray, over the surface's size");
  std::vector<Vec3> net = net_of();
  const PatchSet set = uniform_set(net, spans);
  const RayTask task{spans, std::move(net), camera_of(set.box()), set.box(), set.box().diagonal(), set};
  std::vector<RayRun> runs = tessera_ray_runs(task);
  const std::size_t own = runs.size();
  for (const RayPeer& peer : ray_peers())
    for (RayRun& run : peer.runs(task)) runs.push_back(std::move(run));
  for (const RayRun& run : runs)
    if (!(run.seconds() >= 0)) return std::fprintf(stderr, "%s did not cast\n", run.program.c_str()), 1;
  if (!is_right(task, runs[0])) return std::fputs("Tessera differs from the tests' ray caster\n", stderr), 1;
  std::vector<Difference> differences;
  for (const RayRun& run : runs) {
    differences.push_back(difference(task, run, runs[0]));
    const Difference& d = differences.back();
    if (!is_acceptable(d, run))
      return std::fprintf(stderr, "%s, %s: %.2g%% of the rays are wrong, the median is %.1e of the size off\n",
                          run.program.c_str(), run.way.c_str(), 100 * d.wrong, d.median),
             1;
  }
  std::vector<FunctionRef<double()>> tasks;
  for (const RayRun& run : runs) tasks.emplace_back(run.seconds);
  print(task, runs, best_interleaved(5, tasks), differences, own);
  return 0;
}

}}  // namespace tessera::bench

int main() {
  try {
    return tessera::bench::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ray_casting: %s\n", error.what());
    return 1;
  }
}
