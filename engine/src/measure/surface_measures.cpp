// Areas of surfaces.

#include <algorithm>
#include <cmath>

#include "measure/body_sums.h"
#include "measure/face_integrals.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"
#include "tessera/measures.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct SurfaceIntegrals {
  Status status;
  Status fault;
  Box3 box;
  Integrals area;  ///< relative to the box's centre
  bool proven = true;
};

SurfaceIntegrals integrals_of(const ModelSurface& surface, const MeasureOptions& options) {
  SurfaceIntegrals all;
  const Result<MeasuredFace> face = make_face(surface, *surface.trims);
  if (!face) {
    all.status = face.status();
    return all;
  }
  all.box = face->grid.box();
  const FaceIntegrals found = integrate(*face, all.box.centre(), true, false, options);
  all.fault = face->fault, all.area = found.area.sums(), all.proven = found.proven;
  return all;
}

SurfaceMeasures measures_of(const Integrals& area, const Box3& box, bool proven) {
  return {{area.value[0], area.error[0]}, centroid_of(area, box.centre(), box), proven};
}

SurfaceMeasures total_of(std::span<const SurfaceIntegrals> all) {
  Box3 box;
  for (const SurfaceIntegrals& one : all) box.extend(one.box);
  ExactSums sums;
  bool proven = true;
  for (const SurfaceIntegrals& one : all) {
    sums.add(moved_area(one.area, one.box.centre(), box.centre()), 1);
    proven = proven && one.proven;
  }
  return measures_of(sums.sums(), box, proven);
}

}  // namespace

Result<AreaMeasures> measure_surfaces(const Model& model, const MeasureOptions& options, const Execution& execution) {
  return guarded([&]() -> Result<AreaMeasures> {
    if (Status status = check_options(options); !status.ok()) return status;
    if (Status status = check_topology(model); !status.ok()) return status;
    const std::vector<ModelSurface>& surfaces = model.surfaces;
    std::vector<SurfaceIntegrals> found(surfaces.size());
    Status status = parallel_for(surfaces.size(), 1, execution, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) found[k] = integrals_of(surfaces[k], options);
    });
    if (!status.ok()) return status;
    AreaMeasures all;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const SurfaceIntegrals& one = found[k];
      if (!one.status.ok()) return in_surface(model, k, one.status);
      all.surfaces.push_back(measures_of(one.area, one.box, one.proven));
      if (!std::isfinite(all.surfaces.back().area.value))
        return in_surface(model, k, Status(StatusCode::invalid_argument, "its area is beyond the range of numbers"));
      if (!one.fault.ok()) all.faults.push_back(in_surface(model, k, one.fault));
    }
    all.total = total_of(found);
    return all;
  });
}

}}  // namespace tessera::abi_0_1
