// Files that are read in runs: every run is that part of the whole, and errors are those of the whole.

#include "tessera/surface_file.h"
#include "support/real_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>

#include "io/reader_checks.h"
#include "io/spline/surface_index.h"
#include "support/allocations.h"
#include "support/real_files.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;

/// Windows that end within numbers, lines and surfaces; places after every surface, and after few.
constexpr IndexOptions options_of_tests[] = {{1, 0}, {7, 100}, {64, 1}, {1000, 4000}, {1u << 22, 0}, {}};

Model file_part_of(const Model& model, std::size_t first, std::size_t end) {
  Model part;
  part.surfaces.assign(model.surfaces.begin() + std::ptrdiff_t(first), model.surfaces.begin() + std::ptrdiff_t(end));
  return part;
}

/// Reads runs of 1, 2, 3 and more surfaces, in any order.
void expect_runs_of(const SurfaceIndex& index, const Model& whole, const std::string& what) {
  ASSERT_EQ(index.surface_count(), whole.surfaces.size()) << what;
  std::vector<std::pair<std::size_t, std::size_t>> runs{{0, 0}, {0, whole.surfaces.size()}};
  std::size_t length = 1;
  for (std::size_t first = 0; first < whole.surfaces.size(); first += length++)
    runs.emplace_back(first, std::min(first + length, whole.surfaces.size()));
  for (std::size_t k = runs.size(); k-- > 0;) {
    const auto [first, end] = runs[k];
    Result<Model> run = index.read(first, end);
    ASSERT_TRUE(run.ok()) << what << ": " << run.status().message();
    EXPECT_EQ(run->name, index.file().path().stem().string());
    if (k == 1) {
      EXPECT_EQ(run->warnings, whole.warnings) << what;
    }
    run->warnings.clear();
    expect_same(file_part_of(whole, first, end), *run,
                what + ", " + std::to_string(first) + " to " + std::to_string(end));
  }
}

void expect_runs_of(const fs::path& path) {
  const Result<Model> whole = read_model(path);
  for (const IndexOptions& options : options_of_tests) {
    const std::string what = path.string() + ", windows of " + std::to_string(options.window);
    const Result<SurfaceIndex> index = SurfaceIndex::make(path, options);
    ASSERT_EQ(index.ok(), whole.ok()) << what << index.status().message();
    if (index)
      expect_runs_of(*index, *whole, what);
    else
      EXPECT_EQ(index.status().message(), whole.status().message());
  }
}

/// A sheet of `count` patches of degrees 1 to 3.
std::string sheet(std::size_t count, std::string_view line_end = "\n") {
  std::ostringstream text;
  text << count << line_end;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t m = 1 + k % 3, n = 1 + k / 3 % 3;
    text << m << ' ' << n << line_end;
    if (k % 5 == 0) text << "# 1 2 3" << line_end;
    for (std::size_t i = 0; i <= m; ++i)
      for (std::size_t j = 0; j <= n; ++j)
        text << double(k) + double(i) / double(m) << ' ' << double(j) / double(n) << ' ' << std::sin(double(k + i + j))
             << line_end;
  }
  return text.str();
}

/// Spline surfaces, elementary ones and curves, taken from samples of the corpus.
std::string objects() {
  std::string text;
  for (const char* name : {"splines.g2", "elementary.g2", "others.g2", "trimmed.g2", "splines.g2", "others.g2"})
    text += content_of(fs::path(TESSERA_SOURCE_DIR "/tests/corpus/g2") / name);
  return text;
}

TEST(SurfaceFile, RunsAreThoseOfTheWhole) {
  const ScratchFolder folder;
  expect_runs_of(folder.file("one.bpt", sheet(1)));
  expect_runs_of(folder.file("sheet.bpt", sheet(100)));
  expect_runs_of(folder.file("windows.bpt", "\xEF\xBB\xBF# from elsewhere\r\n" + sheet(30, " # 1 2 \r\n\r\n")));
  expect_runs_of(folder.file("line.bpt", "2 1 1 0 0 0 0 1 0 1 0 0 1 1 0 1 1\t1 0 0 1 1 0 2 0 0 2 1 0# end 1 1 1"));
  expect_runs_of(folder.file("objects.g2", objects()));
  std::string windows = "\xEF\xBB\xBF# from elsewhere\r\n";
  for (const char c : objects()) windows += c == '\n' ? std::string(" # 1 2\r\n\r\n") : std::string(1, c);
  expect_runs_of(folder.file("windows.g2", windows));
}

TEST(SurfaceFile, RunsOfStoredFilesAreThoseOfTheWhole) {
  std::vector<fs::path> folders{TESSERA_SOURCE_DIR "/tests/corpus", TESSERA_SOURCE_DIR "/tools/models"};
  if (const char* const data = std::getenv("TESSERA_TEST_DATA")) folders.emplace_back(data);
  std::size_t files = 0;
  for (const fs::path& folder : folders)
    for (const fs::path& file : files_below(folder)) {
      if (file.extension() != ".bpt" && file.extension() != ".g2") continue;
      expect_runs_of(file);
      ++files;
    }
  EXPECT_GE(files, 7u);
}

TEST(SurfaceFile, WarningsAreThoseOfARun) {
  const std::string surface = "200 1 0 0\n3 0\n2 2\n0 0 1 1\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const std::string line = "120 1 0 0\n3\n0 0 0\n1 0 0\n0 0 1\n";
  const ScratchFolder folder;
  const std::string path = folder.file("m.g2", line + surface + surface + line + line + surface + line);
  for (const IndexOptions& options : options_of_tests) {
    const Result<SurfaceIndex> index = SurfaceIndex::make(path, options);
    ASSERT_TRUE(index.ok()) << index.status().message();
    ASSERT_EQ(index->surface_count(), 3u);
    const auto warnings = [&](std::size_t first, std::size_t end) { return index->read(first, end)->warnings; };
    using Sentences = std::vector<std::string>;
    EXPECT_EQ(warnings(0, 1), Sentences{path + ":1: 1 line is not read"});
    EXPECT_EQ(warnings(1, 2), Sentences{});
    EXPECT_EQ(warnings(2, 3), Sentences{path + ":26: 3 lines are not read"});
    EXPECT_EQ(warnings(0, 3), Sentences{path + ":1: 4 lines are not read"});
  }
}

/// Opens and reads all runs of `length`. The first error, or success.
Status status_of_runs(const fs::path& path, const IndexOptions& options, std::size_t length, bool& opened) {
  const Result<SurfaceIndex> index = SurfaceIndex::make(path, options);
  opened = index.ok();
  if (!index) return index.status();
  for (std::size_t first = 0; first < index->surface_count(); first += length) {
    const Result<Model> run = index->read(first, std::min(first + length, index->surface_count()));
    if (!run) return run.status();
  }
  return {};
}

/// A text that is spoiled somehow gives the error of the whole. A coordinate that is no number is found by read(), so
/// that an error of open() may come before.
void expect_errors_of_the_whole(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  const Result<Model> whole = read_model(path);
  for (const IndexOptions& options : {IndexOptions{5, 0}, IndexOptions{}}) {
    bool opened = false;
    const Status status = status_of_runs(path, options, 2, opened);
    ASSERT_EQ(status.ok(), whole.ok()) << text << '\n' << status.message() << '\n' << whole.status().message();
    ASSERT_EQ(status.code(), whole.status().code()) << text;
    if (opened || whole.status().message().find("3 finite numbers") == std::string::npos) {
      ASSERT_EQ(status.message(), whole.status().message()) << text;
    }
  }
}

TEST(SurfaceFile, TruncatedFilesFailAsTheWhole) {
  const ScratchFolder folder;
  const std::string patches = sheet(4), all = objects();
  for (std::size_t bytes = 0; bytes <= patches.size(); ++bytes)
    expect_errors_of_the_whole(folder / "m.bpt", patches.substr(0, bytes));
  for (std::size_t bytes = 0; bytes <= all.size(); bytes += 3)
    expect_errors_of_the_whole(folder / "m.g2", all.substr(0, bytes));
}

TEST(SurfaceFile, SpoiledFilesFailAsTheWhole) {
  const ScratchFolder folder;
  std::mt19937 random(7);
  const std::string likely = "0123456789.-+eE \n#nai", patches = sheet(4), all = objects();
  for (int k = 0; k < 600; ++k)
    for (const auto& [name, sample] : {std::pair("m.bpt", patches), std::pair("m.g2", all)}) {
      std::string text = sample;
      for (int n = 0; n < 2; ++n) text[random() % text.size()] = likely[random() % likely.size()];
      expect_errors_of_the_whole(folder / name, text);
    }
}

TEST(SurfaceFile, WrongCountsAreErrorsOfOpen) {
  const ScratchFolder folder;
  std::string text = sheet(3);
  text[0] = '4';
  const std::string path = folder.file("m.bpt", text);
  EXPECT_EQ(SurfaceFile::open(path).status().message(), read_model(path).status().message());
  EXPECT_NE(read_model(path).status().message().find("found the end of the file"), std::string::npos);
  text[0] = '2';
  folder.file("m.bpt", text);
  EXPECT_EQ(SurfaceFile::open(path).status().message(), read_model(path).status().message());
  folder.file("m.bpt", "1000000000000\n1 1\n0 0 0\n");
  EXPECT_EQ(SurfaceFile::open(path).status().message(),
            path + ":3: the file ends after 1 of 4 control points of patch 1 of 1000000000000");
}

TEST(SurfaceFile, NotFiniteNumbersAreErrorsOfTheirRun) {
  const ScratchFolder folder;
  std::string text = sheet(50);
  const std::size_t bad = text.rfind(" 0.5 ");
  ASSERT_NE(bad, std::string::npos);
  text.replace(bad, 5, " nan ");
  const std::string path = folder.file("m.bpt", text);
  const Result<SurfaceFile> file = SurfaceFile::open(path);
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(file->read(0, 40).ok());
  EXPECT_EQ(file->read(0, 50).status().message(), read_model(path).status().message());
  EXPECT_EQ(file->read(0, 50).status().code(), StatusCode::parse_error);
}

TEST(SurfaceFile, AChangedFileIsAnError) {
  const ScratchFolder folder;
  const std::string path = folder.file("m.bpt", sheet(50));
  const Result<SurfaceFile> file = SurfaceFile::open(path);
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(file->read(45, 50).ok());
  fs::resize_file(path, 1000);
  for (const std::size_t first : {0u, 45u}) {
    const Status status = file->read(first, first + 5).status();
    EXPECT_EQ(status.code(), StatusCode::io_error);
    EXPECT_EQ(status.message(), path + ": the file has changed since it was opened");
  }
  fs::remove(path);
  EXPECT_FALSE(file->read(0, 1).ok());
}

TEST(SurfaceFile, AFileThatIsReplacedIsReadOn) {
  const ScratchFolder folder;
  const std::string path = folder.file("m.bpt", sheet(50)), other = folder.file("n.bpt", sheet(3));
  const Result<SurfaceFile> file = SurfaceFile::open(path);
  ASSERT_TRUE(file.ok());
  fs::rename(other, path);
  EXPECT_TRUE(file->read(0, 50).ok());
}

TEST(SurfaceFile, OtherFilesAreNamed) {
  const ScratchFolder folder;
  const auto error_of = [&](const std::string& path) { return SurfaceFile::open(path).status(); };
  EXPECT_EQ(error_of(folder / "none.bpt").message(), folder / "none.bpt: cannot be opened: No such file or directory");
  EXPECT_EQ(error_of(folder.path().string()).message(), folder.path().string() + ": is a directory, not a file");
  EXPECT_EQ(error_of(folder.file("a.bpt", "")).message(), folder / "a.bpt: the file is empty");
  EXPECT_EQ(error_of(folder.file("a.obj", "v")).message(),
            folder / "a.obj: unsupported format \".obj\": surfaces are read in runs from .bpt, .g2");
  const std::string packed = folder / "a.bpt: a file packed by gzip cannot be read in runs: unpack it first";
  EXPECT_EQ(error_of(folder.file("a.bpt", "\x1f\x8b\x08")).message(), packed);
  EXPECT_EQ(error_of(folder.file("a.bpt.gz", "\x1f\x8b\x08")).code(), StatusCode::unsupported);
  ASSERT_EQ(::mkfifo((folder / "pipe.bpt").c_str(), 0600), 0);
  EXPECT_EQ(error_of(folder / "pipe.bpt").message(),
            folder / "pipe.bpt: is not a regular file, so it cannot be read in runs");
  EXPECT_EQ(error_of(folder.file("a.g2", "# nothing\n")).message(),
            folder / "a.g2:1: expected an object, found the end of the file");
}

TEST(SurfaceFile, RunsBeyondTheFileAreErrors) {
  const ScratchFolder folder;
  const Result<SurfaceFile> file = SurfaceFile::open(folder.file("m.bpt", sheet(5)));
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->size(), 5u);
  EXPECT_EQ(file->bytes(), fs::file_size(file->path()));
  for (const auto& [first, end] : {std::pair(0u, 6u), {3u, 2u}, {6u, 6u}})
    EXPECT_EQ(file->read(first, end).status().code(), StatusCode::invalid_argument);
  EXPECT_TRUE(file->read(5, 5)->surfaces.empty());
}

TEST(SurfaceFile, ThreadsReadAtOnce) {
  const ScratchFolder folder;
  const std::string path = folder.file("m.bpt", sheet(3000));
  const Result<Model> whole = read_model(path);
  const Result<SurfaceIndex> index = SurfaceIndex::make(path, {5000, 2000});
  ASSERT_TRUE(whole.ok() && index.ok());
  std::vector<Result<Model>> runs(6, Status(StatusCode::internal, "not read"));
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < runs.size(); ++k)
    threads.emplace_back([&, k] { runs[k] = index->read(500 * k, 500 * (k + 1)); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    ASSERT_TRUE(runs[k].ok());
    expect_same(file_part_of(*whole, 500 * k, 500 * (k + 1)), *runs[k], "thread " + std::to_string(k));
  }
}

TEST(SurfaceFile, MemoryIsThatOfARun) {
  const ScratchFolder folder;
  const std::string path = folder.file("m.bpt", sheet(100000));
  const std::uint64_t bytes = fs::file_size(path);
  ASSERT_GT(bytes, std::uint64_t{16} << 20);
  std::size_t before = restart_peak();
  const Result<SurfaceFile> file = SurfaceFile::open(path);
  ASSERT_TRUE(file.ok());
  EXPECT_LT(peak_bytes() - before, std::size_t{5} << 20);
  before = restart_peak();
  ASSERT_TRUE(file->read(90000, 91000).ok());
  EXPECT_LT(peak_bytes() - before, std::size_t{6} << 20);
}

}}  // namespace tessera::test
