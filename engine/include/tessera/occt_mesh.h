#pragma once
// Triangulations of the shapes of OpenCASCADE, stored in them as BRepMesh_IncrementalMesh does, with proven bounds and
// closed along edges. Includes OpenCASCADE's own headers of shapes.

#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tessera/execution.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// How finely the faces of a shape are triangulated.
struct OcctMeshOptions {
  /// The linear deflection: the largest distance between a face and its triangles, above 0, in the shape's lengths. It
  /// is proven, both from the face to the triangles and from these to the face; gaps between faces come on top.
  double deflection = 0;
  /// The angular deflection, radians, above 0: the normals of a face turn by at most this angle over a triangle.
  /// Larger angles than pi / 2 count as that one. Empty: normals may turn by any angle.
  std::optional<double> angle = 0.5;
  /// Whether the deflection of a face is a share of the largest side of the boxes of its edges, instead of a length.
  bool relative = false;
  bool parallel = true;  ///< whether all threads of the caller's TBB arena take part, instead of the caller alone
  /// The largest number of triangles, at most 2^30; a shape that takes more is an error.
  std::uint64_t max_triangles = std::uint64_t{1} << 30;
};

/// A part of a shape, and what became of it.
struct OcctMeshFault {
  TopoDS_Shape part;   ///< a face
  std::string reason;  ///< one sentence
};

/// A triangulation as it was stored.
struct OcctMeshReport {
  std::size_t faces = 0;      ///< with a triangulation; a face that stands at several places counts once
  std::size_t nodes = 0;      ///< of all faces
  std::size_t triangles = 0;  ///< of all faces
  double bound = 0;           ///< the largest distance of a face and its triangles, proven if `certified`
  double gap = 0;             ///< how far nodes left their faces in order to meet those of others
  bool certified = true;      ///< false: a surface that only OpenCASCADE could convert was fitted by samples
  double angle = 0;           ///< the largest angle by which normals turn over a triangle, where bounded
  std::size_t patches_without_angle = 0;  ///< how many parts of faces have no such bound, at cusps for example
  /// Whether the triangulation has no border: each side of a triangle has another triangle. If not, `open_edges` and
  /// `faults` say where.
  bool closed = false;
  std::vector<TopoDS_Edge> open_edges;  ///< if not closed: those that a single face has once
  std::vector<OcctMeshFault> left_out;  ///< faces that keep what they had, and why
  std::vector<OcctMeshFault>
      faults;  ///< faces whose deflection is not met or not proven, or that lack triangles or polygons
};

/// Triangulates the faces of a shape and stores the triangulations in it, in place of older ones.
///
/// - Each face gets one Poly_Triangulation in its own space: nodes, parameters within the rectangle of its border,
///   normals of the surface, triangles as they run on the forward face. Its Deflection() is the face's deflection, or
///   its bound if that is larger.
/// - Each edge gets one Poly_PolygonOnTriangulation per face, two at a seam, by growing parameters from its first to
///   its last. All faces along an edge have nodes at the same parameters and, up to the rounding of their locations, at
///   the same positions: the triangulation of a closed shell is closed.
/// - A face that stands at several places is triangulated where the shape has it first. Elsewhere its neighbours may
///   have other nodes along the common edges, as at the far end of a prism that OpenCASCADE made without copies. Then
///   `closed` is false, and `open_edges` and `faults` name them.
///
/// Edges that lie in a face without bounding it, and edges and vertices without faces, are left as they are.
///
/// Errors, with the shape as it was: invalid_argument (the shape is null or has no faces; a deflection or an angle that
/// is not above 0; a face or an edge with a triangulation to come is locked; no mesh keeps the deflection within the
/// limits, see Tessellation::make()), the reason of the first face (none can be converted), cancelled, out_of_memory,
/// internal (an exception of OpenCASCADE). Exceptions of OpenCASCADE do not leave the call.
///
/// Threads: a call excludes all others, and OpenCASCADE's, that read the triangulations of the same faces and edges.
Result<OcctMeshReport> triangulate(const TopoDS_Shape& shape, const OcctMeshOptions& options,
                                   const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
