// Checks the promises of exact mode against a reference in interval arithmetic that shares no code. The classes are
// difficult rays; rays beside the loops of trimmed faces; rays from inside closed bodies, aimed at seams, none of which
// may escape; rays beside seams, whose hits are counted; rays that leave a surface there; lines through closed bodies.
// Exit status 1 if a ray is missed, falsely hit, hit on a wrong patch, escapes, is counted wrong without a flag, or
// hits again the surface that it leaves.
//
// tessera_proof_report --help

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "support/ray_classes.h"
#include "support/ray_proof.h"
#include "support/seam_rays.h"
#include "support/trimmed_proof.h"

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

/// The values of the options.
struct Wish {
  std::size_t hits = 1000;  ///< proven hits in each class
  std::size_t inside = 1'000'000;
  std::size_t seams = 20'000;  ///< rays beside seams of each body, and rays that leave it there
  std::size_t lines = 250'000;
  unsigned seed = 1;
  std::string only;  ///< part of a class's name
};

/// Casts rays, in rounds on all cores, until enough hits are proven; at most 40 rays per hit. `cast`: draws and checks
/// one.
template <class Tally>
Tally checked(const Wish& wish, const std::function<void(test::Random&, Tally&)>& cast) {
  constexpr std::size_t round = 500;
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<Tally> parts(threads);
  std::atomic<std::size_t> hits{0}, rays{0};
  on_all_cores([&](unsigned thread) {
    test::Random random(wish.seed * 1000 + thread);
    Tally& part = parts[thread];
    while (hits < wish.hits && rays < 40 * wish.hits) {
      const std::size_t before = part.hits;
      for (std::size_t k = 0; k < round; ++k) cast(random, part);
      hits += part.hits - before;
      rays += round;
    }
  });
  Tally sum;
  for (const Tally& part : parts) sum.add(part);
  return sum;
}

/// Median and largest, in units in the last place of 1.
std::string in_units(std::vector<double>& errors) {
  if (errors.empty()) return "-";
  std::sort(errors.begin(), errors.end());
  char text[64];
  std::snprintf(text, sizeof text, "%.2g / %.2g", errors[errors.size() / 2] * 0x1p52, errors.back() * 0x1p52);
  return text;
}

/// The largest share of misses that is consistent with 0 of n at 95% confidence, 1 - 0.05^(1/n).
double bound_of_none(std::size_t n) { return n == 0 ? 1 : -std::expm1(std::log(0.05) / static_cast<double>(n)); }

void print_row(const std::string& name, ProofTally& tally) {
  std::printf("| %s | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %zu | %s | %s | %.1e |\n", name.c_str(),
              tally.rays, tally.hits, tally.missed, tally.false_hits, tally.wrong_patch, tally.undecidable,
              tally.touching, tally.contradicted, tally.incomplete, in_units(tally.t_errors).c_str(),
              in_units(tally.u_errors).c_str(), bound_of_none(tally.hits));
  std::fflush(stdout);
}

/// Tells how long a class took when it goes.
class Timing {
 public:
  explicit Timing(const std::string& name) : name_(name) {}
  Timing(const Timing&) = delete;
  Timing& operator=(const Timing&) = delete;
  ~Timing() {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin_;
    std::fprintf(stderr, "%s: %.0f s\n", name_.c_str(), seconds.count());
  }

 private:
  std::string name_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

bool report(const test::RayClass& rays, const Wish& wish) {
  const Timing timing(rays.name);
  const PatchSet set = test::value_of(PatchSet::make(rays.patches));
  const RayScene scene = exact_scene(set);
  const double size = set.box().diagonal();
  ProofTally tally = checked<ProofTally>(wish, [&](test::Random& random, ProofTally& part) {
    test::check_ray(rays.patches, scene, rays.draw(random), 5e-12 * size, size, part);
  });
  print_row(rays.name, tally);
  return tally.missed == 0 && tally.false_hits == 0 && tally.wrong_patch == 0;
}

/// Adds a sentence to `notes`.
bool report_trimmed(const test::TrimmedClass& rays, const Wish& wish, std::string& notes) {
  const Timing timing(rays.name);
  test::TrimmedTally tally = checked<test::TrimmedTally>(wish, [&](test::Random& random, test::TrimmedTally& part) {
    const test::TrimmedCase& one = rays.cases[random() % rays.cases.size()];
    test::TrimmedCheck(one, test::draw_ray(one, random), part);
  });
  print_row(rays.name, tally);
  const auto add = [&](const char* format, auto... numbers) {
    char text[200];
    std::snprintf(text, sizeof text, format, numbers...);
    notes += text;
  };
  notes += rays.name;
  add(": roots decided within 1e-5, 1e-8, 1e-11 of a loop: %zu, %zu, %zu; rays where rounding decides: %zu\n",
      tally.near[0], tally.near[1], tally.near[2], tally.at_loops);
  if (rays.cases[0].is_joined)
    add("  rays that must meet an edge or one of its faces: %zu; closest hits of edges: %zu; rays moved aside there: "
        "%zu,\n"
        "  all hits of these wrong by parity: %zu\n",
        tally.between, tally.edges, tally.moved_rays, tally.odd);
  return tally.good();
}

/// Counts rays from inside a closed body that miss.
bool report_leaks(const char* name, const std::vector<BezierPatch>& patches, const Wish& wish,
                  const std::function<Ray(test::Random&)>& draw) {
  const PatchSet set = test::value_of(PatchSet::make(patches));
  const RayScene scene = exact_scene(set);
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::size_t> leaks(threads), cast(threads);
  on_all_cores([&](unsigned thread) {
    test::Random random(wish.seed * 1000 + 200 + thread);
    for (std::size_t k = thread; k < wish.inside; k += threads) {
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

/// Compares rays beside seams with their neighbours, and counts rays that leave the body there: if it has no creases,
/// none of these may hit it within a millionth.
bool report_seams(const char* name, const std::vector<BezierPatch>& patches, bool smooth, const Wish& wish) {
  const PatchSet set = test::value_of(PatchSet::make(patches));
  const double size = set.box().diagonal();
  const RayScene scene = exact_scene(set);
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<test::SeamTally> tallies(threads);
  std::vector<std::size_t> again(threads), flagged(threads), wrong(threads);  // of rays that leave the body
  on_all_cores([&](unsigned thread) {
    test::Random random(wish.seed * 1000 + 400 + thread);
    for (std::size_t k = thread; k < wish.seams; k += threads) {
      const test::SeamPlace place = test::beside_seam(patches, random, test::rays::power(random, 1e-15, 1e-6));
      test::check_count(scene, test::through(place, random, size), size, smooth, tallies[thread]);
      Ray out = test::leaving(scene, place, random);
      out.tfar = 1e-6;
      const Hit hit = scene.closest(out);
      again[thread] += hit.kind == HitKind::hit;
      flagged[thread] += hit.kind == HitKind::hit && hit.flags.uncertified;
      wrong[thread] += hit.kind == HitKind::hit && (smooth || (!hit.flags.uncertified && hit.residual > 1e-14 * size));
    }
  });
  test::SeamTally sum;
  for (const test::SeamTally& tally : tallies) sum.add(tally);
  std::size_t met = 0, grazing = 0, false_hits = 0;
  for (std::size_t k = 0; k < threads; ++k) met += again[k], grazing += flagged[k], false_hits += wrong[k];
  std::printf(
      "%s, beside seams: of %zu rays %zu decided by their neighbours, counted wrong %zu, and %zu that say so, and\n"
      "  %zu cross a crease by themselves; the closest is another than the first of all: %zu. Of %zu that leave the\n"
      "  body there %zu meet it within 1e-6, beyond a crease, %zu of them flagged; without cause %zu\n",
      name, sum.rays, sum.decided, sum.wrong, sum.flagged, sum.pairs, sum.not_first, sum.rays, met, grazing,
      false_hits);
  std::fflush(stdout);
  return sum.wrong == 0 && sum.not_first == 0 && sum.flagged * 100 <= sum.rays && false_hits == 0;
}

/// Counts lines that cross a closed body an odd number of times without a flagged hit.
bool report_parity(const char* name, const std::vector<BezierPatch>& patches, const Wish& wish) {
  const PatchSet set = test::value_of(PatchSet::make(patches));
  const double size = set.box().diagonal();
  const RayScene scene = exact_scene(set);
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::size_t> odd(threads), flagged(threads);
  on_all_cores([&](unsigned thread) {
    test::Random random(wish.seed * 1000 + 600 + thread);
    HitLists lists;
    for (std::size_t k = thread; k < wish.lines; k += threads) {
      const Ray ray = test::rays::at_surface(patches, random, 2 * size);
      if (!scene.all(std::span(&ray, 1), lists).ok()) std::abort();
      const bool says_so =
          std::any_of(lists.hits.begin(), lists.hits.end(), [](const Hit& hit) { return hit.flags.uncertified; });
      odd[thread] += !says_so && lists.hits.size() % 2 != 0;
      flagged[thread] += says_so;
    }
  });
  std::size_t wrong = 0, unsure = 0;
  for (std::size_t k = 0; k < threads; ++k) wrong += odd[k], unsure += flagged[k];
  std::printf("%s: of %zu lines %zu cross it an odd number of times, and %zu are flagged\n", name, wish.lines, wrong,
              unsure);
  std::fflush(stdout);
  return wrong == 0;
}

/// Half of the rays are random, half run along a chord of a seam or of an inner cut.
Ray from_inside(const std::vector<BezierPatch>& patches, test::Random& random) {
  const auto [inside, ray] = test::chord_of_seam(patches, random);
  if (inside && random() % 2 == 0) return ray;
  return test::rays::from_to(0.3 * test::rays::unit_vector(random), test::rays::unit_vector(random));
}

constexpr const char* usage =
    "Usage: tessera_proof_report [--hits N] [--inside N] [--seams N] [--lines N] [--only TEXT] [--seed N]\n"
    "  --hits N      proven hits to reach in each class of rays (1000)\n"
    "  --inside N    rays from inside each of four closed bodies (1000000)\n"
    "  --seams N     rays 1e-6 to 1e-15 beside the seams of each of four bodies, and rays that leave it there (20000)\n"
    "  --lines N     lines through each of four closed bodies, which must cross them an even number of times (250000)\n"
    "  --only TEXT   classes and bodies whose name holds TEXT, such as 'trimmed' for all classes of trimmed faces\n"
    "  --seed N      of the random numbers (1)\n"
    "Columns: rays cast; hits that the reference has proven; of these missed; hits whose point is not on patch and "
    "ray; "
    "hits\n"
    "on a patch that the ray provably misses; rays that the reference cannot decide; proven misses met within the\n"
    "tolerance; rays of which any hit and closest hit differ; searches given up; errors, median / largest, of t in "
    "units of\n"
    "2^-52 of the model's size and of u and v in units of 2^-52; the share of misses possible at 95% confidence if "
    "none\n"
    "was seen. Exit status: 0 if nothing is missed, false, let out, counted wrong or met again; 1 otherwise; 2 for a\n"
    "wrong option.\n";

std::optional<Wish> wish_of(std::span<char*> arguments) {
  Wish wish;
  for (std::size_t k = 0; k < arguments.size(); k += 2) {
    const std::string_view name = arguments[k];
    const std::string_view text = k + 1 < arguments.size() ? arguments[k + 1] : std::string_view();
    const auto read = [&](auto& number) {
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      return error == std::errc() && end == text.data() + text.size();
    };
    const bool good = name == "--hits"     ? read(wish.hits)
                      : name == "--inside" ? read(wish.inside)
                      : name == "--seams"  ? read(wish.seams)
                      : name == "--lines"  ? read(wish.lines)
                      : name == "--seed"   ? read(wish.seed)
                      : name == "--only"   ? !(wish.only = text).empty()
                                           : false;
    if (!good) {
      std::fprintf(stderr, "tessera_proof_report: cannot take '%s %s'\n%s", arguments[k], std::string(text).c_str(),
                   usage);
      return std::nullopt;
    }
  }
  return wish;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--help") return std::fputs(usage, stdout) < 0;
  const std::optional<Wish> wish = wish_of(std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
  if (!wish) return 2;
  const auto wanted = [&](const std::string& name) { return name.find(wish->only) != std::string::npos; };
  std::printf(
      "| rays | cast | hits proven | missed | false | wrong patch | undecidable | touching | any/closest differ | "
      "incomplete | t, units | u and v, units | missed at 95%% |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  bool good = true;
  for (const test::RayClass& rays : test::ray_classes())
    if (wanted(rays.name)) good = report(rays, *wish) && good;
  std::string notes;
  for (const test::TrimmedClass& rays : test::trimmed_classes())
    if (wanted(rays.name)) good = report_trimmed(rays, *wish, notes) && good;
  std::printf("%s", notes.c_str());
  for (const auto& [name, patches] :
       {std::pair{"bicubic body", test::closed_body()}, {"rational sphere", test::sphere()}}) {
    const auto draw = [&](test::Random& random) { return from_inside(patches, random); };
    if (wanted(name)) good = report_leaks(name, patches, *wish, draw) && good;
  }
  for (const auto& [name, patches] : {std::pair{"torus, along seams", test::Torus(60).patches(false)},
                                      {"rational torus, along seams", test::Torus(12).patches(true)}}) {
    const auto draw = [&](test::Random& random) { return test::skimming_seam(patches, random); };
    if (wanted(name)) good = report_leaks(name, patches, *wish, draw) && good;
  }
  const struct {
    const char* name;
    std::vector<BezierPatch> patches;
    bool smooth;
  } bodies[] = {{"bicubic body", test::closed_body(), false},
                {"rational sphere", test::sphere(), true},
                {"B-spline torus", test::Torus(6).patches(false), true},
                {"rational cubic torus", test::Torus(5).patches(true), false}};
  for (const auto& body : bodies) {
    if (!wanted(body.name)) continue;
    good = report_seams(body.name, body.patches, body.smooth, *wish) && good;
    good = report_parity(body.name, body.patches, *wish) && good;
  }
  return good ? 0 : 1;
}
