#include "query/nearest_search.h"

#include <algorithm>
#include <cmath>

#include "ray/leaf/kept_part.h"
#include "ray/line/first_order.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double relative_slack = 0x1p-50;  // rounding of a distance by that of differences, relative to it
/// How far apart two places are that count as several nearest points, in the scene's coordinates.
constexpr double min_apart = 1e-6;
constexpr std::size_t max_stack = 256;

/// Whether a line of a patch lies on a side that has collapsed to a point.
bool is_point(const SetView& set, std::uint32_t patch, const PatchPart& line) {
  const SideMask collapsed = set.collapsed_sides(patch);
  return (collapsed.has(Side::u0) && line.u1 == 0) || (collapsed.has(Side::u1) && line.u0 == 1) ||
         (collapsed.has(Side::v0) && line.v1 == 0) || (collapsed.has(Side::v1) && line.v0 == 1);
}

/// Whether a candidate is nearer than another one. Up to the last digits, those where the line is perpendicular come
/// first: a foot just across a border of pieces is the nearest point of both. Of equally near ones the first by patch
/// and parameters counts, whichever was found first.
bool is_better(const NearCandidate& candidate, const NearCandidate& best, double slack) {
  const auto order = [](const NearCandidate& a) { return std::tie(a.distance, a.patch, a.u, a.v); };
  const double digits = 0.125 * slack;
  const bool is_as_near = best.patch != no_id && std::abs(candidate.distance - best.distance) <= digits;
  return is_as_near && candidate.on_border != best.on_border ? best.on_border : order(candidate) < order(best);
}

}  // namespace

NearestSearch::NearestSearch(const SetView& set, const QueryPieces& pieces) : set_(set), pieces_(pieces) {
  stack_.reserve(max_stack);
}

void NearestSearch::start(const Vec3& point, double max_distance) {
  const SceneFrame& frame = pieces_.frame();
  point_ = point - frame.centre;
  scene_point_ = frame.scale * point_;
  outcome_ = {};
  outcome_.slack = (2 * pieces_.rounding() + relative_slack * length(scene_point_)) / frame.scale;
  outcome_.best.distance = max_distance;
  parts_allowed_ = max_parts;
  tie_count_ = 0;
  reach_ = (max_distance + outcome_.slack) * frame.scale;
}

void NearestSearch::search(QueryTree::Path& path) {
  deferred_.clear();
  pieces_.tree().visit_near(path, *this);
  for (const Deferred& one : deferred_)
    if (one.lower <= reach_ && !search_item(one.item, one.lower, parts_allowed_)) outcome_.complete = false;
}

NearestSearch::Outcome NearestSearch::run(QueryTree::Path& path, const Vec3& point, double max_distance) {
  wanted_ = Wanted::nearest;
  start(point, max_distance);
  search(path);
  polish(outcome_.best);
  const double limit = outcome_.best.distance + outcome_.slack, scale = pieces_.frame().scale;
  for (std::size_t k = 0; k < tie_count_; ++k)
    outcome_.ambiguous |=
        ties_[k].distance <= limit && length(ties_[k].position - outcome_.best.position) * scale > min_apart;
  return outcome_;
}

NearestSearch::Outcome NearestSearch::run_all(QueryTree::Path& path, const Vec3& point, double distance) {
  wanted_ = Wanted::all_places;
  places_.clear();
  start(point, distance);
  search(path);
  std::swap(found_places_, places_);
  places_.clear();
  for (NearCandidate& one : found_places_) {
    polish(one);
    add_place(one);
  }
  std::ranges::sort(places_, {}, [](const NearCandidate& a) { return std::tuple(a.patch, a.u, a.v); });
  return outcome_;
}

NearestSearch::Outcome NearestSearch::run_patches(QueryTree::Path& path, const Vec3& point, double max_distance,
                                                  std::size_t count) {
  wanted_ = Wanted::patches, patches_wanted_ = count;
  places_.clear();
  start(point, max_distance);
  parts_allowed_ = max_parts + static_cast<int>(std::min(count, max_patches)) * parts_per_patch;
  search(path);
  for (NearCandidate& one : places_) polish(one);
  std::ranges::sort(places_, {}, [](const NearCandidate& a) { return std::tuple(a.distance, a.patch); });
  return outcome_;
}

/// Returns the distance beyond which points of a patch are of no use.
double NearestSearch::limit(std::uint32_t patch) const {
  if (wanted_ != Wanted::patches) return outcome_.best.distance;
  const auto known = std::ranges::find(places_, patch, &NearCandidate::patch);
  if (known != places_.end()) return known->distance;
  return places_.size() < patches_wanted_ ? outcome_.best.distance : places_.back().distance;
}

/// Keeps the nearest point of each of the nearest patches, the nearest first.
void NearestSearch::add_patch(const NearCandidate& candidate) {
  const auto known = std::ranges::find(places_, candidate.patch, &NearCandidate::patch);
  if (known != places_.end()) {
    if (!is_better(candidate, *known, outcome_.slack)) return;
    places_.erase(known);
  } else if (places_.size() == patches_wanted_) {
    places_.pop_back();
  }
  places_.insert(std::ranges::upper_bound(places_, candidate.distance, {}, &NearCandidate::distance), candidate);
  if (places_.size() == patches_wanted_)
    reach_ = std::min(reach_, (places_.back().distance + outcome_.slack) * pieces_.frame().scale);
}

/// Moves a candidate to the foot of a perpendicular near it. It may be one of a part's border or of few steps, which is
/// as near up to rounding, but off to the side by the root of that.
void NearestSearch::polish(NearCandidate& candidate) const {
  if (candidate.patch == no_id || candidate.is_on_curve || (candidate.is_exact && !candidate.on_border)) return;
  const Foot foot =
      nearest_foot(ground(candidate.patch), point_, {0, 1, 0, 1}, candidate.u, candidate.v, infinity, outcome_.slack);
  const bool is_cut = pieces_.regions().any() && pieces_.regions().is_cut(candidate.patch);
  if (!foot.converged || foot.distance > candidate.distance + outcome_.slack) return;
  if (is_cut && !is_kept(candidate.patch, foot.u, foot.v)) return;
  candidate.u = foot.u, candidate.v = foot.v, candidate.position = foot.position, candidate.distance = foot.distance;
  candidate.on_border = foot.on_border;
}

/// Whether places of a patch are one: a straight way between them in the parameters stays near.
bool NearestSearch::is_same_place(const NearCandidate& a, const NearCandidate& b) const {
  if (a.patch != b.patch) return false;
  const double near = 4 * (outcome_.best.distance + outcome_.slack);
  const auto is_near = [&](double share) {
    const FirstOrder at =
        first_order(set_.patch(a.patch), a.u + share * (b.u - a.u), a.v + share * (b.v - a.v), pieces_.frame().centre);
    return length(at.position - a.position) <= near;
  };
  return is_near(0.25) && is_near(0.5) && is_near(0.75);
}

/// Keeps a place, or the nearer one of two that are the same.
void NearestSearch::add_place(const NearCandidate& candidate) {
  for (NearCandidate& known : places_) {
    if (!is_same_place(known, candidate)) continue;
    const auto order = [](const NearCandidate& a) { return std::tuple(a.on_border, a.distance, a.u, a.v); };
    if (order(candidate) < order(known)) known = candidate;
    return;
  }
  places_.push_back(candidate);
}

bool NearestSearch::visit(std::uint32_t item, double distance) {
  if (outcome_.parts >= parts_allowed_) {
    outcome_.complete = false;
    return false;
  }
  const std::span<const QueryPiece> pieces = pieces_.pieces();
  bool has_work = outcome_.parts < parts_allowed_ / 4;
  if (item < pieces.size()) {
    const QueryPiece& piece = pieces[item];
    ++outcome_.parts;
    if (is_decided(piece, piece.area, piece.facts)) return true;
    // The nearest kept point of a cut piece may lie on a curve: once that is known, few parts of the piece are left.
    has_work &= !piece.is_cut;
  }
  if (!has_work || !search_item(item, distance, first_parts)) deferred_.push_back({item, distance});
  return true;
}

/// Searches a piece or a curve, at least `lower` away, with at most `parts` of work. Returns whether that sufficed.
bool NearestSearch::search_item(std::uint32_t item, double lower, int parts) {
  const std::span<const QueryPiece> pieces = pieces_.pieces();
  return item < pieces.size() ? branch(pieces[item], lower, parts)
                              : search_curve(pieces_.curves()[item - pieces.size()], parts);
}

bool NearestSearch::search_curve(const KeptCurve& curve, int parts) {
  const CurveGround ground{&set_.patch(curve.patch), &set_.source(curve.patch).domain, &pieces_.frame(),
                           &pieces_.kernels()};
  const Foot foot = nearest_foot(ground, curve, point_, limit(curve.patch) + outcome_.slack,
                                 std::min(parts_allowed_, outcome_.parts + parts), outcome_.parts);
  if (!foot.is_farther) offer({curve.patch, foot.u, foot.v, foot.position, foot.distance, true, true, true});
  return foot.converged;
}

/// Finds the nearest point of an area if its place is clear: at a corner, or on a side or within, where the distance is
/// convex.
template <class T>
bool NearestSearch::is_decided(const QueryPiece& piece, const PatchPart& area, const PieceFacts<T>& facts) {
  const DistanceShape shape = distance_shape(facts, scene_point_);
  bool has_u = shape.along_x == Slope::unknown, has_v = shape.along_y == Slope::unknown;
  PatchPart part = area;
  if (!has_u) part.u0 = part.u1 = shape.along_x == Slope::rises ? area.u0 : area.u1;
  if (!has_v) part.v0 = part.v1 = shape.along_y == Slope::rises ? area.v0 : area.v1;
  if (has_u != has_v && is_point(set_, piece.patch, part)) {
    part.u0 = part.u1, part.v0 = part.v1;
    has_u = has_v = false;
  }
  if (has_u && has_v ? !shape.convex : has_u ? !shape.convex_x : has_v && !shape.convex_y) return false;
  // The start is the foot on the tangent plane.
  const Vec3 from = scene_point_ - Vec3(facts.centre);
  const double c = facts.cosine, p = dot(from, Vec3(facts.axes[0]));
  const double q = c * p + double(facts.sine) * dot(from, Vec3(facts.axes[1]));
  const double det = std::max(1 - c * c, 1e-3);
  const double x = has_u && has_v ? (p - c * q) / det : p, y = has_u && has_v ? (q - c * p) / det : q;
  const double u = 0.5 + x / double(facts.length_u), v = 0.5 + y / double(facts.length_v);
  const Foot foot =
      nearest_foot(ground(piece.patch), point_, part, area.u0 + u * (area.u1 - area.u0),
                   area.v0 + v * (area.v1 - area.v0), limit(piece.patch) + outcome_.slack, outcome_.slack);
  if (foot.is_farther) return true;
  offer(piece, foot);
  return foot.converged;
}

/// Halves a piece, at least `lower` away, until each part is decided, or cannot be nearer by more than rounding.
/// Returns whether `parts` sufficed, and what is left of parts_allowed_.
bool NearestSearch::branch(const QueryPiece& piece, double lower, int parts) {
  const int most_parts = std::min(parts_allowed_, outcome_.parts + parts);
  const double rounding = 4 * outcome_.slack * pieces_.frame().scale;
  stack_.clear();
  if (is_cut_away(piece, piece.area) || !may_be_nearer(piece, piece.area, lower)) return true;
  if (++outcome_.parts >= most_parts) return false;
  halve(piece, piece.area, piece.facts);
  while (!stack_.empty()) {
    const Part part = stack_.back();
    stack_.pop_back();
    if (part.lower > reach_ || is_decided(piece, part.area, part.bounds.facts)) continue;
    if (!may_be_nearer(piece, part.area, part.lower)) continue;
    // All points of the part are as near as each other, up to rounding.
    const bool all = wanted_ == Wanted::all_places;
    const double point_size = all ? std::max(rounding, limit(piece.patch) * pieces_.frame().scale) : rounding;
    if (part.bounds.box.diagonal() <= point_size) continue;
    if (++outcome_.parts >= most_parts || stack_.size() + 2 > max_stack) return false;
    halve(piece, part.area, part.bounds.facts);
  }
  return true;
}

/// Moves the limit by a few steps from the middle of an area, since where its nearest point lies is not clear. Returns
/// whether a point of the area, at least `lower` away, can still be nearer by more than rounding.
bool NearestSearch::may_be_nearer(const QueryPiece& piece, const PatchPart& area, double lower) {
  constexpr int few_steps = 3;
  offer(piece, nearest_foot(ground(piece.patch), point_, area, 0.5 * (area.u0 + area.u1), 0.5 * (area.v0 + area.v1),
                            infinity, outcome_.slack, few_steps));
  const double rounding = wanted_ == Wanted::all_places ? 0 : outcome_.slack;
  return lower < (limit(piece.patch) - rounding) * pieces_.frame().scale;
}

/// Puts the halves of an area on the stack, the nearer one on top.
template <class T>
void NearestSearch::halve(const QueryPiece& piece, const PatchPart& area, const PieceFacts<T>& facts) {
  const auto [first, second] = halves(area, facts);
  push(piece, first), push(piece, second);
  const std::size_t count = stack_.size();
  if (count >= 2 && stack_[count - 2].lower < stack_[count - 1].lower) std::swap(stack_[count - 2], stack_[count - 1]);
}

/// Puts a part on the stack, unless loops cut it away or it is too far.
void NearestSearch::push(const QueryPiece& piece, const PatchPart& area) {
  if (is_cut_away(piece, area)) return;
  if (patch_of_nets_ != piece.patch) nets_.start(set_.patch(piece.patch), pieces_.frame());
  patch_of_nets_ = piece.patch;
  const PieceBounds bounds = bound_piece(nets_.part(area));
  const double lower = bounds.box.distance(scene_point_);
  if (lower <= reach_) stack_.push_back({area, lower, bounds});
}

bool NearestSearch::is_cut_away(const QueryPiece& piece, const PatchPart& area) const {
  if (!piece.is_cut) return false;
  const Domain box = rectangle_of(set_.source(piece.patch).domain, area);
  const TrimRegion& region = pieces_.regions().of(piece.patch);
  const TrimSide side = side_of_all(region, box);
  if (side != TrimSide::border) return side == TrimSide::outside;
  // Cells do not tell where a box lies across their sides, however small it is. The pieces do.
  return kept_part(region, pieces_.regions().pieces_of(piece.patch), box).use == PatchUse::out;
}

bool NearestSearch::is_kept(std::uint32_t patch, double u, double v) const {
  const Domain& domain = set_.source(patch).domain;
  return pieces_.regions().of(patch).locate(domain.u_at(u), domain.v_at(v)) != TrimSide::outside;
}

void NearestSearch::offer(const QueryPiece& piece, const Foot& foot) {
  if (!(foot.distance <= limit(piece.patch) + outcome_.slack)) return;
  if (piece.is_cut && !is_kept(piece.patch, foot.u, foot.v)) return;
  offer({piece.patch, foot.u, foot.v, foot.position, foot.distance, foot.on_border, foot.converged});
}

/// Takes a candidate if it is the nearest so far. Others that are as near up to rounding are kept as ties.
void NearestSearch::offer(const NearCandidate& candidate) {
  if (!(candidate.distance <= limit(candidate.patch) + outcome_.slack)) return;
  if (wanted_ == Wanted::all_places) return add_place(candidate);
  if (wanted_ == Wanted::patches) return add_patch(candidate);
  NearCandidate& best = outcome_.best;
  const bool wins = is_better(candidate, best, outcome_.slack);
  const NearCandidate other = wins ? best : candidate;
  if (wins) best = candidate;
  reach_ = std::min(reach_, (best.distance + outcome_.slack) * pieces_.frame().scale);
  if (other.patch == no_id || length(other.position - best.position) * pieces_.frame().scale <= min_apart) return;
  if (tie_count_ == max_ties) {  // the farthest is of the least use
    const auto farthest = std::ranges::max_element(ties_, {}, &NearCandidate::distance);
    if (other.distance < farthest->distance) *farthest = other;
  } else {
    ties_[tie_count_++] = other;
  }
}

}}  // namespace tessera::abi_0_1
