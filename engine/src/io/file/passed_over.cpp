#include "io/file/passed_over.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {

void PassedOver::add(const PartName& name, const TextCursor& at) {
  const auto known = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& k) { return k.name.one == name.one; });
  if (known != kinds_.end()) {
    ++known->count;
  } else {
    kinds_.push_back({name, 1, at.line()});
  }
}

std::vector<std::string> PassedOver::warnings() const {
  std::vector<std::string> sentences;
  for (const Kind& kind : kinds_) {
    sentences.push_back(std::string(file_) + ':' + std::to_string(kind.line) + ": " + kind.words() +
                        (kind.count == 1 ? " is not read" : " are not read"));
  }
  return sentences;
}

Status PassedOver::nothing_else() const {
  std::string words;
  for (const Kind& kind : kinds_) words += (words.empty() ? "" : ", ") + kind.words();
  return Status(StatusCode::unsupported, std::string(file_) + ": no surface that can be read, but " + words);
}

std::string surface_name(std::string_view text) {
  constexpr std::size_t limit = 200;
  if (text.size() > limit) {
    std::size_t end = limit;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    text = text.substr(0, end);
  }
  return std::string(text);
}

}}  // namespace tessera::abi_0_1
