#include "peers/joined_step.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera::bench {
namespace {

constexpr std::string_view header =
    "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
    "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n";

/// The text between DATA; and the end of its section.
std::string_view instances_of_file(std::string_view text, const std::filesystem::path& file) {
  const std::size_t begin = text.find("DATA;"), end = text.rfind("ENDSEC;");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin)
    throw std::runtime_error(file.string() + ": it has no DATA section");
  return text.substr(begin + 5, end - begin - 5);
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Appends instances with `first` added to each number. Returns the largest number that results. Text within
/// apostrophes is kept: a doubled apostrophe ends one text and begins the next.
std::uint64_t append(std::string_view instances, std::uint64_t first, std::string& out) {
  std::uint64_t largest = first;
  bool is_text = false;
  for (std::size_t k = 0; k < instances.size();) {
    const char c = instances[k++];
    out += c;
    if (c == '\'') is_text = !is_text;
    if (c != '#' || is_text) continue;
    std::uint64_t number = first;
    for (std::uint64_t own = 0; k < instances.size() && is_digit(instances[k]); ++k) {
      own = 10 * own + static_cast<std::uint64_t>(instances[k] - '0');
      number = first + own;
    }
    out += std::to_string(number);
    largest = std::max(largest, number);
  }
  return largest;
}

}  // namespace

std::string joined_step(const std::vector<std::filesystem::path>& files, std::size_t size) {
  std::vector<std::string> texts;
  for (const std::filesystem::path& file : files) texts.push_back(test::value_of(read_file(file)));
  if (texts.empty()) throw std::runtime_error("there are no STEP files to join");
  std::string out(header);
  std::uint64_t last = 0;
  for (std::size_t k = 0; out.size() < size; k = (k + 1) % files.size()) {
    last = append(instances_of_file(texts[k], files[k]), last, out);
    out += '\n';
  }
  return out + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace tessera::bench
