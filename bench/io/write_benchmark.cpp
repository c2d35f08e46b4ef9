// Writes meshes to files: write.ply, glb, stl and obj, of a mesh of two million triangles, into the folder that
// TMPDIR names. Each file is read back and compared before the rate is reported. disk_fraction is the time of write(2)
// for the same bytes, in pieces of a MiB as dd writes them, in the same process and folder, over the time of
// write_mesh; synced_fraction is the same with fsync(2) after both.

#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "suite.h"
#include "tessera/io.h"
#include "timing.h"

namespace tessera::bench { namespace {

namespace fs = std::filesystem;

/// A wavy sheet of 1000 x 1000 cells.
Mesh sheet() {
  constexpr std::uint32_t side = 1001;
  Mesh mesh;
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t j = 0; j < side; ++j) {
      const float x = 0.01f * static_cast<float>(i), y = 0.01f * static_cast<float>(j), slope = 0.3f * std::cos(3 * x);
      const float scale = 1 / std::sqrt(1 + slope * slope);
      mesh.positions.insert(mesh.positions.end(), {x, y, 0.1f * std::sin(3 * x)});
      mesh.normals.insert(mesh.normals.end(), {-slope * scale, 0, scale});
      mesh.parameters.insert(mesh.parameters.end(), {0.1f * x, 0.1f * y});
      if (i + 1 == side || j + 1 == side) continue;
      const std::uint32_t a = i * side + j, b = a + side;
      mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
      mesh.patches.insert(mesh.patches.end(), {i / 10, i / 10});
    }
  return mesh;
}

class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "tessera-bench-XXXXXX").string();
    if (!::mkdtemp(name.data())) std::abort();
    path_ = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

bool sync(const fs::path& path) {
  const int file = ::open(path.c_str(), O_WRONLY);
  return file >= 0 && ::fsync(file) == 0 && ::close(file) == 0;
}

bool write_bytes(const fs::path& path, const std::string& bytes) {
  constexpr std::size_t piece = std::size_t{1} << 20;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0) return false;
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t sent = ::write(file, bytes.data() + at, std::min(piece, bytes.size() - at));
    if (sent <= 0) return false;
    at += static_cast<std::size_t>(sent);
  }
  return ::close(file) == 0;
}

template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The best times of both, taken alternately, each into a new file.
struct Times {
  double bytes = 1e9, mesh = 1e9;
};
Times measure(const Mesh& mesh, const fs::path& path, const std::string& bytes, bool synced, int turns) {
  Times best;
  bool good = true;
  for (int k = 0; k < turns; ++k) {
    fs::remove(path);
    best.bytes = std::min(best.bytes, seconds_of([&] { good &= write_bytes(path, bytes) && (!synced || sync(path)); }));
    fs::remove(path);
    best.mesh =
        std::min(best.mesh, seconds_of([&] { good &= write_mesh(mesh, path).ok() && (!synced || sync(path)); }));
  }
  if (!good) std::abort();
  return best;
}

bool same_corners(const Mesh& a, const Mesh& b) {
  if (a.indices.size() != b.indices.size()) return false;
  for (std::size_t k = 0; k < a.indices.size(); ++k)
    if (!std::equal(&a.positions[3 * a.indices[k]], &a.positions[3 * a.indices[k]] + 3, &b.positions[3 * b.indices[k]]))
      return false;
  return true;
}

void write(benchmark::State& state, const char* name) {
  static const Mesh mesh = sheet();
  const Folder folder;
  const fs::path path = folder / name;
  if (const Status status = write_mesh(mesh, path); !status.ok()) return state.SkipWithError(status.message().c_str());
  const Result<Mesh> read = read_mesh(path);
  if (!read || !same_corners(mesh, *read)) return state.SkipWithError("the file is not the mesh");
  std::ifstream file(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const auto best = time_calls(state, 1, [&] {
    fs::remove(path);
    return write_mesh(mesh, path);
  });
  if (!best) return;
  const Times cached = measure(mesh, path, bytes, false, 12), synced = measure(mesh, path, bytes, true, 4);
  report_rates(state, *best, static_cast<double>(mesh.triangle_count()), static_cast<double>(bytes.size()));
  state.counters["disk_fraction"] = cached.bytes / cached.mesh;
  state.counters["synced_fraction"] = synced.bytes / synced.mesh;
  state.counters["disk_MB/s"] = static_cast<double>(bytes.size()) / cached.bytes * 1e-6;
}

const bool registered = [] {
  for (const char* name : {"m.ply", "m.glb", "m.stl", "m.obj"})
    add_case({std::string("write.") + (name + 2), "mesh", "-", "2M"}, Part::full,
             [name](benchmark::State& state) { write(state, name); });
  return true;
}();

}}  // namespace tessera::bench
