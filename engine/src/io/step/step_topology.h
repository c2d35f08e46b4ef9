#pragma once
// Faces, loops, edges and vertices of one part of a STEP file (ISO 10303-42, clause 5), before their geometry is read.

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "io/step/step_entity.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// How a loop uses an edge.
struct StepEdgeUse {
  std::uint32_t edge = 0;  ///< index into StepTopology::edges
  bool reversed = false;   ///< whether the loop runs from the edge's end to its start
};

/// A loop of a face, counter-clockwise about the face's normal where it is an outer one.
struct StepBound {
  bool is_outer = false;          ///< FACE_OUTER_BOUND
  std::vector<StepEdgeUse> uses;  ///< in the loop's order
  std::uint32_t vertex = no_id;   ///< of a VERTEX_LOOP: index into StepTopology::vertices
};

struct StepFace {
  std::uint64_t number = 0;   ///< of the face's instance
  std::uint64_t surface = 0;  ///< of its surface's
  bool agrees = true;         ///< whether its normal is that of the surface
  bool is_polygon = false;    ///< all of its loops are polygons; then it may have no surface
  std::vector<StepBound> bounds = {};
  std::uint32_t whole = no_id;  ///< index into StepTopology::wholes
  Status status = {};           ///< why it cannot be read
};

/// An edge: EDGE_CURVE, or a side of a POLY_LOOP.
struct StepEdge {
  std::uint64_t number = 0;                  ///< of the instance; 0 for a side of a polygon
  std::uint64_t curve = 0;                   ///< of the curve's; 0: straight
  bool agrees = true;                        ///< whether the edge runs along its curve
  std::uint32_t start = no_id, end = no_id;  ///< indices into StepTopology::vertices
  Status status = {};                        ///< why it cannot be read
};

/// A solid, shell or set that holds faces.
struct StepFaceWhole {
  std::uint64_t number = 0;     ///< of its instance
  std::uint32_t above = no_id;  ///< index of the whole that holds it
  std::uint32_t shell = no_id;  ///< index of the shell, for faces in one
  std::uint32_t solid = no_id;  ///< index of the solid, for faces in one
};

/// The faces of one part.
struct StepTopology {
  std::vector<StepFace> faces;          ///< in the order of the file's lists
  std::vector<StepEdge> edges;          ///< in the order in which faces use them
  std::vector<std::uint64_t> vertices;  ///< instances of their points: CARTESIAN_POINT
  std::vector<StepFaceWhole> wholes;
  std::vector<std::uint32_t> shells;  ///< the solid of each shell, or no_id
  std::uint32_t solid_count = 0;
  std::vector<std::string> unread;  ///< items that hold no faces that can be read, one sentence each

  /// Reads the faces that items of a representation hold: solids, shells, shell models, sets of surfaces, faces. What
  /// cannot be read is said in `unread`, or in the face or edge; items of other kinds are passed over. If
  /// `is_mirrored`, faces are turned around. Errors: unsupported (loops that list the same edges far too often),
  /// cancelled, out_of_memory.
  static Result<StepTopology> make(const StepIndex& index, std::span<const std::uint64_t> items, bool is_mirrored,
                                   const Execution& execution);
};

}}  // namespace tessera::abi_0_1
