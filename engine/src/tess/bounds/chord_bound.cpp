#include "tess/bounds/chord_bound.h"

#include "tess/bounds/derivative_nets.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The quarters that each piece is made of: bit 2 i + j stands for quarter [i][j].
constexpr unsigned quarters_of_piece[9] = {0b1111, 0b0011, 0b1100, 0b0101, 0b1010, 0b0001, 0b0010, 0b0100, 0b1000};

/// Returns the smallest t >= 1 with a + b / t + c / t^2 <= limit, a <= limit; infinite if there is none.
double smallest_rate(double a, double b, double c, double limit) {
  const double room = limit - a;
  if (b == 0 && c == 0) return 1;
  if (!(room > 0)) return std::numeric_limits<double>::infinity();
  return std::max(1.0, (b + std::sqrt(b * b + 4 * room * c)) / (2 * room));
}

}  // namespace

ChordBound::ChordBound(const BezierPatch& patch, bool products) {
  const DerivativeNets nets(patch);
  DerivativeNet uu[2][2], uv[2][2], vv[2][2], points[2][2];
  cut(nets.uu, uu);
  cut(nets.uv, uv);
  cut(nets.vv, vv);
  if (nets.rational) cut(nets.points, points);
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    DerivativePiece piece;
    for (unsigned quarter = 0; quarter < 4; ++quarter) {
      if (!(quarters_of_piece[k] >> quarter & 1u)) continue;
      const unsigned i = quarter / 2, j = quarter % 2;
      piece.uu[piece.count] = &uu[i][j];
      piece.uv[piece.count] = &uv[i][j];
      piece.vv[piece.count] = &vv[i][j];
      piece.points[piece.count++] = &points[i][j];
    }
    // Each difference of four coefficients, the translation and the cuts round by less than 16 units of their operands.
    pieces_[k] = bound_piece(nets, piece, 0x1p-46, products);
  }
}

double ChordBound::distance(Rates rates) const {
  const Split split = ChordBound::split(rates);
  double most = 0;
  for (int k = split.first; k < split.first + split.count; ++k)
    most = std::max(most, pieces_[static_cast<std::size_t>(k)].chord(rates));
  return most;
}

namespace {

/// The longest segments that lie in a half, 0 or 1, or anywhere.
struct Longest {
  int half;  ///< -1: anywhere
  double length;
};
constexpr int anywhere_in_patch = -1;

double longest_in(Segments segments, int begin, int end) {
  double least = std::numeric_limits<double>::infinity();
  for (int e = begin; e < end; ++e) least = std::min(least, segments.rate_in(e).value());
  return 1 / least;
}

/// Returns the length of the longest segment that crosses the middle, of these segments or of finer ones. It has a sum
/// of (length in an eighth) x (rate there) of at most 1, so it ends in the eighths beside the middle of which one, or
/// more together, have that sum.
double longest_across(Segments segments) {
  constexpr int middle = Segments::parts / 2;
  double least = std::numeric_limits<double>::infinity();
  for (const int step : {-1, 1}) {
    double reached = 0;
    for (int e = step < 0 ? middle - 1 : middle; e >= 0 && e < Segments::parts && reached < 1; e += step) {
      const double rate = segments.rate_in(e).value();
      least = std::min(least, rate);
      reached += rate / Segments::parts;
    }
  }
  return 1 / least;
}

struct LongestOfHalves {
  std::array<Longest, 3> at;
  int count = 2;

  /// `crosses`: segments may cross the middle even where these do not.
  LongestOfHalves(Segments segments, bool crosses) {
    constexpr int middle = Segments::parts / 2;
    at[0] = {0, longest_in(segments, 0, middle)};
    at[1] = {1, longest_in(segments, middle, Segments::parts)};
    if (!crosses && segments.parts_halves()) return;
    at[2] = {anywhere_in_patch, longest_across(segments)};
    count = 3;
  }
};

}  // namespace

double ChordBound::distance_of(PatchSegments segments, bool anywhere) const {
  if (segments.are_uniform() && !anywhere) return distance(segments.rates());
  const LongestOfHalves along_u(segments.u, anywhere), along_v(segments.v, anywhere);
  double most = 0;
  for (int k = 0; k < along_u.count; ++k)
    for (int l = 0; l < along_v.count; ++l) {
      const Longest u = along_u.at[static_cast<std::size_t>(k)], v = along_v.at[static_cast<std::size_t>(l)];
      const int piece = u.half < 0 ? (v.half < 0 ? 0 : 3 + v.half) : v.half < 0 ? 1 + u.half : 5 + 2 * u.half + v.half;
      most = std::max(most, pieces_[static_cast<std::size_t>(piece)].chord(u.length + 0x1p-24, v.length + 0x1p-24));
    }
  return most;
}

ChordBound::Crossing ChordBound::crossing(Rates rates, Side border, int rate) {
  const bool along_u = border == Side::v0 || border == Side::v1, begin = border == Side::v0 || border == Side::u0;
  const std::size_t half = along_u ? (begin ? 3 : 4) : (begin ? 1 : 2);
  const bool halved = (along_u ? rates.v : rates.u) % 2 == 0;
  return {halved ? half : 0, along_u ? Rates{rate, rates.v} : Rates{rates.u, rate}};
}

double ChordBound::needed(double tolerance, int fixed, bool fixed_u, bool even) const {
  const double h = 1.0 / fixed + 0x1p-24;
  const bool fixed_even = fixed % 2 == 0;
  const Split split = fixed_u ? splits[fixed_even][even] : splits[even][fixed_even];
  double needed = 1;
  for (int k = split.first; k < split.first + split.count; ++k) {
    const SecondDerivatives& d = pieces_[static_cast<std::size_t>(k)];
    needed = std::max(
        needed, smallest_rate(h * h * (fixed_u ? d.uu : d.vv), 2 * h * d.uv, fixed_u ? d.vv : d.uu, 8 * tolerance));
  }
  return needed;
}

double ChordBound::needed_in_quarter(double tolerance, double fixed, bool fixed_u, int quarter) const {
  const SecondDerivatives& d = pieces_[static_cast<std::size_t>(5 + quarter)];
  const double h = 1 / fixed + 0x1p-24;
  return smallest_rate(h * h * (fixed_u ? d.uu : d.vv), 2 * h * d.uv, fixed_u ? d.vv : d.uu, 8 * tolerance);
}

std::optional<Rates> ChordBound::with_rate(double tolerance, int fixed, bool fixed_u, int most) const {
  std::optional<Rates> best;
  for (const bool even : {false, true}) {
    const double least = needed(tolerance, fixed, fixed_u, even);
    if (!(least <= most)) continue;
    int rate = static_cast<int>(std::ceil(least));
    if ((rate % 2 == 0) != even) ++rate;
    const auto rates = [&] { return fixed_u ? Rates{fixed, rate} : Rates{rate, fixed}; };
    if (!(distance(rates()) <= tolerance)) rate += 2;  // the root was rounded, or the parameters are
    // With products a smaller rate may do.
    for (int low = even ? 0 : -1; std::isfinite(pieces_[0].uu_vv) && rate - low > 2;) {
      const int high = rate;
      rate = low + (high - low) / 4 * 2;
      if (!(distance(rates()) <= tolerance)) low = rate, rate = high;
    }
    if (rate <= most && distance(rates()) <= tolerance && (!best || rate < (fixed_u ? best->v : best->u)))
      best = rates();
  }
  return best;
}

std::optional<Rates> ChordBound::cheapest(double tolerance, int most) const {
  std::optional<Rates> best;
  double least = std::numeric_limits<double>::infinity();
  // Over real rates the fewest cells have h^2 uu = k^2 vv, hence 4 tolerance = h^2 (uu + uv sqrt(uu / vv)). Whole
  // numbers and halves move the minimum a little: walk from there both ways over the smaller rate, whose relative steps
  // are larger.
  const SecondDerivatives& d = pieces_[0];
  const bool fixed_u = d.uu <= d.vv;
  const double small = fixed_u ? d.uu : d.vv, large = fixed_u ? d.vv : d.uu;
  const double start = large > 0 ? std::sqrt((small + d.uv * std::sqrt(small / large)) / (4 * tolerance)) : 1;
  const auto attempt = [&](int rate) {
    const std::optional<Rates> rates = with_rate(tolerance, rate, fixed_u, most);
    if (!rates || !(double(rates->u) * rates->v < least)) return false;
    least = double(rates->u) * rates->v;
    best = rates;
    return true;
  };
  const int middle = start < most ? std::max(static_cast<int>(start), 1) : most;
  constexpr int patience = 4;
  for (const int step : {1, -1})
    for (int rate = step > 0 ? middle : middle - 1, left = patience; left > 0 && rate >= 1 && rate <= most;
         rate += step)
      left = attempt(rate) ? patience : left - 1;
  for (int rate = 1; rate <= patience; ++rate)
    if (rate <= most) attempt(rate);
  if (!best) attempt(most);
  return best;
}

}}  // namespace tessera::abi_0_1
