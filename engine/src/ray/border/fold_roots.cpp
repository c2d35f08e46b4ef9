#include "ray/border/fold_roots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "ray/border/root_fan.h"
#include "ray/net/seen_point.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The patch beside a place on its border, to first order, as seen along the line.
class SeenCorner {
 public:
  SeenCorner(const SetView& set, const SceneFrame& frame, const RayLine& line, const LeafRoot& place, double apart)
      : inward_u_(inward(place, 0, apart)), inward_v_(inward(place, 2, apart)) {
    const FirstOrder at = first_order(set.patch(place.patch), place.u, place.v, frame.centre);
    f_ = seen({frame.scale * at.position, frame.scale * at.du, frame.scale * at.dv}, line);
    determinant_ = f_.xu * f_.yv - f_.xv * f_.yu;
  }
  bool is_edge_on() const {
    constexpr double sine = 1e-6;
    return !(std::abs(determinant_) > sine * std::hypot(f_.xu, f_.yu) * std::hypot(f_.xv, f_.yv));
  }
  bool upwards() const { return determinant_ > 0; }
  double residual() const { return f_.residual(); }
  /// The direction from the place into the patch.
  Vec3 into() const {
    const double u = inward_u_ / std::hypot(f_.xu, f_.yu), v = inward_v_ / std::hypot(f_.xv, f_.yv);
    return {f_.xu * u + f_.xv * v, f_.yu * u + f_.yv * v, 0};
  }
  bool holds(const Vec3& q) const {
    const double u = (q.x * f_.yv - q.y * f_.xv) / determinant_, v = (q.y * f_.xu - q.x * f_.yu) / determinant_;
    return (inward_u_ == 0 || u * inward_u_ > 0) && (inward_v_ == 0 || v * inward_v_ > 0);
  }

 private:
  /// 1 or -1 if the place reaches the edge, an index into link_sides, or the next one.
  static double inward(const LeafRoot& place, int edge, double apart) {
    return reaches_edge(place, edge, apart) ? 1 : reaches_edge(place, edge + 1, apart) ? -1 : 0;
  }

  double inward_u_, inward_v_, determinant_;
  NetValue f_;
};

/// Whether a root is that of its patch at a place of a fan.
bool is_at(const LeafRoot& root, const LeafRoot& place, double apart) {
  return root.patch == place.patch && std::abs(root.u - place.u) <= reach_u(root, apart) + reach_u(place, apart) &&
         std::abs(root.v - place.v) <= reach_v(root, apart) + reach_v(place, apart);
}

class FoldCompletion {
 public:
  FoldCompletion(const SetView& set, const Adjacency& borders, const SceneFrame& frame, const RayLine& line,
                 const RootSides& sides, std::vector<LeafRoot>& roots)
      : set_(set), borders_(borders), frame_(frame), line_(line), sides_(sides), roots_(roots), taken_(roots.size()) {
    for (const LeafRoot& root : roots)
      if (root.certified) farthest_ = std::max(farthest_, root.residual + root.noise);
  }

  void run() {
    const std::size_t given = roots_.size();
    for (std::size_t k = 0; k < given; ++k)
      if (!taken_[k] && roots_[k].certified)
        if (const std::optional<LeafRoot> other = missing(LeafRoot(roots_[k]))) roots_.push_back(*other);
    if (roots_.size() > given)
      std::stable_sort(roots_.begin(), roots_.end(), [](const LeafRoot& a, const LeafRoot& b) { return a.s < b.s; });
  }

 private:
  /// Returns the place to add beside a root, if there is one.
  std::optional<LeafRoot> missing(const LeafRoot& root) {
    const double near = root.residual + root.noise + farthest_, apart = around * near;
    if (RootFan(set_, borders_, root, near).beyond().empty()) return {};
    const Vec3 q = SeenCorner(set_, frame_, line_, root, apart).into();
    bool folds = false, is_odd = false;
    std::optional<LeafRoot> held, any;
    for (LeafRoot& place : places_around(root, apart)) {
      const SeenCorner corner(set_, frame_, line_, place, apart);
      const std::optional<std::size_t> found = take(place, apart);
      if (corner.is_edge_on() || is_at_pole(place, apart) || !found) return {};
      const bool holds = corner.holds(q);
      folds |= corner.upwards() != place.upwards;
      is_odd ^= holds != (*found % 2 == 1);
      if (*found > 0) continue;
      place.s = root.s, place.residual = corner.residual(), place.certified = false;
      (holds ? held : any) = place;
    }
    if (!folds || !is_odd) return {};
    return held ? held : any;
  }

  /// The places of a root in the patches around it, itself the first, that loops keep.
  std::vector<LeafRoot> places_around(const LeafRoot& root, double apart) const {
    std::vector<LeafRoot> places{root};
    const RootFan fan(set_, borders_, root, apart);
    for (const LeafRoot& place : fan.beyond()) {
      // A way around the border may come back, up to rounding.
      const auto is_here = [&](const LeafRoot& other) { return is_at(other, place, apart); };
      if (std::ranges::none_of(places, is_here) && sides_.keeps(place)) places.push_back(place);
    }
    return places;
  }

  bool is_at_pole(const LeafRoot& place, double apart) const {
    return std::ranges::any_of(std::array{0, 1, 2, 3},
                               [&](int edge) { return reaches_pole(set_, place, edge, apart); });
  }

  /// Counts the roots at a place that were not taken before; nothing if one is not certified.
  std::optional<std::size_t> take(const LeafRoot& place, double apart) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < roots_.size(); ++k) {
      if (!is_at(roots_[k], place, apart)) continue;
      if (!roots_[k].certified) return {};
      count += !taken_[k];
      taken_[k] = true;
    }
    return count;
  }

  // How far around a root the others may lie, as multiples of its rounding: beside it along a border that is slanted.
  static constexpr double around = 4096;

  const SetView& set_;
  const Adjacency& borders_;
  const SceneFrame& frame_;
  const RayLine& line_;
  const RootSides& sides_;
  std::vector<LeafRoot>& roots_;
  std::vector<bool> taken_;
  double farthest_ = 0;  // from the line, of any certified root
};

}  // namespace

void complete_folds(const SetView& set, const Adjacency& borders, const SceneFrame& frame, const RayLine& line,
                    const RootSides& sides, std::vector<LeafRoot>& roots) {
  FoldCompletion(set, borders, frame, line, sides, roots).run();
}

}}  // namespace tessera::abi_0_1
