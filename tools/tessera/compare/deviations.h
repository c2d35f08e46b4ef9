#pragma once
// How far a mesh and the surfaces of a model are apart, both ways.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "compare/even_points.h"
#include "render/mesh_distance.h"
#include "tessera/execution.h"
#include "tessera/nearest_points.h"
#include "tessera/ray_scene.h"
#include "tessera/solid.h"

namespace tessera::cli {

/// Surfaces, prepared for questions by points. The set must outlive it.
class ComparedModel {
 public:
  /// Makes the scene of points, and that of rays, for surfaces that are closed: others have no sides. Errors: those of
  /// PointScene; cancelled, out_of_memory.
  static Result<ComparedModel> make(const PatchSet& set, const std::function<Execution(const char* work)>& execution);

  const PatchSet& set() const { return *set_; }
  const PointScene& points() const { return points_; }
  /// Whether the surfaces are closed, so that points have sides.
  bool is_closed() const { return solid_.has_value(); }
  const Solid& solid() const { return *solid_; }  ///< requires is_closed()
  /// The distance of a point, negative inside of closed surfaces. Threads: any number of calls.
  double deviation(const Vec3& point) const;

 private:
  ComparedModel(const PatchSet& set, PointScene points) : set_(&set), points_(std::move(points)) {}
  const PatchSet* set_;
  PointScene points_;
  std::optional<RayScene> rays_ = {};  ///< of the solid
  std::optional<Solid> solid_ = {};
};

/// A point of one side, and the nearest one of the other.
struct DeviationPlace {
  double distance = 0;
  Vec3 mesh_point;       ///< in the model's coordinates
  NearestPoint surface;  ///< the point of the model
};

/// The distances of many points of one side from the other side.
struct Deviations {
  std::size_t vertices = 0, samples = 0;        ///< how many points: vertices of triangles, and points spread evenly
  DeviationPlace largest;                       ///< of all points
  double mean = 0, rms = 0, percentile_99 = 0;  ///< of the points spread evenly; 0 without any
  std::size_t uncertified = 0;                  ///< points whose nearest point is not proven to be the nearest
};

/// The deviations of a mesh to either side of closed surfaces.
struct SignedDeviations {
  double outside = 0, inside = 0;  ///< the largest distances to each side, not negative
  double mean = 0;                 ///< of the points spread evenly, negative inside
  std::size_t unsure = 0;          ///< points whose side is not certified, which count as these say
};

/// The deviations of a mesh from a model.
struct MeshDeviations {
  Deviations all;
  std::optional<SignedDeviations> to_sides = {};  ///< none: the surfaces are not closed
  std::vector<float> of_vertices;                 ///< of each vertex, negative inside of closed surfaces
};

/// Told the share that is done, from 0 to 1.
using ShareDone = std::function<void(double)>;

/// Finds the nearest point of the model to each vertex of a mesh, and to `samples` of its points spread evenly.
/// Requires a mesh that MeshDistance takes. Errors: unsupported (a point that is too far away), cancelled,
/// out_of_memory. The same figures for any number of threads.
Result<MeshDeviations> deviations_of_mesh(const ComparedModel& model, const Mesh& mesh, const EvenPoints& even,
                                          std::size_t samples, const ShareDone& done);

/// Finds the nearest point of the mesh to points of the model's surfaces. `drawn` is a mesh of the model with patches
/// and their parameters. The points are those of the surfaces at the parameters of its vertices, and of `samples` of
/// its points spread evenly; a point that loops cut away is moved to the nearest one that they keep. Errors, threads:
/// as above.
Result<Deviations> deviations_of_model(const ComparedModel& model, const Mesh& drawn, const EvenPoints& even,
                                       std::size_t samples, const render::MeshDistance& mesh, const ShareDone& done);

}  // namespace tessera::cli
