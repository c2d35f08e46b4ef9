#pragma once
// Curves of loops in space, with samples that lead to their nearest points.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "model/face_points.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns `status` as "face 3 (rim): ...", with the index 3.
Status in_face(const Shape& shape, std::size_t face, const Status& status);

/// Where a curve of a loop lies in space.
enum class Line : std::uint8_t {
  on_face,  ///< where the face is
  stated,   ///< where its edge says, by its curve; on the face if the edge states none
};

/// A curve of a face's loop in space. The shape must outlive it, and its loops and edges stay.
class SpaceCurve {
 public:
  struct Sample {
    double t;
    Vec3 point;
  };
  static constexpr double max_sagitta = 1.0 / 16;

  /// Samples the curve so densely that it stays near its chords: within max_sagitta of their length, as sampled.
  /// Failures of evaluations go to `failure`, the first of all; points are zero from then on.
  SpaceCurve(const Shape& shape, const EdgeUse& use, Line line, Status& failure);

  const Curve& curve() const { return *curve_; }
  const Interval& domain() const { return curve_->domain(); }
  /// In order of t, both ends included.
  std::span<const Sample> samples() const { return samples_; }
  /// The largest distance of a sample from the first.
  double extent() const { return extent_; }
  Vec3 at(double t) const { return evaluate(t).position; }

  struct Nearest {
    double t = 0, distance = 0;
  };
  /// The nearest point of the curve between two parameters, by Newton's method from the nearest chord; 5 to 10
  /// evaluations.
  Nearest nearest(const Vec3& p, const Interval& within) const;
  /// Whether the face is a strip between this curve at t and another one of it at s: the point at the mean of their
  /// parameters is kept by its loops, and within `reach`.
  bool has_strip(double t, const SpaceCurve& other, double s, double reach) const;
  /// Finds the nearest point by Newton's method, from a parameter near it.
  Nearest nearest_from(const Vec3& p, double t, const Interval& within) const;

 private:
  FacePoint evaluate(double t) const;
  void append(const Sample& from, const Sample& to, int depth);

  const Shape* shape_;
  std::uint32_t face_;
  const Curve* curve_;
  const Coedge* coedge_;
  const BrepEdge* edge_ = nullptr;  ///< whose curve it is, if not on the face
  Status* failure_;
  std::vector<Sample> samples_;
  double extent_ = 0;
};

/// Where a segment from a to b is nearest to p: 0 at a, 1 at b.
double nearest_fraction(const Vec3& a, const Vec3& b, const Vec3& p);

}}  // namespace tessera::abi_0_1
