#pragma once
// How far a mesh and the trimmed faces that it stands for lie apart, by samples of both.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "peers/mesh_distance.h"
#include "peers/trimmed_case.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"

namespace tessera::bench {

/// The triangles of a Tessera mesh: `face` is the index into the case's faces, parameters are OpenCASCADE's. The mesh
/// needs parameters and patches. `set`: of the faces from `first` on, in a space that `placement` leads out of.
std::vector<SurfaceTriangle> triangles_on_faces(const TrimmedCase& one, const PatchSet& set, const Mesh& mesh,
                                                std::size_t first = 0, const Affine& placement = {});

/// The largest distances found, in both directions.
struct FaceErrors {
  double from_mesh = 0;   ///< of a point of the mesh from the kept part of its face
  double from_faces = 0;  ///< of a kept point from the mesh of its face
  std::size_t mesh_face = 0, kept_face = 0;
  std::size_t mesh_points = 0, kept_points = 0;
  double worst() const { return std::max(from_mesh, from_faces); }
};

/// Measures meshes of one case at about `samples` points in each direction.
class FaceErrorMeter {
 public:
  FaceErrorMeter(const TrimmedCase& one, std::size_t samples);
  FaceErrors measure(std::span<const SurfaceTriangle> mesh) const;

 private:
  struct KeptPoint {
    std::size_t face;
    Vec3 position;
  };
  const TrimmedCase& case_;
  std::size_t samples_;
  std::vector<KeptPoint> kept_;
};

}  // namespace tessera::bench
