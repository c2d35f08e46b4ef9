#pragma once
// The parts of a STEP file and the places where they stand: products, assemblies, mapped items.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/file/text_encoding.h"
#include "io/step/step_geometry.h"
#include "io/step/step_index.h"
#include "io/step/step_remarks.h"
#include "io/step/step_styles.h"
#include "tessera/colour.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Items that stand together at each of their places: those of a representation, of the others that plain relationships
/// tie to it, and of all shapes of one product, as far as they have the same units. None occurs twice.
struct StepPart {
  std::uint64_t representation = 0;  ///< the first one; a colour of it is that of all items without their own
  /// Solids, shells, faces, surface models and sets, and whatever else is neither a placement nor a mapped item: kinds
  /// without surfaces too.
  std::vector<std::uint64_t> items;
  StepUnits units;         ///< to millimetres and radians
  double uncertainty = 0;  ///< of lengths, in millimetres; 0: none is stated
  std::string name;        ///< of the product, or of the nearest whole that has one; may be empty
};

/// A part at its place. Places with the same part, the same colours and the same side have one shape.
struct StepPlacedPart {
  std::size_t part = 0;          ///< index into StepTree::parts
  std::size_t colours = 0;       ///< index into StepTree::colours
  Affine placement;              ///< to the model, in millimetres; mapped items may scale and mirror
  std::string name;              ///< of the nearest use in an assembly that has one, or else of the part
  std::optional<Colour> colour;  ///< of the nearest whole that has one and holds the part

  /// Tells whether the shape must be turned inside out, so that its normals keep their side.
  bool is_mirrored() const { return placement.determinant() < 0; }
};

/// All of it. Movable; copies share the colours.
struct StepTree {
  std::vector<StepPart> parts;
  std::vector<StepPlacedPart> places;  ///< in the order of the file
  std::vector<StepColours> colours;    ///< of places: the first without contexts, the others with their own too
  std::string file_unit;               ///< the first root's word for its unit of length; empty: none, or no products
  StepRemarks remarks;                 ///< faults of the file that leave the rest usable
  std::shared_ptr<const StepColourMap> colours_everywhere;  ///< those that `colours` refer to
};

/// Reads the structure of a file. A product that no other one uses is a root. In a file whose products have no shapes,
/// each representation of a shape that no other one holds is a root.
///
/// - `encoding`: of the file's texts.
///
/// Parts that are malformed or hold themselves are left out with a remark. Errors: unsupported (more than 2^20 places,
/// or assemblies within each other more than 256 times), out_of_memory. Threads: any number of calls at once.
Result<StepTree> read_step_tree(const StepIndex& index, TextEncoding encoding = TextEncoding::utf8);

}}  // namespace tessera::abi_0_1
