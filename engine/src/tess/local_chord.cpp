#include "tess/local_chord.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tess/derivative_nets.h"

namespace tessera {
namespace {

constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }

/// A float parameter i / rate lies up to 2^-25 beside it.
double margin(int least) { return 0.5 / least + 0x1p-24; }

constexpr Domain whole{0, 1, 0, 1};
Domain quarter(int half_u, int half_v) { return {0.5 * half_u, 0.5 * half_u + 0.5, 0.5 * half_v, 0.5 * half_v + 0.5}; }

/// Bounds of rectangles, each widened inside a part of the patch.
class Widened {
 public:
  Widened(const DerivativeNets& patch, const Domain& part, Rates least)
      : nets_(patch), part_(part), margin_u_(margin(least.u)), margin_v_(margin(least.v)) {}

  SecondDerivatives bound(const Domain& r) const {
    const Domain wide{std::max(r.u0 - margin_u_, part_.u0), std::min(r.u1 + margin_u_, part_.u1),
                      std::max(r.v0 - margin_v_, part_.v0), std::min(r.v1 + margin_v_, part_.v1)};
    const DerivativeNet uu = cut_to(nets_.uu, wide), uv = cut_to(nets_.uv, wide), vv = cut_to(nets_.vv, wide);
    const DerivativeNet points = nets_.rational ? cut_to(nets_.points, wide) : DerivativeNet();
    // Two cuts along each parameter, of up to 15 mixings each that round by 3 units.
    return bound_piece(nets_, {{&uu}, {&uv}, {&vv}, {&points}, 1}, 0x1p-44, true);
  }

 private:
  const DerivativeNets& nets_;
  Domain part_;
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

LocalChord::LocalChord(const BezierPatch& patch, Rates least, Rates about, std::size_t pieces)
    : LocalChord(DerivativeNets(patch), whole, least, about, pieces) {}

LocalChord::LocalChord(const DerivativeNets& patch, const Domain& part, Rates least, Rates about, std::size_t pieces)
    : least_(least) {
  const Widened widened(patch, part, least);
  const auto is_smaller = [](const Piece& a, const Piece& b) { return a.chord < b.chord; };
  const auto add = [&](const Domain& rectangle) {
    Piece piece{rectangle, widened.bound(rectangle)};
    const double chord = piece.bound.chord(about);
    piece.chord = std::isnan(chord) ? std::numeric_limits<double>::infinity() : chord;
    pieces_[count_++] = piece;
    std::push_heap(pieces_.data(), pieces_.data() + count_, is_smaller);
  };
  add(part);
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

namespace {

/// The same in double the length: whole halves' segments.
Rates evened(Rates rates) { return {rates.u + rates.u % 2, rates.v + rates.v % 2}; }

/// The fewest cells among uniform segments.
std::optional<ProvenSegments> find_uniform(const DerivativeNets& patch, Rates known, double distance,
                                           FunctionRef<bool(Rates)> also) {
  std::optional<ProvenSegments> best;
  Rates rates = known;
  // First roughly, then by smaller pieces about what was found.
  struct Pass {
    double share;
    std::size_t pieces;
  };
  for (const Pass pass : {Pass{0.65, 16}, Pass{0.85, 32}}) {
    if (rates.u * rates.v < 2) break;
    const LocalChord local(patch, whole, shrunk(rates, pass.share), rates, pass.pieces);
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

/// What a quarter of a patch needs: for each number of segments along its part of u the least along its part of v.
class QuarterNeeds {
 public:
  /// Of segments a half: at most `most`.
  QuarterNeeds(const LocalChord& local, Rates most, double distance) : least_v_(at(most.u) + 1, most.v + 1) {
    const auto keeps = [&](Rates halves) { return local.keeps({2 * halves.u, 2 * halves.v}, distance); };
    for (int u = local.least().u / 2; u <= most.u; ++u)
      if (const auto v = least_v(u, local.least().v / 2, most.v, keeps)) least_v_[at(u)] = *v;
  }
  int least_v_for(int u) const { return least_v_[at(u)]; }  ///< above the most if none will do

 private:
  static std::size_t at(int u) { return static_cast<std::size_t>(u); }
  std::vector<int> least_v_;
};

/// The four quarters, `[half of u][half of v]`.
using QuarterChords = std::array<std::array<std::optional<LocalChord>, 2>, 2>;

double distance_of(const QuarterChords& quarters, PatchSegments segments) {
  double most = 0;
  for (const int i : {0, 1})
    for (const int j : {0, 1}) most = std::max(most, quarters[at(i)][at(j)]->distance(segments.of_quarter(i, j)));
  return most;
}

/// The fewest cells among segments that differ between halves, fewer than `known` has.
std::optional<PatchSegments> fewest_halves(const QuarterChords& quarters, PatchSegments known, double distance,
                                           FunctionRef<bool(Rates)> also) {
  const Rates most{3 * known.u.rate / 4 + 1, 3 * known.v.rate / 4 + 1};
  const auto needs = [&](std::size_t i, std::size_t j) { return QuarterNeeds(*quarters[i][j], most, distance); };
  const QuarterNeeds needs00 = needs(0, 0), needs01 = needs(0, 1), needs10 = needs(1, 0), needs11 = needs(1, 1);
  std::optional<PatchSegments> best;
  double least = known.cells();
  for (int low_u = 1; low_u <= most.u; ++low_u)
    for (int high_u = 1; high_u <= most.u && (low_u + high_u) * 2 < least; ++high_u) {
      const int low_v = std::max(needs00.least_v_for(low_u), needs10.least_v_for(high_u)),
                high_v = std::max(needs01.least_v_for(low_u), needs11.least_v_for(high_u));
      if (std::max(low_v, high_v) > most.v) continue;
      const PatchSegments found{Segments::halves(low_u, high_u), Segments::halves(low_v, high_v)};
      if (!(found.cells() < least) || !also(found.coarsest())) continue;
      best = found;
      least = found.cells();
    }
  return best;
}

std::optional<ProvenSegments> find_halves(const DerivativeNets& patch, Rates known, double distance,
                                          FunctionRef<bool(Rates)> also) {
  constexpr int least_cells = 12;  // of fewer none is saved
  std::optional<ProvenSegments> best;
  if (known.u * known.v < least_cells) return best;
  PatchSegments segments = known;
  struct Pass {
    double share;
    std::size_t pieces;
  };
  for (const Pass pass : {Pass{0.5, 12}, Pass{0.8, 24}}) {
    QuarterChords quarters;
    for (const int i : {0, 1})
      for (const int j : {0, 1}) {
        const Rates about = segments.of_quarter(i, j);
        quarters[at(i)][at(j)].emplace(patch, quarter(i, j), evened(shrunk(about, pass.share)), about, pass.pieces);
      }
    const auto found = fewest_halves(quarters, segments, distance, also);
    if (!found) break;
    segments = *found;
    best = {segments, distance_of(quarters, segments)};
  }
  return best;
}

}  // namespace

std::optional<ProvenSegments> find_fewer(const BezierPatch& patch, Rates known, double distance,
                                         FunctionRef<bool(Rates)> also) {
  const DerivativeNets nets(patch);
  const auto uniform = find_uniform(nets, known, distance, also);
  const auto halves = find_halves(nets, uniform ? uniform->segments.rates() : known, distance, also);
  return halves ? halves : uniform;
}

double local_distance(const BezierPatch& patch, PatchSegments segments) {
  const DerivativeNets nets(patch);
  if (segments.are_uniform())
    return LocalChord(nets, whole, segments.rates(), segments.rates(), LocalChord::most_pieces)
        .distance(segments.rates());
  double most = 0;
  for (const int i : {0, 1})
    for (const int j : {0, 1}) {
      const Rates rates = segments.of_quarter(i, j);
      const LocalChord local(nets, quarter(i, j), rates, rates, LocalChord::most_pieces);
      most = std::max(most, local.distance(rates));
    }
  return most;
}

}  // namespace tessera
