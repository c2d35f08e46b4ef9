#include "io/obj/obj_trims.h"

#include <algorithm>
#include <string>

#include "base/text.h"
#include "io/obj/obj_index.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The curve on a part of its domain.
Result<Curve> part_of(const Curve& curve, const Interval& part) {
  if (part == curve.domain()) return curve;
  if (!curve.is_rational()) return Curve::b_spline(curve.degree(), curve.points(), curve.knots(), part);
  return Curve::nurbs(curve.degree(), curve.points(), curve.weights(), curve.knots(), part);
}

std::string range_text(double from, double to) { return "from " + text(from) + " to " + text(to); }

}  // namespace

bool ObjTrimCurves::allow(std::size_t points) {
  if (points > allowed_) return false;
  allowed_ -= points;
  return true;
}

Status ObjTrimCurves::read_loop(TextCursor& cursor, std::vector<Curve>& loop) {
  do {
    const TextCursor before = cursor;
    double from = 0, to = 0;
    std::uint32_t index = 0;
    if (!cursor.take_finite(from)) return cursor.expected("the parameter where the curve begins");
    cursor.skip_blanks();
    if (!cursor.take_finite(to)) return cursor.expected("the parameter where the curve ends");
    cursor.skip_blanks();
    Status status = read_obj_index(cursor, "an index of a curv2", "curv2 elements", curves_.size(), index);
    if (!status.ok()) return status;
    const std::vector<Curve>& pieces = curves_[index];
    const Interval all{pieces.front().domain().from, pieces.back().domain().to};
    if (!(from < to && all.from <= from && to <= all.to))
      return before.failure("curv2 " + std::to_string(index + 1) + " runs " + range_text(all.from, all.to) +
                            ", it has no part " + range_text(from, to));
    const auto first =
        std::partition_point(pieces.begin(), pieces.end(), [&](const Curve& p) { return p.domain().to <= from; });
    for (auto at = first; at != pieces.end() && at->domain().from < to; ++at) {
      const Curve& piece = *at;
      const Interval part{std::max(from, piece.domain().from), std::min(to, piece.domain().to)};
      if (!(part == piece.domain()) && !allow(piece.points().size()))
        return before.failure(
            "the parts of curves of all trims together have more control points than the file has bytes");
      const Result<Curve> curve = part_of(piece, part);
      if (!curve) return Status(curve.status().code(), before.place() + ": " + curve.status().message());
      loop.push_back(*curve);
    }
    cursor.skip_blanks();
  } while (!cursor.at_line_end());
  return {};
}

}}  // namespace tessera::abi_0_1
