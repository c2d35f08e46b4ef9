#include "io_occt/iges_surfaces.h"

#include <algorithm>
#include <charconv>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The characters that separate parameters and end records: the first two parameters of section G, as "1H,,1H;,", or
/// empty for these.
struct Delimiters {
  char parameter = ',', record = ';';

  void read(std::string_view global) {
    if (global.substr(0, 2) == "1H" && global.size() > 2) parameter = global[2], global.remove_prefix(3);
    if (global.empty() || global[0] != parameter) return;
    global.remove_prefix(1);
    if (global.substr(0, 2) == "1H" && global.size() > 2) record = global[2];
  }
};

std::vector<std::string> words_of(std::string_view record, char delimiter) {
  std::vector<std::string> words;
  while (!record.empty()) {
    const std::size_t end = std::min(record.find(delimiter), record.size());
    std::string& word = words.emplace_back();
    for (const char c : record.substr(0, end))
      if (c != ' ') word += c;
    record.remove_prefix(std::min(end + 1, record.size()));
  }
  return words;
}

constexpr std::size_t data_columns = 64, section_column = 72;

class SurfaceScan {
 public:
  explicit SurfaceScan(std::string_view text) : text_(text) {}

  std::vector<IgesSurface> surfaces() {
    for (std::size_t begin = 0; begin < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size() - 1) + 1;
      take(text_.substr(begin, end - begin), begin, end);
      begin = end;
    }
    return std::move(surfaces_);
  }

 private:
  void take(std::string_view line, std::size_t begin, std::size_t end) {
    if (line.size() <= section_column) return;
    if (line[section_column] == 'G' && !global_seen_) {
      delimiters_.read(line);
      global_seen_ = true;
    }
    if (line[section_column] != 'P') return;
    const std::string_view data = line.substr(0, data_columns);
    if (!open_ && !(data.starts_with("128") && data.substr(3, 1) == std::string_view(&delimiters_.parameter, 1)))
      return;
    if (!open_) start(line, begin);
    const std::size_t stop = data.find(delimiters_.record);
    record_ += data.substr(0, stop);
    open_ = stop == std::string_view::npos;
    if (open_) return;
    surfaces_.back().words = words_of(record_, delimiters_.parameter);
    surfaces_.back().end = end;
  }

  void start(std::string_view line, std::size_t begin) {
    IgesSurface& surface = surfaces_.emplace_back();
    surface.begin = begin;
    surface.begin_of_tail = line.substr(data_columns);
    surface.parameter = delimiters_.parameter;
    surface.terminator = delimiters_.record;
    // Columns 66 to 72 are the entity's number.
    const std::string_view entity = line.substr(65, 7);
    surface.entity = "D" + std::string(entity.substr(std::min(entity.find_first_not_of(" 0"), entity.size())));
    record_.clear();
  }

  std::string_view text_;
  std::vector<IgesSurface> surfaces_;
  Delimiters delimiters_;
  std::string record_;
  bool global_seen_ = false, open_ = false;  ///< open: within a record
};

}  // namespace

double IgesSurface::number(std::size_t k) const {
  if (k >= words.size()) return 0;
  std::string word;
  for (const char c : words[k])
    if (c != '+') word += c == 'D' || c == 'd' ? 'E' : c;
  double value = 0;
  std::from_chars(word.data(), word.data() + word.size(), value);
  return value;
}

std::size_t IgesSurface::count(std::size_t k) const {
  const double value = number(k);
  return value > 0 && value < 1e6 ? static_cast<std::size_t>(value) : 0;
}

std::vector<IgesSurface> iges_surfaces(std::string_view text) {
  std::vector<IgesSurface> surfaces = SurfaceScan(text).surfaces();
  std::erase_if(surfaces, [](const IgesSurface& surface) { return surface.words.size() < 10; });
  return surfaces;
}

}}  // namespace tessera::abi_0_1
