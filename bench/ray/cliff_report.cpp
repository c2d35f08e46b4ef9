// Compares exact mode with refined grid mode at its default rate, a row per model. Times coherent rays, as of a camera,
// and incoherent ones; then rays aimed at borders of patches, at their poles, and along tangent planes, beside
// incoherent ones. Uses one thread, and the better of some runs that take turns. Both modes must agree on hit or miss,
// except for one ray in a hundred.

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "model_files.h"
#include "report_arguments.h"
#include "support/errors.h"
#include "support/ray_classes.h"
#include "tessera/ray_scene.h"

namespace {

using namespace tessera;
using test::rays::unit_vector;
using Random = test::Random;

constexpr char usage[] =
    "tessera_cliff_report [MODEL or FOLDER...]\n\n"
    "Times of rays in exact mode over those in refined grid mode, and of hard rays over random ones; of the project's "
    "models\n"
    "if none is named.\n";
constexpr int picture = 160, tile = 4, runs = 3;
constexpr std::size_t ray_count = 8192, hard_ray_count = 2048;

/// Rays tile by tile, from outside, at the middle of the box.
std::vector<Ray> camera_rays(const Box3& box) {
  const double size = box.diagonal();
  const Vec3 centre = 0.5 * (box.lower + box.upper), eye = centre + 1.2 * size * normalized(Vec3{0.5, -0.8, 0.6});
  const Vec3 ahead = normalized(centre - eye), right = normalized(cross(ahead, Vec3{0, 0, 1})),
             up = cross(right, ahead);
  std::vector<Ray> rays;
  for (int k = 0; k < picture * picture; ++k) {
    const int in_tile = k % (tile * tile), tiles = k / (tile * tile), across = picture / tile;
    const double x = tiles % across * tile + in_tile % tile + 0.5, y = tiles / across * tile + in_tile / tile + 0.5;
    rays.emplace_back();
    rays.back().origin = eye;
    rays.back().direction = ahead + 0.9 * (x / picture - 0.5) * right + 0.9 * (y / picture - 0.5) * up;
  }
  return rays;
}

enum class Aim { anywhere, border, pole, tangent };

/// Whether the tangents at the point are zero or parallel: a pole, or a corner without an angle.
bool is_singular(const Hit& at) { return !(length(cross(at.du, at.dv)) > 1e-6 * length(at.du) * length(at.dv)); }

/// Rays at places of the surface, from outside of its box; no rays at poles if the surface has none.
std::vector<Ray> aimed_rays(const RayScene& scene, const PatchSet& set, Aim aim, std::size_t count) {
  const double size = set.box().diagonal();
  Random random(7);
  std::vector<Ray> rays;
  for (std::size_t draws = 0; rays.size() < count && draws < 8 * count; ++draws) {
    Ray ray;
    double u = test::uniform(random, 0, 1), v = test::uniform(random, 0, 1);
    if (aim == Aim::border || aim == Aim::pole) (random() % 2 == 0 ? u : v) = random() % 2 == 0 ? 0 : 1;
    const Hit at = test::value_of(scene.resolve(static_cast<std::uint32_t>(random() % set.patch_count()), u, v));
    if (aim != Aim::anywhere && is_singular(at) != (aim == Aim::pole)) continue;
    const Vec3 along = aim == Aim::tangent ? cross(at.normal, unit_vector(random)) : unit_vector(random);
    const Vec3 direction = dot(along, along) > 1e-6 ? normalized(along) : unit_vector(random);
    ray.origin = at.position - 2 * size * direction;
    ray.direction = direction;
    rays.push_back(ray);
  }
  return rays;
}

/// Times the rays; lowers `best`, in seconds, if they took less.
void time(const RayScene& scene, const std::vector<Ray>& rays, std::vector<Hit>& hits, double& best) {
  tbb::task_arena one(1);
  hits.resize(rays.size());
  const auto start = std::chrono::steady_clock::now();
  const Status status = one.execute([&] { return scene.closest(rays, hits); });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!status.ok()) std::fprintf(stderr, "%s\n", status.message().c_str()), std::exit(1);
  best = std::min(best, seconds);
}

struct Timed {
  double exact = INFINITY, grid = INFINITY;
  double steps = 0;  ///< per ray, of exact mode
  double other = 0;  ///< share of the rays that hit in only one of the modes
  double ratio() const { return exact / grid; }
};

Timed compare(const RayScene& exact, const RayScene& grid, const std::vector<Ray>& rays) {
  Timed out;
  std::vector<Hit> hits, grid_hits;
  for (int k = 0; k < runs; ++k) time(exact, rays, hits, out.exact), time(grid, rays, grid_hits, out.grid);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    out.steps += hits[k].steps;
    out.other += hits[k].kind != grid_hits[k].kind;
  }
  const double count = static_cast<double>(rays.size());
  out.steps /= count, out.other /= count;
  return out;
}

/// Seconds per ray; 0 if there are no rays.
double each(const RayScene& scene, const std::vector<Ray>& rays) {
  double best = rays.empty() ? 0 : INFINITY;
  std::vector<Hit> hits;
  for (int k = 0; k < runs && !rays.empty(); ++k) time(scene, rays, hits, best);
  return best / static_cast<double>(std::max<std::size_t>(rays.size(), 1));
}

/// The ratios of one column.
struct Column {
  std::vector<double> ratios;
  std::string worst;
  void add(double ratio, const std::string& name) {
    if (ratios.empty() || ratio > *std::max_element(ratios.begin(), ratios.end())) worst = name;
    ratios.push_back(ratio);
  }
  void print(const char* title) {
    if (ratios.empty()) return;
    std::sort(ratios.begin(), ratios.end());
    std::printf("%-12s median %.2f, worst %.2f (%s)\n", title, ratios[ratios.size() / 2], ratios.back(), worst.c_str());
  }
};

class Report {
 public:
  void survey(const std::filesystem::path& path) {
    const std::string name = bench::short_name(path);
    const Result<Model> model = read_model(path);
    const Result<PatchSet> set = model ? make_patch_set(*model) : Result<PatchSet>(model.status());
    if (!set) return skip(name, set.status());
    RaySceneOptions options;
    const Result<RayScene> exact = RayScene::make(*set, options);
    options.mode = RayMode::grid;
    const Result<RayScene> grid = RayScene::make(*set, options);
    if (!exact || !grid) return skip(name, exact ? grid.status() : exact.status());
    const auto aimed = [&](Aim aim, std::size_t count) { return aimed_rays(*exact, *set, aim, count); };
    const Timed camera = compare(*exact, *grid, camera_rays(set->box()));
    const std::vector<Ray> random = aimed(Aim::anywhere, ray_count);
    const Timed apart = compare(*exact, *grid, random);
    const double usual = each(*exact, random), seam = each(*exact, aimed(Aim::border, hard_ray_count)) / usual,
                 tangent = each(*exact, aimed(Aim::tangent, hard_ray_count)) / usual,
                 pole = each(*exact, aimed(Aim::pole, hard_ray_count)) / usual;
    const double memory = static_cast<double>(exact->memory_bytes()) / static_cast<double>(set->patch_count()) / 1024;
    std::printf("%-46s %7zu %8.2f %8.2f %7.2f %7.1f %7.1f %7.1f %8.1f %7.2f %7.2f%s\n", name.c_str(),
                set->patch_count(), camera.ratio(), apart.ratio(), apart.steps, seam, pole, tangent, memory,
                1e6 * usual, 100 * std::max(camera.other, apart.other),
                camera.other > 0.01 || apart.other > 0.01 ? " !" : "");
    std::fflush(stdout);
    coherent_.add(camera.ratio(), name), incoherent_.add(apart.ratio(), name);
    seams_.add(seam, name), tangents_.add(tangent, name);
    if (pole > 0) poles_.add(pole, name);
  }

  void finish() {
    std::printf("%zu models\n", coherent_.ratios.size());
    coherent_.print("coherent"), incoherent_.print("incoherent"), seams_.print("borders"), poles_.print("poles"),
        tangents_.print("tangent");
    for (const std::string& line : skipped_) std::printf("skipped: %s\n", line.c_str());
  }

 private:
  void skip(const std::string& name, const Status& why) { skipped_.push_back(name + ": " + why.message()); }

  Column coherent_, incoherent_, seams_, poles_, tangents_;
  std::vector<std::string> skipped_;
};

}  // namespace

int main(int argc, char** argv) {
  const bench::ReportArguments asked(argc, argv, usage);
  std::printf("%-46s %7s %8s %8s %7s %7s %7s %8s %7s %7s\n", "model", "patches", "coherent", "apart", "steps",
              "borders", "tangent", "KiB each", "us", "other%");
  std::printf(
      "(exact over grid: camera's rays, rays with nothing in common and the steps that these take; a ray at a border "
      "and\n"
      "along a tangent plane over one with nothing in common; memory of exact mode; that ray's time; rays of which "
      "one\n"
      "mode meets something and the other nothing)\n");
  Report report;
  for (const std::filesystem::path& path : bench::model_files(asked.models)) report.survey(path);
  report.finish();
  return 0;
}
