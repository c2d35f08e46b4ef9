// Casts rays through the closed solids of files, half of them aimed at edges and vertices. Prints a row for each solid:
// patches; the largest gap, as a share of the size; rays, and inside points that some of them begin or end at; rays
// that pass an edge, and those of them that could not be moved aside; rays with a hit that is flagged uncertified or
// incomplete, and wrong counts of these; wrong counts of rays with a hit on the very border of a patch. Then the
// faults: wrong counts of other rays, and of rays that were moved aside; rays between an inside and an outside point
// that met nothing. Exit status 1 if there is a fault.

#include <cstdio>
#include <filesystem>
#include <string>

#include "model_files.h"
#include "report_arguments.h"
#include "support/solid_rays.h"

namespace {

using namespace tessera;

constexpr char usage[] =
    "tessera_solid_report [--rays N] [MODEL or FOLDER...]\n\n"
    "Whether rays leak into the closed solids of CAD files, or out of them, or cross them an odd number of times; of\n"
    "the project's models if none is named. --rays sets the rays for each solid [100000].\n"
    "Exit status 1 if there is one.\n";

bool report(const std::string& name, const Shape& shape, std::size_t rays) {
  const Result<PatchSet> set = make_patch_set(shape);
  if (!set) return true;
  const Result<RayScene> scene = RayScene::make(*set);
  if (!scene) return true;
  test::SolidRays solid(shape, *scene, 1);
  solid.cast(rays);
  const test::SolidTally& tally = solid.tally();
  double gap = 0;
  for (const double of : test::value_of(scene->edge_gaps())) gap = std::max(gap, of);
  std::printf("%-60s %6zu %8.1e %7zu %6zu %7zu %7zu %7zu %7zu %7zu | %6zu %6zu %6zu\n", name.c_str(),
              set->patch_count(), gap / scene->box().diagonal(), tally.rays(), solid.inside_count(), tally.seams,
              tally.unmoved, tally.unsure, tally.unsure_odd, tally.border_odd, tally.odd, tally.seam_odd, tally.leaks);
  std::fflush(stdout);
  return tally.good();
}

}  // namespace

int main(int argc, char** argv) {
  const bench::ReportArguments asked(argc, argv, usage);
  std::printf("%-60s %6s %8s %7s %6s %7s %7s %7s %7s %7s | %6s %6s %6s\n", "solid", "patch", "gap", "rays", "inside",
              "seams", "unmoved", "unsure", "odd", "borders", "odd", "moved", "leaks");
  bool good = true;
  for (const std::filesystem::path& path : bench::model_files(asked.models)) {
    const Result<Model> model = read_model(path);
    if (!model) continue;
    for (std::size_t k = 0; k < model->shapes.size(); ++k) {
      const std::string name = bench::short_name(path) + " " + std::to_string(k);
      const Shape& shape = model->shapes[k];
      if (!test::is_closed(shape)) {
        std::printf("%s is not closed\n", name.c_str());
        continue;
      }
      good = report(name, shape, asked.rays) && good;
    }
  }
  return good ? 0 : 1;
}
