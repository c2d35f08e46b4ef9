#include "ray/leaf/leaf_cuts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "ray/leaf/local_leaf.h"
#include "ray/net/projected_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_halvings_per_side = 6, max_halvings_by_bend = 3, max_halvings_by_certificate = 5;
constexpr int max_halvings_of_folds = 4;  // for patches that look folded everywhere, such as those without an area
constexpr double max_net_bend = 0.12;     // share of a piece's length: an arc of nearly a radian

/// Measures of a control net before it is cut.
struct NetShapes {
  double length_u = 0, length_v = 0;  ///< of the longest lines
  double bend_u = 0,
         bend_v = 0;    ///< upper bound of the lines' distance from their chords, by second differences (Farin, sec.
                        ///< 5.4)
  double shortest = 0;  ///< shortest side
};

/// Finds the longest line along u or v, and the largest bend.
void measure_lines(const BezierPatch& patch, bool along_u, double& longest, double& bend) {
  const int lines = along_u ? patch.degree_v() : patch.degree_u(),
            steps = along_u ? patch.degree_u() : patch.degree_v();
  double largest = 0;
  for (int line = 0; line <= lines; ++line) {
    const auto at = [&](int k) { return along_u ? patch.point(k, line) : patch.point(line, k); };
    double sum = 0;
    Vec3 before;
    for (int k = 0; k < steps; ++k) {
      const Vec3 step = at(k + 1) - at(k), turn = step - before;
      sum += length(step);
      if (k > 0) largest = std::max(largest, dot(turn, turn));
      before = step;
    }
    longest = std::max(longest, sum);
  }
  bend = std::sqrt(largest) * steps * (steps - 1) / 8;
}

NetShapes measure(const BezierPatch& patch) {
  NetShapes out;
  measure_lines(patch, true, out.length_u, out.bend_u);
  measure_lines(patch, false, out.length_v, out.bend_v);
  const int m = patch.degree_u(), n = patch.degree_v();
  const Vec3 a = patch.point(0, 0), b = patch.point(0, n), c = patch.point(m, 0), d = patch.point(m, n);
  out.shortest = std::min({length(b - a), length(d - c), length(c - a), length(d - b)});
  return out;
}

/// Returns a guess of the factor by which weights increase half the second derivatives of a patch.
double spread_of_weights(const BezierPatch& patch) {
  if (!patch.is_rational()) return 1;
  const auto [lightest, heaviest] = std::minmax_element(patch.weights().begin(), patch.weights().end());
  return *heaviest / *lightest;
}

/// Returns the halvings for a bend; each halves the bend relative to the length.
int halvings_by_bend(double bend, double length) {
  int halvings = 0;
  for (double share = bend; share > max_net_bend * length && halvings < max_halvings_by_bend; share *= 0.5) ++halvings;
  return halvings;
}

Cuts cuts_by_net(const NetShapes& net, int halvings) {
  const int by_u = std::max(halvings, halvings_by_bend(net.bend_u, net.length_u)),
            by_v = std::max(halvings, halvings_by_bend(net.bend_v, net.length_v));
  const auto more = [&](double longer, double shorter, int already) {
    if (!(longer > 2 * shorter)) return 0;
    const int extra = shorter > 0 ? std::ilogb(longer / shorter) : max_halvings_per_side;
    return std::min(extra, max_halvings_per_side - already);
  };
  const double piece_u = std::ldexp(net.length_u, -by_u), piece_v = std::ldexp(net.length_v, -by_v);
  return {by_u + more(piece_u, piece_v, by_u), by_v + more(piece_v, piece_u, by_v)};
}

/// Returns whether the whole patch is so flat that nothing else needs a look. A guess with a margin.
bool is_surely_flat(const BezierPatch& patch, const NetShapes& net, double max_bend) {
  const int m = patch.degree_u(), n = patch.degree_v();
  const Vec3 twist = patch.point(0, 0) - patch.point(0, n) - patch.point(m, 0) + patch.point(m, n);
  const double spread = spread_of_weights(patch), bend = 4 * (net.bend_u + net.bend_v) + 1.5 * length(twist);
  return bend * spread * spread + (spread - 1) * (net.length_u + net.length_v) < 0.5 * max_bend * net.shortest;
}

/// Errors of the kernels' linear models of a piece, relative to its length: half the second derivatives, also along u
/// and v alone, and the uncertainty of a float root from terms that kernels omit.
struct Bend {
  double all = 0, along_u = 0, along_v = 0;
};

Bend bend_of(const kernel::RayLeaf& leaf) {
  Bend out;
  if (!std::isfinite(leaf.noise)) return {std::numeric_limits<double>::infinity(), 1, 1};  // kernels decide nothing
  constexpr double by_slope = 16;
  for (std::size_t c = 0; c < 3; ++c) {
    const double uu = 0.5 * leaf.bend_uu[c], uv = leaf.bend_uv[c], vv = 0.5 * leaf.bend_vv[c];
    out.all = std::max(out.all, uu + uv + vv);
    out.along_u = std::max(out.along_u, uu), out.along_v = std::max(out.along_v, vv);
  }
  out.all = (out.all + by_slope * leaf.slope_noise) / leaf.lightest;
  return out;
}

/// Returns whether the net tapers off along u or v: a side has nearly no length beside the opposite one. Towards a pole
/// all pieces look alike, however small they are, and none becomes flat.
bool is_tapered(const NetShape<0, 0>& shape, bool rational, const double* net) {
  constexpr double least = 1e-3;
  const int size = shape.size(), last = size - 1, columns = shape.columns();
  const auto point = [&](int k) {
    const double w = rational ? net[3 * size + k] : 1;
    return Vec3{net[k] / w, net[size + k] / w, net[2 * size + k] / w};
  };
  const Vec3 a = point(0), b = point(shape.n()), c = point(last - columns + 1), d = point(last);
  const auto differ = [](double x, double y) { return std::min(x, y) <= least * std::max(x, y); };
  return differ(length(b - a), length(d - c)) || differ(length(c - a), length(d - b));
}

}  // namespace

void write_patch(const BezierPatch& patch, const SceneFrame& frame, double* net) {
  const std::size_t size = patch.points().size();
  double weight_scale = 1;
  if (patch.is_rational()) {
    const double heaviest = *std::max_element(patch.weights().begin(), patch.weights().end());
    weight_scale = std::ldexp(1.0, -std::ilogb(heaviest));
  }
  for (std::size_t k = 0; k < size; ++k) {
    const double w = patch.is_rational() ? weight_scale * patch.weights()[k] : 1;
    const Vec3 x = w * frame.to_scene(patch.points()[k]);
    net[k] = x.x, net[size + k] = x.y, net[2 * size + k] = x.z;
    if (patch.is_rational()) net[3 * size + k] = w;
  }
}

void LeafCutter::start(const BezierPatch& patch) {
  patch_ = &patch;
  cuts_ = {};
  nets_.resize(values());
  write_patch(patch, *frame_, nets_.data());
}

void LeafCutter::halve(bool along_u) {
  const std::size_t pieces = cuts_.pieces(), columns = std::size_t{1} << cuts_.v;
  const NetShape<0, 0> shape{patch_->degree_u(), patch_->degree_v()};
  const int components = patch_->is_rational() ? 4 : 3;
  nets_.swap(halves_);
  nets_.resize(2 * pieces * values());
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const std::size_t across = piece / columns, along = piece % columns;
    const std::size_t lower = along_u ? 2 * across * columns + along : 2 * piece,
                      upper = along_u ? lower + columns : lower + 1;
    tessera::halve(shape, components, halves_.data() + piece * values(), along_u, nets_.data() + lower * values(),
                   nets_.data() + upper * values());
  }
  ++(along_u ? cuts_.u : cuts_.v);
}

void LeafCutter::cut(const Cuts& cuts) {
  while (cuts_.u < cuts.u) halve(true);
  while (cuts_.v < cuts.v) halve(false);
}

const double* LeafCutter::part_of(std::size_t piece, const Domain& rectangle) {
  const double columns = std::ldexp(1.0, cuts_.v), rows = std::ldexp(1.0, cuts_.u);
  const auto row = static_cast<double>(piece >> cuts_.v);
  const auto column = static_cast<double>(piece & ((std::size_t{1} << cuts_.v) - 1));
  const NetShape<0, 0> shape{patch_->degree_u(), patch_->degree_v()};
  const int components = patch_->is_rational() ? 4 : 3;
  part_.assign(net(piece), net(piece) + values());
  restrict_net(shape, components, part_.data(), true, rectangle.u0 * rows - row, rectangle.u1 * rows - row);
  restrict_net(shape, components, part_.data(), false, rectangle.v0 * columns - column,
               rectangle.v1 * columns - column);
  return part_.data();
}

/// Returns whether more than one piece in ten bends by more than `max_bend`, and along which parameter.
bool LeafCutter::bends(double max_bend, bool& along_u) const {
  alignas(kernel::RayLeaf) std::byte room[kernel::ray_leaf_bytes(true)];
  const NetShape<0, 0> shape{patch_->degree_u(), patch_->degree_v()};
  /// Counts of pieces and of their bends.
  struct Tally {
    std::size_t count = 0, bent = 0;
    double by_u = 0, by_v = 0;
  } even, tapered;
  std::size_t folded = 0;
  for (std::size_t piece = 0; piece < cuts_.pieces(); ++piece) {
    auto* const leaf = new (room) kernel::RayLeaf;
    make_local_leaf(shape, patch_->is_rational(), net(piece), *leaf);
    Tally& tally = is_tapered(shape, patch_->is_rational(), net(piece)) ? tapered : even;
    ++tally.count;
    const Bend bend = bend_of(*leaf);
    if (!(bend.all > max_bend)) continue;
    ++tally.bent;
    folded += std::isinf(bend.all);
    tally.by_u += bend.along_u / bend.all, tally.by_v += bend.along_v / bend.all;
  }
  const Tally& which = even.count > 0 ? even : tapered;
  along_u = which.by_u > which.by_v || (which.by_u == which.by_v && cuts_.u <= cuts_.v);
  if (folded == cuts_.pieces() && cuts_.u + cuts_.v >= max_halvings_of_folds) return false;
  return 10 * which.bent > which.count;
}

Cuts LeafCutter::flatten(int halvings, double max_bend) {
  const NetShapes net = measure(*patch_);
  const Cuts by_net = cuts_by_net(net, halvings);
  if (is_surely_flat(*patch_, net, max_bend)) return by_net;
  cut(by_net);
  for (bool along_u = true; bends(max_bend, along_u);) {
    const auto can = [&](bool u) { return (u ? cuts_.u : cuts_.v) < max_halvings_by_certificate; };
    if (!can(along_u)) along_u = !along_u;
    if (!can(along_u)) break;
    halve(along_u);
  }
  return cuts_;
}

}}  // namespace tessera::abi_0_1
