// Compares meshes of the trimmed faces of CAD files with those of OpenCASCADE's BRepMesh_IncrementalMesh, each on one
// thread. OpenCASCADE gets a deflection, and the distance of its mesh from the trimmed faces is measured by samples in
// both directions (peers/face_errors.h). Tessera gets about the largest tolerance at which its own mesh, measured in
// the same way, is no farther. Where the curves of a file in space lie farther from the faces than OpenCASCADE's mesh
// can keep, its error says nothing: Tessera's must not exceed the deflection then.
//
// Times: Tessera from the model in memory (its patches are made from splines, its loops are prepared) to positions,
// normals and triangles; OpenCASCADE from the shape to positions and triangles. OpenCASCADE meshes each face once,
// even if instances share it; Tessera meshes each instance. So OpenCASCADE also gets a shape whose instances have
// faces of their own: that is the time that counts, and the time of the shape as it was read stands beside it.
//
// Checks: bounds of Tessera's meshes against the measured distances; areas of faces against BRepGProp; sides of
// TrimRegion against BRepTopAdaptor_FClass2d.

#include <tbb/global_control.h>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <optional>
#include <string_view>

#include "peers/equal_error.h"
#include "peers/face_errors.h"
#include "peers/interleaved.h"
#include "peers/occt_shape.h"
#include "peers/results.h"
#include "peers/trimmed_checks.h"
#include "support/synthetic_sets.h"
#include "tessera/tessellation.h"

namespace tessera::bench { namespace {

constexpr char usage[] =
    "tessera_peer_occt_trimmed_mesh [--only NAME] [--points N] [--no-sides] [--no-search] [FILE...]\n"
    "tessera_peer_occt_trimmed_mesh --parts [--only NAME] [--points N] [--relative R] [--angle A] [FOLDER...]\n\n"
    "Meshes of trimmed CAD files beside OpenCASCADE's at equal measured error, one thread; areas and sides of their\n"
    "faces. Without files: those of the folder TESSERA_TEST_DATA. About 10 minutes.\n"
    "  --parts      a line for each file: Tessera's closed mesh, and OpenCASCADE's with the deflection at which its\n"
    "               error is the same; medians at the end. Without folders: TESSERA_TEST_DATA. About an hour\n"
    "  --only NAME  files whose names contain NAME\n"
    "  --points N   measures meshes at about N points in each direction [12000]\n"
    "  --relative R Tessera's tolerance, as a share of the size [0.001]\n"
    "  --angle A    OpenCASCADE's angular deflection, radians [0.5]\n"
    "  --no-sides   without the check of sides\n"
    "  --no-search  at equal tolerance only\n"
    "Exit status 1 if a bound does not hold.\n";

constexpr const char* default_files[] = {"step_cad/as1-oc-214.stp",
                                         "step_cad/as1_pe_203.stp",
                                         "step_cad/face_recognition_sample_part.stp",
                                         "step_cad/screw.step",
                                         "step_brlcad_edge/ap214_periodic_edge_propagation.stp",
                                         "iges_cad/occt_hammer.iges",
                                         "step_cad/nurbsjl_torus.stp",
                                         "iges_cad/igesio_input.igs",
                                         "iges_cad/surf114.igs",
                                         "iges_nist_benchmarks/144-000.igs",
                                         "iges_nist_benchmarks/144-000-example-1.igs",
                                         "step_cad/AMSurface.step",
                                         "brep_occt/bottle.brep",
                                         "brep_occt/hammer.brep",
                                         "iges_bodies/mug_solid.igs",
                                         "iges_bodies/wrench.iges"};
constexpr std::size_t points_per_face = 10000;
constexpr double max_seconds = 60;  // for one of OpenCASCADE's meshes

struct Options {
  std::string only;
  std::size_t points = 12000;
  double relative = 1e-3, angle = occt_default_angle;
  bool sides = true, search = true, parts = false;
  std::vector<std::filesystem::path> files;
};

/// A mesh's figures.
struct Measured {
  std::size_t triangles = 0;
  FaceErrors errors;
  double seconds = 0, bound = 0, tolerance = 0;
};

class Comparison {
 public:
  Comparison(const TrimmedCase& one, std::size_t points)
      : case_(one), set_(test::value_of(make_patch_set(one.model))), meter_(one, points), size_(set_.box().diagonal()) {
    for (const auto& face : one.faces) {
      edge_gap_ = std::max(edge_gap_, face->edge_gap());
      wire_gap_ = std::max(wire_gap_, face->wire_gap());
    }
  }

  void print_head() const {
    std::printf(
        "%s: %zu faces (%zu distinct), %zu trimmed; %zu patches, %zu cut; size %.4g, gaps: edges %.1e, wires "
        "%.1e of it; %zu faults\n",
        case_.name.c_str(), case_.faces.size(), case_.distinct_faces, case_.trimmed_faces(), set_.patch_count(),
        set_.cut_count(), size_, edge_gap_ / size_, wire_gap_ / size_, set_.trim_faults().size());
    for (const Status& fault : set_.trim_faults()) std::printf("  fault: %s\n", fault.message().c_str());
  }

  /// Returns whether the bounds hold.
  bool compare(double relative, bool search) const {
    const double deflection = relative * size_;
    bool good = true;
    const std::optional<Measured> same = measure(deflection);
    if (!same) return false;
    Measured timed = *same;
    timed.seconds = seconds(deflection);
    std::printf("  %.0e  Tessera: %zu triangles, bound %.2e, measured %.2e to faces, %.2e to mesh, %.2f ms\n", relative,
                timed.triangles, timed.bound / size_, timed.errors.from_mesh / size_, timed.errors.from_faces / size_,
                1e3 * timed.seconds);
    good = holds(*same);
    for (const double angle : {occt_default_angle, std::numbers::pi}) {
      Measured occt, as_read;
      if (!measure_occt(deflection, angle, occt, as_read)) {
        std::printf("         OpenCASCADE takes more than %.0f s\n", max_seconds);
        break;
      }
      std::printf(
          "         OpenCASCADE, %.1f rad: %zu triangles, measured %.2e to faces, %.2e to mesh, %.2f ms (as read "
          "%.2f)\n",
          angle, occt.triangles, occt.errors.from_mesh / size_, occt.errors.from_faces / size_, 1e3 * occt.seconds,
          1e3 * as_read.seconds);
      if (!search) continue;
      const bool is_gap = occt.errors.worst() > deflection && edge_gap_ > 0.3 * occt.errors.worst();
      const double error = is_gap ? deflection : occt.errors.worst();
      Measured equal = coarsest(error, timed);
      equal.seconds = seconds(equal.tolerance);
      good = holds(equal) && good;
      std::printf(
          "         Tessera%s: %zu triangles, tolerance %.2e, measured %.2e, %.2f ms: %.2f times the triangles, "
          "%.1f times as fast (as read %.1f)\n",
          is_gap ? ", at the deflection, as gaps rule" : "", equal.triangles, equal.tolerance / size_,
          equal.errors.worst() / size_, 1e3 * equal.seconds,
          static_cast<double>(equal.triangles) / static_cast<double>(occt.triangles), occt.seconds / equal.seconds,
          as_read.seconds / equal.seconds);
      char way[64];
      std::snprintf(way, sizeof way, "BRepMesh_IncrementalMesh, %.0e of the size, %.1f rad", relative, angle);
      add_result({"trimmed meshes of equal error: " + case_.name, "OpenCASCADE " OCC_VERSION_COMPLETE, way,
                  static_cast<double>(occt.triangles) / occt.seconds, "certified mesh", occt.seconds / equal.seconds});
      std::fflush(stdout);
    }
    return good;
  }

 private:
  std::optional<Measured> measure(double tolerance, bool areas = true) const {
    const Result<Tessellation> plan = Tessellation::make(set_, {.tolerance = tolerance});
    if (!plan) {
      std::printf("  no plan: %s\n", plan.status().message().c_str());
      return {};
    }
    Mesh mesh = test::value_of(plan->allocate());
    if (!plan->run(set_, mesh.views()).ok()) std::abort();
    const std::vector<SurfaceTriangle> triangles = triangles_on_faces(case_, set_, mesh);
    if (areas) {
      const AreaCheck check = check_areas(case_, triangles, plan->bound());
      std::printf("  areas: largest difference %.2e (face %zu); %.2f of what is expected (face %zu)\n", check.worst,
                  check.face, check.expected, check.expected_face);
    }
    return Measured{triangles.size(), meter_.measure(triangles), 0, plan->bound(), tolerance};
  }

  bool holds(const Measured& mesh) const {
    if (mesh.errors.worst() <= mesh.bound + wire_gap_ + 1e-9 * size_) return true;
    std::printf("  VIOLATION: bound %.3e and gap %.1e, but face %zu: %.3e to the face, face %zu: %.3e to the mesh\n",
                mesh.bound / size_, wire_gap_ / size_, mesh.errors.mesh_face, mesh.errors.from_mesh / size_,
                mesh.errors.kept_face, mesh.errors.from_faces / size_);
    return false;
  }

  /// The time from the model to the triangles, in existing memory.
  double seconds(double tolerance) const {
    const Tessellation plan = test::value_of(Tessellation::make(set_, {.tolerance = tolerance}));
    Mesh mesh = test::value_of(plan.allocate());
    MeshViews out = mesh.views();
    out.parameter = {};
    out.patch = {};
    const auto make = [&] {
      return seconds_of([&] {
        const Result<PatchSet> set = make_patch_set(case_.model);
        const auto again = set ? Tessellation::make(*set, {.tolerance = tolerance}) : set.status();
        if (!again || !again->run(*set, out).ok()) std::abort();
      });
    };
    return best_interleaved(3, {make}, 0.02)[0];
  }

  bool measure_occt(double deflection, double angle, Measured& own, Measured& as_read) const {
    std::vector<TopoDS_Face> faces;
    for (const auto& face : case_.faces) faces.push_back(face->face());
    OcctShape shape(case_.shape, faces), shared(case_.as_read, {});
    own.seconds = shape.mesh(deflection, angle, max_seconds);
    if (std::isinf(own.seconds)) return false;
    const bool quick = own.seconds < 0.5;
    if (quick) own.seconds = best_interleaved(3, {[&] { return shape.mesh(deflection, angle); }}, 0.02)[0];
    const std::vector<SurfaceTriangle> triangles = shape.triangles();
    own.triangles = triangles.size();
    own.errors = meter_.measure(triangles);
    const bool same = case_.shape.IsSame(case_.as_read);
    as_read.seconds =
        same ? own.seconds : best_interleaved(quick ? 3 : 1, {[&] { return shared.mesh(deflection, angle); }}, 0.02)[0];
    return true;
  }

  /// About the coarsest mesh whose measured error is at most `error`.
  Measured coarsest(double error, const Measured& known) const {
    std::optional<Measured> best;
    double tolerance = known.tolerance, found = known.errors.worst();
    for (int step = 0; step < 7; ++step) {
      tolerance = std::min(tolerance * std::clamp(0.98 * error / std::max(found, 1e-12 * size_), 0.1, 10.0), size_);
      if (best && !(tolerance > 1.02 * best->tolerance)) break;
      const std::optional<Measured> next = measure(tolerance, false);
      if (!next) break;
      found = next->errors.worst();
      if (found <= error && (!best || next->tolerance > best->tolerance)) best = next;
      if (found <= error && (found > 0.9 * error || next->triangles < 5 * set_.patch_count() / 2)) break;
    }
    return best ? *best : *measure(0.9 * error, false);  // proven to be near enough
  }

  const TrimmedCase& case_;
  PatchSet set_;
  FaceErrorMeter meter_;
  double size_, edge_gap_ = 0, wire_gap_ = 0;
};

bool report(const std::filesystem::path& file, const Options& options) {
  const TrimmedCase one = read_case(file);
  const Comparison comparison(one, options.points);
  comparison.print_head();
  if (options.sides) {
    const SideCheck sides = check_sides(one, points_per_face);
    std::printf(
        "  sides: of %zu points %zu on the border, %zu differ within 1e-6 of it, %zu elsewhere, at most %.1e "
        "from it\n",
        sides.points, sides.borders, sides.near, sides.apart, sides.farthest);
  }
  bool good = true;
  for (const double relative : {1e-3, 1e-4}) good = comparison.compare(relative, options.search) && good;
  std::fflush(stdout);
  return good;
}

int run(Options options) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (options.files.empty() && data == nullptr) throw std::runtime_error("name files, or set TESSERA_TEST_DATA");
  if (options.parts) {
    if (options.files.empty()) options.files = {data, std::filesystem::path(data) / "cad_corpus"};
    compare_parts({options.files, options.only, options.points, options.relative, options.angle});
    return 0;
  }
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  if (options.files.empty())
    for (const char* const file : default_files) options.files.push_back(std::filesystem::path(data) / file);
  std::printf("Errors, tolerances and bounds are shares of the size of the model's box.\n");
  bool good = true;
  for (const std::filesystem::path& file : options.files) {
    if (file.string().find(options.only) == std::string::npos) continue;
    try {
      good = report(file, options) && good;
    } catch (const Standard_Failure& failure) {
      std::printf("%s: OpenCASCADE: %s\n", file.filename().c_str(), failure.GetMessageString());
    } catch (const std::runtime_error& error) {
      std::printf("%s: skipped: %s\n", file.filename().c_str(), error.what());
    }
  }
  return good ? 0 : 1;
}

/// Reads a number above 0. Returns whether it is one; otherwise it says so.
template <class T>
bool read_number(std::string_view option, std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value > 0) return true;
  std::fprintf(stderr, "%s is a number above 0, not '%s'\n", option.data(), text.data());
  return false;
}

/// Reads the arguments but --help. Returns whether they are understood; otherwise it says what is not.
bool read_arguments(int argc, char** argv, Options& options) {
  for (int k = 1; k < argc; ++k) {
    const std::string_view option = argv[k];
    const bool has_value = k + 1 < argc;
    if (option == "--no-sides") {
      options.sides = false;
    } else if (option == "--no-search") {
      options.search = false;
    } else if (option == "--parts") {
      options.parts = true;
    } else if (option == "--only" && has_value) {
      options.only = argv[++k];
    } else if (option == "--points" && has_value) {
      if (!read_number(option, argv[++k], options.points)) return false;
    } else if (option == "--relative" && has_value) {
      if (!read_number(option, argv[++k], options.relative)) return false;
    } else if (option == "--angle" && has_value) {
      if (!read_number(option, argv[++k], options.angle)) return false;
    } else if (option.starts_with('-')) {
      std::fprintf(stderr, "unknown option '%s'\n%s", argv[k], usage);
      return false;
    } else {
      options.files.emplace_back(option);
    }
  }
  return true;
}

}}  // namespace tessera::bench

int main(int argc, char** argv) {
  for (int k = 1; k < argc; ++k)
    if (std::strcmp(argv[k], "--help") == 0 || std::strcmp(argv[k], "-h") == 0)
      return std::fputs(tessera::bench::usage, stdout) < 0;
  tessera::bench::Options options;
  if (!tessera::bench::read_arguments(argc, argv, options)) return 2;
  try {
    return tessera::bench::run(std::move(options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "occt_trimmed_mesh: %s\n", error.what());
  }
  return 1;
}
