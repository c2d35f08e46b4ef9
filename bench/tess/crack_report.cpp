// Searches certified meshes of models for cracks, at five tolerances each. Prints a row per model with, for each
// tolerance, the triangles and their faults; then what was skipped, with reasons. Open edges that are borders of the
// model itself are not cracks: such borders are counted. Exit status 1 if there is a crack.

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "model_files.h"
#include "report_arguments.h"
#include "support/crack_survey.h"

namespace {

using namespace tessera;

constexpr char usage[] =
    "tessera_crack_report [--fewest] [MODEL or FOLDER...]\n\n"
    "Whether certified meshes have cracks, at five tolerances each; of the project's models if none is named.\n"
    "  --fewest  meshes of the fewest triangles\n"
    "Exit status 1 if there is a crack.\n";
constexpr double tolerances[] = {1e-2, 3e-3, 1e-3, 3e-4, 1e-4};
constexpr std::uint64_t max_triangles = 500000;

/// A cell of the table: triangles and faults.
std::string cell(const test::CrackCount& count) {
  std::string text = (count.capped ? "<" : "") + std::to_string(count.report.triangles);
  const auto add = [&](const char* what, std::size_t n) {
    if (n > 0) text += std::string(" ") + what + std::to_string(n);
  };
  add("crack:", count.cracks);
  add("manifold:", count.non_manifold);
  add(count.folded ? "turns:" : "flat:", count.report.degenerate_triangles);
  add("nan:", count.report.non_finite_vertices);
  return text;
}

class Report {
 public:
  explicit Report(bool fewest) : fewest_(fewest) {}

  void survey(const std::filesystem::path& path) {
    const std::string name = bench::short_name(path);
    const Result<Model> model = read_model(path);
    const Result<PatchSet> set = model ? make_patch_set(*model) : Result<PatchSet>(model.status());
    if (!set) return skip(name, set.status());
    std::string row;
    test::CrackCount last;
    for (const double tolerance : tolerances) {
      const Result<test::CrackCount> count = test::count_cracks(*set, tolerance, max_triangles, fewest_);
      if (!count) {
        skip(name + " at " + std::to_string(tolerance), count.status());
        row += "           -";
        continue;
      }
      const std::string text = cell(*count);
      row += std::string(text.size() < 12 ? 12 - text.size() : 1, ' ') + text;
      good_ = good_ && count->good();
      last = *count;
      ++meshes_;
    }
    ++models_;
    std::printf("%-52s %7zu %7zu %6zu %6zu%s\n", name.c_str(), set->patch_count(), last.own_borders,
                last.own_non_manifold, last.report.t_junctions, row.c_str());
    std::fflush(stdout);
  }

  bool finish() const {
    std::printf("%zu models, %zu meshes\n", models_, meshes_);
    for (const std::string& line : skipped_) std::printf("skipped: %s\n", line.c_str());
    return good_;
  }

 private:
  void skip(const std::string& name, const Status& why) { skipped_.push_back(name + ": " + why.message()); }

  bool fewest_;
  std::size_t models_ = 0, meshes_ = 0;
  bool good_ = true;
  std::vector<std::string> skipped_;
};

}  // namespace

int main(int argc, char** argv) {
  const bench::ReportArguments asked(argc, argv, usage);
  std::printf("%-52s %7s %7s %6s %6s", "model", "patches", "borders", "multi", "T");
  for (const double tolerance : tolerances) std::printf("%12.0e", tolerance);
  std::printf(
      "\n(of the model itself: borders that meet none, edges of more than two triangles, T-junctions, of the finest "
      "mesh; then "
      "triangles by tolerance, a share of the size, < where only so many were allowed)\n");
  Report report(asked.fewest);
  for (const std::filesystem::path& path : bench::model_files(asked.models)) report.survey(path);
  return report.finish() ? 0 : 1;
}
