#include "io_occt/iges_weights.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace tessera::inline abi_0_1 {
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

/// The numbers of a record; 0 for a parameter that is missing or not a number. A D may stand for the E of an exponent.
std::vector<double> numbers_of(std::string_view record, char delimiter) {
  std::vector<double> numbers;
  while (!record.empty()) {
    const std::size_t end = std::min(record.find(delimiter), record.size());
    std::string word;
    for (const char c : record.substr(0, end))
      if (c != ' ' && c != '+') word += c == 'D' || c == 'd' ? 'E' : c;
    double value = 0;
    std::from_chars(word.data(), word.data() + word.size(), value);
    numbers.push_back(value);
    record.remove_prefix(std::min(end + 1, record.size()));
  }
  return numbers;
}

std::size_t count(double number) { return number > 0 && number < 1e6 ? static_cast<std::size_t>(number) : 0; }

/// Checks 128, K1, K2, M1, M2, five flags (the third is 1 for a polynomial surface), the knots, and the weights with
/// the first index running fastest (IGES 5.3, sec. 4.23).
Status check_surface(const std::vector<double>& p, const std::string& where) {
  if (p.size() < 10 || p[0] != 128 || p[7] == 1) return {};
  const std::size_t row = count(p[1]) + 1, rows = count(p[2]) + 1;
  const std::size_t first = 10 + (row + count(p[3]) + 1) + (rows + count(p[4]) + 1);
  for (std::size_t k = 0; k < row * rows && first + k < p.size(); ++k) {
    if (p[first + k] > 0) continue;
    return Status(StatusCode::invalid_weight, where + ": weight [" + std::to_string(k % row) + "][" +
                                                  std::to_string(k / row) + "] is " + text(p[first + k]) +
                                                  ", it must be greater than 0");
  }
  return {};
}

}  // namespace

Status check_iges_weights(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Delimiters delimiters;
  std::string line, record;
  bool global_seen = false, in_surface = false;
  while (std::getline(file, line)) {
    if (line.size() <= 72) continue;
    if (line[72] == 'G' && !global_seen) {
      delimiters.read(line);
      global_seen = true;
    }
    if (line[72] != 'P') continue;
    // Columns 1 to 64 are data, 66 to 72 the entity's number.
    const std::string_view data = std::string_view(line).substr(0, 64);
    if (!in_surface && !(data.starts_with("128") && data.substr(3, 1) == std::string_view(&delimiters.parameter, 1)))
      continue;
    const std::size_t end = data.find(delimiters.record);
    record += data.substr(0, end);
    in_surface = end == std::string_view::npos;
    if (in_surface) continue;
    const std::string_view entity = std::string_view(line).substr(65, 7);
    const std::size_t digits = std::min(entity.find_first_not_of(" 0"), entity.size());
    Status status = check_surface(numbers_of(record, delimiters.parameter),
                                  path + ": surface D" + std::string(entity.substr(digits)));
    if (!status.ok()) return status;
    record.clear();
  }
  return {};
}

}  // namespace tessera::inline abi_0_1
