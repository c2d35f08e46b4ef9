#pragma once
// Generalized winding numbers of points with regard to the surfaces of a ray scene.

#include <span>

#include "query/set_orientation.h"
#include "ray/scene/exact_source.h"
#include "ray/scene/ray_scene_impl.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The number of a point is the solid angle that the surface covers, seen from there, as a share of a sphere: see
/// border_arc.h. Const calls from any number of threads.
class WindingNumbers {
 public:
  /// `scene`: in exact mode, of all patches, with its borders prepared. Errors: cancelled, those of rays.
  static Result<WindingNumbers> make(const RayScene::Impl& scene, const Execution& execution);

  const SetOrientation& orientation() const { return orientation_; }
  /// Writes the numbers of a task's points; NaN for those that make no valid ray.
  Status find(std::span<const Vec3> points, std::span<double> numbers) const;
  /// Returns the number by one direction, and whether it is sure. Errors: those of rays.
  Status number_along(const Vec3& point, const Vec3& direction, AngleShare& number) const;

 private:
  explicit WindingNumbers(const RayScene::Impl& scene) : scene_(&scene) {}
  const LeafTracer& tracer() const { return scene_->exact_source()->tracer(); }
  AngleShare number_by(const Ray& ray, std::span<const Hit> hits) const;
  Status settle(const Vec3& point, double& number) const;
  Status face_outwards(const Execution& execution);

  const RayScene::Impl* scene_;
  SetOrientation orientation_;
};

}}  // namespace tessera::abi_0_1
