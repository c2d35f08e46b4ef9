#include "tessera/trim_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "base/text.h"
#include "tessera/guard.h"
#include "trim/loop_repair.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double max_snap = 1e-3;

Status check_breaks(std::span<const double> breaks, const char* name) {
  const auto failure = [&](StatusCode code, const std::string& what, std::size_t k) {
    return Status(code, std::string(name) + "[" + std::to_string(k) + "] " + what, static_cast<std::ptrdiff_t>(k));
  };
  if (breaks.size() < 2)
    return Status(StatusCode::invalid_argument,
                  std::string(name) + " must have at least 2 values, found " + std::to_string(breaks.size()));
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    if (!std::isfinite(breaks[k])) return failure(StatusCode::non_finite, "is " + text(breaks[k]), k);
    if (!(std::abs(breaks[k]) <= 1e100))
      return failure(StatusCode::invalid_argument, "is " + text(breaks[k]) + "; the largest is limited to 1e+100", k);
    if (k > 0 && !(breaks[k - 1] < breaks[k]))
      return failure(StatusCode::invalid_argument, "does not increase: " + text(breaks[k]), k);
  }
  if (!(breaks.back() - breaks.front() >= 1e-100))
    return Status(StatusCode::invalid_argument, std::string(name) + " must span at least 1e-100");
  return {};
}

/// Whether the sides u0 and u1 of a grid, or v0 and v1, are the same points.
bool closes(const PatchGrid& grid, bool along_u) {
  const double near = 1e-9 * grid.box().diagonal();
  const std::size_t last = (along_u ? grid.count_u() : grid.count_v()) - 1;
  const std::size_t count = along_u ? grid.count_v() : grid.count_u();
  for (std::size_t k = 0; k < count; ++k) {
    const BezierPatch& from = along_u ? grid.patch(0, k) : grid.patch(k, 0);
    const BezierPatch& to = along_u ? grid.patch(last, k) : grid.patch(k, last);
    const int degree = along_u ? from.degree_v() : from.degree_u();
    if (degree != (along_u ? to.degree_v() : to.degree_u())) return false;
    for (int i = 0; i <= degree; ++i) {
      const Vec3 p = along_u ? from.point(0, i) : from.point(i, 0);
      const Vec3 q = along_u ? to.point(to.degree_u(), i) : to.point(i, to.degree_v());
      if (!(length(p - q) <= near)) return false;
    }
  }
  return true;
}

/// The distance for snapping: a share of the domain, and less than a third of the narrowest patch.
CutAxis axis_of(std::span<const double> breaks, bool periodic, double snap) {
  CutAxis axis{{breaks.begin(), breaks.end()}, periodic, snap * (breaks.back() - breaks.front())};
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
    axis.snap = std::min(axis.snap, 0.3 * (breaks[k + 1] - breaks[k]));
  return axis;
}

/// Lists the pieces that cut each patch.
void list_cutting(TrimRegion::Impl& region) {
  const std::vector<double>&u = region.lines.u.lines, &v = region.lines.v.lines;
  std::vector<std::pair<std::size_t, std::uint32_t>> cuts;  // place of the patch, piece
  for (std::uint32_t k = 0; k < region.pieces.size(); ++k) {
    const TrimPiece& piece = region.pieces[k];
    const bool along_u = piece.start().v == piece.end().v && region.lines.v.is_line(piece.start().v);
    const bool along_v = piece.start().u == piece.end().u && region.lines.u.is_line(piece.start().u);
    if (along_u || along_v) continue;
    const std::size_t a = interval_of(u, 0.5 * piece.lower_u() + 0.5 * piece.upper_u());
    const std::size_t b = interval_of(v, 0.5 * piece.lower_v() + 0.5 * piece.upper_v());
    cuts.emplace_back(a * region.count_v() + b, k);
  }
  std::ranges::sort(cuts);
  region.first_cutting.assign((u.size() - 1) * (v.size() - 1) + 1, 0);
  for (const auto& [place, piece] : cuts) {
    ++region.first_cutting[place + 1];
    region.cutting.push_back(piece);
  }
  std::partial_sum(region.first_cutting.begin(), region.first_cutting.end(), region.first_cutting.begin());
}

/// Tells which patches pieces cut, and on which side the others lie: their middles, by the parity of the pieces that a
/// ray towards larger u crosses. Each piece lies in one row of patches, and in one column or on a line before it.
void sort_patches(TrimRegion::Impl& region) {
  const std::vector<double>&u = region.lines.u.lines, &v = region.lines.v.lines;
  const std::size_t count_u = u.size() - 1, count_v = region.count_v();
  list_cutting(region);
  std::vector<std::uint8_t> crossed((count_u + 1) * count_v, 0);  // [column or line][row]
  for (const TrimPiece& piece : region.pieces) {
    const double lower = piece.lower_v(), upper = piece.upper_v();
    if (lower == upper) continue;
    const std::size_t b = interval_of(v, 0.5 * lower + 0.5 * upper);
    const double middle = 0.5 * v[b] + 0.5 * v[b + 1];
    if (!(lower <= middle && middle < upper)) continue;
    const bool is_on_line = piece.start().u == piece.end().u && region.lines.u.is_line(piece.start().u);
    const std::size_t a = is_on_line
                              ? static_cast<std::size_t>(std::ranges::lower_bound(u, piece.start().u) - u.begin())
                              : interval_of(u, 0.5 * piece.lower_u() + 0.5 * piece.upper_u());
    crossed[a * count_v + b] ^= 1;
  }
  region.patches.resize(count_u * count_v);
  for (std::size_t b = 0; b < count_v; ++b) {
    bool is_kept = region.starts_inside;
    for (std::size_t a = count_u; a-- > 0;) {
      is_kept ^= crossed[(a + 1) * count_v + b] != 0;
      const std::size_t place = a * count_v + b;
      const bool is_cut = !region.pieces_of(place).empty();
      region.patches[place] = is_cut ? TrimSide::border : is_kept ? TrimSide::inside : TrimSide::outside;
      region.is_whole = region.is_whole && region.patches[place] == TrimSide::inside;
    }
  }
}

}  // namespace

Result<TrimRegion> TrimRegion::Impl::make(std::span<const TrimLoop> loops, std::span<const double> breaks_u,
                                          std::span<const double> breaks_v, const TrimOptions& options, Use use,
                                          CurveExtractions* shared) {
  return guarded([&]() -> Result<TrimRegion> {
    if (Status status = check_breaks(breaks_u, "breaks_u"); !status.ok()) return status;
    if (Status status = check_breaks(breaks_v, "breaks_v"); !status.ok()) return status;
    if (!(options.snap >= 0 && options.snap <= max_snap))
      return Status(StatusCode::invalid_argument,
                    "snap must be from 0 to " + text(max_snap) + ", found " + text(options.snap));
    auto region = std::make_shared<Impl>();
    region->lines = {axis_of(breaks_u, options.periodic_u, options.snap),
                     axis_of(breaks_v, options.periodic_v, options.snap)};
    region->domain = {breaks_u.front(), breaks_u.back(), breaks_v.front(), breaks_v.back()};
    Result<RepairedLoops> repaired = repair_loops(loops, region->lines, shared);
    if (!repaired) return repaired.status();
    region->pieces = std::move(repaired->pieces);
    region->starts_inside = repaired->starts_inside;
    region->remarks = std::move(repaired->remarks);
    for (const TrimPiece& piece : region->pieces) region->band = larger(region->band, reach(piece));
    if (use == Use::points) region->cells = RegionCells::make(region->pieces, region->domain, region->starts_inside);
    sort_patches(*region);
    return TrimRegion(std::move(region));
  });
}

TrimRegion TrimRegion::Impl::for_points(const TrimRegion& region) {
  auto made = std::make_shared<Impl>(*region.impl_);
  made->cells = RegionCells::make(made->pieces, made->domain, made->starts_inside);
  return TrimRegion(std::move(made));
}

TrimOptions TrimRegion::Impl::options_of(const PatchGrid& grid) {
  constexpr double file_digits = 0x1p-32;  // files state the ends of curves to about 10 digits
  return {.periodic_u = closes(grid, true), .periodic_v = closes(grid, false), .snap = file_digits};
}

Result<TrimRegion> TrimRegion::Impl::make(std::span<const TrimLoop> loops, const PatchGrid& grid, Use use) {
  return make(loops, grid.breaks_u(), grid.breaks_v(), options_of(grid), use);
}

Result<TrimRegion> TrimRegion::make(std::span<const TrimLoop> loops, std::span<const double> breaks_u,
                                    std::span<const double> breaks_v, const TrimOptions& options) {
  return Impl::make(loops, breaks_u, breaks_v, options, Impl::Use::points);
}

Result<TrimRegion> TrimRegion::make(std::span<const TrimLoop> loops, const Domain& domain, const TrimOptions& options) {
  return make(loops, std::array{domain.u0, domain.u1}, std::array{domain.v0, domain.v1}, options);
}

Result<TrimRegion> TrimRegion::make(std::span<const TrimLoop> loops, const PatchGrid& grid) {
  return Impl::make(loops, grid, Impl::Use::points);
}

TrimSide TrimRegion::locate(double u, double v) const {
  if (!impl_->domain.contains(u, v)) return TrimSide::outside;
  return impl_->cells.locate(impl_->pieces, u, v);
}

Status TrimRegion::locate(std::span<const double> u, std::span<const double> v, std::span<TrimSide> sides) const {
  if (u.size() != v.size() || u.size() != sides.size())
    return Status(StatusCode::count_mismatch, "there are " + counted(u.size(), "value") + " of u, " +
                                                  std::to_string(v.size()) + " of v, and room for " +
                                                  counted(sides.size(), "side"));
  for (std::size_t k = 0; k < u.size(); ++k) sides[k] = locate(u[k], v[k]);
  return {};
}

TrimSide TrimRegion::patch(std::size_t a, std::size_t b) const { return impl_->patches[a * impl_->count_v() + b]; }
bool TrimRegion::is_whole() const { return impl_->is_whole; }
Domain TrimRegion::domain() const { return impl_->domain; }
ParameterPoint TrimRegion::band() const { return impl_->band; }
std::size_t TrimRegion::piece_count() const { return impl_->pieces.size(); }
std::span<const LoopRemark> TrimRegion::remarks() const { return impl_->remarks; }

}}  // namespace tessera::abi_0_1
