// Tessera's triangulate() beside OpenCASCADE's BRepMesh_IncrementalMesh, both from a shape in memory to triangulations
// and polygons in its faces and edges, with parameters; Tessera's have normals, too. Conversion to a model counts.
//
// Both meshes are measured by samples (peers/face_errors.h): OpenCASCADE gets about the largest deflection at which the
// error of its mesh does not exceed that of Tessera's. Both get the same angular deflection. Times: on one thread the
// processor time, on two the wall clock; the best of several turns.

#include <tbb/global_control.h>
#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <Bnd_Box.hxx>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "peers/child_result.h"
#include "peers/equal_error.h"
#include "peers/face_errors.h"
#include "peers/interleaved.h"
#include "peers/occt_shape.h"
#include "peers/results.h"
#include "peers/trimmed_case.h"
#include "tessera/cad.h"
#include "tessera/occt_mesh.h"
#include "tessera/patch_set.h"
#include "tessera/tessellation.h"

namespace tessera::bench { namespace {

constexpr char usage[] =
    "tessera_peer_occt_triangulate [--only NAME] [--relative R] [--angle A] [--points N] [FOLDER or FILE...]\n\n"
    "triangulate() beside BRepMesh_IncrementalMesh at equal measured error, from shape to shape, on one thread and on\n"
    "two. Without folders: TESSERA_TEST_DATA. About half an hour.\n"
    "  --only NAME  files whose names contain NAME\n"
    "  --relative R Tessera's deflection, as a share of the size [0.001]\n"
    "  --angle A    the angular deflection of both, radians; 0: none [0.5]\n"
    "  --points N   measures meshes at about N points in each direction [6000]\n"
    "Exit status 1 if a file fails.\n";

constexpr std::uintmax_t max_bytes = 1'500'000;
constexpr unsigned max_seconds = 240;  // for a file

struct Options {
  std::vector<std::filesystem::path> places;
  std::string only;
  double relative = 1e-3, angle = occt_default_angle;
  std::size_t points = 6000;
};

/// The figures of a file. Errors are shares of its size.
struct Row {
  std::size_t faces = 0, triangles = 0, occt_triangles = 0;
  double error = 0, occt_error = 0, bound = 0;
  bool closed = false;
  double seconds = 0, occt_seconds = 0;          ///< one thread
  double two_seconds = 0, occt_two_seconds = 0;  ///< two threads
  char text[120] = "";                           ///< why there are no figures

  double speed() const { return occt_seconds / seconds; }
  double two_speed() const { return occt_two_seconds / two_seconds; }
  double share() const { return static_cast<double>(triangles) / static_cast<double>(occt_triangles); }
};

/// A file, read once; each distinct face where it comes first.
class Subject {
 public:
  Subject(const std::filesystem::path& file, const Options& options)
      : case_(read_case(file, false)), options_(options) {
    std::set<const void*> seen;
    std::erase_if(case_.faces, [&](const auto& face) { return !seen.insert(face->face().TShape().get()).second; });
    Bnd_Box box;
    BRepBndLib::Add(case_.as_read, box, false);
    if (box.IsVoid()) throw std::runtime_error("no faces");
    size_ = std::sqrt(box.SquareExtent());
  }

  Row compare() {
    const FaceErrorMeter meter(case_, options_.points);
    std::vector<TopoDS_Face> faces;
    for (const auto& face : case_.faces) faces.push_back(face->face());
    OcctShape theirs(case_.as_read, faces);
    Row row{.faces = faces.size()};
    const OcctMeshReport made = ours(false);
    const std::vector<SurfaceTriangle> own = theirs.triangles();
    const double error = meter.measure(own).worst(), tolerance = options_.relative * size_;
    if (std::isinf(error)) throw std::runtime_error("a face has no triangles");
    row.triangles = own.size(), row.error = error / size_, row.bound = made.bound / size_, row.closed = made.closed;
    const double angle = options_.angle > 0 ? options_.angle : 3.14159;
    const EqualMesh equal = mesh_of_equal_error(theirs, meter, error, tolerance, angle);
    row.occt_triangles = equal.triangles, row.occt_error = equal.error / size_;
    if (row.occt_triangles == 0) throw std::runtime_error("OpenCASCADE makes no triangles");
    const auto one = [&] { return seconds_of([&] { (void)ours(false); }); };
    const auto two = [&] { return wall_seconds_of([&] { (void)ours(true); }); };
    const auto occt_one = [&] { return theirs.mesh(equal.deflection, angle); };
    const auto occt_two = [&] { return occt_on_two(equal.deflection, angle); };
    const std::vector<double> best = best_interleaved(5, {one, occt_one, two, occt_two}, 0.02);
    row.seconds = best[0], row.occt_seconds = best[1], row.two_seconds = best[2], row.occt_two_seconds = best[3];
    return row;
  }

 private:
  OcctMeshReport ours(bool parallel) const {
    OcctMeshOptions wanted{.deflection = options_.relative * size_, .angle = {}, .parallel = parallel};
    if (options_.angle > 0) wanted.angle = options_.angle;
    Result<OcctMeshReport> made = triangulate(case_.as_read, wanted);
    if (!made) throw std::runtime_error(made.status().message());
    return *std::move(made);
  }
  double occt_on_two(double deflection, double angle) const {
    BRepTools::Clean(case_.as_read);
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection;
    parameters.Angle = angle;
    parameters.InParallel = true;
    BRepMesh_IncrementalMesh mesher;
    mesher.SetShape(case_.as_read);
    mesher.ChangeParameters() = parameters;
    return wall_seconds_of([&] { mesher.Perform(); });
  }

  TrimmedCase case_;
  Options options_;
  double size_ = 0;
};

Row row_of(const std::filesystem::path& file, const Options& options) {
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  Row row;
  try {
    return Subject(file, options).compare();
  } catch (const Standard_Failure& failure) {
    std::snprintf(row.text, sizeof row.text, "OpenCASCADE: %s", failure.GetMessageString());
  } catch (const std::exception& error) {
    std::snprintf(row.text, sizeof row.text, "%s", error.what());
  }
  return row;
}

struct Named {
  std::string name;
  Row row;
};

void print_summary(const std::vector<Named>& rows) {
  if (rows.empty()) return;
  std::vector<double> one, two, shares;
  for (const Named& of : rows)
    one.push_back(of.row.speed()), two.push_back(of.row.two_speed()), shares.push_back(of.row.share());
  std::printf("\n%zu files compared\n", rows.size());
  print_ratios("times as fast as OpenCASCADE, one thread", one);
  print_ratios("times as fast as OpenCASCADE, two threads", two);
  print_ratios("triangles, Tessera's over OpenCASCADE's", shares);
  const auto is_slower = [](const Named& one) { return one.row.speed() < 1 || one.row.two_speed() < 1; };
  std::printf("slower: %td\n", std::ranges::count_if(rows, is_slower));
  for (const Named& one : rows)
    if (is_slower(one))
      std::printf("  %s: %.2f and %.2f times as fast, %.2f times the triangles\n", one.name.c_str(), one.row.speed(),
                  one.row.two_speed(), one.row.share());
}

std::vector<std::filesystem::path> files_of(const Options& options) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& place : options.places) {
    if (!std::filesystem::is_directory(place)) {
      files.push_back(place);
      continue;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(place))
      if (entry.is_regular_file() && is_cad_file(entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::erase_if(files, [&](const auto& file) { return file.string().find(options.only) == std::string::npos; });
  return files;
}

int run(const Options& options) {
  std::printf("Errors and bounds are shares of the size. Times: best of several turns; %.2f rad\n", options.angle);
  std::printf("%-44s %5s %6s %8s %8s %8s %8s %9s %9s %6s %9s %9s %6s\n", "file", "faces", "closed", "error", "theirs",
              "triangl.", "theirs", "ms", "theirs", "speed", "2 thr.", "theirs", "speed");
  std::vector<Named> rows;
  bool good = true;
  for (const std::filesystem::path& file : files_of(options)) {
    const std::string name = file.filename().string();
    std::printf("%-44.44s ", name.c_str());
    if (std::filesystem::file_size(file) > max_bytes) {
      std::printf("left out: larger than %.1f MB\n", 1e-6 * max_bytes);
      continue;
    }
    const ChildResult<Row> made = in_child<Row>(max_seconds, [&] { return row_of(file, options); });
    const Row& row = made.value;
    if (!made.failure.empty() || row.text[0] != '\0') {
      std::printf("left out: %s\n", made.failure.empty() ? row.text : made.failure.c_str());
      continue;
    }
    std::printf("%5zu %6s %8.1e %8.1e %8zu %8zu %9.2f %9.2f %6.1f %9.2f %9.2f %6.1f\n", row.faces,
                row.closed ? "closed" : "open", row.error, row.occt_error, row.triangles, row.occt_triangles,
                1e3 * row.seconds, 1e3 * row.occt_seconds, row.speed(), 1e3 * row.two_seconds,
                1e3 * row.occt_two_seconds, row.two_speed());
    std::fflush(stdout);
    rows.push_back({name, row});
    add_result({"triangulations at equal error: " + name, "OpenCASCADE " OCC_VERSION_COMPLETE,
                "BRepMesh_IncrementalMesh", static_cast<double>(row.occt_triangles) / row.occt_seconds, "triangulate()",
                row.speed()});
  }
  print_summary(rows);
  return good ? 0 : 1;
}

}}  // namespace tessera::bench

int main(int argc, char** argv) {
  tessera::bench::Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string_view argument = argv[k];
    const char* const next = k + 1 < argc ? argv[k + 1] : nullptr;
    if (argument == "--help" || argument == "-h") return std::fputs(tessera::bench::usage, stdout) < 0;
    if (!argument.starts_with("--")) {
      options.places.emplace_back(argument);
    } else if (argument == "--only" && next) {
      options.only = next, ++k;
    } else if (argument == "--relative" && next) {
      options.relative = std::atof(next), ++k;
    } else if (argument == "--angle" && next) {
      options.angle = std::atof(next), ++k;
    } else if (argument == "--points" && next) {
      options.points = static_cast<std::size_t>(std::atol(next)), ++k;
    } else {
      std::fprintf(stderr, "unknown option '%s'\n%s", argv[k], tessera::bench::usage);
      return 2;
    }
  }
  try {
    if (const char* const data = std::getenv("TESSERA_TEST_DATA"); options.places.empty() && data)
      options.places.emplace_back(data);
    if (options.places.empty()) throw std::runtime_error("name files, or set TESSERA_TEST_DATA");
    return tessera::bench::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "occt_triangulate: %s\n", error.what());
  }
  return 1;
}
