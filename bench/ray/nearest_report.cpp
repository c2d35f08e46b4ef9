// Checks the promises of nearest points against a search that shares no code, in all classes of difficult places: no
// point may be nearer than a certified one. Exit status 1 if one is, or if a position or a distance is wrong.
//
// tessera_nearest_report --help

#include <atomic>
#include <charconv>
#include <cstdio>
#include <mutex>
#include <string_view>
#include <thread>
#include <vector>

#include "support/nearest_proof.h"

namespace {

using namespace tessera;

constexpr const char* usage =
    "tessera_nearest_report [--points N]\n\nCompares N nearest points (1000) of each class with a reference, on all "
    "cores.\n";
constexpr std::size_t round = 250;

/// Compares the points of a class in rounds on all cores.
test::NearestTally tally_of(const test::RayClass& of, std::size_t count) {
  test::NearestTally sum;
  std::mutex mutex;
  std::atomic<std::size_t> next{0};
  std::vector<std::thread> threads;
  for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k)
    threads.emplace_back([&] {
      for (std::size_t at = next++; at * round < count; at = next++) {
        const test::NearestTally part = test::nearest_tally(of, std::min(round, count - at * round), 1000 + at);
        const std::lock_guard lock(mutex);
        sum.add(part);
      }
    });
  for (std::thread& thread : threads) thread.join();
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 1000;
  for (int k = 1; k < argc; ++k) {
    const std::string_view word = argv[k], value = k + 1 < argc ? argv[k + 1] : "";
    if (word == "--help" || word == "-h") return std::fputs(usage, stdout) < 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), count);
    if (word != "--points" || error != std::errc() || end != value.data() + value.size() || count == 0) {
      std::fprintf(stderr, "unknown option '%s', or no positive integer\n%s", argv[k], usage);
      return 2;
    }
    ++k;
  }
  test::NearestTally all;
  std::printf("%-52s %9s %10s %6s %5s %9s\n", "class", "points", "certified", "wrong", "off", "worst");
  for (const test::RayClass& of : test::ray_classes()) {
    const test::NearestTally one = tally_of(of, count);
    std::printf("%-52s %9zu %9.3f%% %6zu %5zu %9.1e\n", of.name.c_str(), one.points,
                100.0 * static_cast<double>(one.certified) / static_cast<double>(one.points), one.wrong,
                one.off + one.missed, one.worst);
    std::fflush(stdout);
    all.add(one);
  }
  std::printf("all: %zu points, %zu certified, %zu wrong, %zu off\n", all.points, all.certified, all.wrong,
              all.off + all.missed);
  return all.wrong + all.off + all.missed > 0 ? 1 : 0;
}
