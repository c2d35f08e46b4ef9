#include "peers/equal_error.h"

#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <stdexcept>

#include "peers/face_errors.h"
#include "peers/interleaved.h"
#include "peers/occt_shape.h"
#include "peers/results.h"
#include "support/real_files.h"
#include "support/synthetic_sets.h"
#include "tessera/cad.h"
#include "tessera/tessellation.h"

namespace tessera::bench {
namespace {

using test::value_of;

constexpr std::uintmax_t max_bytes = 1'500'000;
constexpr unsigned max_seconds = 240;  // for a file
constexpr double max_mesh_seconds = 20;

/// The figures of a file. Errors are shares of its size.
struct PartRow {
  std::size_t faces = 0, patches = 0, triangles = 0, occt_triangles = 0;
  double seconds = 0, occt_seconds = 0, bound = 0, error = 0, occt_error = 0, deflection = 0;
  char text[120] = "";  ///< why there are no figures

  double speed() const { return occt_seconds / seconds; }
  double share() const { return static_cast<double>(triangles) / static_cast<double>(occt_triangles); }
};

/// The shapes of a file, each meshed once, in its first instance.
class Parts {
 public:
  Parts(TrimmedCase one, const PartOptions& options)
      : case_(std::move(one)), shapes_(case_.model.shapes), options_(options) {
    if (shapes_.empty()) throw std::runtime_error("no shapes");
    std::vector<std::unique_ptr<TrueFace>> faces;
    first_.assign(shapes_.size(), no_face);
    placements_.resize(shapes_.size());
    for (const Instance& instance : case_.model.instances) {
      std::size_t& first = first_[instance.shape];
      if (first != no_face) continue;
      first = faces.size();
      placements_[instance.shape] = *instance.placement;
      for (std::size_t k = 0; k < shapes_[instance.shape].faces.size(); ++k)
        faces.push_back(std::move(case_.faces[instance.first_surface + k]));
    }
    case_.faces = std::move(faces);
    Box3 box;
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      const PatchSet set = value_or_throw(make_patch_set(shapes_[s]));
      patches_ += set.patch_count();
      size_ = std::max(size_, set.box().diagonal());
    }
  }

  PartRow compare() {
    const FaceErrorMeter meter(case_, options_.points);
    const double tolerance = options_.relative * size_;
    PartRow row{.faces = case_.faces.size(), .patches = patches_};
    const std::vector<SurfaceTriangle> own = mesh(tolerance, &row);
    const double error = meter.measure(own).worst();
    if (std::isinf(error)) throw std::runtime_error("a face has no triangles");
    row.triangles = own.size();
    row.bound /= size_, row.error = error / size_;
    std::vector<TopoDS_Face> faces;
    for (const auto& face : case_.faces) faces.push_back(face->face());
    OcctShape theirs(case_.as_read, faces);
    const EqualMesh equal = mesh_of_equal_error(theirs, meter, error, tolerance, options_.angle);
    row.deflection = equal.deflection / size_, row.occt_error = equal.error / size_;
    row.occt_triangles = equal.triangles;
    if (row.occt_triangles == 0) throw std::runtime_error("OpenCASCADE makes no triangles");
    const std::vector<double> best =
        best_interleaved(3,
                         {[&] { return seconds_of([&] { mesh(tolerance, nullptr); }); },
                          [&] { return theirs.mesh(row.deflection * size_, options_.angle); }},
                         0.02);
    row.seconds = best[0], row.occt_seconds = best[1];
    return row;
  }

 private:
  static constexpr std::size_t no_face = std::size_t(-1);

  template <class T>
  static T value_or_throw(Result<T> result) {
    if (!result) throw std::runtime_error(result.status().message());
    return *std::move(result);
  }

  /// Meshes all shapes. Returns the triangles if there is a row for the bound.
  std::vector<SurfaceTriangle> mesh(double tolerance, PartRow* row) const {
    std::vector<SurfaceTriangle> all;
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      const PatchSet set = value_or_throw(make_patch_set(shapes_[s]));
      const Tessellation plan = value_or_throw(Tessellation::make(set, {.tolerance = tolerance}));
      Mesh made = value_or_throw(plan.allocate());
      if (!plan.run(set, made.views()).ok()) std::abort();
      if (!row) continue;
      row->bound = std::max(row->bound, plan.bound());
      const std::vector<SurfaceTriangle> of_shape = triangles_on_faces(case_, set, made, first_[s], placements_[s]);
      all.insert(all.end(), of_shape.begin(), of_shape.end());
    }
    return all;
  }

  TrimmedCase case_;
  std::span<const Shape> shapes_;
  PartOptions options_;
  std::vector<std::size_t> first_;  ///< by shape, its first face in the case
  std::vector<Affine> placements_;  ///< of that instance
  std::size_t patches_ = 0;
  double size_ = 0;
};

PartRow row_of(const std::filesystem::path& file, const PartOptions& options) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  PartRow row;
  try {
    return Parts(read_case(file, false), options).compare();
  } catch (const Standard_Failure& failure) {
    std::snprintf(row.text, sizeof row.text, "OpenCASCADE: %s", failure.GetMessageString());
  } catch (const std::exception& error) {
    std::snprintf(row.text, sizeof row.text, "%s", error.what());
  }
  return row;
}

/// The row of a file, made in a child process.
PartRow row_by_child(const std::filesystem::path& file, const PartOptions& options) {
  PartRow row;
  if (std::filesystem::file_size(file) > max_bytes) {
    std::snprintf(row.text, sizeof row.text, "larger than %.1f MB", 1e-6 * max_bytes);
    return row;
  }
  int ends[2];
  std::fflush(stdout);
  if (pipe(ends) != 0) throw std::runtime_error("no pipes");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    alarm(max_seconds);
    const PartRow made = row_of(file, options);
    _exit(write(ends[1], &made, sizeof made) == sizeof made ? 0 : 1);
  }
  close(ends[1]);
  const bool is_read = read(ends[0], &row, sizeof row) == sizeof row;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!is_read) {
    row = {};
    const bool is_late = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
    std::snprintf(row.text, sizeof row.text, is_late ? "more than %u s" : "it crashed", max_seconds);
  }
  return row;
}

struct Named {
  std::string name;
  PartRow row;
};

void print_summary(const std::vector<Named>& rows) {
  if (rows.empty()) return;
  std::vector<double> speeds, shares;
  for (const Named& one : rows) speeds.push_back(one.row.speed()), shares.push_back(one.row.share());
  std::printf("\n%zu files compared\n", rows.size());
  print_ratios("times as fast as OpenCASCADE", speeds);
  print_ratios("triangles, Tessera's over OpenCASCADE's", shares);
  const auto list = [&](const char* title, auto is_one) {
    std::printf("%s: %td\n", title, std::ranges::count_if(rows, is_one));
    for (const Named& one : rows)
      if (is_one(one))
        std::printf("  %s: %.2f times as fast, %.2f times the triangles\n", one.name.c_str(), one.row.speed(),
                    one.row.share());
  };
  list("slower", [](const Named& one) { return one.row.speed() < 1; });
  list("more than 3 times the triangles", [](const Named& one) { return one.row.share() > 3; });
  list("2 to 3 times the triangles", [](const Named& one) { return one.row.share() > 2 && one.row.share() <= 3; });
}

}  // namespace

void print_ratios(const char* of, std::vector<double> ratios) {
  std::ranges::sort(ratios);
  const std::size_t half = ratios.size() / 2;
  const double median = ratios.size() % 2 == 1 ? ratios[half] : (ratios[half - 1] + ratios[half]) / 2;
  std::printf("%s: median %.3g, from %.3g to %.3g\n", of, median, ratios.front(), ratios.back());
}

EqualMesh mesh_of_equal_error(OcctShape& theirs, const FaceErrorMeter& meter, double own, double tolerance,
                              double angle) {
  const double error = std::max(own, 1e-3 * tolerance);
  constexpr double near = 1.02, enough = 1.15;
  EqualMesh found;
  double good = 0, bad = 0;
  for (double deflection = error; good == 0 || bad == 0 || bad > enough * good;) {
    if (std::isinf(theirs.mesh(deflection, angle, max_mesh_seconds)))
      throw std::runtime_error("OpenCASCADE takes more than 20 s for the same error");
    const std::vector<SurfaceTriangle> triangles = theirs.triangles();
    const double measured = meter.measure(triangles).worst();
    const bool is_good = measured <= near * error;
    if (is_good || deflection == error) found = {deflection, measured, triangles.size()};
    (is_good ? good : bad) = deflection;
    if (good == 0 && deflection < 0.26 * error) break;
    if (good > 8 * tolerance) break;
    deflection = bad == 0 ? 2 * good : good == 0 ? bad / 2 : std::sqrt(good * bad);
  }
  return found;
}

void compare_parts(const PartOptions& options) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& place : options.places) {
    if (!std::filesystem::is_directory(place))
      files.push_back(place);
    else
      for (const std::filesystem::path& file : test::files_below(place))
        if (is_cad_file(file)) files.push_back(file);
  }
  std::printf("Errors are shares of the size. Times: one thread, the best of three turns; %.1f rad\n", options.angle);
  std::printf("%-52s %6s %8s %8s %8s %6s %9s %9s %6s %8s %8s\n", "file", "faces", "error", "theirs", "triangl.",
              "theirs", "ms", "theirs", "speed", "triangl.", "bound");
  std::vector<Named> rows;
  for (const std::filesystem::path& file : files) {
    if (file.string().find(options.only) == std::string::npos) continue;
    const std::string name = file.parent_path().filename().string() + "/" + file.filename().string();
    const PartRow row = row_by_child(file, options);
    std::printf("%-52s ", name.c_str());
    if (row.text[0] != '\0') {
      std::printf("left out: %s\n", row.text);
      continue;
    }
    std::printf("%6zu %8.1e %8.1e %8zu %6zu %9.2f %9.2f %6.1f %8.2f %8.1e\n", row.faces, row.error, row.occt_error,
                row.triangles, row.occt_triangles, 1e3 * row.seconds, 1e3 * row.occt_seconds, row.speed(), row.share(),
                row.bound);
    rows.push_back({name, row});
    add_result({"parts at equal error: " + name, "OpenCASCADE " OCC_VERSION_COMPLETE, "BRepMesh_IncrementalMesh",
                static_cast<double>(row.occt_triangles) / row.occt_seconds, "certified closed mesh", row.speed()});
  }
  print_summary(rows);
}

}  // namespace tessera::bench
