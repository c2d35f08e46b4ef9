// tessera_soak: uses all functions of the library for a set time, and records the memory of the process. It must not
// grow.

#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "soak/soak.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/evaluate.h"
#include "tessera/io.h"
#include "tessera/ray_scene.h"
#include "tessera/tessellation.h"

namespace tessera::bench { namespace {

using test::Random;
using test::uniform_vector;
using test::value_of;

constexpr const char* usage =
    R"(tessera_soak [--seconds N] [--csv FILE] [--png FILE] [--most-growth MIB]

Makes sets, grids, meshes, ray scenes and models, edits them and throws them away, over and over, for N seconds (3600).
Every second a line goes to FILE.csv: seconds, resident MiB, rounds; at the end a chart to FILE.png. Exit status 1 where the
memory grows by more than MIB an hour (8) over the second half.
)";

struct Options {
  double seconds = 3600, max_growth = 8;
  std::string csv, png;
};

double resident_mib() {
  std::ifstream file("/proc/self/statm");
  double all = 0, resident = 0;
  file >> all >> resident;
  return resident * 4096 / (1 << 20);
}

void need(const Status& status) {
  if (status.ok()) return;
  std::fprintf(stderr, "tessera_soak: %s\n", status.message().c_str());
  std::exit(2);
}

/// The work of typical programs: another size, and other options, each time.
class Work {
 public:
  void round() {
    const int size = 4 + static_cast<int>(random_() % 24);
    std::vector<BezierPatch> patches = test::wavy_field(size, size);
    const auto balls = test::placed(test::sphere(), 0.4, {1, 1, 2});
    patches.insert(patches.end(), balls.begin(), balls.end());
    PatchSet set = value_of(PatchSet::make(patches, {.blocks = {.float_points = true}}));
    evaluate_set(set);
    mesh(set);
    cast(set);
    read();
  }

 private:
  void evaluate_set(const PatchSet& set) {
    const std::vector<double> t = uniform_parameters(3 + static_cast<int>(random_() % 20));
    const GridPlan plan = value_of(GridPlan::make(set, t, t));
    std::vector<float> grid(6 * plan.capacity());
    need(evaluate(set, plan,
                  QuantityViews<float>{.position = View3<float>::interleaved(grid, 6, 0),
                                       .normal = View3<float>::interleaved(grid, 6, 3)}));
    const std::size_t count = 1 + random_() % 5000;
    std::vector<std::uint32_t> patch(count);
    std::vector<float> u(count), v(count), points(3 * count);
    for (std::size_t k = 0; k < count; ++k) {
      patch[k] = static_cast<std::uint32_t>(random_() % set.patch_count());
      u[k] = static_cast<float>(test::uniform(random_, 0, 0.99));
      v[k] = static_cast<float>(test::uniform(random_, 0, 0.99));
    }
    const PatchSamples<float> samples{View1<const std::uint32_t>::interleaved(patch),
                                      View1<const float>::interleaved(u), View1<const float>::interleaved(v)};
    need(evaluate(set, samples, QuantityViews<float>{.position = View3<float>::interleaved(points)}));
  }

  void mesh(PatchSet& set) {
    TessellationOptions options{.tolerance = 1e-3 * (1 + static_cast<double>(random_() % 9))};
    options.joining.share_vertices = random_() % 2 == 0;
    options.joining.weld = random_() % 2 == 0 ? 1e-6 : 0;
    Tessellation plan = value_of(Tessellation::make(set, options));
    Mesh mesh = value_of(plan.allocate());
    need(plan.run(set, mesh.views()));
    for (int frame = 0; frame < 5; ++frame) {
      const std::vector<std::uint32_t> patch{static_cast<std::uint32_t>(random_() % 16)};
      std::vector<Vec3> points(set.patch(patch[0]).points().begin(), set.patch(patch[0]).points().end());
      for (Vec3& p : points) p.z += 1e-3;
      if (!value_of(plan.update(set, {patch, points}, mesh.views())).topology) continue;
      mesh = value_of(plan.allocate());
      need(plan.run(set, mesh.views()));
    }
    (void)value_of(check(mesh));
  }

  void cast(PatchSet& set) {
    RaySceneOptions options{.mode = random_() % 3 == 0 ? RayMode::grid : RayMode::exact, .rate = 4};
    RayScene scene = value_of(RayScene::make(set, options));
    std::vector<Ray> rays(1 + random_() % 2000);
    for (Ray& ray : rays) {
      ray.origin = set.box().centre() + set.box().diagonal() * uniform_vector(random_, -1, 1);
      ray.direction = set.box().centre() + 3 * uniform_vector(random_, -1, 1) - ray.origin;
    }
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> dark(rays.size());
    for (int times = 0; times < 2; ++times) {
      need(scene.closest(rays, hits));
      need(scene.occluded(rays, dark));
      HitLists lists;
      if (options.mode == RayMode::exact) need(scene.all(rays, lists));
      const std::vector<Vec3> points(set.patch(0).points().begin(), set.patch(0).points().end());
      need(set.set_control_points(0, points));
      need(scene.refit());
    }
    if (const Status stale = set.set_control_points(set.patch_count(), {}); stale.ok())
      need({StatusCode::internal, "an edit of no patch was taken"});
  }

  /// Reads a model, and a truncated one.
  void read() {
    const std::string text =
        R"({"format": "tessera", "version": 1, "surfaces": [{"kind": "parametric", "name": "wave", "x": "u", "y": "v", "z": "sin(3*u)*v"}]})";
    const Model model = value_of(parse_json_model(text, "m"));
    (void)value_of(make_patch_set(model, {}, {.tolerance = 1e-3}));
    if (parse_json_model(text.substr(0, random_() % text.size()), "m").ok())
      need({StatusCode::internal, "a model that is cut was read"});
  }

  Random random_{1};
};

bool parse(int count, char** words, Options& options) {
  for (int k = 1; k + 1 < count; k += 2) {
    const std::string_view name = words[k], value = words[k + 1];
    double* const number = name == "--seconds"       ? &options.seconds
                           : name == "--most-growth" ? &options.max_growth
                                                     : nullptr;
    if (number) {
      const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), *number);
      if (error != std::errc{} || end != value.data() + value.size() || !(*number > 0)) return false;
    } else if (name == "--csv") {
      options.csv = value;
    } else if (name == "--png") {
      options.png = value;
    } else {
      return false;
    }
  }
  return count % 2 == 1;
}

int run(const Options& options) {
  std::ofstream csv;
  if (!options.csv.empty()) csv.open(options.csv);
  csv << "seconds,resident_mib,rounds\n";
  std::vector<SoakSample> samples;
  samples.reserve(1 << 20);
  Work work;
  std::size_t rounds = 0;
  const auto start = std::chrono::steady_clock::now();
  for (double seconds = 0, next = 0; seconds < options.seconds;) {
    work.round();
    ++rounds;
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (seconds < next) continue;
    next = seconds + 1;
    samples.push_back({seconds, resident_mib(), rounds});
    csv << seconds << ',' << samples.back().resident << ',' << rounds << '\n' << std::flush;
  }
  if (!options.png.empty()) need(draw_soak(samples, options.png));
  const auto [least, most] =
      std::ranges::minmax(std::span(samples).subspan(samples.size() / 2), {}, &SoakSample::resident);
  const double growth = growth_per_hour(samples);
  std::printf("%zu rounds in %.0f s; second half: %.1f to %.1f MiB resident, %+.2f MiB an hour\n", rounds,
              samples.back().seconds, least.resident, most.resident, growth);
  return growth <= options.max_growth ? 0 : 1;
}

}}  // namespace tessera::bench

int main(int count, char** words) {
  tessera::bench::Options options;
  if (!tessera::bench::parse(count, words, options)) {
    std::fputs(tessera::bench::usage, stderr);
    return 2;
  }
  return tessera::bench::run(options);
}
