#pragma once
// The integrals over the faces of a shape, and its skins: parts of shells that edges join.

#include <vector>

#include "measure/edge_slits.h"
#include "measure/face_integrals.h"
#include "measure/shell_orientation.h"
#include "tessera/measures.h"

namespace tessera { inline namespace abi_0_1 {

/// A closed surface of joined faces.
struct Skin {
  Integrals moments;  ///< of the volume within, positive
  Box3 box;           ///< about that of its faces
  double gap = 0;
  bool proven = true;
};

/// Measures the flux through all faces of a shape that belong to shells.
class ShapeIntegrals {
 public:
  /// The shape must outlive this object.
  explicit ShapeIntegrals(const Shape& shape) : shape_(shape) {}
  /// `faces`: which are needed. Errors: those of make_face(), cancelled.
  Status run(const std::vector<bool>& faces, const MeasureOptions& options, const Execution& execution);

  const Vec3& centre() const { return centre_; }
  const Box3& box() const { return box_; }
  /// Returns all faces as one skin, as their normals are.
  Skin whole_skin() const;
  /// Appends the skins of a closed shell. Errors: those of oriented_shell().
  Status add_skins(const Shell& shell, std::vector<Skin>& skins) const;

 private:
  struct Face {
    Status status;
    Box3 box;
    LoopDirections directions;
    ExactSums flux;
    bool proven = true;
  };
  void add_slits(const std::vector<std::uint32_t>& faces, Skin& skin, ExactSums& sums) const;

  const Shape& shape_;
  Vec3 centre_;
  Box3 box_;
  std::vector<Face> faces_;
  std::vector<LoopDirections> directions_;
  std::vector<EdgeSlit> slits_;
};

}}  // namespace tessera::abi_0_1
