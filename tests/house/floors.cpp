#include "house/floors.h"

#include <algorithm>
#include <sstream>

namespace tessera::house {
namespace {

using Words = std::vector<std::string>;

Words split(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find('#')));
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

// Adds "KIND NAME on BELOW...". A floor or room may stand only on those stated before it, so there is no circle.
void add_place(const Words& words, std::map<std::string, Names, std::less<>>& places,
               std::vector<std::string>& faults) {
  const Names below(words.begin() + (words.size() == 2 ? 2 : 3), words.end());
  for (const std::string& name : below) {
    if (!places.contains(name)) faults.push_back(words[1] + " stands on " + name + ", which is not stated above it");
  }
  if (!places.emplace(words[1], below).second) faults.push_back(words[0] + " " + words[1] + " is stated twice");
}

std::string floor_of_room(std::string_view room) { return std::string(room.substr(0, room.find('/'))); }

// Adds a room. All rooms that it stands on belong to its floor.
void add_room(const Words& words, FloorTable& table, std::vector<std::string>& faults) {
  const std::string floor = floor_of_room(words[1]);
  if (floor == words[1] || !table.on.contains(floor)) faults.push_back(words[1] + " is a room of no floor");
  add_place(words, table.rooms, faults);
  for (const std::string& below : table.rooms.at(words[1]))
    if (floor_of_room(below) != floor) faults.push_back(words[1] + " stands on " + below + ", a room of another floor");
}

Names reachable_in(const std::map<std::string, Names, std::less<>>& places, std::string_view name) {
  Names seen{std::string(name)};
  std::vector<std::string> open{std::string(name)};
  while (!open.empty()) {
    const auto found = places.find(open.back());
    open.pop_back();
    if (found == places.end()) continue;
    for (const std::string& below : found->second) {
      if (seen.insert(below).second) open.push_back(below);
    }
  }
  return seen;
}

// Parses one line of the table; false if it has none of the four forms.
bool parse_line(const Words& words, FloorTable& table, std::vector<std::string>& faults) {
  if (words.size() < 2) return false;
  if ((words[0] == "floor" || words[0] == "room") && (words.size() == 2 || (words.size() > 3 && words[2] == "on"))) {
    if (words[0] == "floor") {
      add_place(words, table.on, faults);
    } else {
      add_room(words, table, faults);
    }
    return true;
  }
  if (words[0] == "header" && words.size() == 4 && words[2] == "of") {
    if (!table.on.contains(words[3])) faults.push_back(words[1] + " belongs to the unknown floor " + words[3]);
    if (!table.floor_of.emplace(words[1], words[3]).second) faults.push_back("header " + words[1] + " is stated twice");
    return true;
  }
  if (words[0] == "outside") {
    const auto divider = std::find(words.begin(), words.end(), "for");
    if (divider == words.end() || divider + 1 == words.end()) return false;
    for (auto prefix = words.begin() + 1; prefix != divider; ++prefix) {
      for (auto place = divider + 1; place != words.end(); ++place) {
        if (!table.on.contains(*place) && !table.floor_of.contains(*place)) {
          faults.push_back(*prefix + " is for " + *place + ", which is neither a floor nor a header");
        }
        table.outside[*prefix].insert(*place);
      }
    }
    return true;
  }
  return false;
}

}  // namespace

Names FloorTable::reachable(std::string_view floor) const { return reachable_in(on, floor); }

Names FloorTable::reachable_rooms(std::string_view room) const { return reachable_in(rooms, room); }

bool FloorTable::has_rooms(std::string_view floor) const {
  return std::ranges::any_of(rooms, [&](const auto& room) { return floor_of_room(room.first) == floor; });
}

FloorTable parse_floors(std::string_view text, std::vector<std::string>& faults) {
  FloorTable table;
  std::istringstream stream{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const Words words = split(line);
    if (!words.empty() && !parse_line(words, table, faults)) {
      faults.push_back("line " + std::to_string(number) + " has none of the known forms: " + line);
    }
  }
  return table;
}

}  // namespace tessera::house
