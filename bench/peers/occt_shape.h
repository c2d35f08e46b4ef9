#pragma once
// Surfaces as faces of OpenCASCADE, and its meshes of them.

#include <BRep_Builder.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <limits>
#include <vector>

#include "peers/mesh_distance.h"
#include "tessera/nurbs_surface.h"

namespace tessera::bench {

constexpr double occt_default_angle = 0.5;  ///< OpenCASCADE's own angular deflection, radians

/// Converts a surface, parameters included.
Handle(Geom_BSplineSurface) occt_surface(const BSplineSurface& surface);
Handle(Geom_BezierSurface) occt_surface(const BezierPatch& patch);

/// A compound of faces, one per surface, each over all of its surface's parameters; or the trimmed faces of a file.
class OcctShape {
 public:
  /// Throws std::runtime_error if OpenCASCADE makes no face of a surface.
  explicit OcctShape(const std::vector<Handle(Geom_Surface)>& surfaces);
  /// A shape with these faces.
  OcctShape(const TopoDS_Shape& shape, std::vector<TopoDS_Face> faces);

  /// Meshes all faces anew on this thread. Returns the processor time in seconds, or infinity if it was stopped after
  /// about max_seconds. The angular deflection is in radians.
  double mesh(double deflection, double angle = occt_default_angle,
              double max_seconds = std::numeric_limits<double>::infinity());
  /// The triangles of the last mesh(). Empty before the first.
  std::vector<SurfaceTriangle> triangles() const;
  /// A point of a face that was made of a surface.
  Vec3 point(std::size_t face, double u, double v) const;

 private:
  std::vector<TopoDS_Face> faces_;
  std::vector<GeomAdaptor_Surface> surfaces_;
  TopoDS_Shape shape_;
};

}  // namespace tessera::bench
