// All items of a text. Long ones are read in pieces by several threads, each from where an item seems to begin. A piece
// counts if the one before ends just there; otherwise its text is read again. Errors come from a walk through the text
// from its begin, which knows the number of each item.

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "io/file/make_room.h"
#include "io/spline/item_reader.h"
#include "parallel/caller_arena.h"
#include "parallel/long_lists.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 18, shortest_text = 16 * piece_bytes;

/// Items that follow each other.
struct ItemPiece {
  std::size_t begin = 0, end = 0;  ///< where the first item begins, and the item after the last
  bool has_failed = false;
  std::vector<ModelSurface> surfaces = {};
};

class ItemPieces {
 public:
  ItemPieces(ItemReader& reader, std::string_view text, std::string_view name)
      : reader_(reader), text_(text), name_(name) {}

  /// The surfaces of the text; none if a walk through all of it is wanted, for its error or its warnings.
  Result<std::optional<std::vector<ModelSurface>>> read() {
    TextCursor cursor(text_, name_);
    if (!reader_.begin(cursor).ok()) return std::optional<std::vector<ModelSurface>>();
    cursor.skip_space();
    at_ = text_.size() - cursor.remaining();
    surfaces_.reserve(reader_.expected(text_.size()));
    // Surfaces take memory twice until a round of pieces is joined.
    const std::size_t count = (text_.size() - at_) / piece_bytes,
                      at_once = 8 * static_cast<std::size_t>(arena_threads());
    bool is_well = true;
    // Where no piece of a round holds a whole item, items are long: the rest is read by one thread.
    has_fitted_ = true;
    for (std::size_t first = 0, begin = at_; first < count && is_well && has_fitted_; first += at_once) {
      std::vector<ItemPiece> pieces(std::min(at_once, count - first));
      const Status status = parallel_for(pieces.size(), 1, {}, [&](std::size_t k, std::size_t) {
        const std::size_t from = begin + (first + k) * piece_bytes,
                          to = first + k + 1 < count ? from + piece_bytes : text_.size();
        pieces[k] = piece_at(first + k == 0 ? begin : likely_item(from, to), to);
      });
      if (!status.ok()) return status;
      has_fitted_ = false;
      fetch_room_for(pieces);
      is_well = join(pieces);
    }
    if (!is_well || !ends_well()) return std::optional<std::vector<ModelSurface>>();
    return std::optional(std::move(surfaces_));
  }

 private:
  /// A cursor in a part of the text. Its lines are counted from `begin` on: errors of pieces are not told, and must not
  /// take the longer the farther back they are.
  TextCursor cursor_at(std::size_t begin, std::size_t end) const {
    return TextCursor(text_.substr(begin, end - begin), name_);
  }
  TextCursor cursor_at(std::size_t begin) const { return cursor_at(begin, text_.size()); }
  /// Whether what would be a byte order mark at a file's begin stands here, where it is an error.
  bool has_mark(std::size_t place) const { return text_.substr(place).starts_with("\xEF\xBB\xBF"); }

  /// Reads a piece. None reads far into what others read, whatever it takes for an item.
  ItemPiece piece_at(std::size_t begin, std::size_t limit) const {
    const std::size_t line_end = text_.find('\n', std::min(limit + piece_bytes, text_.size()));
    return read_piece(begin, limit, std::min(line_end, text_.size() - 1) + 1);
  }

  /// Where an item seems to begin a line, from `from` on; `limit` if none does before it.
  std::size_t likely_item(std::size_t from, std::size_t limit) const {
    for (std::size_t at = from; (at = text_.find('\n', at)) < limit;) {
      TextCursor cursor = cursor_at(at);  // at the end of a line
      cursor.skip_space();
      at = text_.size() - cursor.remaining();
      if (at >= limit) break;
      if (reader_.seems_item(cursor)) return at;
    }
    return limit;
  }

  /// Reads items from one on, until one begins at `limit` or later, or does not end within the first `size` bytes.
  ItemPiece read_piece(std::size_t begin, std::size_t limit, std::size_t size) const {
    ItemPiece piece{.begin = begin, .end = begin, .has_failed = has_mark(begin)};
    const std::unique_ptr<ItemReader> reader = reader_.for_rest();
    for (TextCursor cursor = cursor_at(begin, size);
         !piece.has_failed && piece.end < limit && reader->more(cursor, piece.surfaces.size());) {
      Result<ReadItem> item = reader->read(cursor, piece.surfaces.size(), text_.size() - size);
      if (cursor.at_end() && size < text_.size()) break;
      piece.has_failed = !item || !item->surface || item->swapped;
      if (piece.has_failed) break;
      make_room(piece.surfaces, piece.end - begin, limit - begin);
      piece.surfaces.push_back(*std::move(item->surface));
      cursor.skip_space();
      piece.end = size - cursor.remaining();
    }
    return piece;
  }

  /// Fetches the memory that the surfaces of pieces will take.
  void fetch_room_for(std::span<const ItemPiece> pieces) {
    std::size_t count = 0;
    for (const ItemPiece& piece : pieces) count += piece.surfaces.size();
    count = std::min(count, surfaces_.capacity() - surfaces_.size());
    fetch_room({reinterpret_cast<std::byte*>(surfaces_.data() + surfaces_.size()), count * sizeof(ModelSurface)});
  }

  /// Puts pieces after what is joined. Returns whether all is well.
  bool join(std::span<ItemPiece> pieces) {
    for (ItemPiece& piece : pieces) {
      if (piece.begin < at_) continue;
      if (piece.begin > at_ && !add(read_piece(at_, piece.begin, text_.size()))) return false;
      if (piece.begin != at_) continue;
      has_fitted_ |= !piece.surfaces.empty();
      if (!add(std::move(piece))) return false;
    }
    return true;
  }

  bool ends_well() {
    if (at_ < text_.size() && !add(read_piece(at_, text_.size(), text_.size()))) return false;
    TextCursor cursor = cursor_at(at_);
    return !surfaces_.empty() && !reader_.more(cursor, surfaces_.size()) && reader_.end(cursor, nullptr).ok();
  }

  bool add(ItemPiece piece) {
    TextCursor cursor = cursor_at(piece.begin);
    make_room(surfaces_, at_, text_.size());
    std::ranges::move(piece.surfaces, std::back_inserter(surfaces_));
    at_ = piece.end;
    return !piece.has_failed && (piece.surfaces.empty() || reader_.more(cursor, surfaces_.size() - 1));
  }

  ItemReader& reader_;
  std::string_view text_, name_;
  std::size_t at_ = 0;       ///< the end of what is joined
  bool has_fitted_ = false;  ///< whether a piece of the last round was joined
  std::vector<ModelSurface> surfaces_;
};

Result<Model> walk_items(ItemReader& reader, std::string_view text, std::string_view name) {
  Model model;
  ItemWalk walk(reader, name, {});
  const Status status = walk.go(
      {}, text.size(),
      [&](std::uint64_t, std::size_t, std::string_view) {
        return TextWindow{text, 0};
      },
      [&](ReadItem& item) {
        if (!item.surface) return;
        if (model.surfaces.empty()) model.surfaces.reserve(reader.expected(text.size()));
        make_room(model.surfaces, static_cast<std::size_t>(walk.offset()), text.size());
        model.surfaces.push_back(*std::move(item.surface));
      });
  if (!status.ok()) return status;
  model.warnings = walk.warnings();
  return model;
}

}  // namespace

Result<Model> read_items(ItemReader& reader, std::string_view text, std::string_view name) {
  if (text.size() < shortest_text || arena_threads() == 1) return walk_items(reader, text, name);
  Result<std::optional<std::vector<ModelSurface>>> surfaces = ItemPieces(reader, text, name).read();
  if (!surfaces) return surfaces.status();
  if (!*surfaces) return walk_items(reader, text, name);
  Model model;
  model.surfaces = **std::move(surfaces);
  return model;
}

}}  // namespace tessera::abi_0_1
