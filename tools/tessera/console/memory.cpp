#include "console/memory.h"
#include "io/file/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <string_view>

#include "console/console.h"
#include "line/command_line.h"

namespace tessera::cli {
namespace {

constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

/// The number in a file of one line; `unknown` for "max" and where there is no file.
std::uint64_t number_in(const char* path) {
  std::ifstream file(path);
  std::uint64_t number = unknown;
  return file >> number ? number : unknown;
}

/// What the control group of this process leaves (version 2, as containers see it).
std::uint64_t free_in_group() {
  const std::uint64_t most = number_in("/sys/fs/cgroup/memory.max"), used = number_in("/sys/fs/cgroup/memory.current");
  return most == unknown || used == unknown ? unknown : most - std::min(used, most);
}

std::uint64_t free_in_system() {
  std::ifstream file("/proc/meminfo");
  std::uint64_t kibibytes = 0;
  for (std::string word; file >> word;)
    if (word == "MemAvailable:" && file >> kibibytes) return kibibytes * 1024;
  return unknown;
}

}  // namespace

std::uint64_t available_memory() { return std::min(free_in_system(), free_in_group()); }

std::string readable_bytes(std::uintmax_t bytes) {
  constexpr std::array<const char*, 5> units{" bytes", " kB", " MB", " GB", " TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000 && unit + 1 < units.size(); ++unit) value /= 1000;
  return (unit == 0 ? std::to_string(bytes) : readable(value, 3)) + units[unit];
}

std::uint64_t parse_bytes(const std::string& option, const std::string& text) {
  constexpr std::string_view units = "KMGT";
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, value);
  const std::string_view unit(parsed, static_cast<std::size_t>(end - parsed));
  const std::size_t power = unit.size() == 1 ? units.find(unit[0]) : unit.empty() ? 0 : units.npos;
  const unsigned shift = unit.empty() ? 0 : 10 * (static_cast<unsigned>(power) + 1);
  if (error != std::errc() || power == units.npos || value == 0 || value > (unknown >> shift))
    throw UsageError(option, "expected a size like 800M or 12G, found " + quote(text));
  return value << shift;
}

}  // namespace tessera::cli
