#include "ray/leaf_nets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include "parallel/parallel_for.h"
#include "ray/local_leaf.h"
#include "ray/projected_net.h"

namespace tessera {
namespace {

constexpr std::size_t patches_a_task = 64;
constexpr int most_halvings_a_side = 6, most_halvings_by_bend = 3;
constexpr double most_bend = 0.12;  // of a piece's length: an arc of nearly a radian

/// The longest line of the net along u or v.
double net_length(const BezierPatch& patch, bool along_u) {
  const int lines = along_u ? patch.degree_v() : patch.degree_u(),
            steps = along_u ? patch.degree_u() : patch.degree_v();
  const auto at = [&](int line, int k) { return along_u ? patch.point(k, line) : patch.point(line, k); };
  double longest = 0;
  for (int line = 0; line <= lines; ++line) {
    double sum = 0;
    for (int k = 0; k < steps; ++k) sum += length(at(line, k + 1) - at(line, k));
    longest = std::max(longest, sum);
  }
  return longest;
}

/// How far the lines of the net along u or v bend away from their chords, at the most: second differences bound it
/// (Farin, sec. 5.4).
double net_bend(const BezierPatch& patch, bool along_u) {
  const int lines = along_u ? patch.degree_v() : patch.degree_u(),
            steps = along_u ? patch.degree_u() : patch.degree_v();
  const auto at = [&](int line, int k) { return along_u ? patch.point(k, line) : patch.point(line, k); };
  double largest = 0;
  for (int line = 0; line <= lines; ++line) {
    for (int k = 0; k + 2 <= steps; ++k)
      largest = std::max(largest, length(at(line, k + 2) - 2 * at(line, k + 1) + at(line, k)));
  }
  return largest * steps * (steps - 1) / 8;
}

struct Cuts {
  int u = 0, v = 0;  // halvings
};

/// Each halving takes half of the bend, for its length.
int halvings_by_bend(double bend, double length) {
  int halvings = 0;
  for (double share = bend; share > most_bend * length && halvings < most_halvings_by_bend; share *= 0.5) ++halvings;
  return halvings;
}

Cuts cuts_of(const BezierPatch& patch, int halvings) {
  const double u = net_length(patch, true), v = net_length(patch, false);
  const int by_u = std::max(halvings, halvings_by_bend(net_bend(patch, true), u)),
            by_v = std::max(halvings, halvings_by_bend(net_bend(patch, false), v));
  const auto more = [&](double longer, double shorter, int already) {
    if (!(longer > 2 * shorter)) return 0;
    const int extra = shorter > 0 ? std::ilogb(longer / shorter) : most_halvings_a_side;
    return std::min(extra, most_halvings_a_side - already);
  };
  const double piece_u = std::ldexp(u, -by_u), piece_v = std::ldexp(v, -by_v);
  return {by_u + more(piece_u, piece_v, by_u), by_v + more(piece_v, piece_u, by_v)};
}

void write_patch(const BezierPatch& patch, const SceneFrame& frame, double* out) {
  const std::size_t size = patch.points().size();
  double weight_scale = 1;
  if (patch.is_rational()) {
    const double heaviest = *std::max_element(patch.weights().begin(), patch.weights().end());
    weight_scale = std::ldexp(1.0, -std::ilogb(heaviest));
  }
  for (std::size_t k = 0; k < size; ++k) {
    const double w = patch.is_rational() ? weight_scale * patch.weights()[k] : 1;
    const Vec3 x = w * frame.to_scene(patch.points()[k]);
    out[k] = x.x, out[size + k] = x.y, out[2 * size + k] = x.z;
    if (patch.is_rational()) out[3 * size + k] = w;
  }
}

/// Halves `count` nets that follow each other; the halves of each stand in its place and `count * step` values behind.
void halve_all(const NetShape<0, 0>& shape, int components, double* nets, std::size_t count, bool along_u,
               std::vector<double>& halves) {
  const std::size_t values = static_cast<std::size_t>(shape.size() * components);
  halves.resize(2 * count * values);
  for (std::size_t k = 0; k < count; ++k) {
    halve(shape, components, nets + k * values, along_u, halves.data() + 2 * k * values,
          halves.data() + (2 * k + 1) * values);
  }
  std::copy(halves.begin(), halves.end(), nets);
}

/// Of the control points.
Box3 box_of(const Leaf& leaf, const double* net) {
  const std::size_t size = static_cast<std::size_t>(leaf.size());
  Box3 box;
  for (std::size_t k = 0; k < size; ++k) {
    const double w = leaf.rational ? net[3 * size + k] : 1;
    box.extend(Vec3{net[k] / w, net[size + k] / w, net[2 * size + k] / w});
  }
  return box;
}

}  // namespace

/// Where the pieces of a patch stand.
struct LeafNets::Plan {
  int halvings_u = 0, halvings_v = 0;
  std::size_t first_leaf = 0;
  std::size_t count() const { return std::size_t{1} << (halvings_u + halvings_v); }
};

/// Makes room and says for what.
std::vector<LeafNets::Plan> LeafNets::plan(const SetView& set, int pieces) {
  const int halvings = std::ilogb(static_cast<double>(pieces));
  std::vector<Plan> plans(set.patch_count());
  std::size_t leaves = 0;
  bool rational = false;
  largest_ = 0;
  most_halvings_ = 0;
  for (std::size_t k = 0; k < plans.size(); ++k) {
    const BezierPatch& patch = set.patch(k);
    const Cuts cuts = cuts_of(patch, halvings);
    plans[k] = {cuts.u, cuts.v, leaves};
    leaves += plans[k].count();
    rational |= patch.is_rational();
    largest_ = std::max(largest_, patch.points().size() * (patch.is_rational() ? 4 : 3));
    most_halvings_ = std::max(most_halvings_, cuts.u + cuts.v);
  }
  leaves_.resize(leaves);
  boxes_.resize(leaves);
  local_bytes_ = kernel::ray_leaf_bytes(rational);
  local_.resize(leaves * local_bytes_);
  return plans;
}

/// As it was made.
LeafNets::Plan LeafNets::plan_of(std::uint32_t patch) const {
  const auto first = std::lower_bound(leaves_.begin(), leaves_.end(), patch,
                                      [](const Leaf& leaf, std::uint32_t index) { return leaf.patch < index; });
  return {first->halvings_u, first->halvings_v, static_cast<std::size_t>(first - leaves_.begin())};
}

/// `nets` and `halves`: memory that is used again.
void LeafNets::cut(const BezierPatch& patch, std::uint32_t index, const Plan& plan, std::vector<double>& nets,
                   std::vector<double>& halves) {
  const NetShape<0, 0> shape{patch.degree_u(), patch.degree_v()};
  const int components = patch.is_rational() ? 4 : 3;
  const std::size_t values = static_cast<std::size_t>(shape.size() * components);
  nets.resize(plan.count() * values);
  write_patch(patch, frame_, nets.data());
  std::size_t count = 1;
  for (int k = 0; k < plan.halvings_u; ++k, count *= 2) halve_all(shape, components, nets.data(), count, true, halves);
  for (int k = 0; k < plan.halvings_v; ++k, count *= 2) halve_all(shape, components, nets.data(), count, false, halves);
  const std::size_t along_v = std::size_t{1} << plan.halvings_v;
  for (std::size_t piece = 0; piece < count; ++piece) {
    const std::size_t place = plan.first_leaf + piece;
    const double* const net = nets.data() + piece * values;
    Leaf& leaf = leaves_[place];
    leaf.patch = index;
    leaf.points = patch.points().data();
    leaf.degree_u = static_cast<std::uint8_t>(patch.degree_u());
    leaf.degree_v = static_cast<std::uint8_t>(patch.degree_v());
    leaf.rational = patch.is_rational();
    leaf.halvings_u = static_cast<std::uint8_t>(plan.halvings_u);
    leaf.halvings_v = static_cast<std::uint8_t>(plan.halvings_v);
    leaf.du = std::ldexp(1.0, -plan.halvings_u), leaf.dv = std::ldexp(1.0, -plan.halvings_v);
    const std::size_t across = piece / along_v, along = piece % along_v;
    leaf.u0 = static_cast<double>(across) * leaf.du;
    leaf.v0 = static_cast<double>(along) * leaf.dv;
    boxes_[place] = box_of(leaf, net);
    make_local_leaf(shape, leaf.rational, net, *new (local_.data() + place * local_bytes_) kernel::RayLeaf);
  }
}

void LeafNets::write_net(const SetView& set, const Leaf& leaf, double* net, double* other) const {
  const NetShape<0, 0> shape{leaf.degree_u, leaf.degree_v};
  write_patch(set.patch(leaf.patch), frame_, net);
  const auto piece_u = static_cast<unsigned>(leaf.u0 / leaf.du), piece_v = static_cast<unsigned>(leaf.v0 / leaf.dv);
  for (int k = leaf.halvings_u; k-- > 0;) {
    const bool upper = piece_u >> k & 1;
    halve(shape, leaf.components(), net, true, upper ? other : net, upper ? net : other);
  }
  for (int k = leaf.halvings_v; k-- > 0;) {
    const bool upper = piece_v >> k & 1;
    halve(shape, leaf.components(), net, false, upper ? other : net, upper ? net : other);
  }
}

Box3 LeafNets::box(const SetView& set, std::size_t leaf) const {
  if (!boxes_.empty()) return boxes_[leaf];
  const Leaf& of = leaves_[leaf];
  std::vector<double> nets(2 * static_cast<std::size_t>(of.size() * of.components()));
  write_net(set, of, nets.data(), nets.data() + nets.size() / 2);
  return box_of(of, nets.data());
}

Status LeafNets::build(const SetView& set, const SceneFrame& frame, int pieces, const Execution& execution) {
  frame_ = frame;
  const std::vector<Plan> plans = plan(set, pieces);
  return parallel_for(plans.size(), patches_a_task, execution, [&](std::size_t begin, std::size_t end) {
    std::vector<double> nets, halves;
    for (std::size_t k = begin; k < end; ++k) cut(set.patch(k), static_cast<std::uint32_t>(k), plans[k], nets, halves);
  });
}

Status LeafNets::update(const SetView& set, std::span<const std::uint32_t> patches, const Execution& execution) {
  return parallel_for(patches.size(), patches_a_task, execution, [&](std::size_t begin, std::size_t end) {
    std::vector<double> nets, halves;
    for (const std::uint32_t patch : patches.subspan(begin, end - begin))
      cut(set.patch(patch), patch, plan_of(patch), nets, halves);
  });
}

}  // namespace tessera
