#include "ray/leaf/leaf_trims.h"

#include <algorithm>
#include <cmath>

#include "base/impl_access.h"
#include "parallel/parallel_for.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t leaves_per_task = 64;
constexpr double shares = 1024;          // of a leaf's side; a leaf shrinks to a few of them
constexpr int max_shrinks = 2;           // each to 1/1024 of a side at most: the ends stay exact numbers
constexpr double max_needle = 16;        // by which a shrunk leaf may be longer along one side than the leaf was
constexpr double worth_shrinking = 0.8;  // share of the area

/// A leaf's side along u or v, in the patch's parameter.
struct LeafSide {
  double start, width;
};

/// A leaf's rectangle in the parameters of its surface.
Domain rectangle_of(const Domain& patch, const Leaf& leaf) {
  return {patch.u_at(leaf.u0), patch.u_at(leaf.u0 + leaf.du), patch.v_at(leaf.v0), patch.v_at(leaf.v0 + leaf.dv)};
}

/// Returns a part of a leaf's side that holds a range of the patch's parameter, with a margin of a quarter of a share.
/// Its ends are even shares of the side, so that no sum rounds.
LeafSide shrunk(const LeafSide& side, double from, double to) {
  const auto share = [&](double x) { return shares * ((x - side.start) / side.width); };
  const double lower = std::clamp(std::floor(share(from) - 0.25), 0.0, shares - 1);
  const double upper = std::clamp(std::ceil(share(to) + 0.25), lower + 1, shares);
  return {side.start + lower / shares * side.width, (upper - lower) / shares * side.width};
}

/// Returns a side that is at least `width` wide, within the side that it is a part of.
LeafSide widened(LeafSide side, double width, const LeafSide& within) {
  while (side.width < width) {
    side.start = std::max(side.start - side.width, within.start);
    side.width = std::min(4 * side.width, within.start + within.width - side.start);
  }
  return side;
}

/// Shrinks a leaf to what is kept of it, but not to a needle. Returns whether that pays.
bool shrink(Leaf& leaf, const Domain& patch, const Domain& kept) {
  const LeafSide along_u{leaf.u0, leaf.du}, along_v{leaf.v0, leaf.dv};
  LeafSide u = shrunk(along_u, patch.local_u(kept.u0), patch.local_u(kept.u1));
  LeafSide v = shrunk(along_v, patch.local_v(kept.v0), patch.local_v(kept.v1));
  u = widened(u, v.width / leaf.dv * leaf.du / max_needle, along_u);
  v = widened(v, u.width / leaf.du * leaf.dv / max_needle, along_v);
  if (u.width * v.width > worth_shrinking * leaf.du * leaf.dv) return false;
  leaf.u0 = u.start, leaf.du = u.width, leaf.v0 = v.start, leaf.dv = v.width;
  leaf.is_shrunk = true;
  return true;
}

/// Fills the squares of a leaf, by quarters.
class SquareMarker {
 public:
  SquareMarker(const TrimRegion& region, const Domain& patch, const Leaf& leaf, KeptSquares& squares)
      : region_(region), patch_(patch), leaf_(leaf), squares_(squares) {}

  /// Fills `size` x `size` squares from (i, j) on, of which `kept` is kept.
  void mark(const KeptPart& kept, unsigned i, unsigned j, unsigned size) {
    if (kept.use != PatchUse::cut)
      return fill(kept.use == PatchUse::whole ? squares_.inside : squares_.outside, i, j, size);
    if (size == 1) return;
    const unsigned half = size / 2;
    for (const unsigned k : {i, i + half})
      for (const unsigned n : {j, j + half}) mark(kept_part(region_, kept.pieces, rectangle(k, n, half)), k, n, half);
  }

 private:
  static void fill(std::uint64_t& bits, unsigned i, unsigned j, unsigned size) {
    for (unsigned k = i; k < i + size; ++k)
      for (unsigned n = j; n < j + size; ++n) bits |= std::uint64_t{1} << (KeptSquares::per_side * k + n);
  }
  Domain rectangle(unsigned i, unsigned j, unsigned size) const {
    Leaf part = leaf_;
    part.du *= double(size) / KeptSquares::per_side, part.dv *= double(size) / KeptSquares::per_side;
    part.u0 += i * (leaf_.du / KeptSquares::per_side), part.v0 += j * (leaf_.dv / KeptSquares::per_side);
    return rectangle_of(patch_, part);
  }

  const TrimRegion& region_;
  const Domain& patch_;
  const Leaf& leaf_;
  KeptSquares& squares_;
};

}  // namespace

Status LeafTrims::build(const SetView& set, std::span<Leaf> leaves, const Execution& execution) {
  set_ = &set.impl();
  if (Status status = regions_.build(set, execution); !status.ok() || !regions_.any()) return status;
  const Execution quiet{.cancel = execution.cancel};
  squares_.resize(leaves.size());
  const auto find_squares = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) squares_[k] = squares_of(set, leaves[k]);
  };
  return parallel_for(leaves.size(), leaves_per_task, quiet, find_squares);
}

/// Whether a strip along a side, and a little around it, is inside as a whole. Its middle and its half lengths are in
/// shares of the leaf.
bool LeafTrims::is_inside(const Leaf& leaf, double u, double v, double along_u, double along_v, int halvings) const {
  constexpr double near = 1e-6;
  const RegionCells& cells = impl_of(regions_.of(leaf.patch)).cells;
  const Domain box = around(leaf.patch, leaf.u0 + u * leaf.du, leaf.v0 + v * leaf.dv, (along_u + near) * leaf.du,
                            (along_v + near) * leaf.dv);
  const TrimSide side = cells.locate_all(box);
  if (side != TrimSide::border || halvings == 0) return side == TrimSide::inside;
  along_u *= 0.5, along_v *= 0.5;
  return is_inside(leaf, u - along_u, v - along_v, along_u, along_v, halvings - 1) &&
         is_inside(leaf, u + along_u, v + along_v, along_u, along_v, halvings - 1);
}

/// A root beyond a side of its patch, within rounding, is found on the side. So squares there are left open where a
/// loop may be near.
void LeafTrims::open_sides(const Leaf& leaf, KeptSquares& squares) const {
  constexpr unsigned count = KeptSquares::per_side;
  constexpr int halvings = 4;
  constexpr double half = 0.5 / count;
  const auto open = [&](unsigned i, unsigned j) { squares.inside &= ~(std::uint64_t{1} << (count * i + j)); };
  for (const double end : {0.0, 1.0}) {
    const unsigned at = end == 0 ? 0 : count - 1;
    for (unsigned k = 0; k < count; ++k) {
      const double middle = (k + 0.5) / count;
      if (leaf.u0 + end * leaf.du == end && !is_inside(leaf, end, middle, 0, half, halvings)) open(at, k);
      if (leaf.v0 + end * leaf.dv == end && !is_inside(leaf, middle, end, half, 0, halvings)) open(k, at);
    }
  }
}

KeptSquares LeafTrims::squares_of(const SetView& set, Leaf& leaf) const {
  KeptSquares squares;
  if (!regions_.is_cut(leaf.patch)) {
    squares.inside = ~std::uint64_t{0};
    if (regions_.has_region(leaf.patch)) open_sides(leaf, squares);
    return squares;
  }
  const TrimRegion& region = regions_.of(leaf.patch);
  const std::span<const std::uint32_t> pieces = regions_.pieces_of(leaf.patch);
  const Domain& patch = set.source(leaf.patch).domain;
  KeptPart kept = kept_part(region, pieces, rectangle_of(patch, leaf));
  for (int k = 0; k < max_shrinks && kept.use == PatchUse::cut && shrink(leaf, patch, kept.hull); ++k)
    kept = kept_part(region, pieces, rectangle_of(patch, leaf));
  SquareMarker(region, patch, leaf, squares).mark(kept, 0, 0, KeptSquares::per_side);
  open_sides(leaf, squares);
  return squares;
}

/// A rectangle about a point of a patch, in the surface's parameters. It may reach into the patch's neighbours: a root
/// that lies just beyond a border is found on the border, too.
Domain LeafTrims::around(std::uint32_t patch, double u, double v, double reach_u, double reach_v) const {
  const Domain &domain = set_->sources[patch].domain, face = impl_of(regions_.of(patch)).domain;
  return {std::max(domain.u_at(u - reach_u), face.u0), std::min(domain.u_at(u + reach_u), face.u1),
          std::max(domain.v_at(v - reach_v), face.v0), std::min(domain.v_at(v + reach_v), face.v1)};
}

TrimSide LeafTrims::side_near(std::uint32_t patch, double u, double v, double reach_u, double reach_v) const {
  return impl_of(regions_.of(patch)).cells.locate_all(around(patch, u, v, reach_u, reach_v));
}

// The root may lie anywhere in a rectangle about it. A loop that passes through has corners on both sides of it, unless
// it turns back inside: then it is as near as rounding.
TrimSide LeafTrims::side_of(const LeafRoot& root) const {
  const TrimRegion& region = regions_.of(root.patch);
  const double off = root.residual + root.noise;
  const Domain box = around(root.patch, root.u, root.v, reach_u(root, off), reach_v(root, off));
  if (const TrimSide all = impl_of(region).cells.locate_all(box); all != TrimSide::border) return all;
  const Domain& domain = set_->sources[root.patch].domain;
  const TrimSide side = region.locate(domain.u_at(root.u), domain.v_at(root.v));
  for (const double u : {box.u0, box.u1})
    for (const double v : {box.v0, box.v1})
      if (region.locate(u, v) != side) return TrimSide::border;
  return side;
}

}}  // namespace tessera::abi_0_1
