#include "io/step/step_replica.h"

#include <utility>
#include <vector>

#include "io/step/step_transform.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

class ReplicaInverse : public SurfaceInverse {
 public:
  ReplicaInverse(std::unique_ptr<SurfaceInverse> of, const Affine& map, double tolerance)
      : of_(std::move(of)), map_(map), back_(inverse_place(map)), scale_(length(map.columns[0])) {
    whole_ = of_->whole(), period_ = of_->period();
    turns_u_ = of_->turns_u(), turns_v_ = of_->turns_v();
    fit_error_ = scale_ * of_->fit_error();
    tolerance_ = tolerance;
  }

  ParameterPoint at(const Vec3& p, const ParameterPoint& near) const override { return of_->at(back_.point(p), near); }
  ParameterPoint find(const Vec3& p) const override { return of_->find(back_.point(p)); }
  Vec3 point(const ParameterPoint& place) const override { return map_.point(of_->point(place)); }
  ParameterPoint speeds(const ParameterPoint& place) const override {
    const ParameterPoint speeds = of_->speeds(place);
    return {scale_ * speeds.u, scale_ * speeds.v};
  }
  std::array<std::vector<double>, 2> knots() const override { return of_->knots(); }
  std::optional<double> apex() const override { return of_->apex(); }

  Result<FaceSurface> surface(const Domain& box) const override {
    Result<FaceSurface> made = of_->surface(box);
    if (!made) return made;
    const BSplineSurface& s = made->surface;
    std::vector<Vec3> points;
    for (const Vec3& p : s.points()) points.push_back(map_.point(p));
    std::vector<double> weights(s.weights().begin(), s.weights().end());
    return with_parameters(weights.empty()
                               ? BSplineSurface::polynomial(s.degree_u(), s.knots_u(), s.degree_v(), s.knots_v(),
                                                            std::move(points), s.domain())
                               : BSplineSurface::rational(s.degree_u(), s.knots_u(), s.degree_v(), s.knots_v(),
                                                          std::move(points), std::move(weights), s.domain()),
                           made->parameters, scale_ * made->fit_error);
  }

 private:
  std::unique_ptr<SurfaceInverse> of_;
  Affine map_, back_;
  double scale_;
};

}  // namespace

std::unique_ptr<SurfaceInverse> make_replica_inverse(std::unique_ptr<SurfaceInverse> of, const Affine& map,
                                                     double tolerance) {
  return std::make_unique<ReplicaInverse>(std::move(of), map, tolerance);
}

Result<std::optional<StepReplica>> StepGeometry::replica(std::uint64_t number) const {
  StepEntity entity(index_, number);
  if (!entity.is("SURFACE_REPLICA")) return std::optional<StepReplica>();
  StepReplica out{entity.reference(entity.attribute(1)), {}};
  const std::uint64_t by = entity.reference(entity.attribute(2));
  if (!entity.status().ok()) return entity.status();
  const Result<Affine> map = step_place(index_, {by, units_});
  if (!map) return map.status();
  out.map = *map;
  out.parent = bare_surface(out.parent);
  if (StepEntity(index_, out.parent).is("SURFACE_REPLICA"))
    return entity.error("is a copy of a copy", StatusCode::unsupported);
  return std::optional<StepReplica>(out);
}

}}  // namespace tessera::abi_0_1
