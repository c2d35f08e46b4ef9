#include "ray/leaf_nets.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/parallel_for.h"
#include "ray/projected_net.h"

namespace tessera {
namespace {

constexpr std::size_t patches_a_task = 64;
constexpr int most_halvings_a_side = 6;

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

struct Cuts {
  int u = 0, v = 0;  // halvings
};

Cuts cuts_of(const BezierPatch& patch, int halvings) {
  const double u = net_length(patch, true), v = net_length(patch, false);
  const auto more = [&](double longer, double shorter) {
    if (!(longer > 2 * shorter)) return 0;
    const int extra = shorter > 0 ? std::ilogb(longer / shorter) : most_halvings_a_side;
    return std::min(extra, most_halvings_a_side - halvings);
  };
  return {halvings + more(u, v), halvings + more(v, u)};
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

}  // namespace

Status LeafNets::build(const SetView& set, const SceneFrame& frame, int pieces, const Execution& execution) {
  const int halvings = std::ilogb(static_cast<double>(pieces));
  std::vector<Cuts> cuts(set.patch_count());
  std::vector<std::size_t> first_leaf(set.patch_count() + 1, 0);
  std::size_t values = 0;
  largest_ = 0;
  most_halvings_ = 0;
  std::vector<std::size_t> first_value(set.patch_count());
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const BezierPatch& patch = set.patch(k);
    cuts[k] = cuts_of(patch, halvings);
    const std::size_t count = std::size_t{1} << (cuts[k].u + cuts[k].v);
    const std::size_t net = patch.points().size() * (patch.is_rational() ? 4 : 3);
    first_leaf[k + 1] = first_leaf[k] + count;
    first_value[k] = values;
    values += count * net;
    largest_ = std::max(largest_, net);
    most_halvings_ = std::max(most_halvings_, cuts[k].u + cuts[k].v);
  }
  leaves_.resize(first_leaf.back());
  coefficients_.resize(values);
  return parallel_for(set.patch_count(), patches_a_task, execution, [&](std::size_t begin, std::size_t end) {
    std::vector<double> halves;
    for (std::size_t k = begin; k < end; ++k) {
      const BezierPatch& patch = set.patch(k);
      const NetShape<0, 0> shape{patch.degree_u(), patch.degree_v()};
      const int components = patch.is_rational() ? 4 : 3;
      double* const nets = coefficients_.data() + first_value[k];
      write_patch(patch, frame, nets);
      std::size_t count = 1;
      for (int cut = 0; cut < cuts[k].u; ++cut, count *= 2) halve_all(shape, components, nets, count, true, halves);
      for (int cut = 0; cut < cuts[k].v; ++cut, count *= 2) halve_all(shape, components, nets, count, false, halves);
      const std::size_t along_v = std::size_t{1} << cuts[k].v;
      for (std::size_t piece = 0; piece < count; ++piece) {
        Leaf& leaf = leaves_[first_leaf[k] + piece];
        leaf.patch = static_cast<std::uint32_t>(k);
        leaf.degree_u = static_cast<std::uint8_t>(patch.degree_u());
        leaf.degree_v = static_cast<std::uint8_t>(patch.degree_v());
        leaf.rational = patch.is_rational();
        leaf.halvings = static_cast<std::uint8_t>(cuts[k].u + cuts[k].v);
        leaf.first = first_value[k] + piece * static_cast<std::size_t>(leaf.size() * components);
        leaf.du = std::ldexp(1.0, -cuts[k].u), leaf.dv = std::ldexp(1.0, -cuts[k].v);
        leaf.u0 = static_cast<double>(piece / along_v) * leaf.du;
        leaf.v0 = static_cast<double>(piece % along_v) * leaf.dv;
      }
    }
  });
}

Box3 LeafNets::box(const Leaf& leaf) const {
  const std::size_t size = static_cast<std::size_t>(leaf.size());
  const double* x = net(leaf);
  Box3 box;
  for (std::size_t k = 0; k < size; ++k) {
    const double w = leaf.rational ? x[3 * size + k] : 1;
    box.extend(Vec3{x[k] / w, x[size + k] / w, x[2 * size + k] / w});
  }
  return box;
}

}  // namespace tessera
