#pragma once
// A trimmed face of OpenCASCADE as the truth that meshes are measured against: its surface, and the curves in its
// parameters as its border.

#include <BRepAdaptor_Surface.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <Geom2d_Curve.hxx>
#include <TopoDS_Face.hxx>
#include <array>
#include <memory>
#include <random>
#include <vector>

#include "occt/face_loops.h"
#include "occt/face_surface.h"
#include "tessera/geometry.h"

namespace tessera::bench {

using Parameters = std::array<double, 2>;

/// A face. `Parameters` are OpenCASCADE's unless a name says "ours".
class TrueFace {
 public:
  /// `map` and `box` as face_surface() and face_box() return them. May throw Standard_Failure.
  TrueFace(const TopoDS_Face& face, const FaceBox& box, const Reparametrization& map);

  const TopoDS_Face& face() const { return face_; }
  const Domain& box() const { return box_; }
  double area() const { return area_; }            ///< of BRepGProp
  double perimeter() const { return perimeter_; }  ///< of the edges
  double wire_gap() const { return wire_gap_; }    ///< between ends of curves that meet in a vertex
  double edge_gap() const { return edge_gap_; }    ///< between edges in space and those in the parameters

  Vec3 point(const Parameters& at) const;
  Vec3 normal(const Parameters& at) const;  ///< a unit vector, or zero at a degenerate point
  Parameters theirs(const Parameters& ours) const;
  Parameters ours(const Parameters& theirs) const;
  bool contains(const Parameters& at) const;  ///< on the border too

  /// An upper bound of the distance of the face's kept part, which is sharp if `start` lies near the foot.
  double distance(const Vec3& p, const Parameters& start) const;
  /// The distance of a point from the border, by the curves in the parameters.
  double distance_from_border(const Vec3& p) const;
  /// The distance of a parameter from the border, as a share of the box's width and height.
  double border_share(const Parameters& at) const;
  /// A random parameter in the box.
  Parameters random(std::mt19937& generator) const;
  /// Points of the border, on the surface.
  std::vector<Vec3> border_points(std::size_t per_edge) const;

 private:
  struct Edge {
    Handle(Geom2d_Curve) curve;
    double from, to;
    std::vector<Vec3> points;            ///< at even steps
    std::vector<Parameters> parameters;  ///< of the points
  };
  Vec3 point_of(const Edge& edge, double t) const;
  void measure_gaps();

  TopoDS_Face face_;
  BRepAdaptor_Surface surface_;
  std::unique_ptr<BRepTopAdaptor_FClass2d> sides_;
  Domain box_;
  Reparametrization map_;
  bool reversed_;
  double area_ = 0, perimeter_ = 0, wire_gap_ = 0, edge_gap_ = 0;
  std::vector<Edge> edges_;
};

}  // namespace tessera::bench
