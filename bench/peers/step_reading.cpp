// STEP files read by Tessera and by OpenCASCADE's STEPCAFControl_Reader (names and colours on), one thread each, taking
// turns: from the file to the model, and from the file to a .glb of its meshes.
//
// Each file has a process of its own, as OpenCASCADE crashes on some. Before a time counts, the results are compared:
// the number of faces, the area of all, and whether Tessera's meshes of closed shapes are closed. Files that
// OpenCASCADE cannot read, and those whose results differ, are listed and are in no ratio. Both meshers get the same
// tolerance, which only Tessera proves.
//
// Files of a few megabytes, assembled of the others, show the time of two threads and the memory at its peak.

#include <malloc.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "peers/child_result.h"
#include "peers/file_arguments.h"
#include "peers/interleaved.h"
#include "peers/joined_shape.h"
#include "peers/joined_step.h"
#include "peers/results.h"
#include "peers/step_opencascade.h"
#include "support/real_files.h"
#include "support/scratch_folder.h"
#include "support/synthetic_sets.h"
#include "tessera/cad.h"
#include "tessera/io.h"
#include "tessera/measures.h"
#include "tessera/mesh_assembly.h"
#include "tessera/tessellation.h"

namespace tessera::bench { namespace {

namespace fs = std::filesystem;
using test::value_of;

constexpr char usage[] =
    "tessera_peer_step_reading [FILE...]\n\n"
    "STEP files read by Tessera and by OpenCASCADE, one thread each.\n"
    "Without files: all of the folder TESSERA_TEST_DATA. About 5 minutes.\n"
    "Exit status 1 if the mesh of a closed shape has an open edge.\n";

constexpr double relative_tolerance = 1e-3;  // of the model's size
constexpr double equal_area = 1e-3;          // as a share
constexpr unsigned seconds_per_file = 120;

/// The result of one file.
struct Times {
  double read[2] = {}, glb[2] = {};  ///< seconds: Tessera, OpenCASCADE
  double area[2] = {};
  std::size_t faces[2] = {}, triangles[2] = {};
  std::size_t open_edges = 0;  ///< of Tessera's meshes of closed shapes
};

Model read_own(const fs::path& file) {
  Result<Model> model = read_cad(file, {.step_reader = StepReader::tessera});
  if (!model) throw std::runtime_error("Tessera: " + model.status().message());
  return *std::move(model);
}

/// The meshes of a model, as the command line makes them.
MeshAssembly meshes_of(const Model& model, double tolerance) {
  MeshAssembly assembly = value_of(instances_of(model));
  for (std::size_t k = 0; k < model.shapes.size(); ++k) {
    const Shape shape = joined_shape(model.shapes[k]);
    const PatchSet set = value_of(make_patch_set(shape));
    const Tessellation plan = value_of(Tessellation::make(set, {.tolerance = tolerance}));
    Mesh& mesh = assembly.shapes[k].mesh = value_of(plan.allocate());
    if (!plan.run(set, mesh.views()).ok()) std::abort();
    mesh.parts = value_of(parts_by_face(mesh, set, shape));
  }
  return assembly;
}

/// Compares what both read and make of a file.
void compare_results(const fs::path& file, const fs::path& glb, double& tolerance, Times& times) {
  StepDocument theirs(file);
  const Model ours = read_own(file);
  times.faces[0] = ours.surfaces.size(), times.faces[1] = theirs.faces();
  times.area[0] = value_of(measure_surfaces(ours, {.accuracy = 1e-6})).total.area.value;
  times.area[1] = theirs.area();
  tolerance = relative_tolerance * theirs.box().diagonal();
  if (!(tolerance > 0)) throw std::runtime_error("OpenCASCADE finds no extent in " + file.string());
  const MeshAssembly made = meshes_of(ours, tolerance);
  for (const MeshInstance& instance : made.instances)
    times.triangles[0] += made.shapes[instance.shape].mesh.triangle_count();
  for (std::size_t k = 0; k < ours.shapes.size(); ++k)
    if (is_closed(ours.shapes[k])) times.open_edges += value_of(check(made.shapes[k].mesh)).open_edges;
  times.triangles[1] = theirs.write_glb(tolerance, glb);
}

Times times_of(const fs::path& file, const fs::path& glb) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  Times times;
  double tolerance = 0;
  compare_results(file, glb, tolerance, times);
  const auto own_read = [&] { return seconds_of([&] { (void)read_own(file); }); };
  const auto read = [&] { return seconds_of([&] { StepDocument document(file); }); };
  // Each writes a new file: to replace one, ext4 first writes the new blocks to the disk, 0.2 ms.
  const auto own_glb = [&] {
    fs::remove(glb);
    return seconds_of([&] {
      if (!write_assembly(meshes_of(read_own(file), tolerance), glb).ok()) std::abort();
    });
  };
  const auto with_glb = [&] {
    fs::remove(glb);
    return seconds_of([&] { StepDocument(file).write_glb(tolerance, glb); });
  };
  const std::vector<double> reading = best_interleaved(3, {own_read, read}, 0.02);
  const std::vector<double> whole = best_interleaved(2, {own_glb, with_glb}, 0.01);
  for (std::size_t k = 0; k < 2; ++k) times.read[k] = reading[k], times.glb[k] = whole[k];
  return times;
}

/// A row of the table, with the ratios of the files that count.
struct Row {
  std::string name;
  Times times;
};

/// Whether both read the same.
bool agrees(const Times& times) {
  const double larger = std::max(times.area[0], times.area[1]);
  return times.faces[0] == times.faces[1] && std::abs(times.area[0] - times.area[1]) <= equal_area * larger;
}

void print_row(const Row& row) {
  const Times& t = row.times;
  std::printf("%-62s %6zu | %9.3f %9.3f %7.1f | %9.2f %9.2f %7.1f | %8zu %8zu\n", row.name.c_str(), t.faces[0],
              1e3 * t.read[0], 1e3 * t.read[1], t.read[1] / t.read[0], 1e3 * t.glb[0], 1e3 * t.glb[1],
              t.glb[1] / t.glb[0], t.triangles[0], t.triangles[1]);
  std::fflush(stdout);
}

/// Prints the ratios of all rows: the quarters, the least with its file, and that of the sums.
void print_ratios(const char* what, const std::vector<Row>& rows, const double (Times::*member)[2]) {
  std::vector<std::pair<double, std::string>> ratios;
  double sums[2] = {};
  for (const Row& row : rows) {
    const double(&seconds)[2] = row.times.*member;
    ratios.emplace_back(seconds[1] / seconds[0], row.name);
    sums[0] += seconds[0], sums[1] += seconds[1];
  }
  std::ranges::sort(ratios);
  const auto at = [&](double share) {
    return ratios[static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1))].first;
  };
  std::printf(
      "%s, OpenCASCADE's time over Tessera's, %zu files: median %.1f, a quarter below %.1f, least %.2f (%s), largest "
      "%.0f; sums %.3f s and %.3f s: %.1f\n",
      what, rows.size(), at(0.5), at(0.25), ratios[0].first, ratios[0].second.c_str(), ratios.back().first, sums[1],
      sums[0], sums[1] / sums[0]);
  add_result({what, "OpenCASCADE", "STEPCAFControl_Reader", static_cast<double>(rows.size()) / sums[1],
              "median of the files", at(0.5)});
}

/// A figure of the process's memory, such as "VmHWM:", in bytes.
double memory(std::string_view key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kilobytes = 0; word == key && status >> kilobytes) return 1024 * kilobytes;
  return 0;
}

/// The memory that `work` takes at its peak, in a process of its own.
template <class Work>
ChildResult<double> peak_of(Work&& work) {
  return in_child<double>(seconds_per_file, [&] {
    const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    const double before = memory("VmRSS:");
    work();
    return memory("VmHWM:") - before;
  });
}

/// One reading of a large file.
struct Reading {
  double seconds = 0;  ///< by the wall clock
  std::size_t faces = 0;
};

ChildResult<Reading> read_by_threads(const fs::path& file, std::size_t threads) {
  return in_child<Reading>(seconds_per_file, [&] {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Reading reading;
    const auto task = [&] { return wall_seconds_of([&] { reading.faces = read_own(file).surfaces.size(); }); };
    reading.seconds = best_interleaved(5, {task}, 1e-6)[0];
    return reading;
  });
}

ChildResult<Reading> read_by_opencascade(const fs::path& file) {
  return in_child<Reading>(seconds_per_file, [&] {
    Reading reading;
    reading.seconds = wall_seconds_of([&] { reading.faces = StepDocument(file).faces(); });
    return reading;
  });
}

/// Reads files that are assembled of others.
void report_large(const std::vector<fs::path>& files) {
  const test::ScratchFolder folder;
  for (const std::size_t size : {5'000'000u, 20'000'000u}) {
    const fs::path file = folder.file("joined.step", joined_step(files, size));
    const double bytes = static_cast<double>(fs::file_size(file));
    malloc_trim(0);  // or else the processes would find free memory that is counted already
    const ChildResult<Reading> one = read_by_threads(file, 1), two = read_by_threads(file, 2),
                               theirs = read_by_opencascade(file);
    const ChildResult<double> peak = peak_of([&] { (void)read_own(file); });
    const ChildResult<double> peer_peak = peak_of([&] { StepDocument document(file); });
    for (const std::string* const failure :
         {&one.failure, &two.failure, &theirs.failure, &peak.failure, &peer_peak.failure})
      if (!failure->empty()) std::printf("  a process of the file below: %s\n", failure->c_str());
    std::printf(
        "%.1f MB: %zu faces in %.3f s by one thread (%.1f MB/s), %.2f times as fast by two; OpenCASCADE %zu faces in "
        "%.2f s; memory at the peak over the file's size %.1f, OpenCASCADE's %.1f\n",
        1e-6 * bytes, one.value.faces, one.value.seconds, 1e-6 * bytes / one.value.seconds,
        one.value.seconds / two.value.seconds, theirs.value.faces, theirs.value.seconds, peak.value / bytes,
        peer_peak.value / bytes);
    std::fflush(stdout);
  }
}

/// Returns whether no mesh of a closed shape is open.
bool run(std::vector<fs::path> files) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (files.empty() && data != nullptr) files = test::step_files_below(data);
  if (files.empty()) throw std::runtime_error("name files, or set TESSERA_TEST_DATA");
  std::printf("%-62s %6s | %-27s | %-27s | %s\n", "", "", "reading: ms, OpenCASCADE's", "to .glb: ms, OpenCASCADE's",
              "triangles, OpenCASCADE's");
  const test::ScratchFolder folder;
  std::vector<Row> rows;
  std::vector<fs::path> large;
  bool good = true;
  for (const fs::path& file : files) {
    const ChildResult<Times> found =
        in_child<Times>(seconds_per_file, [&] { return times_of(file, folder / "mesh.glb"); });
    const std::string name = (file.parent_path().filename() / file.filename()).string();
    if (!found.failure.empty()) {
      std::printf("left out: %s: %s\n", name.c_str(), found.failure.c_str());
      continue;
    }
    const Times& times = found.value;
    if (times.open_edges > 0) std::printf("%s: %zu open edges\n", name.c_str(), times.open_edges);
    good = good && times.open_edges == 0;
    if (!agrees(times)) {
      std::printf("left out: %s: Tessera reads %zu faces of area %.8g, OpenCASCADE %zu of %.8g\n", name.c_str(),
                  times.faces[0], times.area[0], times.faces[1], times.area[1]);
      continue;
    }
    rows.push_back({name.substr(name.size() > 62 ? name.size() - 62 : 0), times});
    print_row(rows.back());
    if (fs::file_size(file) > 100'000) large.push_back(file);
  }
  if (rows.empty()) return good;
  print_ratios("reading of STEP", rows, &Times::read);
  print_ratios("STEP to .glb", rows, &Times::glb);
  if (!large.empty()) report_large(large);
  return good;
}

}}  // namespace tessera::bench

int main(int argc, char** argv) {
  try {
    return tessera::bench::run(tessera::bench::file_arguments(argc, argv, tessera::bench::usage)) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "step_reading: %s\n", error.what());
  }
  return 1;
}
