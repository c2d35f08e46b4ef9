#pragma once
// The faces of one part as a shape, face by face.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "exact/face_box.h"
#include "occt/described_shape.h"
#include "occt/part_tree.h"
#include "occt/shape_edges.h"
#include "tessera/execution.h"
#include "tessera/model.h"
#include "tessera/occt.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Parts of a file that the model lacks or changes.
struct Shortcomings {
  std::vector<std::string> left_out;                ///< faces, one sentence each
  std::vector<TopoDS_Face> faces_left_out;          ///< the same, where they stand first
  std::vector<std::string> whole;                   ///< faces whose loops or edges cannot be read, the same way
  std::vector<TopoDS_Face> faces_whole;             ///< of each of these sentences
  StatusCode first_code = StatusCode::parse_error;  ///< of the first face that is left out
  std::size_t fitted = 0;                           ///< surfaces
  double worst_fit = 0;                             ///< their largest distance
  std::vector<double> fit_errors;                   ///< of each face that is made, the distance of its surface
  std::vector<SplineShift> shifts;                  ///< of each of these, what DescribedShape::spline_shift led to
};

/// Reads a part in its own space, wherever it is placed. Calls in this order: make(), convert() of each face, from any
/// thread, finish(). Faces without a name are named after the whole that holds the part, if that has one.
class PartShape {
 public:
  /// Lists faces and reads edges, by all threads. `first_face` is what messages call the first face that has no label.
  /// Errors: cancelled, internal (an exception of OpenCASCADE). May throw Standard_Failure. The file must outlive it.
  static Result<PartShape> make(const DescribedShape& file, const PlacedPart& placed, std::size_t first_face,
                                const Execution& execution);

  std::size_t face_count() const { return faces_.size(); }
  /// Converts a face. An error of the face is kept for finish(); throws std::bad_alloc.
  void convert(std::size_t face);
  /// Makes a shape of the faces that are converted, in their order; it has none if all failed.
  void finish(Shape& shape, OcctShape& sources, Shortcomings& shortcomings) &&;

 private:
  /// Name, colour and shell of the wholes that hold a face.
  struct Wholes {
    const std::string* name = nullptr;
    std::optional<Colour> colour;
    std::uint32_t shell = no_id, solid = no_id;
  };
  /// A face, and what becomes of it.
  struct PartFace {
    TopoDS_Face face;
    Wholes wholes;
    std::size_t number = 0;  ///< what messages call it, if it has no label
    Status status;           ///< why it is left out
    std::optional<ShapeFace> made;
    OcctFace source;
    std::vector<std::string> whole;  ///< Shortcomings::whole
    double fit_error = 0;
    SplineShift shift = {};
  };

  PartShape(const DescribedShape& file, const PlacedPart& placed, ShapeEdges edges)
      : file_(&file), placed_(&placed), edges_(std::move(edges)) {}
  void add_all(const TopoDS_Shape& shape, Wholes wholes, std::size_t first_face);
  std::string words(const PartFace& face) const;
  Status try_face(PartFace& face) const;
  bool take_range(PartFace& face, FaceBox& box) const;

  const DescribedShape* file_;
  const PlacedPart* placed_;
  ShapeEdges edges_;
  Shape shape_;  ///< without faces, until finish()
  std::vector<PartFace> faces_;
};

}}  // namespace tessera::abi_0_1
