// Nearest points by OpenCASCADE's GeomAPI_ProjectPointOnSurf, which finds all points where the line is perpendicular to
// the surface; the nearest one counts. It is slow, so it searches from one point in many.

#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <Standard_Version.hxx>

#include <limits>
#include <memory>

#include "peers/interleaved.h"
#include "peers/nearest_task.h"
#include "peers/occt_spline.h"

namespace tessera::bench { namespace {

constexpr std::size_t step = 499;  // a prime

class Projection {
 public:
  explicit Projection(const NearestTask& task) : task_(task), distances_((task.points.size() + step - 1) / step) {
    const double end = task.spans, tolerance = 1e-9 * task.size;
    projection_.Init(uniform_spline(task.net, task.spans), 0, end, 0, end, tolerance, Extrema_ExtAlgo_Grad);
  }
  double run() {
    return seconds_of([&] {
      for (std::size_t k = 0; k < distances_.size(); ++k) {
        const Vec3& p = task_.points[k * step];
        projection_.Perform(gp_Pnt(p.x, p.y, p.z));
        const bool is_found = projection_.IsDone() && projection_.NbPoints() > 0;
        distances_[k] = is_found ? projection_.LowerDistance() : std::numeric_limits<double>::quiet_NaN();
      }
    });
  }
  double distance(std::size_t point) const { return distances_[point / step]; }

 private:
  const NearestTask& task_;
  GeomAPI_ProjectPointOnSurf projection_;
  std::vector<double> distances_;
};

const bool registered = [] {
  nearest_peers().push_back({"OpenCASCADE", [](const NearestTask& task) {
                               const auto projection = std::make_shared<Projection>(task);
                               return NearestRun{"OpenCASCADE " OCC_VERSION_COMPLETE, "GeomAPI_ProjectPointOnSurf",
                                                 step, [=] { return projection->run(); },
                                                 [=](std::size_t point) { return projection->distance(point); }};
                             }});
  return true;
}();

}}  // namespace tessera::bench
