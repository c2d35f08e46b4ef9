#include "tess/trimmed/trimmed_patch.h"

#include <algorithm>

namespace tessera::inline abi_0_1 {
namespace {

/// Writes rate + 1 even lines; the first and the last are the ends themselves.
void divide(std::vector<double>& lines, double from, double to, int rate) {
  lines.resize(static_cast<std::size_t>(rate) + 1);
  for (int k = 0; k < rate; ++k) lines[static_cast<std::size_t>(k)] = from + (to - from) * k / rate;
  lines.back() = to;
}

}  // namespace

void PatchCutter::begin(const TrimmedPatch& patch) {
  patch_ = patch;
  points_.clear();
  chords_.clear();
  sliver_ = 0;
  divide(lines_u_, patch.domain.u0, patch.domain.u1, patch.rates.u);
  divide(lines_v_, patch.domain.v0, patch.domain.v1, patch.rates.v);
  grid_ = {lines_u_, lines_v_};
}

std::uint32_t PatchCutter::add_point(const ParameterPoint& point) {
  points_.push_back(point);
  return static_cast<std::uint32_t>(points_.size() - 1);
}

void PatchCutter::add_side(std::span<const SidePoint> side, double across, bool runs_along_u, bool above) {
  const auto at = [&](double along) {
    return runs_along_u ? ParameterPoint{along, across} : ParameterPoint{across, along};
  };
  std::uint32_t last = no_place;
  for (std::size_t k = 0; k + 1 < side.size(); ++k) {
    if (!(above ? side[k].above : side[k].below)) {
      last = no_place;
      continue;
    }
    if (last == no_place) last = add_point(at(side[k].at));
    const std::uint32_t next = add_point(at(side[k + 1].at));
    chords_.push_back({last, next});
    last = next;
  }
}

void PatchCutter::add_piece(const TrimPiece& piece) {
  const double width = patch_.domain.u1 - patch_.domain.u0, height = patch_.domain.v1 - patch_.domain.v0;
  const ChordLimits limits{patch_.sliver,
                           {patch_.chord_share * width / patch_.rates.u, patch_.chord_share * height / patch_.rates.v},
                           {patch_.speed.u / width, patch_.speed.v / height}};
  std::uint32_t last = add_point(piece.start());
  sliver_ = std::max(sliver_, chords_of_pieces_.append(piece, limits, points_));
  points_.back() = piece.end();
  for (; last + 1 < points_.size(); ++last) chords_.push_back({last, last + 1});
}

bool PatchCutter::cut() { return cells_.run(grid_, points_, chords_); }

ParameterPoint PatchCutter::point(std::uint32_t vertex) const {
  if (vertex < points_.size()) return points_[vertex];
  return grid_.point(grid_.place_of_vertex(cells_.grid_vertices()[vertex - points_.size()]));
}

ParameterPoint PatchCutter::local(std::uint32_t vertex) const {
  const ParameterPoint at = point(vertex);
  return {patch_.domain.local_u(at.u), patch_.domain.local_v(at.v)};
}

void PatchCutter::local_lines(std::vector<double>& u, std::vector<double>& v) const {
  u.clear(), v.clear();
  for (const double line : lines_u_) u.push_back(patch_.domain.local_u(line));
  for (const double line : lines_v_) v.push_back(patch_.domain.local_v(line));
}

// Bounds of a half or a quarter hold for triangles within it. The pieces are ordered as ChordBound::pieces() says.
double PatchCutter::triangle_bound(const CutCells::Triangle& triangle) const {
  const ParameterPoint a = local(triangle[0]), b = local(triangle[1]), c = local(triangle[2]);
  const auto [u0, u1] = std::minmax({a.u, b.u, c.u});
  const auto [v0, v1] = std::minmax({a.v, b.v, c.v});
  const std::size_t low_u = u1 <= 0.5, high_u = u0 >= 0.5, low_v = v1 <= 0.5, high_v = v0 >= 0.5;
  const bool half_u = low_u || high_u, half_v = low_v || high_v;
  std::size_t piece = 0;
  if (half_u && half_v)
    piece = 5 + 2 * high_u + high_v;
  else if (half_u)
    piece = 1 + high_u;
  else if (half_v)
    piece = 3 + high_v;
  // A parameter is off by three roundings.
  return patch_.chord->pieces()[piece].chord(u1 - u0 + 0x1p-24, v1 - v0 + 0x1p-24);
}

double PatchCutter::chord_bound() {
  double most = cells_.whole_count() > 0 ? patch_.chord->distance(patch_.rates) : 0;
  for (const CutCells::Triangle& triangle : cells_.band()) most = std::max(most, triangle_bound(triangle));
  return most;
}

}  // namespace tessera::inline abi_0_1
