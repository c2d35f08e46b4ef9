#pragma once
// Files of surfaces, item by item: the items of a .bpt file are its patches, those of a .g2 file its objects. A reader
// takes one item from a text; a walk goes through all of a file, or through a run of its surfaces.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/function_ref.h"
#include "io/file/passed_over.h"
#include "io/file/text_cursor.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// An item that is not read, and its place.
struct PassedItem {
  PartName name;
  TextCursor at;
};

/// One item: a surface, or an item that is passed over.
struct ReadItem {
  std::optional<ModelSurface> surface = {};  ///< none also where it was skipped
  std::optional<PassedItem> passed_over = {};
  bool swapped = false;  ///< u and v are swapped in the file

  bool is_surface() const { return !passed_over; }
};

/// The items of a format. A text may be a part of the file that begins and ends anywhere between two items.
class ItemReader {
 public:
  virtual ~ItemReader() = default;

  /// The characters after which a text may be cut without a change of what stands before.
  virtual std::string_view cuts() const = 0;
  /// Takes the text before the first item.
  virtual Status begin(TextCursor&) { return {}; }
  /// Whether item number `item`, counted from 0, is to come.
  virtual bool more(TextCursor& cursor, std::size_t item) const = 0;
  /// Takes an item. `beyond`: the bytes of the file after the text. If the text ends before the item does, the cursor
  /// is at its end afterwards, and the result means nothing.
  virtual Result<ReadItem> read(TextCursor& cursor, std::size_t item, std::uint64_t beyond) = 0;
  /// Takes an item and makes no surface of it. Numbers may be left unchecked.
  virtual Result<ReadItem> skip(TextCursor& cursor, std::size_t item, std::uint64_t beyond) {
    Result<ReadItem> taken = read(cursor, item, beyond);
    if (taken) taken->surface.reset();
    return taken;
  }
  /// Takes the text after the last item. `nothing`: if the file has no surfaces, what it has instead; else null.
  virtual Status end(TextCursor& cursor, const PassedOver* nothing) const = 0;
  /// The most surfaces that a file of so many bytes may have, or 0 if they are not known before.
  virtual std::size_t expected(std::uint64_t bytes) const = 0;
  /// A reader of items further on in the same file.
  virtual std::unique_ptr<ItemReader> for_rest() const = 0;
  /// Whether an item seems to begin with this line. Takes it, or a part of it.
  virtual bool seems_item(TextCursor& line) const = 0;
};

/// `count`: the number of patches that the file states, for texts that begin after it.
std::unique_ptr<ItemReader> make_bpt_reader(std::size_t count);
std::unique_ptr<ItemReader> make_g2_reader();

/// A place between two items.
struct FilePlace {
  std::uint64_t offset = 0;
  std::size_t line = 1;
  std::size_t item = 0, surface = 0;  ///< how many stand before
};

/// A part of a file.
struct TextWindow {
  std::string_view text;
  std::uint64_t beyond;  ///< the bytes of the file after the text
};

/// A run of the surfaces of a file, with the items that stand before each. Without an end it has all items to the end
/// of the file.
struct ItemRun {
  static constexpr std::size_t to_the_end = std::numeric_limits<std::size_t>::max();
  std::size_t first = 0, end = to_the_end;
  bool keep = true;  ///< if not, surfaces are skipped
};

/// Goes through the items of a file, window by window.
class ItemWalk {
 public:
  /// Loads `bytes` bytes from `offset` on, fewer at the end of the file. The text may be cut after one of `cuts`.
  using Load = FunctionRef<Result<TextWindow>(std::uint64_t offset, std::size_t bytes, std::string_view cuts)>;
  /// Called after each item of the run.
  using Take = FunctionRef<void(ReadItem&)>;

  /// `name` stands for the file in messages.
  ItemWalk(ItemReader& reader, std::string_view name, const ItemRun& run)
      : reader_(reader), name_(name), run_(run), passed_over_(name) {}

  /// Takes all items from a place on to the end of the run. Errors: those of `load` and of the reader.
  Status go(const FilePlace& from, std::size_t window_bytes, Load load, Take take);
  /// The place after the last item. Counts lines, within `take` alone.
  FilePlace place();
  std::uint64_t offset() const { return at_.offset; }        ///< of that place
  std::size_t surface_count() const { return at_.surface; }  ///< before that place
  std::vector<std::string> warnings() const;

 private:
  enum class Step : std::uint8_t { done, needs_more_text };
  Result<Step> go_on(const TextWindow& window, Take take);

  ItemReader& reader_;
  std::string_view name_;
  ItemRun run_;
  FilePlace at_;  ///< its line is that of counted_
  const char *counted_ = nullptr, *here_ = nullptr;
  PassedOver passed_over_;
  std::size_t swapped_ = 0;
};

/// Reads all surfaces of a text, long ones in pieces by several threads; `name` stands for the file in messages.
Result<Model> read_items(ItemReader& reader, std::string_view text, std::string_view name);

}}  // namespace tessera::abi_0_1
