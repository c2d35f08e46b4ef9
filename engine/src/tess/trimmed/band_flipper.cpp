#include "tess/trimmed/band_flipper.h"

#include <algorithm>

#include "basis/exact_sign.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double max_tilt = 0.134;    // of triangles that are left as they are: 30 degrees
constexpr double least_gain = 0.875;  // of the tilts, far above rounding

}  // namespace

const BandFlipper::Place& BandFlipper::place(std::uint32_t vertex) {
  Place& place = places_[vertex];
  if (!place.is_known) place = {points_.at(vertices_[vertex]), points_.normal(vertices_[vertex]), true};
  return place;
}

// A triangle without an area, or where the surface has no normal, has no tilt.
double BandFlipper::tilt(const Triangle& triangle) {
  const Place &a = place(triangle[0]), &b = place(triangle[1]), &c = place(triangle[2]);
  const Vec3 twice = cross(b.position - a.position, c.position - a.position);
  const Vec3 normal = a.normal + b.normal + c.normal;
  const double scale = length(twice) * length(normal);
  return scale > 0 ? 1 - dot(twice, normal) / scale : 0;
}

bool BandFlipper::is_ccw(const Triangle& triangle) const {
  return orientation(vertices_[triangle[0]], vertices_[triangle[1]], vertices_[triangle[2]]) > 0;
}

void BandFlipper::run(
    std::vector<Triangle>& triangles, std::size_t first,
    FunctionRef<bool(const Triangle& a, const Triangle& b, const Triangle& new_a, const Triangle& new_b)> may_flip,
    const std::atomic<bool>* cancel) {
  std::vector<double> tilts;
  std::vector<std::uint32_t> turned;
  const auto is_cancelled = [&] { return cancel && cancel->load(std::memory_order_relaxed); };
  for (std::size_t t = first; t < triangles.size() && !is_cancelled(); ++t) {
    tilts.push_back(tilt(triangles[t]));
    if (tilts.back() > max_tilt) turned.push_back(static_cast<std::uint32_t>(t));
  }
  if (turned.empty()) return;
  mesh_.link(triangles, first);
  const auto tilt_of = [&](std::uint32_t t) -> double& { return tilts[t - first]; };
  while (!turned.empty() && !is_cancelled()) {
    const std::uint32_t t = turned.back();
    turned.pop_back();
    if (!(tilt_of(t) > max_tilt)) continue;
    BandMesh::Edge best;
    double best_tilt = least_gain, best_tilts[2] = {};
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const BandMesh::Edge edge{t, corner}, other = mesh_.across(edge);
      if (!other.exists()) continue;
      const auto [own, others] = mesh_.flipped(edge);
      if (!is_ccw(own) || !is_ccw(others)) continue;
      const double before = std::max(tilt_of(t), tilt_of(other.triangle)), tilts_of[2] = {tilt(own), tilt(others)};
      const double after = std::max(tilts_of[0], tilts_of[1]) / before;
      if (!(after < best_tilt) || !may_flip(triangles[t], triangles[other.triangle], own, others)) continue;
      best = edge;
      best_tilt = after;
      std::ranges::copy(tilts_of, best_tilts);
    }
    if (!best.exists()) continue;
    const std::uint32_t neighbour = mesh_.across(best).triangle;
    if (!mesh_.flip(best)) continue;
    tilt_of(t) = best_tilts[0], tilt_of(neighbour) = best_tilts[1];
    for (const std::uint32_t changed : {t, neighbour})  // their neighbours may be flipped with them now
      for (std::uint32_t corner = 0; corner < 3; ++corner)
        if (const BandMesh::Edge beside = mesh_.across({changed, corner}); beside.exists())
          turned.push_back(beside.triangle);
  }
}

}}  // namespace tessera::abi_0_1
