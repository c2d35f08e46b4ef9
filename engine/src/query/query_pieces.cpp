#include "query/query_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/impl_access.h"
#include "parallel/parallel_for.h"
#include "ray/leaf/leaf_cuts.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t patches_per_task = 64;
constexpr double max_off = 0.06, max_aspect = 3;  // of pieces: shares of the longer and of the shorter side
constexpr int max_halvings = 8;
constexpr int max_curve_halvings = 10;
constexpr double max_sag = 0.06;  // share of a curve's chord

/// Whether a piece departs little from its tangent plane, and is not a strip.
bool is_flat(const PieceBounds& bounds) {
  const PieceFacts<double>& f = bounds.facts;
  const double longer = std::max(f.length_u, f.length_v), shorter = std::min(f.length_u, f.length_v);
  return squared(f.off) <= max_off * max_off * longer * longer && longer <= max_aspect * shorter;
}

double rounding_of(const SetView& set) {
  double rounding = 0;
  for (std::size_t k = 0; k < set.patch_count(); ++k)
    rounding = std::max(rounding, net_rounding(set.patch(k).degree_u(), set.patch(k).degree_v()));
  return rounding;
}

}  // namespace

/// The items of one patch.
struct QueryPieces::PatchItems {
  std::vector<QueryPiece> pieces;
  std::vector<ItemBoxes> piece_boxes;
  std::vector<KeptCurve> curves;
  std::vector<ItemBoxes> curve_boxes;
};

/// Cuts a patch by halves until each piece is nearly flat, and not much longer than wide.
void QueryPieces::make_pieces(const SetView& set, std::uint32_t patch, PatchItems& items) const {
  const BezierPatch& of = set.patch(patch);
  const bool is_cut = regions_.any() && regions_.is_cut(patch);
  struct Part {
    PatchPart area;
    int halvings;
  };
  NetParts nets(of, frame_);
  std::vector<Part> left{{{0, 1, 0, 1}, 0}};
  while (!left.empty()) {
    const auto [area, halvings] = left.back();
    left.pop_back();
    QueryPiece piece{.patch = patch, .is_cut = false, .area = area, .facts = {}};
    if (is_cut) {
      const TrimSide side = side_of_all(regions_.of(patch), rectangle_of(set.source(patch).domain, area));
      if (side == TrimSide::outside) continue;
      piece.is_cut = side == TrimSide::border;
    }
    const PieceBounds bounds = bound_piece(nets.part(area));
    if (halvings < max_halvings && !is_flat(bounds)) {
      const auto [lower, upper] = halves(area, bounds.facts);
      left.push_back({upper, halvings + 1}), left.push_back({lower, halvings + 1});
      continue;
    }
    piece.facts = packed(bounds.facts);
    items.pieces.push_back(piece);
    items.piece_boxes.push_back({bounds.axis_box, bounds.box});
  }
}

/// Cuts the curves of a patch until they are nearly straight.
void QueryPieces::make_curves(const SetView& set, std::uint32_t patch, PatchItems& items) const {
  if (!regions_.any() || !regions_.is_cut(patch)) return;
  const CurveGround ground{&set.patch(patch), &set.source(patch).domain, &frame_, kernels_};
  const TrimRegion::Impl& region = impl_of(regions_.of(patch));
  for (const std::uint32_t index : regions_.pieces_of(patch)) {
    std::vector<std::pair<KeptCurve, int>> left{{{&region.pieces[index], patch, 0, 1, {}}, 0}};
    while (!left.empty()) {
      auto [curve, halvings] = left.back();
      left.pop_back();
      bound_bend(ground, curve);
      const double chord =
          length(point_of(ground, curve, curve.to).position - point_of(ground, curve, curve.from).position) *
          frame_.scale;
      if (sag_of(curve) > max_sag * chord && halvings < max_curve_halvings && sag_of(curve) > 1e-9) {
        const double middle = 0.5 * (curve.from + curve.to);
        KeptCurve lower = curve, upper = curve;
        lower.to = upper.from = middle;
        left.emplace_back(upper, halvings + 1), left.emplace_back(lower, halvings + 1);
        continue;
      }
      items.curves.push_back(curve);
      items.curve_boxes.push_back(boxes_of(ground, curve));
    }
  }
}

/// Joins the items of all patches, made in order of patches, and returns their boxes, of pieces first.
std::vector<ItemBoxes> QueryPieces::take_items(std::vector<PatchItems>&& made) {
  pieces_.clear(), curves_.clear();
  const std::size_t count = first_piece_.size() - 1;
  std::vector<ItemBoxes> boxes, curve_boxes;
  std::size_t piece_count = 0, curve_count = 0;
  for (const PatchItems& items : made) piece_count += items.pieces.size(), curve_count += items.curves.size();
  pieces_.reserve(piece_count), curves_.reserve(curve_count), boxes.reserve(piece_count + curve_count);
  for (std::size_t task = 0; task < made.size(); ++task) {
    const std::size_t end = std::min(count, (task + 1) * patches_per_task);
    for (std::size_t k = task * patches_per_task; k < end; ++k) {
      first_piece_[k + 1] += static_cast<std::uint32_t>(pieces_.size());
      first_curve_[k + 1] += static_cast<std::uint32_t>(curves_.size());
    }
    PatchItems items = std::move(made[task]);
    pieces_.insert(pieces_.end(), items.pieces.begin(), items.pieces.end());
    curves_.insert(curves_.end(), items.curves.begin(), items.curves.end());
    boxes.insert(boxes.end(), items.piece_boxes.begin(), items.piece_boxes.end());
    curve_boxes.insert(curve_boxes.end(), items.curve_boxes.begin(), items.curve_boxes.end());
  }
  boxes.insert(boxes.end(), curve_boxes.begin(), curve_boxes.end());
  return boxes;
}

Status QueryPieces::build(const SetView& set, const SceneFrame& frame, const Execution& execution) {
  const Result<Isa> isa = usable_isa({});
  if (!isa) return isa.status();
  kernels_ = &ray_kernels(*isa);
  frame_ = frame;
  if (Status status = regions_.build(set, execution); !status.ok()) return status;
  const std::size_t count = set.patch_count();
  std::vector<PatchItems> made((count + patches_per_task - 1) / patches_per_task);
  first_piece_.assign(count + 1, 0), first_curve_.assign(count + 1, 0);
  const auto make = [&](std::size_t begin, std::size_t end) {
    PatchItems& items = made[begin / patches_per_task];
    for (std::size_t k = begin; k < end; ++k) {
      const auto patch = static_cast<std::uint32_t>(k);
      make_pieces(set, patch, items), make_curves(set, patch, items);
      first_piece_[k + 1] = static_cast<std::uint32_t>(items.pieces.size());
      first_curve_[k + 1] = static_cast<std::uint32_t>(items.curves.size());
    }
  };
  if (Status status = parallel_for(count, patches_per_task, execution, make); !status.ok()) return status;
  const std::vector<ItemBoxes> boxes = take_items(std::move(made));
  if (boxes.size() >= std::size_t{1} << 31)
    return Status(StatusCode::unsupported, "more than 2^31 pieces of patches and curves");
  tree_.build(boxes);
  rounding_ = rounding_of(set);
  return {};
}

Status QueryPieces::update(const SetView& set, std::span<const std::uint32_t> patches, const Execution& execution) {
  std::vector<QueryTree::Change> changes;
  std::vector<std::size_t> first_change;  // of each edited patch
  const auto push_items = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) changes.push_back({static_cast<std::uint32_t>(k), {}});
  };
  for (const std::uint32_t patch : patches) {
    first_change.push_back(changes.size());
    push_items(first_piece_[patch], first_piece_[patch + 1]);
    push_items(pieces_.size() + first_curve_[patch], pieces_.size() + first_curve_[patch + 1]);
  }
  const auto remake = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) remake_items(set, patches[k], changes.data() + first_change[k]);
  };
  if (Status status = parallel_for(patches.size(), patches_per_task, execution, remake); !status.ok()) return status;
  tree_.refit(changes);
  return {};
}

/// Bounds the pieces and curves of a patch anew, at the same parameters.
void QueryPieces::remake_items(const SetView& set, std::uint32_t patch, QueryTree::Change* change) {
  const BezierPatch& of = set.patch(patch);
  NetParts nets(of, frame_);
  for (std::size_t k = first_piece_[patch]; k < first_piece_[patch + 1]; ++k, ++change) {
    const PieceBounds bounds = bound_piece(nets.part(pieces_[k].area));
    pieces_[k].facts = packed(bounds.facts);
    change->boxes = {bounds.axis_box, bounds.box};
  }
  const CurveGround ground{&of, &set.source(patch).domain, &frame_, kernels_};
  for (std::size_t k = first_curve_[patch]; k < first_curve_[patch + 1]; ++k, ++change) {
    bound_bend(ground, curves_[k]);
    change->boxes = boxes_of(ground, curves_[k]);
  }
}

std::size_t QueryPieces::memory_bytes() const {
  return pieces_.capacity() * sizeof(QueryPiece) + curves_.capacity() * sizeof(KeptCurve) +
         (first_piece_.capacity() + first_curve_.capacity()) * sizeof(std::uint32_t) + regions_.memory_bytes() +
         tree_.memory_bytes();
}

}}  // namespace tessera::abi_0_1
