// Text in memory to a model: read/bpt and read/obj, about 20 MB each, of numbers with 7 digits. Every control point is
// compared with the number that was written before the rate is reported; memcpy_fraction is the time to copy the text,
// measured in the same process, over the time to read it.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "tessera/io.h"

namespace tessera::bench {
namespace {

constexpr std::size_t text_size = 20'000'000;

struct Text {
  std::string bytes;
  std::vector<Vec3> points;  ///< as they stand in the text, in order

  void add(double value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 7);
    bytes.append(digits, end);
    bytes += ' ';
  }
  /// A point of a wavy field; what is kept is the number that the digits mean.
  void add_point() {
    const double k = static_cast<double>(points.size());
    Vec3 p{std::sin(0.7 * k) * 12, std::cos(1.3 * k) * 150, 1e-3 * k};
    for (double* const value : {&p.x, &p.y, &p.z}) {
      const std::size_t begin = bytes.size();
      add(*value);
      std::from_chars(bytes.data() + begin, bytes.data() + bytes.size(), *value);
    }
    bytes.back() = '\n';
    points.push_back(p);
  }
};

/// Bicubic patches.
Text bpt_text() {
  Text text;
  std::size_t patches = 0;
  for (; text.bytes.size() < text_size; ++patches) {
    text.bytes += "3 3\n";
    for (int k = 0; k < 16; ++k) text.add_point();
  }
  text.bytes.insert(0, std::to_string(patches) + "\n");
  return text;
}

/// Bicubic B-spline surfaces of 32 x 32 control points.
Text obj_text() {
  constexpr int count = 32;
  Text text;
  while (text.bytes.size() < text_size) {
    for (int k = 0; k < count * count; ++k) {
      text.bytes += "v ";
      text.add_point();
    }
    text.bytes += "cstype bspline\ndeg 3 3\nsurf 3 32 3 32";
    const std::size_t last = text.points.size();
    for (std::size_t k = last - count * count + 1; k <= last; ++k) text.bytes += " " + std::to_string(k);
    for (const char* direction : {"\nparm u", "\nparm v"}) {
      text.bytes += direction;
      for (int k = 0; k < count + 4; ++k) text.bytes += " " + std::to_string(k);
    }
    text.bytes += "\nend\n";
  }
  return text;
}

bool holds(const Model& model, const Text& text) {
  std::size_t begin = 0;
  for (const ModelSurface& surface : model.surfaces) {
    if (const auto* const patch = std::get_if<BezierPatch>(&surface.surface)) {
      const auto points = patch->points();
      if (!std::equal(points.begin(), points.end(), text.points.begin() + std::ptrdiff_t(begin))) return false;
      begin += points.size();
    } else {  // u runs first in the file, v in the surface
      const auto& spline = std::get<BSplineSurface>(surface.surface);
      for (std::size_t j = 0; j < spline.count_v(); ++j)
        for (std::size_t i = 0; i < spline.count_u(); ++i)
          if (!(spline.point(i, j) == text.points[begin++])) return false;
    }
  }
  return begin == text.points.size();
}

double seconds_to_copy(const std::string& bytes) {
  std::string copy(bytes.size(), ' ');
  double best = 1e9;
  for (int k = 0; k < 8; ++k) {
    const auto start = std::chrono::steady_clock::now();
    std::memcpy(copy.data(), bytes.data(), bytes.size());
    benchmark::DoNotOptimize(copy.data());
    benchmark::ClobberMemory();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

void read(benchmark::State& state, const Text& text, Result<Model> (*parse)(std::string_view, std::string_view)) {
  const Result<Model> checked = parse(text.bytes, "text");
  if (!checked) return state.SkipWithError(checked.status().message().c_str());
  if (!holds(*checked, text)) return state.SkipWithError("the model is not what the text says");
  for (auto _ : state) {
    const Result<Model> model = parse(text.bytes, "text");
    benchmark::DoNotOptimize(model->surfaces.data());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(text.bytes.size()));
  state.counters["memcpy_fraction"] =
      benchmark::Counter(seconds_to_copy(text.bytes), benchmark::Counter::kIsIterationInvariantRate);
}

void read_bpt(benchmark::State& state) {
  static const Text text = bpt_text();
  read(state, text, parse_bpt);
}
BENCHMARK(read_bpt)->Name("read/bpt")->Unit(benchmark::kMillisecond);

void read_obj(benchmark::State& state) {
  static const Text text = obj_text();
  read(state, text, parse_obj_freeform);
}
BENCHMARK(read_obj)->Name("read/obj")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tessera::bench
