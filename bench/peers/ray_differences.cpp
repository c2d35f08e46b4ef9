#include "peers/ray_differences.h"

#include <BRepClass_FaceClassifier.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>

namespace tessera::bench {
namespace {

constexpr double grazing =
    1e-3;  // slope of a tangent ray: its two roots lie nearer together than about 1e-3 of the radius

double distance_from(const Ray& ray, const Vec3& p) {
  const Vec3 off = p - ray.origin;
  return length(off - dot(off, ray.direction) * ray.direction);
}

}  // namespace

RayReferee::RayReferee(const TrimmedCase& one, double tolerance) : case_(one), tolerance_(tolerance) {
  for (const auto& face : one.faces) {
    double largest = 0;
    for (TopExp_Explorer walk(face->face(), TopAbs_EDGE); walk.More(); walk.Next())
      largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Edge(walk.Current())));
    edge_tolerance_.push_back(largest);
  }
}

double RayReferee::reach(const FaceHit& hit) const {
  return (10 * tolerance_ + case_.fit_errors[hit.face]) / std::max(hit.slope, grazing);
}

bool RayReferee::is_near_edge(const FaceHit& hit) const {
  const TrueFace& face = *case_.faces[hit.face];
  return face.distance_from_border(face.point(hit.at)) <=
         edge_tolerance_[hit.face] + tolerance_ / std::max(hit.slope, grazing);
}

bool RayReferee::confirms(const Ray& ray, const FaceHit& hit) const {
  const TrueFace& face = *case_.faces[hit.face];
  if (distance_from(ray, face.point(hit.at)) > 10 * tolerance_ + case_.fit_errors[hit.face]) return false;
  const gp_Pnt2d at(hit.at[0], hit.at[1]);
  return face.contains(hit.at) && BRepClass_FaceClassifier(face.face(), at, 1e-12).State() != TopAbs_OUT;
}

RayCause RayReferee::cause(const Ray& ray, const FaceHit& hit, bool is_ours, std::span<const FaceHit> theirs) const {
  if (is_near_edge(hit)) return RayCause::edge;
  if (hit.slope < grazing) return RayCause::tangent;
  const bool is_kept = confirms(ray, hit);
  if (is_ours) return is_kept ? RayCause::missed : RayCause::unexplained;
  const auto count = std::ranges::count_if(
      theirs, [&](const FaceHit& other) { return other.face == hit.face && std::abs(other.t - hit.t) <= reach(hit); });
  if (count > 1) return RayCause::twice;
  return is_kept ? RayCause::unexplained : RayCause::refuted;
}

RayOutcome RayReferee::compare(const Ray& ray, std::span<const FaceHit> ours, std::span<const FaceHit> theirs) const {
  RayOutcome outcome;
  std::vector<bool> taken(theirs.size());
  for (const FaceHit& hit : ours) {
    std::size_t best = theirs.size();
    double least = reach(hit);
    for (std::size_t k = 0; k < theirs.size(); ++k)
      if (!taken[k] && theirs[k].face == hit.face && std::abs(theirs[k].t - hit.t) <= least)
        best = k, least = std::abs(theirs[k].t - hit.t);
    if (best == theirs.size()) {
      outcome.differences.push_back({hit, true, cause(ray, hit, true, theirs)});
      continue;
    }
    taken[best] = true;
    outcome.apart = std::max(outcome.apart, least);
  }
  for (std::size_t k = 0; k < theirs.size(); ++k)
    if (!taken[k]) outcome.differences.push_back({theirs[k], false, cause(ray, theirs[k], false, theirs)});
  return outcome;
}

}  // namespace tessera::bench
