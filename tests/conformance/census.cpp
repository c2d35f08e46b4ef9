#include "conformance/census.h"

#include <cctype>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "support/scratch_folder.h"

namespace tessera::test {
namespace {

using Count = std::size_t;

Count matches(const std::string& text, const char* pattern) {
  const std::regex regex(pattern, std::regex::ECMAScript | std::regex::multiline);
  return static_cast<Count>(std::distance(std::sregex_iterator(text.begin(), text.end(), regex), {}));
}

Count patches_of_bpt(const std::string& text) { return std::stoul(std::regex_replace(text, std::regex("#.*"), "")); }

/// The numbers of a .bv file are passed segment by segment; kinds 4, 5 and 8 are tensor patches.
Count patches_of_bv(const std::string& text) {
  std::istringstream stream(std::regex_replace(text, std::regex("[Gg]roup.*"), ""));
  const std::vector<double> numbers{std::istream_iterator<double>(stream), {}};
  Count patches = 0, at = 0;
  const auto take = [&] { return static_cast<Count>(numbers.at(at++)); };
  while (at < numbers.size()) {
    const Count kind = take(), first = take();
    if (kind == 1) {
      const Count faces = take();
      at += 3 * first;
      for (Count k = 0; k < faces; ++k) at += numbers.at(at) > 0 ? 1 + static_cast<Count>(numbers[at]) : 1;
    } else if (kind == 3) {
      at += 3 * (first + 1) * (first + 2) / 2;
    } else if (kind == 4 || kind == 5 || kind == 8) {
      const Count second = kind == 4 ? first : take();
      at += (kind == 8 ? 4 : 3) * (first + 1) * (second + 1);
      ++patches;
    } else {
      throw std::runtime_error("a kind that this census does not know");
    }
  }
  return patches;
}

/// Counts the words that make a surface outside of comments and strings; of a motion only the first moment.
Count patches_of_rib(const std::string& text) {
  const std::set<std::string> surfaces{"Patch", "PatchMesh", "NuPatch",    "Sphere",      "Cylinder",
                                       "Cone",  "Disk",      "Paraboloid", "Hyperboloid", "Torus"};
  std::istringstream words(std::regex_replace(text, std::regex(R"re(#.*|"[^"]*"|\[[^\]]*\])re"), " "));
  Count patches = 0;
  bool moves = false, first = true;
  for (std::string word; words >> word;) {
    if (word == "MotionBegin" || word == "MotionEnd") moves = word == "MotionBegin", first = true;
    if (!surfaces.contains(word)) continue;
    patches += !moves || first;
    first = false;
  }
  return patches;
}

}  // namespace

std::size_t surfaces_stated(const std::filesystem::path& path) {
  const std::string text = content_of(path), extension = path.extension().string();
  if (extension == ".bpt") return patches_of_bpt(text);
  if (extension == ".bv") return patches_of_bv(text);
  if (extension == ".rib") return patches_of_rib(text);
  if (extension == ".obj") return matches(text, R"(^surf\s)");
  // Spline surfaces, planes, cylinders, spheres, cones and tori; trimmed ones of all these but tori, and extrusions.
  if (extension == ".g2")
    return matches(text, R"(^(200|250|260|270|280|290) 1 0 \d+\s*$)") +
           matches(text, R"(^210 1 0 \d+\s+(200|250|260|261|270|280)\s*$)");
  throw std::runtime_error("no census of " + extension);
}

}  // namespace tessera::test
