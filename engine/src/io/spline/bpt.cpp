// .bpt: the number of patches, then for each patch its degrees along u and v and its control points, v running fastest,
// all separated by white space; `#` begins a comment. Polynomial patches only.

#include <algorithm>
#include <array>
#include <string>

#include "base/text.h"
#include "io/file/text_cursor.h"
#include "io/spline/item_reader.h"
#include "surface/net/patch_pool.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
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

constexpr auto ends_token = [] {
  std::array<bool, 256> ends{};
  for (const unsigned char c : {' ', '\t', '\r', '\n', '#'}) ends[c] = true;
  return ends;
}();

/// Skips `count` tokens, or all that are left. Returns how many there were.
std::size_t skip_tokens(TextCursor& cursor, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    cursor.skip_space();
    const char *const begin = cursor.position(), *const end = begin + cursor.remaining(), *at = begin;
    while (at != end && !ends_token[static_cast<unsigned char>(*at)]) ++at;
    if (at == begin) return k;
    cursor.skip({begin, static_cast<std::size_t>(at - begin)});
  }
  return count;
}

class BptReader : public ItemReader {
 public:
  explicit BptReader(std::size_t count) : count_(static_cast<std::int64_t>(count)) {}

  std::string_view cuts() const override { return " \t\n"; }

  Status begin(TextCursor& cursor) override {
    cursor.skip_space();
    TextCursor after = cursor;
    if (!after.take_number(count_) || count_ < 1) return cursor.expected("the number of patches, at least 1");
    cursor = after;
    return {};
  }

  bool more(TextCursor&, std::size_t item) const override { return static_cast<std::int64_t>(item) < count_; }

  Result<ReadItem> read(TextCursor& cursor, std::size_t item, std::uint64_t) override {
    Result<BezierPatch> patch = read_patch(cursor, place(item), points_);
    if (!patch) return patch.status();
    return ReadItem{.surface = ModelSurface{{}, pool_.placed(*patch)}};
  }

  Result<ReadItem> skip(TextCursor& cursor, std::size_t item, std::uint64_t) override {
    int degree_u = 0, degree_v = 0;
    Status status = read_degree(cursor, 'u', place(item), degree_u);
    if (status.ok()) status = read_degree(cursor, 'v', place(item), degree_v);
    if (!status.ok()) return status;
    const int points = (degree_u + 1) * (degree_v + 1);
    const std::size_t found = skip_tokens(cursor, 3 * static_cast<std::size_t>(points));
    if (found / 3 < static_cast<std::size_t>(points))
      return point_failure(cursor, place(item), static_cast<int>(found / 3), points);
    return ReadItem{};
  }

  Status end(TextCursor& cursor, const PassedOver*) const override {
    cursor.skip_space();
    if (cursor.at_end()) return {};
    return cursor.expected("the end of the file after " +
                           counted(static_cast<std::size_t>(count_), "patch", "patches"));
  }

  std::size_t expected(std::uint64_t bytes) const override {
    constexpr std::uint64_t shortest_patch = 28;  // characters, of degree 1 x 1
    return static_cast<std::size_t>(std::min(static_cast<std::uint64_t>(count_), bytes / shortest_patch + 1));
  }

  std::unique_ptr<ItemReader> for_rest() const override {
    return std::make_unique<BptReader>(static_cast<std::size_t>(count_));
  }

  /// The degrees usually fill a line.
  bool seems_item(TextCursor& line) const override {
    for (int k = 0; k < 2; ++k) {
      std::int64_t degree = 0;
      line.skip_blanks();
      if (!line.take_number(degree) || degree < 1 || degree > max_degree) return false;
    }
    return line.take_line_end();
  }

 private:
  PatchPlace place(std::size_t item) const { return {static_cast<std::int64_t>(item), count_}; }

  std::int64_t count_;
  Points points_;
  PatchPool pool_;
};

}  // namespace

Result<Model> parse_bpt(std::string_view text, std::string_view name) {
  return guarded([&] {
    BptReader reader(0);
    return read_items(reader, text, name);
  });
}

std::unique_ptr<ItemReader> make_bpt_reader(std::size_t count) { return std::make_unique<BptReader>(count); }

}}  // namespace tessera::abi_0_1
