// The grid by OpenCASCADE, point by point: by Geom_BSplineSurface, and by BSplSLib_Cache, which keeps the polynomial of
// one span. Spans are taken one after the other, so that each polynomial is made once.

#include <BSplSLib_Cache.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Standard_Version.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <memory>

#include "peers/grid_task.h"
#include "peers/interleaved.h"

namespace tessera::bench { namespace {

class Evaluation {
 public:
  explicit Evaluation(const GridTask& task)
      : task_(task), knots_(1, task.spans + 7), poles_(1, task.side(), 1, task.side()) {
    TColStd_Array1OfInteger once(1, task.spans + 7);
    for (int k = 1; k <= task.spans + 7; ++k) {
      knots_.SetValue(k, k - 4);
      once.SetValue(k, 1);
    }
    for (int i = 0; i < task.side(); ++i)
      for (int j = 0; j < task.side(); ++j) {
        const Vec3& p = task.net[static_cast<std::size_t>(i * task.side() + j)];
        poles_.SetValue(i + 1, j + 1, gp_Pnt(p.x, p.y, p.z));
      }
    surface_ = new Geom_BSplineSurface(poles_, knots_, knots_, once, once, 3, 3);
    position_.resize(task.points());
    if (task.tangents) du_.resize(task.points()), dv_.resize(task.points());
  }

  double run_surface() {
    return seconds_of([&] {
      for_each_span([&](int, int) {},
                    [&](double u, double v, std::size_t at) {
                      if (task_.tangents) {
                        surface_->D1(u, v, position_[at], du_[at], dv_[at]);
                      } else {
                        surface_->D0(u, v, position_[at]);
                      }
                    });
    });
  }
  double run_cache() {
    return seconds_of([&] {
      BSplSLib_Cache cache(3, false, knots_, 3, false, knots_);
      for_each_span([&](int a, int b) { cache.BuildCache(a + 0.5, b + 0.5, knots_, knots_, poles_); },
                    [&](double u, double v, std::size_t at) {
                      if (task_.tangents) {
                        cache.D1(u, v, position_[at], du_[at], dv_[at]);
                      } else {
                        cache.D0(u, v, position_[at]);
                      }
                    });
    });
  }

  GridValue read(std::size_t i, std::size_t j) const {
    const auto n = static_cast<std::size_t>(task_.per_span);
    const std::size_t span = i / n * static_cast<std::size_t>(task_.spans) + j / n;
    const std::size_t at = (span * n + i % n) * n + j % n;
    const auto vector = [](const auto& p) { return Vec3{p.X(), p.Y(), p.Z()}; };
    if (!task_.tangents) return {vector(position_[at]), {}, {}};
    return {vector(position_[at]), vector(du_[at]), vector(dv_[at])};
  }

 private:
  template <class Span, class Point>
  void for_each_span(Span span, Point point) {
    std::size_t at = 0;
    for (int a = 0; a < task_.spans; ++a)
      for (int b = 0; b < task_.spans; ++b) {
        span(a, b);
        for (const double s : task_.local)
          for (const double t : task_.local) point(a + s, b + t, at++);
      }
  }

  const GridTask& task_;
  TColStd_Array1OfReal knots_;
  TColgp_Array2OfPnt poles_;
  Handle(Geom_BSplineSurface) surface_;
  std::vector<gp_Pnt> position_;
  std::vector<gp_Vec> du_, dv_;
};

const bool registered = [] {
  grid_peers().push_back({"OpenCASCADE", [](const GridTask& task) {
                            const auto work = std::make_shared<Evaluation>(task);
                            const std::string program = "OpenCASCADE " OCC_VERSION_COMPLETE;
                            const auto read = [=](std::size_t i, std::size_t j) { return work->read(i, j); };
                            return std::vector<GridRun>{
                                {program, task.tangents ? "Geom_BSplineSurface::D1" : "Geom_BSplineSurface::D0", true,
                                 [=] { return work->run_surface(); }, read},
                                {program, task.tangents ? "BSplSLib_Cache::D1" : "BSplSLib_Cache::D0", true,
                                 [=] { return work->run_cache(); }, read}};
                          }});
  return true;
}();

}}  // namespace tessera::bench
