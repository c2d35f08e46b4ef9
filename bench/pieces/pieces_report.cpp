// Models larger than memory: what it takes to open a file of patches, and to read it in runs.
//
//   tessera_pieces_report ROWS COLUMNS [RUNS]   makes a sheet of ROWS x COLUMNS patches in the temporary folder
//   tessera_pieces_report ROWS COLUMNS FILE     only makes the file

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "pieces/wavy_sheet.h"
#include "tessera/surface_file.h"

namespace tessera::bench { namespace {

namespace fs = std::filesystem;

double seconds_of(const auto& run) {
  const auto begin = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double peak_megabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

int fail(const Status& status) {
  std::fprintf(stderr, "tessera_pieces_report: %s\n", status.message().c_str());
  return 1;
}

int report(const fs::path& path, std::size_t runs) {
  Result<SurfaceFile> file = Status(StatusCode::internal, "not opened");
  const double opening = seconds_of([&] { file = SurfaceFile::open(path); });
  if (!file) return fail(file.status());
  const double megabytes = double(file->bytes()) / 1e6, patches = double(file->size());
  std::printf("open: %.0f patches, %.0f MB in %.2f s (%.0f MB/s), peak %.0f MB\n", patches, megabytes, opening,
              megabytes / opening, peak_megabytes());
  std::size_t surfaces = 0;
  Status status;
  const double reading = seconds_of([&] {
    for (std::size_t k = 0; k < runs && status.ok(); ++k) {
      const Result<Model> run = file->read(file->size() * k / runs, file->size() * (k + 1) / runs);
      if (run) surfaces += run->surfaces.size();
      status = run.status();
    }
  });
  if (!status.ok()) return fail(status);
  if (surfaces != file->size()) return fail({StatusCode::internal, "runs are not the whole"});
  std::printf("read: %zu runs in %.2f s (%.0f MB/s), peak %.0f MB\n", runs, reading, megabytes / reading,
              peak_megabytes());
  return 0;
}

int run(int argc, char** argv) {
  if (argc < 3 || argc > 4) return fail({StatusCode::invalid_argument, "expected ROWS COLUMNS [RUNS or FILE]"});
  const std::size_t rows = std::strtoull(argv[1], nullptr, 10), columns = std::strtoull(argv[2], nullptr, 10);
  const std::string last = argc > 3 ? argv[3] : "10";
  const bool only_file = last.find_first_not_of("0123456789") != std::string::npos;
  const fs::path path = only_file ? fs::path(last) : fs::temp_directory_path() / "tessera_pieces_report.bpt";
  Status status;
  const double writing = seconds_of([&] { status = write_wavy_sheet(path, rows, columns); });
  if (!status.ok()) return fail(status);
  std::printf("made %s in %.1f s\n", path.c_str(), writing);
  if (only_file) return 0;
  const int failed = report(path, std::max<std::size_t>(1, std::strtoull(last.c_str(), nullptr, 10)));
  fs::remove(path);
  return failed;
}

}}  // namespace tessera::bench

int main(int argc, char** argv) { return tessera::bench::run(argc, argv); }
