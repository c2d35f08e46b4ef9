#pragma once
// The products and representations of a STEP file as wholes, each listed once, and the uses between them.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include "io/step/step_structure.h"
#include "io/step/step_tree.h"
#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// One whole within another.
struct StepUse {
  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
  std::size_t whole = nowhere;               ///< that is used; nowhere: it would hold itself
  Affine place = {};                         ///< to the space of the one that uses it
  std::uint64_t number = 0;                  ///< of the instance that states the use; 0: a product's own shape
  std::string name = {};                     ///< of the use; may be empty
  std::string part_name = {};                ///< of the product whose shape is used; may be empty
  std::vector<std::uint64_t> contexts = {};  ///< numbers by which styles may name it
};

/// A product, or representations that are tied to each other.
struct StepWhole {
  std::vector<std::uint64_t> representations;  ///< that are tied, or whose items are one part of a product
  std::vector<StepPart> own;                   ///< items by their units; without names
  std::vector<StepUse> uses;
  const StepProduct* product = nullptr;  ///< null: representations
  bool is_read = false;
  enum { unmeasured, open, measured } state = unmeasured;
  std::size_t places = 0;  ///< of parts in it, at most StepWholes::max_places + 1
  int depth = 0;           ///< of uses in it
};

/// Finds the wholes. Every list is at most as long as the file.
class StepWholes {
 public:
  static constexpr std::size_t max_places = std::size_t{1} << 20;
  static constexpr int max_depth = 256;

  /// All must outlive the object.
  StepWholes(const StepIndex& index, const StepStructure& structure, StepRemarks& remarks)
      : index_(index), structure_(structure), remarks_(remarks) {}

  /// Reads a representation, once.
  const StepRepresentation& representation(std::uint64_t number);
  /// Returns the products that no other one uses; they and what is in them are read.
  std::vector<std::size_t> product_roots();
  /// Returns the representations that no other one holds, likewise.
  std::vector<std::size_t> representation_roots();
  /// Returns what a colour of a mapped item is a colour of: the representations that it places, and their item if they
  /// have only one. None if the number is of something else.
  std::vector<std::uint64_t> mapped_by(std::uint64_t item) const;
  const StepWhole& operator[](std::size_t k) const { return wholes_[k]; }

 private:
  std::size_t of_product(std::uint64_t definition);
  std::size_t of_representation(std::uint64_t number);
  /// Reads a whole and what is in it, and counts the places of parts.
  void read_all(std::size_t root);
  void read(std::size_t whole);
  void read_product(StepWhole& whole, const StepProduct& product);
  void read_representation(StepWhole& whole, std::uint64_t number);
  void add_mapped(StepWhole& whole, std::uint64_t number, std::uint64_t item);
  void add_placed(StepWhole& whole, const StepLink& link);
  const std::vector<std::size_t>& shapes_of(const StepProduct& product);
  bool is_reversed(const StepLink& link, const StepProduct& assembly, const StepProduct& component);
  Result<Affine> place_of(const StepLink& link);
  std::string part_name(std::size_t whole) const;

  const StepIndex& index_;
  const StepStructure& structure_;
  StepRemarks& remarks_;
  std::deque<StepWhole> wholes_;
  std::unordered_map<std::uint64_t, std::size_t> of_product_, of_representation_, of_mapped_item_;  ///< by number
  std::unordered_map<const StepProduct*, std::vector<std::size_t>> shapes_of_;
  std::unordered_map<std::uint64_t, StepRepresentation> representations_;  ///< by their numbers
};

}}  // namespace tessera::abi_0_1
