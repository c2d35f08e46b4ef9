#include "roofline/roofline.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

#include "base/aligned.h"
#include "sets.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"

namespace tessera::bench {
namespace {

constexpr double cache_bytes = 1 << 20, memory_bytes = 160 << 20;

/// The name of the processor, as the system reports it.
std::string machine_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "this machine";
}

struct Case {
  const char* name;
  QuantityFlags outputs;
};
constexpr Case cases[] = {{"positions", {.position = true}},
                          {"+ normals", {.position = true, .normal = true}},
                          {"+ du + dv", {.position = true, .du = true, .dv = true}},
                          {"+ curvatures",
                           {.position = true,
                            .du = true,
                            .dv = true,
                            .duu = true,
                            .duv = true,
                            .dvv = true,
                            .gaussian = true,
                            .mean = true}}};

/// Memory for the outputs of a plan, in blocks.
class Outputs {
 public:
  Outputs(const GridPlan& plan, const QuantityFlags& wanted) {
    const auto make_room = [&](bool is_wanted, std::size_t count, std::span<float>& span) {
      if (!is_wanted) return;
      memory_.emplace_back(count, 0.0f);
      span = memory_.back();
    };
    const std::size_t vectors = plan.block_capacity();
    make_room(wanted.position, vectors, blocks.position);
    make_room(wanted.du, vectors, blocks.du);
    make_room(wanted.dv, vectors, blocks.dv);
    make_room(wanted.normal, vectors, blocks.normal);
    make_room(wanted.duu, vectors, blocks.duu);
    make_room(wanted.duv, vectors, blocks.duv);
    make_room(wanted.dvv, vectors, blocks.dvv);
    make_room(wanted.gaussian, vectors / 3, blocks.gaussian);
    make_room(wanted.mean, vectors / 3, blocks.mean);
  }
  QuantityBlocks<float> blocks;

 private:
  std::vector<AlignedVector<float>> memory_;
};

/// The best of several calls on one thread over the patches of `set`, with as many parameters as make about `bytes`.
Result<RooflinePoint> measure(const PatchSet& set, const Case& c, double bytes) {
  const auto two = uniform_parameters(2);
  auto smallest = GridPlan::make(set, two, two);
  if (!smallest) return smallest.status();
  const double a_point = smallest->work(c.outputs).bytes_written / static_cast<double>(smallest->capacity());
  const double side = std::sqrt(bytes / a_point / static_cast<double>(set.patch_count()));
  const auto t = uniform_parameters(std::max(4, static_cast<int>(side)));
  auto plan = GridPlan::make(set, t, t);
  if (!plan) return plan.status();
  const Work work = plan->work(c.outputs);
  Outputs out(*plan, c.outputs);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  tbb::task_arena arena(1);
  double best = 1e30, spent = 0;
  for (int k = 0; k < 3 || (k < 2000 && spent < 0.15); ++k) {
    const auto start = std::chrono::steady_clock::now();
    Status status;
    arena.execute([&] { status = evaluate(set, *plan, out.blocks); });
    if (!status.ok()) return status;
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best = std::min(best, seconds);
    spent += seconds;
  }
  return RooflinePoint{c.name, work.lane_operations / work.bytes_written, work.lane_operations / best,
                       static_cast<double>(plan->capacity()) / best, bytes <= cache_bytes};
}

Result<Roofline> measure_roofline() {
  Roofline out;
  out.machine = machine_name();
  for (const Isa isa : available_isas()) {
    auto limits = measure_limits({.isa = isa, .store_bytes = static_cast<std::size_t>(memory_bytes)});
    if (!limits) return limits.status();
    out.isas.push_back(*limits);
  }
  auto cache = measure_limits({.isa = available_isas().back(), .store_bytes = static_cast<std::size_t>(cache_bytes)});
  if (!cache) return cache.status();
  out.cache_store = cache->store_bytes_per_second;
  auto few = PatchSet::make(test::wavy_field(16, 16));
  if (!few) return few.status();
  for (const bool in_cache : {true, false})
    for (const Case& c : cases) {
      auto point = measure(in_cache ? *few : set_named("bicubic20000"), c, in_cache ? cache_bytes : memory_bytes);
      if (!point) return point.status();
      out.points.push_back(*point);
    }
  return out;
}

void print(const Roofline& r) {
  std::printf("%s, %u threads; one thread:\n", r.machine.c_str(), std::thread::hardware_concurrency());
  for (const Limits& limits : r.isas)
    std::printf(
        "  %-7s %6.1f G multiply-adds/s in float, %6.1f in double; stores to memory %5.1f GB/s, past the caches "
        "%5.1f\n",
        std::string(name(limits.isa)).c_str(), 1e-9 * limits.float_operations_per_second,
        1e-9 * limits.double_operations_per_second, 1e-9 * limits.plain_store_bytes_per_second,
        1e-9 * limits.streaming_store_bytes_per_second);
  std::printf("  stores to the second-level cache %.1f GB/s\n", 1e-9 * r.cache_store);
  std::puts("bicubic patches in blocks, fastest instruction set: M points/s, and the share of the limit");
  for (const RooflinePoint& p : r.points) {
    const double bandwidth = p.in_cache ? r.cache_store : r.isas.back().store_bytes_per_second;
    const double limit = std::min(r.isas.back().float_operations_per_second, bandwidth * p.per_byte);
    std::printf("  %-13s to %-6s %7.0f  %.2f\n", p.name.c_str(), p.in_cache ? "cache" : "memory", 1e-6 * p.points,
                p.operations / limit);
  }
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

/// One object of JSON; rates are per second.
std::string json_of(const Roofline& r) {
  std::string text =
      "{\"machine\": \"" + r.machine + "\", \"cache_store\": " + number(r.cache_store) + ",\n \"isas\": [";
  for (const Limits& limits : r.isas)
    text += std::string(&limits == r.isas.data() ? "" : ",") + "\n  {\"isa\": \"" + std::string(name(limits.isa)) +
            "\", \"float_operations\": " + number(limits.float_operations_per_second) +
            ", \"double_operations\": " + number(limits.double_operations_per_second) +
            ", \"plain_store\": " + number(limits.plain_store_bytes_per_second) +
            ", \"streaming_store\": " + number(limits.streaming_store_bytes_per_second) + "}";
  text += "],\n \"points\": [";
  for (const RooflinePoint& p : r.points)
    text += std::string(&p == r.points.data() ? "" : ",") + "\n  {\"name\": \"" + p.name +
            "\", \"per_byte\": " + number(p.per_byte) + ", \"operations\": " + number(p.operations) +
            ", \"points\": " + number(p.points) + ", \"in_cache\": " + (p.in_cache ? "true" : "false") + "}";
  return text + "]}\n";
}

Status write_json(const Roofline& roofline, const std::string& path) {
  std::ofstream file(path);
  file << json_of(roofline);
  file.close();
  return file ? Status{} : Status(StatusCode::io_error, path + ": can't be written");
}

}  // namespace

Status print_roofline(const std::string& file) {
  const auto roofline = measure_roofline();
  if (!roofline) return roofline.status();
  print(*roofline);
  if (file.empty()) return {};
  const Status status = write_json(*roofline, file);
  if (status.ok()) std::printf("written: %s\n", file.c_str());
  return status;
}

}  // namespace tessera::bench
