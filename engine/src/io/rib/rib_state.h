#pragma once
// The part of a RIB file's graphics state that surfaces depend on, and the blocks that save it.

#include <string>
#include <string_view>
#include <vector>

#include "io/file/text_cursor.h"
#include "io/rib/rib_mesh.h"
#include "tessera/detail/shared.h"
#include "tessera/geometry.h"
#include "tessera/model.h"

namespace tessera { inline namespace abi_0_1 {

struct RibState {
  /// From the current coordinates to those at WorldBegin (within an object: at ObjectBegin; before both: at the file's
  /// begin).
  Shared<Affine> transform;
  Shared<std::string> name;
  RibBasis basis_u = *find_rib_basis("bezier"), basis_v = basis_u;
  Shared<std::vector<TrimLoop>> trims;
};

/// The state within nested blocks: Frame, World, Attribute, Transform, Solid, Object.
class RibStack {
 public:
  RibState& state() { return state_; }

  static bool is_block(std::string_view kind) {
    for (const std::string_view known : {"Attribute", "Transform", "World", "Frame", "Solid", "Object"}) {
      if (kind == known) return true;
    }
    return false;
  }
  /// Saves the state. A world and an object begin with coordinates of their own. Error: parse_error (too deep).
  Status begin(std::string_view kind, const TextCursor& at) {
    if (blocks_.size() == depth_limit) {
      return at.failure("blocks are nested deeper than " + std::to_string(depth_limit) + " levels");
    }
    blocks_.push_back({kind, at, state_});
    if (kind == "World" || kind == "Object") state_.transform = {};
    return {};
  }
  /// Restores the state; for a Transform block only the transformation. Error: parse_error (another block is open).
  Status end(std::string_view kind, const TextCursor& at) {
    if (blocks_.empty() || blocks_.back().kind != kind) {
      const std::string name(kind);
      return at.failure("expected " + name + "End to end a block that " + name + "Begin began, " + open_block());
    }
    if (kind == "Transform") {
      state_.transform = blocks_.back().saved.transform;
    } else {
      state_ = blocks_.back().saved;
    }
    blocks_.pop_back();
    return {};
  }
  /// Whether a block is open, and a few words about the innermost.
  bool is_open() const { return !blocks_.empty(); }
  std::string open_block() const {
    if (blocks_.empty()) return "but no block is open";
    const Block& block = blocks_.back();
    return "but " + std::string(block.kind) + "Begin of line " + std::to_string(block.at.line()) + " is open";
  }

 private:
  static constexpr std::size_t depth_limit = 1000;
  struct Block {
    std::string_view kind;
    TextCursor at;
    RibState saved;
  };
  RibState state_;
  std::vector<Block> blocks_;
};

}}  // namespace tessera::abi_0_1
