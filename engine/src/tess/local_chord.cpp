#include "tess/local_chord.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tess/derivative_nets.h"

namespace tessera {
namespace {

/// A float parameter i / rate lies up to 2^-25 beside it.
double margin(int least) { return 0.5 / least + 0x1p-24; }

/// Bounds of rectangles, each widened.
class Widened {
 public:
  Widened(const BezierPatch& patch, Rates least)
      : nets_(patch), margin_u_(margin(least.u)), margin_v_(margin(least.v)) {}

  SecondDerivatives bound(const Domain& r) const {
    const Domain wide{std::max(r.u0 - margin_u_, 0.0), std::min(r.u1 + margin_u_, 1.0), std::max(r.v0 - margin_v_, 0.0),
                      std::min(r.v1 + margin_v_, 1.0)};
    const DerivativeNet uu = cut_to(nets_.uu, wide), uv = cut_to(nets_.uv, wide), vv = cut_to(nets_.vv, wide);
    const DerivativeNet points = nets_.rational ? cut_to(nets_.points, wide) : DerivativeNet();
    // Two cuts along each parameter, of up to 15 mixings each that round by 3 units.
    return bound_piece(nets_, {{&uu}, {&uv}, {&vv}, {&points}, 1}, 0x1p-44, true);
  }

 private:
  DerivativeNets nets_;
  double margin_u_, margin_v_;
};

/// The smallest rate v with this u, between `least` and `most`, if `most` will do.
template <class Keeps>
std::optional<int> least_v(int u, int least, int most, const Keeps& keeps) {
  if (most < least || !keeps({u, most})) return {};
  for (int low = least - 1; most - low > 1;) {
    const int middle = (low + most) / 2;
    (keeps({u, middle}) ? most : low) = middle;
  }
  return most;
}

/// Rates down to so many parts of those known are looked for.
Rates shrunk(Rates rates, double share) {
  const auto least = [share](int rate) { return std::max(1, static_cast<int>(share * rate)); };
  return {least(rates.u), least(rates.v)};
}

}  // namespace

LocalChord::LocalChord(const BezierPatch& patch, Rates least, Rates about, std::size_t pieces) : least_(least) {
  const Widened widened(patch, least);
  const auto is_smaller = [](const Piece& a, const Piece& b) { return a.chord < b.chord; };
  const auto add = [&](const Domain& rectangle) {
    Piece piece{rectangle, widened.bound(rectangle)};
    const double chord = piece.bound.chord(about);
    piece.chord = std::isnan(chord) ? std::numeric_limits<double>::infinity() : chord;
    pieces_[count_++] = piece;
    std::push_heap(pieces_.data(), pieces_.data() + count_, is_smaller);
  };
  add({0, 1, 0, 1});
  while (count_ < pieces) {
    const Domain d = pieces_.front().rectangle;
    const double cells_u = (d.u1 - d.u0) * about.u, cells_v = (d.v1 - d.v0) * about.v;
    if (std::max(cells_u, cells_v) <= 0.5) break;  // hardly less than its margins
    std::pop_heap(pieces_.data(), pieces_.data() + count_--, is_smaller);
    const double u = 0.5 * (d.u0 + d.u1), v = 0.5 * (d.v0 + d.v1);
    const bool halves_u = cells_u >= cells_v;
    add(halves_u ? Domain{d.u0, u, d.v0, d.v1} : Domain{d.u0, d.u1, d.v0, v});
    add(halves_u ? Domain{u, d.u1, d.v0, d.v1} : Domain{d.u0, d.u1, v, d.v1});
  }
  std::sort(pieces_.data(), pieces_.data() + count_, [](const Piece& a, const Piece& b) { return a.chord > b.chord; });
}

double LocalChord::distance(Rates rates) const {
  double most = 0;
  for (std::size_t k = 0; k < count_; ++k) most = std::max(most, pieces_[k].bound.chord(rates));
  return most;
}

bool LocalChord::keeps(Rates rates, double distance) const {
  for (std::size_t k = 0; k < count_; ++k)
    if (!(pieces_[k].bound.chord(rates) <= distance)) return false;
  return true;
}

std::optional<ProvenRates> find_fewer(const BezierPatch& patch, Rates known, double distance,
                                      FunctionRef<bool(Rates)> also) {
  std::optional<ProvenRates> best;
  Rates rates = known;
  // First roughly, then by smaller pieces about what was found.
  struct Pass {
    double share;
    std::size_t pieces;
  };
  for (const Pass pass : {Pass{0.65, 16}, Pass{0.85, 32}}) {
    if (rates.u * rates.v < 2) break;
    const LocalChord local(patch, shrunk(rates, pass.share), rates, pass.pieces);
    const auto keeps = [&](Rates r) { return local.keeps(r, distance) && also(r); };
    const int most_u = rates.u + rates.u / 2 + 1;
    for (int u = local.least().u; u <= most_u; ++u) {
      const auto v = least_v(u, local.least().v, (rates.u * rates.v - 1) / u, keeps);
      if (!v) continue;
      rates = {u, *v};
      best = {rates, local.distance(rates)};
    }
  }
  return best;
}

}  // namespace tessera
