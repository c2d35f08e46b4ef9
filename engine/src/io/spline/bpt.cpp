// .bpt: the number of patches, then for each patch its degrees along u and v and its control points, v running fastest,
// all separated by white space; `#` begins a comment. Polynomial patches only.

#include <algorithm>
#include <array>
#include <string>

#include "base/text.h"
#include "surface/net/patch_pool.h"
#include "tessera/files.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {
namespace {

using Points = std::array<Vec3, (max_degree + 1) * (max_degree + 1)>;

/// The patch that is being read. Messages alone need it in words.
struct PatchPlace {
  std::int64_t patch, count;
  std::string words() const { return "patch " + std::to_string(patch + 1) + " of " + std::to_string(count); }
};

Status read_degree(TextCursor& cursor, char direction, const PatchPlace& place, int& degree) {
  cursor.skip_space();
  TextCursor after = cursor;
  std::int64_t value = 0;
  if (!after.take_number(value) || value < 1 || value > max_degree) {
    return cursor.expected(std::string("the degree along ") + direction + " of " + place.words() + ", from 1 to " +
                           std::to_string(max_degree));
  }
  cursor = after;
  degree = static_cast<int>(value);
  return {};
}

bool read_point(TextCursor& cursor, Vec3& point) {
  for (double* const coordinate : {&point.x, &point.y, &point.z}) {
    cursor.skip_space();
    if (!cursor.take_finite(*coordinate)) return false;
  }
  return true;
}

Status point_failure(const TextCursor& cursor, const PatchPlace& place, int found, int wanted) {
  const std::string count =
      std::to_string(found) + " of " + std::to_string(wanted) + " control points of " + place.words();
  if (cursor.at_end()) return cursor.failure("the file ends after " + count);
  return cursor.expected("3 finite numbers for a control point (after " + count + ")");
}

Result<BezierPatch> read_patch(TextCursor& cursor, const PatchPlace& place, Points& points) {
  int degree_u = 0, degree_v = 0;
  Status status = read_degree(cursor, 'u', place, degree_u);
  if (status.ok()) status = read_degree(cursor, 'v', place, degree_v);
  if (!status.ok()) return status;
  const int wanted = (degree_u + 1) * (degree_v + 1);
  for (int k = 0; k < wanted; ++k) {
    if (!read_point(cursor, points[static_cast<std::size_t>(k)])) return point_failure(cursor, place, k, wanted);
  }
  return BezierPatch::polynomial(degree_u, degree_v, std::span(points).first(static_cast<std::size_t>(wanted)));
}

Result<Model> parse(std::string_view text, std::string_view name) {
  TextCursor cursor(text, name);
  cursor.skip_space();
  TextCursor after = cursor;
  std::int64_t count = 0;
  if (!after.take_number(count) || count < 1) return cursor.expected("the number of patches, at least 1");
  cursor = after;

  Model model;
  // Bounds the patches that a file may state: the shortest one, of degree 1 x 1, takes 28 characters.
  constexpr std::size_t shortest_patch = 28;
  model.surfaces.reserve(std::min(static_cast<std::size_t>(count), cursor.remaining() / shortest_patch + 1));
  Points points;
  PatchPool pool;
  for (std::int64_t k = 0; k < count; ++k) {
    Result<BezierPatch> patch = read_patch(cursor, {k, count}, points);
    if (!patch) return patch.status();
    model.surfaces.push_back({{}, pool.placed(*patch)});
  }
  cursor.skip_space();
  if (!cursor.at_end())
    return cursor.expected("the end of the file after " + counted(static_cast<std::size_t>(count), "patch", "patches"));
  return model;
}

}  // namespace

Result<Model> parse_bpt(std::string_view text, std::string_view name) {
  return guarded([&] { return parse(text, name); });
}

}  // namespace tessera::inline abi_0_1
