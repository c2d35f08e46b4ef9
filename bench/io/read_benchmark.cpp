// Reads text in memory into a model: read.bpt, bv, g2, json, obj and rib, about 20 MB each (1 MB where instructions are
// counted), of numbers with 7 digits. Every control point is compared with the number that was written before the rate
// is reported. memcpy_fraction is the time to copy the text, measured in the same process, over the time to read it.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "suite.h"
#include "tessera/io.h"
#include "timing.h"

namespace tessera::bench { namespace {

struct Text {
  std::string bytes;
  std::vector<Vec3> points;  ///< in the order of the text

  /// Appends the digits of the value, and rounds the value to them.
  void add(double& value) {
    char digits[32];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 7);
    std::from_chars(digits, end, value);
    bytes.append(digits, end);
  }
  /// A point of a wavy field.
  void add_point(std::string_view between = " ", std::string_view end = "\n") {
    const double k = static_cast<double>(points.size());
    Vec3 p{std::sin(0.7 * k) * 12, std::cos(1.3 * k) * 150, 1e-3 * k};
    add(p.x);
    bytes += between;
    add(p.y);
    bytes += between;
    add(p.z);
    bytes += end;
    points.push_back(p);
  }
  void add_knots(int count) {
    for (int k = 0; k < count; ++k) bytes += " " + std::to_string(k);
  }
};

/// Bicubic patches.
Text bpt_text(std::size_t text_size) {
  Text text;
  std::size_t patches = 0;
  for (; text.bytes.size() < text_size; ++patches) {
    text.bytes += "3 3\n";
    for (int k = 0; k < 16; ++k) text.add_point();
  }
  text.bytes.insert(0, std::to_string(patches) + "\n");
  return text;
}

/// Bicubic patches in groups of 100.
Text bv_text(std::size_t text_size) {
  Text text;
  for (std::size_t patches = 0; text.bytes.size() < text_size; ++patches) {
    if (patches % 100 == 0) text.bytes += "Group 0 wave" + std::to_string(patches) + "\n";
    text.bytes += "5\n3 3\n";
    for (int k = 0; k < 16; ++k) text.add_point();
  }
  return text;
}

/// Bicubic patches, a row of points per line of text.
Text json_text(std::size_t text_size) {
  Text text{R"({"format": "tessera", "version": 1, "surfaces": [)", {}};
  while (text.bytes.size() < text_size) {
    text.bytes += text.points.empty() ? "\n" : ",\n";
    text.bytes += R"({"kind": "bezier", "points": [)";
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        text.bytes += j == 0 ? "[[" : ", [";
        text.add_point(", ", "]");
      }
      text.bytes += i < 3 ? "],\n" : "]";
    }
    text.bytes += "]}";
  }
  text.bytes += "]}\n";
  return text;
}

/// Control points along each direction of B-spline surfaces.
constexpr int count = 32;

/// Bicubic B-spline surfaces.
Text g2_text(std::size_t text_size) {
  Text text;
  while (text.bytes.size() < text_size) {
    text.bytes += "200 1 0 0\n3 0\n";
    for (int direction = 0; direction < 2; ++direction) {
      text.bytes += std::to_string(count) + " 4\n";
      text.add_knots(count + 4);
      text.bytes += "\n";
    }
    for (int k = 0; k < count * count; ++k) text.add_point();
  }
  return text;
}

/// Bicubic patches and meshes of bicubic B-splines.
Text rib_text(std::size_t text_size) {
  Text text;
  const std::string size = std::to_string(count);
  while (text.bytes.size() < text_size) {
    for (int patches = 0; patches < 16; ++patches) {
      text.bytes += "Basis \"bezier\" 3 \"bezier\" 3\nPatch \"bicubic\" \"P\" [";
      for (int k = 0; k < 16; ++k) text.add_point();
      text.bytes += "]\n";
    }
    text.bytes += "Basis \"b-spline\" 1 \"b-spline\" 1\nPatchMesh \"bicubic\" " + size + " \"nonperiodic\" " + size +
                  " \"nonperiodic\" \"P\" [";
    for (int k = 0; k < count * count; ++k) text.add_point();
    text.bytes += "]\n";
  }
  return text;
}

/// Bicubic B-spline surfaces.
Text obj_text(std::size_t text_size) {
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
      text.add_knots(count + 4);
    }
    text.bytes += "\nend\n";
  }
  return text;
}

/// Compares the points. A patch's points run along v first in its file, unless `patches_transposed`; those of splines
/// run along u first in every file, while v runs first in the surface.
bool holds(const Model& model, const Text& text, bool patches_transposed) {
  std::size_t begin = 0;
  for (const ModelSurface& surface : model.surfaces) {
    if (const auto* const patch = std::get_if<BezierPatch>(&surface.surface)) {
      for (int i = 0; i <= patch->degree_u(); ++i)
        for (int j = 0; j <= patch->degree_v(); ++j)
          if (!((patches_transposed ? patch->point(j, i) : patch->point(i, j)) == text.points[begin++])) return false;
    } else {
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
    best = std::min(best, seconds_since(start));
  }
  return best;
}

using Parser = Result<Model> (*)(std::string_view, std::string_view);

void read(benchmark::State& state, const Text& text, Parser parse, bool patches_transposed) {
  {
    const Result<Model> checked = parse(text.bytes, "text");
    if (!checked) return state.SkipWithError(checked.status().message().c_str());
    if (!holds(*checked, text, patches_transposed)) return state.SkipWithError("the model is not what the text says");
  }
  const auto best = time_calls(state, 1, [&] { return parse(text.bytes, "text").status(); });
  if (!best) return;
  report_rates(state, *best, static_cast<double>(text.points.size()), static_cast<double>(text.bytes.size()));
  state.counters["memcpy_fraction"] = seconds_to_copy(text.bytes) / *best;
}

void add_read(const char* format, const char* surface, Text (*make)(std::size_t), Parser parse,
              bool patches_transposed = false) {
  for (const std::size_t megabytes : {20, 1})
    add_case({std::string("read.") + format, surface, "3", std::to_string(megabytes) + "MB"},
             megabytes == 20 ? Part::quick : Part::full,
             [=](benchmark::State& state) { read(state, make(megabytes * 1'000'000), parse, patches_transposed); });
}

const bool registered = [] {
  add_read("bpt", "bicubic", bpt_text, parse_bpt);
  add_read("bv", "bicubic", bv_text, parse_bv);
  add_read("g2", "bspline", g2_text, parse_g2);
  add_read("json", "bicubic", json_text, parse_json_model);
  add_read("obj", "bspline", obj_text, parse_obj_freeform);
  add_read("rib", "bicubic", rib_text, parse_rib, true);
  return true;
}();

}}  // namespace tessera::bench
