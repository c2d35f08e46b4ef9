#include "measure/kept_strips.h"

#include <algorithm>
#include <map>
#include <span>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Makes the strips of one row of patches, from the last to the first. In a row, the region is kept at a point where
/// the signs of the pieces on its right add up to 1 (with one more if points that no piece encloses are kept).
class RowStrips {
 public:
  RowStrips(const TrimRegion::Impl& region, const PieceSigns& signs, const ParameterPoint& loop_error)
      : region_(region), signs_(signs), loop_error_(loop_error) {}

  /// `at_lines[a]`: pieces of the row along line a of the lines of constant u.
  void run(std::size_t row, std::span<const std::vector<std::uint32_t>> at_lines, KeptStrips& to) {
    steps_.clear();
    const std::size_t columns = region_.lines.u.lines.size() - 1;
    for (std::size_t a = columns; a-- > 0;) {
      for (const std::uint32_t piece : at_lines[a + 1]) count(piece);
      const std::size_t place = a * region_.count_v() + row;
      if (region_.patches[place] == TrimSide::inside) to.patches.push_back({place, {whole_strip()}});
      if (region_.patches[place] != TrimSide::border) continue;
      to.patches.push_back({place, strips_of(a, row, to.is_certain)});
      for (const std::uint32_t piece : region_.pieces_of(place)) count(piece);
    }
  }

 private:
  void count(std::uint32_t piece) {
    const TrimPiece& of = region_.pieces[piece];
    const int sign = signs_.signs[piece];
    if (sign == 0) return;
    step(of.lower_v(), sign), step(of.upper_v(), -sign);
  }
  void step(double v, int by) {
    const auto [at, is_new] = steps_.try_emplace(v, 0);
    if ((at->second += by) == 0) steps_.erase(at);
  }

  std::vector<CurveStrip> strips_of(std::size_t a, std::size_t b, bool& is_certain) const {
    const std::vector<double>&u = region_.lines.u.lines, &v = region_.lines.v.lines;
    const Domain patch{u[a], u[a + 1], v[b], v[b + 1]};
    std::vector<CurveStrip> strips;
    int kept = region_.starts_inside ? 1 : 0;
    double from = patch.v0;
    const auto add_side = [&](double to) {
      if (kept != 0 && to > from)
        strips.push_back({LocalCurve({1, patch.local_v(from)}, {1, patch.local_v(to)}), 0, double(kept)});
      is_certain = is_certain && (kept == 0 || kept == 1);
      from = to;
    };
    for (const auto& [at, by] : steps_) {
      add_side(std::clamp(at, patch.v0, patch.v1));
      kept += by;
    }
    add_side(patch.v1);
    for (const std::uint32_t piece : region_.pieces_of(a * region_.count_v() + b))
      strips.push_back(strip(piece, patch));
    return strips;
  }

  CurveStrip strip(std::uint32_t index, const Domain& patch) const {
    const TrimPiece& piece = region_.pieces[index];
    ParameterPoint band = piece.error;
    if (piece.start().u != piece.end().u && piece.start().v != piece.end().v) band = band + loop_error_;
    if (signs_.is_crossed[index]) band = band + distance(piece.start(), piece.end());
    return {LocalCurve(piece.curve, patch),
            0,
            double(signs_.signs[index]),
            {band.u / (patch.u1 - patch.u0), band.v / (patch.v1 - patch.v0)}};
  }

  const TrimRegion::Impl& region_;
  const PieceSigns& signs_;
  const ParameterPoint loop_error_;
  std::map<double, int> steps_;  ///< of the sum of signs, where v grows
};

}  // namespace

KeptStrips kept_strips(const TrimRegion::Impl& region, const ParameterPoint& loop_error) {
  const std::vector<double>&u = region.lines.u.lines, &v = region.lines.v.lines;
  const PieceSigns signs = piece_signs(region.pieces, region.starts_inside);
  std::vector<std::vector<std::vector<std::uint32_t>>> at_lines(v.size() - 1);
  for (auto& row : at_lines) row.resize(u.size());
  for (std::uint32_t k = 0; k < region.pieces.size(); ++k) {
    const TrimPiece& piece = region.pieces[k];
    if (signs.signs[k] == 0 || piece.start().u != piece.end().u || !region.lines.u.is_line(piece.start().u)) continue;
    const auto line = static_cast<std::size_t>(std::ranges::lower_bound(u, piece.start().u) - u.begin());
    at_lines[interval_of(v, 0.5 * piece.lower_v() + 0.5 * piece.upper_v())][line].push_back(k);
  }
  KeptStrips all{{}, signs.is_certain};
  RowStrips row(region, signs, loop_error);
  for (std::size_t b = 0; b + 1 < v.size(); ++b) row.run(b, at_lines[b], all);
  return all;
}

}}  // namespace tessera::abi_0_1
