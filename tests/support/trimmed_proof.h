#pragma once
// Compares hits on trimmed faces with proven roots of the whole surfaces and closed formulas of the loops.
//
// The reference proves all roots of a ray on the whole patches, in intervals of u and v. A formula tells how far a root
// is from the loops. Beyond its interval and the rounding of the loops' numbers, the root is kept or cut away for sure,
// and the scene must say so. At the loop of a plug, and in the gap between the plug and its hole, rounding is no
// excuse: one of the faces or their edge must be hit.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "support/ray_proof.h"
#include "support/trimmed_classes.h"

namespace tessera::test {

/// Beside the counts of whole patches. Rays at a loop are undecidable, too.
struct TrimmedTally : ProofTally {
  std::size_t at_loops = 0;             ///< rays with a root so near to a loop that rounding decides
  std::array<std::size_t, 3> near{};    ///< roots within 1e-5, 1e-8, 1e-11 of a loop that are kept or cut away for sure
  std::size_t edges = 0;                ///< closest hits of edges
  std::size_t between = 0;              ///< rays that must meet an edge, or a face where rounding decides which one
  std::size_t odd = 0, moved_rays = 0;  ///< rays moved aside at edges; of these, a wrong parity of all hits

  void add(const TrimmedTally& other) {
    ProofTally::add(other);
    at_loops += other.at_loops, edges += other.edges, between += other.between;
    odd += other.odd, moved_rays += other.moved_rays;
    for (std::size_t k = 0; k < near.size(); ++k) near[k] += other.near[k];
  }
  bool good() const { return missed == 0 && false_hits == 0 && wrong_patch == 0 && contradicted == 0 && odd == 0; }
};

/// A root on a whole face.
struct TrimmedRoot {
  enum class Kept { yes, no, unsure };
  std::uint32_t face = 0;
  Kept kept = Kept::unsure;
  bool is_proven = true;    ///< otherwise there may be no root
  bool is_at_plug = false;  ///< near enough to the loop of a plug to lie between it and its hole
  Real u = 0, v = 0;        ///< the middle of its interval
  Real wide = 0, high = 0;  ///< half of its interval's widths
  Real depth = 0;           ///< see OutlinedFace::depth()
  Interval t = {};
  double sine = 1;       ///< of the angle between ray and surface
  double stretch = 1;    ///< a point moves at least this far per parameter
  std::size_t hits = 0;  ///< of RayScene::all()
};

/// Checks one ray.
class TrimmedCheck {
 public:
  TrimmedCheck(const TrimmedCase& of, const Ray& ray, TrimmedTally& tally)
      : of_(of), ray_(ray), tally_(tally), speed_(length(ray.direction)), tolerance_(5e-12 * of.size) {
    find_roots();
    count_roots();
    const bool is_late = misses_first(), is_missing = misses_any();
    tally_.missed += is_late || is_missing;
  }

 private:
  using Kept = TrimmedRoot::Kept;

  template <class Condition>
  bool any_root(Condition condition) const {
    return std::ranges::any_of(roots_, condition);
  }
  bool must_meet_any() const {
    return any_root([&](const TrimmedRoot& root) { return must_be_met(root); });
  }

  void find_roots() {
    const Verdict verdict = reference_verdict(of_.patches, ray_);
    for (const Verdict::Root& root : verdict.hits) add(root, true);
    for (const Verdict::Root& root : verdict.undecided) add(root, false);
    drop_doubles();
  }

  void add(const Verdict::Root& found, bool is_proven) {
    const Domain& domain = of_.domains[found.patch];
    const auto middle = [](Interval x) { return (Real(x.lo) + x.hi) / 2; };
    const Real wide = Real(domain.u1) - domain.u0, high = Real(domain.v1) - domain.v0;
    TrimmedRoot root{.face = of_.face[found.patch], .t = found.t};
    root.is_proven = is_proven && found.t.width() * speed_ < 1e-9 * of_.size;
    const OutlinedFace& face = of_.faces[root.face];
    root.u = domain.u0 + wide * middle(found.u), root.v = domain.v0 + high * middle(found.v);
    root.wide = wide * found.u.width() / 2, root.high = high * found.v.width() / 2;
    root.depth = face.depth(root.u, root.v);
    const Real unsure = face.margin() + face.change(root.wide, root.high);
    if (std::abs(root.depth) > unsure) root.kept = root.depth > 0 ? Kept::yes : Kept::no;
    root.is_at_plug = of_.is_joined && root.depth > -(of_.reach + unsure);
    if (!root.is_proven && root.kept == Kept::no && !root.is_at_plug) return;
    const SurfaceJet jet = evaluate_jet(of_.patches[found.patch], found.u.middle(), found.v.middle());
    const Vec3 across = cross(jet.du, jet.dv);
    root.sine = std::abs(dot(normalized(across), ray_.direction)) / speed_;
    root.stretch = length(across) / std::max(length(jet.du) * double(high), length(jet.dv) * double(wide));
    roots_.push_back(root);
  }
  /// The reference may prove a root twice, in boxes that hold it alone. Keeps the narrower one.
  void drop_doubles() {
    const auto is_double = [&](const TrimmedRoot& root) {
      return any_root([&](const TrimmedRoot& other) {
        const bool is_narrower = other.wide + other.high < root.wide + root.high ||
                                 (other.wide + other.high == root.wide + root.high && &other < &root);
        return &other != &root && is_narrower && other.is_proven && other.face == root.face &&
               std::abs(other.u - root.u) <= root.wide + 1e-11L && std::abs(other.v - root.v) <= root.high + 1e-11L;
      });
    };
    std::vector<TrimmedRoot> kept;
    std::ranges::remove_copy_if(roots_, std::back_inserter(kept), is_double);
    roots_ = std::move(kept);
  }

  void count_roots() {
    constexpr std::array<Real, 3> distances{1e-5L, 1e-8L, 1e-11L};
    for (const TrimmedRoot& root : roots_)
      for (std::size_t k = 0; k < distances.size(); ++k)
        tally_.near[k] += root.is_proven && root.kept != Kept::unsure && std::abs(root.depth) < distances[k];
    const bool is_open = any_root([](const TrimmedRoot& root) { return !root.is_proven; });
    const bool is_at_loop =
        !of_.is_joined && any_root([](const TrimmedRoot& root) { return root.is_proven && root.kept == Kept::unsure; });
    const bool must_meet = must_meet_any();
    ++tally_.rays;
    tally_.at_loops += is_at_loop;
    tally_.undecidable += is_open || is_at_loop;
    tally_.hits += must_meet;
    tally_.misses += !must_meet && !is_open && !is_at_loop;
    tally_.between += any_root([&](const TrimmedRoot& root) { return root.kept != Kept::yes && must_be_met(root); });
  }

  /// How far t of a hit may be from a root's, as for whole patches (see check_ray()).
  double slack(const TrimmedRoot& root, const HitFlags& flags) const {
    const double strict = std::max(1e-9, 16 * 0x1p-53 / root.sine) * of_.size / speed_;
    const double loose = 4 * std::sqrt(tolerance_ * of_.size) / speed_;
    const bool is_aside = flags.edge || (root.is_at_plug && root.kept != Kept::yes);
    return (flags.uncertified ? std::max(strict, loose) : strict) + (is_aside ? edge_slack(root) : 0);
  }
  /// How far a ray may pass an edge that it hits. Even where faces fit, an edge has some breadth.
  double edge_reach() const { return 4 * of_.gap + 1e-10 * of_.size; }
  /// How far t of an edge's hit may be from that of a root beside it.
  double edge_slack(const TrimmedRoot& root) const { return 4 * edge_reach() / (root.sine * speed_); }
  bool is_near(const TrimmedRoot& root, const Hit& hit) const {
    return std::abs(hit.t - root.t.middle()) <= slack(root, hit.flags) + root.t.width();
  }

  /// Whether the scene must have a hit at a root: it is kept, or lies between a hole and its plug.
  bool must_be_met(const TrimmedRoot& root) const {
    if (!root.is_proven) return false;
    if (root.kept == Kept::yes) return true;
    return root.is_at_plug && !any_root([&](const TrimmedRoot& other) {
             return other.kept == Kept::yes && std::abs(other.t.middle() - root.t.middle()) <= edge_slack(root);
           });
  }

  /// Checks the closest hit, and whether there is any. Returns whether it is missing or too late.
  bool misses_first() {
    const Hit hit = of_.scene->closest(ray_);
    const bool is_met = hit.kind == HitKind::hit;
    tally_.contradicted += (of_.scene->occluded(ray_) == HitKind::hit) != is_met;
    tally_.incomplete += hit.flags.incomplete;
    tally_.edges += is_met && hit.flags.edge;
    if (is_met) check_place(hit);
    const TrimmedRoot* first = nullptr;
    for (const TrimmedRoot& root : roots_)
      if (must_be_met(root) && (first == nullptr || root.t.hi < first->t.hi)) first = &root;
    if (first == nullptr) return false;
    if (!is_met || hit.t > first->t.hi + slack(*first, hit.flags)) return true;
    if (first->kept == Kept::yes && !hit.flags.edge && nearest_root(hit) == first) note_errors(hit, *first);
    return false;
  }
  void note_errors(const Hit& hit, const TrimmedRoot& root) {
    tally_.t_errors.push_back(std::abs(hit.t - root.t.middle()) * speed_ / of_.size);
    tally_.u_errors.push_back(double(std::max(std::abs(hit.u - root.u), std::abs(hit.v - root.v))));
  }

  /// Checks all hits. Returns whether one is missing.
  bool misses_any() {
    HitLists lists;
    if (!of_.scene->all(std::span(&ray_, 1), lists).ok()) std::abort();
    const std::vector<Hit>& hits = lists.hits;
    const bool has_edge = std::ranges::any_of(hits, [](const Hit& hit) { return hit.flags.edge; });
    if (has_edge || (hits.empty() && any_root([](const TrimmedRoot& root) { return root.is_at_plug; }))) {
      check_moved(hits);
      return false;
    }
    for (const Hit& hit : hits) check_place(hit, true);
    bool is_missing = false;
    for (const TrimmedRoot& root : roots_) {
      tally_.false_hits += root.kept == Kept::yes && root.hits > 1;
      is_missing = is_missing || (must_be_met(root) &&
                                  std::ranges::none_of(hits, [&](const Hit& hit) { return is_near(root, hit); }));
    }
    return is_missing;
  }
  /// Checks the hits of a ray that was moved aside at an edge. As long as it stays off the domain's sides, the whole
  /// surface changes the number of its roots by even numbers only.
  void check_moved(const std::vector<Hit>& hits) {
    ++tally_.moved_rays;
    const auto is_amid = [](Real x) { return x > 0.02L && x < 0.98L; };
    std::size_t roots = 0;
    for (const TrimmedRoot& root : roots_) {
      if (!root.is_proven || !is_amid(root.u) || !is_amid(root.v)) return;
      roots += root.face == 0;
    }
    const bool is_unsure =
        std::ranges::any_of(hits, [](const Hit& hit) { return hit.flags.uncertified || hit.flags.incomplete; });
    tally_.odd += of_.gap < 1e-4 && !is_unsure && hits.size() % 2 != roots % 2;
  }

  /// Checks that a hit lies on its ray, and on a part of a face that is kept or on an edge. `counts`: notes it at the
  /// root.
  void check_place(const Hit& hit, bool counts = false) {
    const Vec3 p = de_casteljau(of_.set->patch(hit.patch), hit.patch_u, hit.patch_v);
    const double reach = std::max({max_abs(p), max_abs(ray_.origin), max_abs(p - ray_.origin)});
    const double rounding = 64 * 0x1p-53 * max_abs(p) + 0x1p-58 * reach, off = distance_from_line(p, ray_);
    const bool is_at_loop = std::abs(of_.faces[hit.surface].depth(hit.u, hit.v)) < 1e-9L;
    if (hit.t < ray_.tnear || hit.t > ray_.tfar || off > (hit.flags.edge ? edge_reach() : tolerance_ + rounding) ||
        (hit.flags.edge && !is_at_loop)) {
      ++tally_.false_hits;
      return;
    }
    if (hit.flags.edge) return;
    TrimmedRoot* const root = nearest_root(hit);
    if (root != nullptr) root->hits += counts;
    if (root != nullptr && root->kept != Kept::no) return;
    const bool is_touched = root == nullptr || std::abs(root->depth) * root->stretch * root->sine < 4 * tolerance_;
    if (hit.flags.uncertified && is_touched) {
      ++tally_.touching;
    } else {
      ++(root == nullptr && is_at_other_face(hit) ? tally_.wrong_patch : tally_.false_hits);
    }
  }
  /// The root that a hit stands for: of those near it along the ray, on its face, the nearest in the parameters.
  TrimmedRoot* nearest_root(const Hit& hit) {
    TrimmedRoot* nearest = nullptr;
    const auto away = [&](const TrimmedRoot& root) { return std::hypot(root.u - hit.u, root.v - hit.v); };
    for (TrimmedRoot& root : roots_)
      if (root.face == hit.surface && is_near(root, hit) && (nearest == nullptr || away(root) < away(*nearest)))
        nearest = &root;
    return nearest;
  }
  bool is_at_other_face(const Hit& hit) const {
    return any_root([&](const TrimmedRoot& root) {
      return root.face != hit.surface && root.kept == Kept::yes && is_near(root, hit);
    });
  }

  const TrimmedCase& of_;
  const Ray& ray_;
  TrimmedTally& tally_;
  double speed_, tolerance_;
  std::vector<TrimmedRoot> roots_;
};

}  // namespace tessera::test
