// What exact mode promises, counted against a referee in interval arithmetic that shares no code, on rays that are hard
// to get right; and rays from inside closed bodies, aimed at seams, which nothing may let out. Exit status 1 if a ray
// is missed, falsely hit or let out.
//
//   tessera_proof_report [rays a class [rays from inside]]

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

#include "support/ray_classes.h"
#include "support/ray_proof.h"

namespace {

using namespace tessera;
using test::ProofTally;

RayScene exact_scene(const PatchSet& set) {
  RaySceneOptions options;
  options.mode = RayMode::exact;
  return test::value_of(RayScene::make(set, options));
}

/// Calls work(thread) on all cores and waits.
template <class Work>
void on_all_cores(Work work) {
  std::vector<std::thread> threads;
  for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k)
    threads.emplace_back([&, k] { work(k); });
  for (std::thread& thread : threads) thread.join();
}

ProofTally judged(const test::RayClass& rays, const RayScene& scene, std::size_t count, double size) {
  std::vector<ProofTally> parts(std::max(1u, std::thread::hardware_concurrency()));
  on_all_cores([&](unsigned thread) {
    test::Random random(100 + thread);
    for (std::size_t k = thread; k < count; k += parts.size())
      test::judge_ray(rays.patches, scene, rays.draw(random), 5e-12 * size, size, parts[thread]);
  });
  ProofTally sum;
  for (const ProofTally& part : parts) sum.add(part);
  return sum;
}

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

bool report(const test::RayClass& rays, std::size_t count) {
  const PatchSet set = test::value_of(PatchSet::from(rays.patches));
  const double size = set.box().diagonal();
  const RayScene scene = exact_scene(set);
  ProofTally tally = judged(rays, scene, count, size);
  const double t_median = median(tally.t_errors), u_median = median(tally.u_errors);
  const auto largest = [](const std::vector<double>& sorted) { return sorted.empty() ? 0.0 : sorted.back(); };
  std::printf("| %s | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %.1e / %.1e | %.1e / %.1e |\n", rays.name.c_str(),
              tally.rays, tally.hits, tally.missed, tally.false_hits, tally.undecidable, tally.touching,
              tally.contradicted, tally.incomplete, t_median, largest(tally.t_errors), u_median,
              largest(tally.u_errors));
  std::fflush(stdout);
  return tally.missed == 0 && tally.false_hits == 0;
}

/// Rays from inside a closed body that meet nothing.
bool report_leaks(const char* name, const std::vector<BezierPatch>& patches, std::size_t count,
                  const std::function<Ray(test::Random&)>& draw) {
  const PatchSet set = test::value_of(PatchSet::from(patches));
  const RayScene scene = exact_scene(set);
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::size_t> leaks(threads), cast(threads);
  on_all_cores([&](unsigned thread) {
    test::Random random(200 + thread);
    for (std::size_t k = thread; k < count; k += threads) {
      const Ray ray = draw(random);
      ++cast[thread];
      leaks[thread] += scene.closest(ray).kind != HitKind::hit;
    }
  });
  std::size_t all = 0, lost = 0;
  for (std::size_t k = 0; k < threads; ++k) all += cast[k], lost += leaks[k];
  std::printf("%s: %zu of %zu rays from inside met nothing\n", name, lost, all);
  std::fflush(stdout);
  return lost == 0;
}

/// Half of them at random, half along a chord of a seam or of an inner cut.
Ray from_inside(const std::vector<BezierPatch>& patches, test::Random& random) {
  const auto [inside, ray] = test::chord_of_seam(patches, random);
  if (inside && random() % 2 == 0) return ray;
  return test::rays::from_to(0.3 * test::rays::unit_vector(random), test::rays::unit_vector(random));
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int k, std::size_t otherwise) {
    return argc > k ? static_cast<std::size_t>(std::strtoull(argv[k], nullptr, 10)) : otherwise;
  };
  const std::size_t count = number(1, 2000), inside = number(2, 1'000'000);
  std::printf(
      "| rays | cast | hits proven | missed | false | undecidable | touching | any/closest differ | incomplete | t "
      "error, "
      "of the size: median / largest | u, v error |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- "
      "|\n");
  bool good = true;
  for (const test::RayClass& rays : test::ray_classes()) good = report(rays, count) && good;
  for (const auto& [name, patches] :
       {std::pair{"bicubic body", test::closed_body()}, {"rational sphere", test::sphere()}}) {
    good =
        report_leaks(name, patches, inside, [&](test::Random& random) { return from_inside(patches, random); }) && good;
  }
  for (const auto& [name, patches] : {std::pair{"torus, along seams", test::Torus(60).patches(false)},
                                      {"rational torus, along seams", test::Torus(12).patches(true)}}) {
    good = report_leaks(name, patches, inside,
                        [&](test::Random& random) { return test::skimming_seam(patches, random); }) &&
           good;
  }
  return good ? 0 : 1;
}
