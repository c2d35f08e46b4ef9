#include "measure/extent_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/impl_access.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Takes what is there of a region, without a copy for whole faces.
const TrimRegion::Impl* region_of(const MeasuredFace& face) {
  return face.region && !face.region->is_whole() ? &impl_of(*face.region) : nullptr;
}

ScalarRange product(const ScalarRange& a, const ScalarRange& b, double scale) {
  const auto [low, high] = std::minmax({a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper});
  return {scale * low, scale * high};
}
ScalarRange sum(const ScalarRange& a, const ScalarRange& b) { return {a.lower + b.lower, a.upper + b.upper}; }

/// The rectangle between the ends of a curve.
Domain box_of(const LocalCurve& curve) {
  const auto [u0, u1] = std::minmax({std::clamp(curve.start().u, 0.0, 1.0), std::clamp(curve.end().u, 0.0, 1.0)});
  const auto [v0, v1] = std::minmax({std::clamp(curve.start().v, 0.0, 1.0), std::clamp(curve.end().v, 0.0, 1.0)});
  return {u0, u1, v0, v1};
}

}  // namespace

ExtentSearch::ExtentSearch(const MeasuredFace& face, int axis, double sign)
    : face_(face), axis_(axis), sign_(sign), nets_(face.grid.patches().size()) {
  const Box3& box = face.grid.box();
  // Cutting a net takes at most 2 * 15 levels of 3 roundings each in a direction.
  slack_ = 0x1p-46 * std::max(max_abs(box.lower), max_abs(box.upper)) + face.data_error;
}

bool ExtentSearch::is_cut(std::size_t patch) const {
  const TrimRegion::Impl* const region = region_of(face_);
  return region && region->patches[patch] == TrimSide::border;
}

const ScalarNet& ExtentSearch::net(std::size_t patch) {
  if (!nets_[patch]) nets_[patch].emplace(face_.grid.patches()[patch], axis_, sign_);
  return *nets_[patch];
}

double ExtentSearch::at(std::size_t patch, const ParameterPoint& p) {
  const double u = std::clamp(p.u, 0.0, 1.0), v = std::clamp(p.v, 0.0, 1.0);
  return net(patch).restricted({u, u, v, v}).corner(false, false);
}

double ExtentSearch::quick() const {
  double most = -std::numeric_limits<double>::infinity();
  const auto take = [&](const Vec3& p) {
    most = std::max(most, sign_ * (axis_ == 0 ? p.x : axis_ == 1 ? p.y : p.z) - slack_);
  };
  const TrimRegion::Impl* const region = region_of(face_);
  for (std::size_t place = 0; place < nets_.size(); ++place) {
    if (region && region->patches[place] != TrimSide::inside) continue;
    const BezierPatch& patch = face_.grid.patches()[place];
    for (const int i : {0, patch.degree_u()})
      for (const int j : {0, patch.degree_v()}) take(patch.point(i, j));
  }
  return most;
}

TrimSide ExtentSearch::side(std::size_t patch, const Domain& window) const {
  if (!is_cut(patch)) return TrimSide::inside;
  const Domain domain = face_.grid.patch_domain(patch), all = face_.grid.domain();
  constexpr double grown = 1e-12;  // far above the rounding of the window's ends
  const double du = grown * (all.u1 - all.u0), dv = grown * (all.v1 - all.v0);
  return impl_of(*points_).cells.locate_all(
      {std::max(domain.u_at(window.u0) - du, all.u0), std::min(domain.u_at(window.u1) + du, all.u1),
       std::max(domain.v_at(window.v0) - dv, all.v0), std::min(domain.v_at(window.v1) + dv, all.v1)});
}

void ExtentSearch::push(Part part) {
  if (!(part.bound > reached_ + tolerance_)) return leave(part.bound);
  part.number = made_++;
  open_.push_back(std::move(part));
  std::push_heap(open_.begin(), open_.end());
}

void ExtentSearch::add_window(std::size_t patch, const Domain& window) {
  const ScalarNet part = net(patch).restricted(window);
  const double bound = part.highest() + slack_;
  if (!(bound > reached_ + tolerance_)) return leave(bound);
  const TrimSide where = side(patch, window);
  if (where == TrimSide::outside) return;
  for (const bool last_u : {false, true})
    for (const bool last_v : {false, true}) {
      const Domain corner{last_u ? window.u1 : window.u0, last_u ? window.u1 : window.u0,
                          last_v ? window.v1 : window.v0, last_v ? window.v1 : window.v0};
      if (where == TrimSide::inside || side(patch, corner) == TrimSide::inside) reach(part.corner(last_u, last_v));
    }
  const bool is_point = window.u0 == window.u1 && window.v0 == window.v1;
  if (is_point && where != TrimSide::inside) return push({bound, patch, 0, window});
  if (is_point || (window.u0 < window.u1 && !part.by_u().has_zero())) return;
  if (window.v0 < window.v1 && !part.by_v().has_zero()) return;
  push({bound, patch, 0, window});
}

void ExtentSearch::add_curve(std::size_t patch, const LocalCurve& curve, double band) {
  const Domain window = box_of(curve);
  const ScalarNet part = net(patch).restricted(window);
  const double from = at(patch, curve.start()), to = at(patch, curve.end());
  reach(from - band), reach(to - band);
  // Along the curve, the derivative is r_u u' + r_v v', where r_u and r_v are by the window's parameters.
  const LocalCurve::Slopes slopes = curve.slopes();
  const double width = window.u1 - window.u0, height = window.v1 - window.v0;
  const ScalarRange along = sum(width > 0 ? product(part.by_u(), slopes.u, 1 / width) : ScalarRange{0, 0},
                                height > 0 ? product(part.by_v(), slopes.v, 1 / height) : ScalarRange{0, 0});
  // A function of [0, 1] with slopes in this range exceeds its ends by no more than this.
  const double rise = along.has_zero() ? std::min(along.upper, -along.lower) : 0;
  const double bound = std::min(part.highest(), std::max(from, to) + rise) + slack_ + band;
  if (rise > 0) return push({bound, patch, 0, window, curve, band});
  leave(bound);
}

void ExtentSearch::add_patch(std::size_t place) {
  const TrimRegion::Impl* const region = region_of(face_);
  if (region && region->patches[place] == TrimSide::outside) return;
  if (const double bound = net(place).highest() + slack_; !(bound > reached_ + tolerance_)) return leave(bound);
  if (is_cut(place) && !points_) points_ = TrimRegion::Impl::for_points(*face_.region);
  // Corners, sides, and the inside.
  for (const double u : {0.0, 1.0})
    for (const double v : {0.0, 1.0}) add_window(place, {u, u, v, v});
  for (const double x : {0.0, 1.0}) add_window(place, {x, x, 0, 1}), add_window(place, {0, 1, x, x});
  add_window(place, {0, 1, 0, 1});
  if (!is_cut(place)) return;
  const Domain patch = face_.grid.patch_domain(place);
  const double by_u = net(place).by_u().magnitude(), by_v = net(place).by_v().magnitude();
  for (const std::uint32_t k : region->pieces_of(place)) {
    const TrimPiece& piece = region->pieces[k];
    ParameterPoint band = piece.error;
    if (piece.start().u != piece.end().u && piece.start().v != piece.end().v) band = band + face_.loop_error;
    const LocalCurve curve(piece.curve, patch);
    const double rounding = 64 * curve.rounding();  // of halves of halves too
    const double off_u = band.u / (patch.u1 - patch.u0) + rounding, off_v = band.v / (patch.v1 - patch.v0) + rounding;
    add_curve(place, curve, off_u * by_u + off_v * by_v);
  }
}

void ExtentSearch::halve(const Part& part) {
  if (part.curve) {
    const auto [left, right] = part.curve->halves();
    add_curve(part.patch, left, part.band), add_curve(part.patch, right, part.band);
    return;
  }
  const Domain& w = part.window;
  const ScalarNet of = net(part.patch).restricted(w);
  const bool along_u = w.v0 == w.v1 || (w.u0 < w.u1 && of.variation(true) >= of.variation(false));
  const double u = along_u ? 0.5 * (w.u0 + w.u1) : w.u1, v = along_u ? w.v1 : 0.5 * (w.v0 + w.v1);
  add_window(part.patch, {w.u0, u, w.v0, v});
  add_window(part.patch, along_u ? Domain{u, w.u1, w.v0, w.v1} : Domain{w.u0, w.u1, v, w.v1});
}

Extent ExtentSearch::run(double reached, double tolerance, std::size_t max_cells) {
  reached_ = reached, tolerance_ = tolerance;
  for (std::size_t place = 0; place < nets_.size(); ++place) add_patch(place);
  for (std::size_t cells = 0; !open_.empty() && cells < max_cells; ++cells) {
    std::pop_heap(open_.begin(), open_.end());
    const Part top = std::move(open_.back());
    open_.pop_back();
    if (!(top.bound > reached_ + tolerance_)) {
      leave(top.bound);
      open_.clear();
      break;
    }
    if (!top.curve && top.window.u0 == top.window.u1 && top.window.v0 == top.window.v1) {
      leave(top.bound);  // a corner of which it is not known whether it is kept
      continue;
    }
    halve(top);
  }
  if (!open_.empty()) leave(open_.front().bound);
  return {reached_, std::max(reached_, left_)};
}

}}  // namespace tessera::abi_0_1
