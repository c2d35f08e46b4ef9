#include <algorithm>

#include "base/text.h"
#include "io/spline/item_reader.h"

namespace tessera { inline namespace abi_0_1 {

Status ItemWalk::go(const FilePlace& from, std::size_t window_bytes, Load load, Take take) {
  at_ = from;
  for (std::size_t bytes = window_bytes;;) {
    const std::uint64_t begin = at_.offset;
    const Result<TextWindow> window = load(begin, bytes, reader_.cuts());
    if (!window) return window.status();
    const Result<Step> step = go_on(*window, take);
    if (!step || *step == Step::done) return step.status();
    at_ = place();
    bytes = at_.offset == begin ? 2 * bytes : window_bytes;
  }
}

Result<ItemWalk::Step> ItemWalk::go_on(const TextWindow& window, Take take) {
  TextCursor cursor(window.text, name_, {}, at_.line);
  counted_ = here_ = window.text.data();
  const auto advance = [&] {
    at_.offset += static_cast<std::uint64_t>(cursor.position() - here_);
    here_ = cursor.position();
  };
  // An item that reaches the end of the text may go on after it.
  const auto is_cut = [&] { return cursor.at_end() && window.beyond > 0; };
  if (at_.offset == 0) {
    const Status status = reader_.begin(cursor);
    if (is_cut()) return Step::needs_more_text;
    if (!status.ok()) return status;
    advance();
  }
  while (at_.surface != run_.end) {
    if (!reader_.more(cursor, at_.item)) {
      const Status status = reader_.end(cursor, at_.surface == 0 ? &passed_over_ : nullptr);
      if (is_cut()) return Step::needs_more_text;
      if (!status.ok()) return status;
      break;
    }
    const bool is_inside = at_.surface >= run_.first;
    Result<ReadItem> item = is_inside && run_.keep ? reader_.read(cursor, at_.item, window.beyond)
                                                   : reader_.skip(cursor, at_.item, window.beyond);
    if (is_cut()) return Step::needs_more_text;
    if (!item) return item.status();
    if (is_inside && item->passed_over) passed_over_.add(item->passed_over->name, item->passed_over->at);
    if (is_inside && item->swapped) ++swapped_;
    ++at_.item;
    at_.surface += item->is_surface() ? 1 : 0;
    advance();
    if (is_inside) take(*item);
  }
  return Step::done;
}

FilePlace ItemWalk::place() {
  at_.line += static_cast<std::size_t>(std::count(counted_, here_, '\n'));
  counted_ = here_;
  return at_;
}

std::vector<std::string> ItemWalk::warnings() const {
  std::vector<std::string> sentences = passed_over_.warnings();
  if (swapped_ > 0)
    sentences.push_back(std::string(name_) + ": " + counted(swapped_, "elementary surface") +
                        (swapped_ == 1 ? " has" : " have") + " u and v swapped in the file, but not here");
  return sentences;
}

}}  // namespace tessera::abi_0_1
