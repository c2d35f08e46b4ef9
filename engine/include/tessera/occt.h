#pragma once
// Models of shapes that a program of OpenCASCADE holds in memory, and which faces and edges of the shape their own are.
// Includes OpenCASCADE's own headers, in whose folder the compiler must look.
//
// Surfaces, edges, instances and their exactness are those that OpenCASCADE's reader of cad.h gives for a file of the
// shape: a part that stands at several places is one Shape with several instances. Names, colours and the unit, which a
// shape does not have, are empty. Messages number faces from 0, in the order of the shape.
//
// Hits and nearest points name surfaces of the model and their parameters (RayScene::make(), PointScene::make() and
// Solid::make() take the model, or scenes of it). OcctModel::at() returns OpenCASCADE's face and its parameters.
//
// Memory: results own theirs; the faces and edges in them are handles, which share the shape's geometry and keep it.
// Threads: calls read shapes by OpenCASCADE's const functions, so that any number of threads may read the same shapes
// meanwhile, and none may change them.

#include <TopLoc_Location.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tessera/curve.h"
#include "tessera/execution.h"
#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Relates a parameter of the model to OpenCASCADE's: of a surface along u or v, or of an edge. They are equal, save
/// along circles and ellipses, where OpenCASCADE's is the angle and the model's that of rational arcs. Those are equal,
/// of at most 90 degrees each, and at their ends both parameters are the angle.
struct OcctParameter {
  std::optional<Interval> arcs = {};  ///< the angles between which the arcs lie, radians; empty: parameters are equal

  double to_occt(double parameter) const;    ///< from the model's; increases
  double from_occt(double parameter) const;  ///< the inverse of to_occt(), up to rounding
};

/// The face that a face of the model is made of.
struct OcctFace {
  TopoDS_Face face;                ///< in the space of the model's shape, with its orientation
  OcctParameter along_u, along_v;  ///< of OpenCASCADE's u and v
  bool is_turned = false;          ///< the face is reversed: the model's u follows from OpenCASCADE's v, and v from u

  std::array<double, 2> to_occt(double u, double v) const;    ///< from the model's parameters of the surface
  std::array<double, 2> from_occt(double u, double v) const;  ///< the inverse of to_occt(), up to rounding
};

/// The edge that an edge of the model is made of.
struct OcctEdge {
  TopoDS_Edge edge;         ///< forward, in the space of the model's shape; starts and ends as the model's
  OcctParameter parameter;  ///< of its curve in space; for an edge without one, of its range
};

/// The faces, edges and vertices that a shape of the model is made of: element k of each belongs to element k there.
struct OcctShape {
  std::vector<OcctFace> faces;          ///< of Shape::faces
  std::vector<OcctEdge> edges;          ///< of Shape::edges
  std::vector<TopoDS_Vertex> vertices;  ///< of Shape::vertices
};

/// A point of a face.
struct OcctPoint {
  TopoDS_Face face;     ///< as the shape of model_from() holds it, with its location and orientation
  double u = 0, v = 0;  ///< its own parameters
};

/// A model that is made of a shape of OpenCASCADE.
struct OcctModel {
  Model model;                             ///< lengths are the shape's
  std::vector<OcctShape> shapes;           ///< of Model::shapes
  std::vector<TopLoc_Location> locations;  ///< of Model::instances: from the space of the model's shape to the model
  std::vector<TopoDS_Face> left_out;       ///< faces that the model lacks, each where it stands first

  /// Returns the face that a surface of the model is, as the shape holds it. Null if there is no such surface.
  TopoDS_Face face(std::size_t surface) const;
  /// Returns the edge that an edge of an instance's shape is, as the shape holds it, forward. Null if there is none.
  TopoDS_Edge edge(std::size_t instance, std::size_t edge) const;
  /// Returns the face and its parameters of a point of the model: at(hit.surface, hit.u, hit.v). The face is null if
  /// there is no such surface.
  OcctPoint at(std::size_t surface, double u, double v) const;
};

/// Makes a model of all faces of a shape, by the threads of the caller's arena; it does not depend on their number. A
/// face that cannot be converted is left out, with a warning of the model: a face without a surface (a triangulation
/// alone), an unbounded one, one that OpenCASCADE cannot fit.
///
/// Floating-point exceptions that the program lets trap do not trap within the call. Exceptions of OpenCASCADE do not
/// leave it.
///
/// Errors: invalid_argument (the shape is null or has no faces), the first warning's reason (no face is left),
/// unsupported (more than 4 million faces, shells, solids and compounds, counted at each of their places), cancelled,
/// out_of_memory, internal (an exception of OpenCASCADE, with its type and message). Memory: about 100 bytes per face
/// and per edge beside the model.
Result<OcctModel> model_from(const TopoDS_Shape& shape, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
