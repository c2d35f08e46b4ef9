#include "tess/trimmed/divided_chords.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "basis/exact_sign.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

class Divider {
 public:
  Divider(const PatchCutter& cutter, std::span<const std::uint32_t> numbers,
          std::span<const CutPatch::Triangle> triangles)
      : cutter_(cutter), numbers_(numbers) {
    for (const CutPatch::Triangle& triangle : triangles)
      for (std::size_t c = 0; c < 3; ++c) ++uses_[key(triangle[c], triangle[(c + 1) % 3])];
  }

  void add(const LoopChord& chord) {
    points_.assign({chord.start, chord.end});
    if (!is_border(chord.start, chord.end)) find_points(chord);
    for (std::size_t k = 0; k + 1 < points_.size(); ++k) {
      const std::uint32_t a = points_[k], b = points_[k + 1];
      if (is_border(a, b))
        segments_.push_back(
            {chord.piece, numbers_[a], numbers_[b], cutter_.parameter(chord, a), cutter_.parameter(chord, b)});
    }
  }
  std::vector<CutPatch::LoopSegment> take() { return std::move(segments_); }

 private:
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  }
  bool is_border(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t from = numbers_[a], to = numbers_[b];
    if (from == no_id || to == no_id || from == to) return false;
    const auto uses = uses_.find(key(from, to));
    return uses != uses_.end() && uses->second == 1;
  }
  /// Lists the points on a chord from its start to its end.
  void find_points(const LoopChord& chord) {
    const ParameterPoint a = cutter_.point(chord.start), b = cutter_.point(chord.end);
    const auto lies_between = [](double x, double from, double to) {
      return std::min(from, to) <= x && x <= std::max(from, to);
    };
    points_.pop_back();
    for (std::uint32_t k = 0; k < cutter_.vertex_count(); ++k) {
      const ParameterPoint at = cutter_.point(k);
      if (lies_between(at.u, a.u, b.u) && lies_between(at.v, a.v, b.v) && !(at == a) && !(at == b) &&
          numbers_[k] != no_id && orientation(a, b, at) == 0)
        points_.push_back(k);
    }
    points_.push_back(chord.end);
    const auto place = [&](std::uint32_t k) {
      const ParameterPoint at = cutter_.point(k);
      return std::pair(std::abs(at.u - a.u), std::abs(at.v - a.v));
    };
    std::ranges::sort(std::span(points_).subspan(1, points_.size() - 2), {}, place);
  }

  const PatchCutter& cutter_;
  std::span<const std::uint32_t> numbers_;
  std::unordered_map<std::uint64_t, std::uint32_t> uses_;  ///< by edge, its triangles
  std::vector<std::uint32_t> points_;
  std::vector<CutPatch::LoopSegment> segments_;
};

}  // namespace

std::vector<CutPatch::LoopSegment> divided_chords(const PatchCutter& cutter, std::span<const std::uint32_t> numbers,
                                                  std::span<const CutPatch::Triangle> triangles) {
  Divider divider(cutter, numbers, triangles);
  cutter.for_loop_chords([&](const LoopChord& chord) { divider.add(chord); });
  return divider.take();
}

}}  // namespace tessera::abi_0_1
