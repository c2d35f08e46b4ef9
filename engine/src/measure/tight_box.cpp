// The smallest box of a model.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "measure/extent_search.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"
#include "tessera/measures.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// By the six sides: x, y, z, and then their opposites.
using Sides = std::array<double, 6>;

struct BoxFace {
  Status status;
  std::optional<MeasuredFace> face;
  Sides reached{}, bound{};
};

int axis_of(std::size_t side) { return static_cast<int>(side % 3); }
double sign_of(std::size_t side) { return side < 3 ? 1 : -1; }

void begin(const ModelSurface& surface, BoxFace& to) {
  Result<MeasuredFace> face = make_face(surface, *surface.trims);
  to.status = face.status();
  if (!face) return;
  to.face = *std::move(face);
  for (std::size_t side = 0; side < 6; ++side)
    to.reached[side] = ExtentSearch(*to.face, axis_of(side), sign_of(side)).quick();
}

/// The largest of all faces.
Sides largest(const std::vector<BoxFace>& faces, Sides BoxFace::*of) {
  Sides most;
  most.fill(-std::numeric_limits<double>::infinity());
  for (const BoxFace& face : faces)
    for (std::size_t side = 0; side < 6; ++side) most[side] = std::max(most[side], (face.*of)[side]);
  return most;
}

Vec3 vector_of(const Sides& sides, std::size_t from) { return {sides[from], sides[from + 1], sides[from + 2]}; }

MeasuredBox box_of(const std::vector<BoxFace>& faces) {
  const Sides reached = largest(faces, &BoxFace::reached), bound = largest(faces, &BoxFace::bound);
  MeasuredBox all{{-vector_of(bound, 3), vector_of(bound, 0)},
                  vector_of(bound, 3) - vector_of(reached, 3),
                  vector_of(bound, 0) - vector_of(reached, 0)};
  FitError fit;
  for (const BoxFace& face : faces) {
    const FitError& of = face.face->grid.fit_error();
    fit.distance = std::max(fit.distance, of.distance), fit.certified = fit.certified && of.certified;
    const bool is_fit = of.distance > 0;
    all.proven = all.proven && (is_fit ? of.certified : face.face->proven);
  }
  const Vec3 by{fit.distance, fit.distance, fit.distance};
  all.box = {all.box.lower - by, all.box.upper + by};
  all.lower_error += 2 * by, all.upper_error += 2 * by;
  return all;
}

}  // namespace

Result<MeasuredBox> measure_box(const Model& model, const MeasureOptions& options, const Execution& execution) {
  return guarded([&]() -> Result<MeasuredBox> {
    if (Status status = check_options(options); !status.ok()) return status;
    if (Status status = check_topology(model); !status.ok()) return status;
    const std::vector<ModelSurface>& surfaces = model.surfaces;
    if (surfaces.empty()) return MeasuredBox{};
    std::vector<BoxFace> faces(surfaces.size());
    constexpr std::array ends{0.4, 1.0};
    CallProgress progress(execution, ends);
    Status status = parallel_for(faces.size(), 1, progress.loops(), [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) begin(surfaces[k], faces[k]);
    });
    if (!status.ok()) return status;
    Box3 hull;
    for (std::size_t k = 0; k < faces.size(); ++k) {
      if (!faces[k].status.ok()) return in_surface(model, k, faces[k].status);
      hull.extend(faces[k].face->grid.box());
    }
    const Sides reached = largest(faces, &BoxFace::reached);
    const double tolerance = options.accuracy * hull.diagonal();
    status = parallel_for(faces.size(), 1, progress.loops(), [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k)
        for (std::size_t side = 0; side < 6; ++side) {
          ExtentSearch search(*faces[k].face, axis_of(side), sign_of(side));
          const Extent found = search.run(reached[side], tolerance, options.max_cells);
          faces[k].reached[side] = found.reached, faces[k].bound[side] = found.bound;
        }
    });
    if (!status.ok()) return progress.finish(status);
    if (!std::isfinite(tolerance))
      return Status(StatusCode::invalid_argument, "the model's size is beyond the range of numbers");
    if (!std::isfinite(largest(faces, &BoxFace::reached)[0]))
      return Status(StatusCode::invalid_argument, "trimming loops cut away every patch");
    if (Status done = progress.finish({}); !done.ok()) return done;
    return box_of(faces);
  });
}

}}  // namespace tessera::abi_0_1
