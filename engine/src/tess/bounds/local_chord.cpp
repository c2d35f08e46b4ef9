#include "tess/bounds/local_chord.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tess/bounds/derivative_nets.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Half the width of a triangle's box. A float parameter lies up to 2^-25 beside i / rate.
double margin(int least) { return 0.5 / least + 0x1p-24; }

constexpr std::size_t at(int k) { return static_cast<std::size_t>(k); }

constexpr Domain whole_domain{0, 1, 0, 1};
/// Part (i, j) of the whole, divided into parts.u x parts.v.
Domain part(Rates parts, int i, int j) {
  const auto begin = [](int k, int count) { return double(k) / count; };
  return {begin(i, parts.u), begin(i + 1, parts.u), begin(j, parts.v), begin(j + 1, parts.v)};
}

/// Bounds rectangles, each widened within a part of the patch.
class Widened {
 public:
  Widened(const DerivativeNets& patch, const Domain& part, Rates least)
      : nets_(patch), part_(part), margin_u_(margin(least.u)), margin_v_(margin(least.v)) {}

  SecondDerivatives bound(const Domain& r) const {
    const Domain wide{std::max(r.u0 - margin_u_, part_.u0), std::min(r.u1 + margin_u_, part_.u1),
                      std::max(r.v0 - margin_v_, part_.v0), std::min(r.v1 + margin_v_, part_.v1)};
    const DerivativeNet uu = cut_to(nets_.uu, wide), uv = cut_to(nets_.uv, wide), vv = cut_to(nets_.vv, wide);
    DerivativeNet points;
    if (nets_.rational) points = cut_to(nets_.points, wide);
    // Two cuts along each parameter, of up to 15 mixings each that round by 3 units.
    return bound_piece(nets_, {{&uu}, {&uv}, {&vv}, {&points}, 1}, 0x1p-44, true);
  }

 private:
  const DerivativeNets& nets_;
  Domain part_;
  double margin_u_, margin_v_;
};

/// Returns the smallest rate v with this u, between `least` and `most`; empty if `most` does not keep the limits.
template <class Keeps>
std::optional<int> min_v(int u, int least, int most, const Keeps& keeps) {
  if (most < least || !keeps({u, most})) return {};
  for (int low = least - 1; most - low > 1;) {
    const int middle = (low + most) / 2;
    (keeps({u, middle}) ? most : low) = middle;
  }
  return most;
}

/// The least rates of a search: this share of the known ones.
Rates shrunk(Rates rates, double share) {
  const auto least = [share](int rate) { return std::max(1, static_cast<int>(share * rate)); };
  return {least(rates.u), least(rates.v)};
}

}  // namespace

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
    if (std::max(cells_u, cells_v) <= 0.5) break;  // no wider than its margins
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

/// One pass of a search: the first has rough bounds, the next has smaller pieces near the rates that were found.
struct Pass {
  double share;  ///< the bounds hold down to this share of the known rates
  std::size_t pieces;
};

/// Adds uniform segments to the choices.
void add_uniform(const DerivativeNets& patch, double distance, FunctionRef<bool(PatchSegments)> also,
                 SegmentChoices& choices) {
  for (const Pass pass : {Pass{0.65, 16}, Pass{0.85, 32}}) {
    const Rates rates = choices.fewest().segments.rates();
    if (rates.u * rates.v < 2) break;
    const LocalChord local(patch, whole_domain, shrunk(rates, pass.share), rates, pass.pieces);
    const auto keeps = [&](Rates r) { return local.keeps(r, distance) && also(r); };
    const int max_u = std::min(max_rate, rates.u + rates.u / 2 + 1);
    for (int u = local.least().u; u <= max_u; ++u) {
      const int max_v = std::min(max_rate, static_cast<int>(choices.max_cells()) / u);
      const auto v = min_v(u, local.least().v, max_v, keeps);
      if (const Rates found{u, v.value_or(0)}; v && choices.has_room_for(found))
        choices.add({found, local.distance(found), true});
    }
  }
}

/// The number of parts along each parameter.
using PartCounts = Rates;

/// The rate at which uniform segments are as long as `count` of a part, and the segments of both parts.
int rate_of(int count, int parts) { return parts * count; }
Segments joined(int lower, int upper, int parts) { return parts == 2 ? Segments::halves(lower, upper) : lower; }

/// The needs of a part of a patch: for each number of segments along its u the least number along its v.
class PartNeeds {
 public:
  /// `most`: the largest numbers of segments of the part.
  PartNeeds(const LocalChord& local, PartCounts parts, Rates most, double distance)
      : min_v_(at(most.u) + 1, most.v + 1) {
    const auto keeps = [&](Rates counts) {
      return local.keeps({rate_of(counts.u, parts.u), rate_of(counts.v, parts.v)}, distance);
    };
    for (int u = local.least().u / parts.u; u <= most.u; ++u)
      if (const auto v = min_v(u, local.least().v / parts.v, most.v, keeps)) min_v_[at(u)] = *v;
  }
  int min_v_for(int u) const { return min_v_[at(u)]; }  ///< above `most` if no number suffices

 private:
  std::vector<int> min_v_;
};

/// Bounds of the parts of a patch: quarters, or halves where the other parameter has only one segment.
class PartChords {
 public:
  PartChords(const DerivativeNets& patch, PatchSegments about, Pass pass)
      : parts_{about.u.rate() > 1 ? 2 : 1, about.v.rate() > 1 ? 2 : 1} {
    for (int i = 0; i < parts_.u; ++i)
      for (int j = 0; j < parts_.v; ++j) {
        const Rates rates = about.of_quarter(i, j);
        Rates least = shrunk(rates, pass.share);
        least = {least.u + least.u % parts_.u, least.v + least.v % parts_.v};  // whole parts' segments
        chords_[at(2 * i + j)].emplace(patch, part(parts_, i, j), least, rates, pass.pieces);
      }
  }

  PartCounts parts() const { return parts_; }
  const LocalChord& of(int half_u, int half_v) const {
    return *chords_[at(2 * std::min(half_u, parts_.u - 1) + std::min(half_v, parts_.v - 1))];
  }
  double distance(PatchSegments segments) const {
    double most = 0;
    for (int i = 0; i < parts_.u; ++i)
      for (int j = 0; j < parts_.v; ++j) most = std::max(most, of(i, j).distance(segments.of_quarter(i, j)));
    return most;
  }

 private:
  PartCounts parts_;
  std::array<std::optional<LocalChord>, 4> chords_;
};

/// Adds segments whose lengths may differ between the halves to the choices.
void add_halves(const PartChords& chords, double distance, FunctionRef<bool(PatchSegments)> also,
                SegmentChoices& choices) {
  const PatchSegments known = choices.fewest().segments;
  const PartCounts parts = chords.parts();
  const auto max_of = [](Segments had, int count) {
    return count == 2 ? std::min(3 * had.rate() / 4 + 1, max_rate / 2) : int{had.rate()};
  };
  const Rates most{max_of(known.u, parts.u), max_of(known.v, parts.v)};
  const auto needs = [&](int i, int j) { return PartNeeds(chords.of(i, j), parts, most, distance); };
  const PartNeeds needs00 = needs(0, 0), needs01 = needs(0, 1), needs10 = needs(1, 0), needs11 = needs(1, 1);
  for (int low_u = 1; low_u <= most.u; ++low_u)
    for (int high_u = parts.u == 2 ? 1 : low_u; high_u <= (parts.u == 2 ? most.u : low_u); ++high_u) {
      const Segments u = joined(low_u, high_u, parts.u);
      if (u.rate() * parts.v > choices.max_cells()) break;
      const int low_v = std::max(needs00.min_v_for(low_u), needs10.min_v_for(high_u)),
                high_v = std::max(needs01.min_v_for(low_u), needs11.min_v_for(high_u));
      if (std::max(low_v, high_v) > most.v) continue;
      const PatchSegments found{u, joined(low_v, high_v, parts.v)};
      if (choices.has_room_for(found) && also(found)) choices.add({found, chords.distance(found)});
    }
}

void add_halves(const DerivativeNets& patch, double distance, FunctionRef<bool(PatchSegments)> also,
                SegmentChoices& choices) {
  constexpr int min_cells = 12;  // with fewer cells nothing is saved
  for (const Pass pass : {Pass{0.5, 12}, Pass{0.8, 24}}) {
    const PatchSegments known = choices.fewest().segments;
    if (known.cells() < min_cells) return;
    add_halves(PartChords(patch, known, pass), distance, also, choices);
    if (!(choices.fewest().segments.cells() < known.cells())) return;
  }
}

}  // namespace

void find_fewer(const BezierPatch& patch, double distance, FunctionRef<bool(PatchSegments)> also,
                SegmentChoices& choices) {
  const DerivativeNets nets(patch);
  add_uniform(nets, distance, also, choices);
  add_halves(nets, distance, also, choices);
}

double local_distance(const BezierPatch& patch, PatchSegments segments) {
  const DerivativeNets nets(patch);
  const PartCounts parts = segments.are_uniform()
                               ? PartCounts{1, 1}
                               : PartCounts{segments.u.parts_halves() ? 2 : 1, segments.v.parts_halves() ? 2 : 1};
  double most = 0;
  for (int i = 0; i < parts.u; ++i)
    for (int j = 0; j < parts.v; ++j) {
      const Rates quarter = segments.of_quarter(i, j), coarsest = segments.coarsest();
      const Rates rates{parts.u == 2 ? quarter.u : coarsest.u, parts.v == 2 ? quarter.v : coarsest.v};
      const LocalChord local(nets, part(parts, i, j), rates, rates, LocalChord::max_pieces);
      most = std::max(most, local.distance(rates));
    }
  return most;
}

}}  // namespace tessera::abi_0_1
