#pragma once
// Tables of a STEP file's products, their representations, and how these are tied (ISO 10303-41, 10303-43, 10303-44).

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "io/file/text_encoding.h"
#include "io/step/step_entity.h"
#include "io/step/step_index.h"
#include "io/step/step_remarks.h"
#include "io/step/step_units.h"

namespace tessera { inline namespace abi_0_1 {

/// A representation: items and their units.
struct StepRepresentation {
  std::vector<std::uint64_t> items, sorted_items;  ///< that the file has
  StepContextUnits units;
};

/// Two representations that a relationship ties.
struct StepLink {
  std::uint64_t number = 0;          ///< of the relationship
  std::uint64_t first = 0;           ///< rep_1, which is placed in the other one
  std::uint64_t second = 0;          ///< rep_2
  std::uint64_t transformation = 0;  ///< from the first to the second; 0: they have one space
};

/// One use of a product in an assembly (NEXT_ASSEMBLY_USAGE_OCCURRENCE).
struct StepOccurrence {
  std::uint64_t number = 0;
  std::uint64_t component = 0;          ///< the product that is used
  std::string name;                     ///< or else the id; may be empty
  std::optional<StepLink> link;         ///< where it stands; none: where the assembly does
  std::vector<std::uint64_t> contexts;  ///< numbers by which styles may name this use: its own, its shape's, ..
};

/// A product's definition.
struct StepProduct {
  std::string name;                            ///< of the product, or else its id; may be empty
  std::vector<std::uint64_t> representations;  ///< of its shape
  std::vector<StepOccurrence> components;      ///< in the order of their numbers
  bool is_component = false;                   ///< of another product
};

/// The tables, read once; what is malformed is left out, each with a remark. Const calls from any number of threads.
class StepStructure {
 public:
  /// The index must outlive the object. Texts are in `encoding`.
  StepStructure(const StepIndex& index, TextEncoding encoding, StepRemarks& remarks);

  const std::map<std::uint64_t, StepProduct>& products() const { return products_; }  ///< by PRODUCT_DEFINITION
  /// Returns the numbers of all representations of shapes, which rise.
  std::vector<std::uint64_t> shape_representations() const;
  /// Returns the representation and all that plain relationships tie to it, in either direction, except those of other
  /// products.
  std::vector<std::uint64_t> tied_to(std::uint64_t representation) const;
  /// Returns the product whose shape a representation is, or 0.
  std::uint64_t product_of(std::uint64_t representation) const;
  /// Returns the relationships by which others are placed in a representation, except those of occurrences.
  const std::vector<StepLink>& placed_in(std::uint64_t representation) const;

 private:
  void read_products();
  void read_occurrences();
  void read_shapes();
  void read_places();
  void read_relationships();
  std::string product_name(std::uint64_t definition) const;
  std::string text(std::string_view raw) const;
  StepLink link_of(StepEntity& entity) const;
  /// Returns what the shape that an attribute refers to is of; 0 after an error.
  std::uint64_t owner_of_shape(StepEntity& entity, std::size_t k) const;
  std::vector<std::uint64_t> numbers_of(std::string_view kind, std::string_view part) const;
  bool is_shape_representation(std::uint64_t number) const;

  const StepIndex& index_;
  TextEncoding encoding_;
  StepRemarks& remarks_;
  std::map<std::uint64_t, StepProduct> products_;
  std::unordered_map<std::uint64_t, StepOccurrence*> occurrences_;  ///< by their numbers, while reading
  std::unordered_map<std::uint64_t, std::uint64_t> product_of_;     ///< by representation
  std::unordered_map<std::uint64_t, std::vector<std::uint64_t>> ties_;
  std::unordered_map<std::uint64_t, std::vector<StepLink>> placed_in_;
  std::unordered_set<std::uint64_t> of_occurrences_;  ///< relationships
};

/// Reads a representation's items and units. References to nothing are left out, with a remark. Errors: parse_error,
/// those of step_units().
Result<StepRepresentation> step_representation(const StepIndex& index, std::uint64_t number, StepRemarks& remarks);

}}  // namespace tessera::abi_0_1
