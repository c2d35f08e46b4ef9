// The rays by OpenCASCADE's IntCurvesFace_Intersector, which intersects a face's surface itself and finds all hits of a
// line; the first one counts. It is slow, so it casts one ray in many.

#include <BRepBuilderAPI_MakeFace.hxx>
#include <IntCurvesFace_Intersector.hxx>
#include <Standard_Version.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Lin.hxx>

#include <algorithm>
#include <limits>
#include <memory>

#include "peers/interleaved.h"
#include "peers/occt_spline.h"
#include "peers/ray_task.h"

namespace tessera::bench { namespace {

constexpr std::size_t step = 211;  // a prime, to avoid single columns of pixels

class Casting {
 public:
  explicit Casting(const RayTask& task)
      : task_(task), intersector_(face_of(task), 1e-7), t_(task.camera.rays() / step + 1) {}

  double run() {
    return seconds_of([&] {
      for (std::size_t k = 0; k < t_.size() && k * step < task_.camera.rays(); ++k) t_[k] = closest(k * step);
    });
  }
  double t(std::size_t ray) const { return t_[ray / step]; }

 private:
  static TopoDS_Face face_of(const RayTask& task) {
    const double end = task.spans;
    return BRepBuilderAPI_MakeFace(uniform_spline(task.net, task.spans), 0.0, end, 0.0, end, 1e-7).Face();
  }

  /// The parameters along the line are lengths.
  double closest(std::size_t pixel) {
    const Ray ray = task_.camera.ray(pixel);
    const Vec3 &o = ray.origin, &d = ray.direction;
    intersector_.Perform(gp_Lin(gp_Pnt(o.x, o.y, o.z), gp_Dir(d.x, d.y, d.z)), 0.0, 4 * task_.size);
    double nearest = std::numeric_limits<double>::infinity();
    if (!intersector_.IsDone()) return nearest;
    for (int k = 1; k <= intersector_.NbPnt(); ++k) nearest = std::min(nearest, intersector_.WParameter(k));
    return nearest / length(d);
  }

  const RayTask& task_;
  IntCurvesFace_Intersector intersector_;
  std::vector<double> t_;
};

const bool registered = [] {
  ray_peers().push_back({"OpenCASCADE", [](const RayTask& task) {
                           const auto casting = std::make_shared<Casting>(task);
                           return std::vector<RayRun>{{"OpenCASCADE " OCC_VERSION_COMPLETE, "IntCurvesFace_Intersector",
                                                       step, [=] { return casting->run(); },
                                                       [=](std::size_t ray) { return casting->t(ray); }}};
                         }});
  return true;
}();

}}  // namespace tessera::bench
