#include <algorithm>
#include <array>
#include <mutex>
#include <string>

#include "base/saturated.h"
#include "convert/spline/curve_pieces.h"
#include "convert/spline/spline_strips.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Writes the patches strip by strip, in parallel, and returns the box of their control points.
Result<Box3> write_patches(const ExtractedRows& rows, PatchPieces& pieces) {
  constexpr std::size_t patches_in_piece = 1024;
  const std::size_t in_strip = rows.v().span_count();
  Box3 box;
  bool finite = true;
  std::mutex mutex;  // guards `box` and `finite`
  const Status status =
      parallel_for(rows.u().span_count(), patches_in_piece / in_strip, {}, [&](std::size_t begin, std::size_t end) {
        UnsetVector<double> memory(Strip::memory_size(rows, Strip::max_patches));
        Strip strip(rows, Strip::max_patches, memory.data());
        for (std::size_t b = 0; b < in_strip; b += Strip::max_patches) {
          strip.select(b, std::min(b + Strip::max_patches, in_strip));
          for (std::size_t a = begin; a < end; ++a) {
            strip.compute(a, a > begin);
            with_order(rows.surface().degree_v(), [&](auto order) { strip.write(a * in_strip, order, pieces); });
          }
        }
        const std::lock_guard lock(mutex);
        box.extend(strip.box());
        finite = finite && strip.is_finite();
      });
  if (!status.ok()) return status;
  if (!finite) return Status(StatusCode::non_finite, "the control points are too large: a mean of them is not finite");
  return box;
}

std::pair<std::size_t, std::size_t> touched(const KnotLine& line, std::size_t i) {
  return touched_spans(distinct_spans(line), line.degree, i);
}

}  // namespace

Result<PatchGrid> to_bezier(const BSplineSurface& surface) {
  return guarded([&]() -> Result<PatchGrid> {
    ExtractedRows rows(surface);
    if (Status status = rows.compute(); !status.ok()) return status;
    PatchPieces pieces(surface.degree_u(), surface.degree_v(),
                       saturated_product(rows.u().span_count(), rows.v().span_count()), surface.is_rational());
    const Result<Box3> box = write_patches(rows, pieces);
    if (!box) return box.status();
    return PatchGrid::make(rows.u().breaks, rows.v().breaks, pieces.take(), {}, *box);
  });
}

BezierPieces bezier_pieces(const Curve& curve, const Extraction& extraction) {
  BezierPieces pieces{curve.degree(), extraction.breaks, {}, {}};
  pieces.points.reserve(extraction.rows.size());
  std::optional<Scales> scales;
  if (curve.is_rational()) scales.emplace(curve.points(), curve.weights());
  const std::size_t width = scales ? 4 : 3;
  UnsetVector<double> net(curve.points().size() * width);
  write_numbers(curve.points(), curve.weights(), scales ? &*scales : nullptr, net.data());
  for (const Extraction::Row& row : extraction.rows) {
    std::array<double, 4> values{};
    apply(extraction, row, net.data(), width, width, values.data());
    NetPoint at{{values[0], values[1], values[2]}, 1};
    if (scales) at = project(values.data(), *scales);
    if (row.count == 1) at = {curve.points()[row.first], curve.weight(row.first)};  // keeps its bits
    pieces.points.push_back(at.point);
    if (scales) pieces.weights.push_back(at.weight);
  }
  return pieces;
}

Result<BezierPieces> to_bezier(const Curve& curve) {
  return guarded([&]() -> Result<BezierPieces> { return bezier_pieces(curve, make_extraction(line_of(curve))); });
}

Result<PatchRange> touched_patches(const BSplineSurface& surface, std::size_t i, std::size_t j) {
  return guarded([&]() -> Result<PatchRange> {
    if (i >= surface.count_u() || j >= surface.count_v())
      return Status(StatusCode::invalid_argument, "there is no control point [" + std::to_string(i) + "][" +
                                                      std::to_string(j) + "] in " + std::to_string(surface.count_u()) +
                                                      " x " + std::to_string(surface.count_v()));
    const auto [a0, a1] = touched(line_u(surface), i);
    const auto [b0, b1] = touched(line_v(surface), j);
    return PatchRange{a0, a1, b0, b1};
  });
}

}}  // namespace tessera::abi_0_1
