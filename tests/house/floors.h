#pragma once
// The table of floors and rooms (floors.txt): which parts of engine/ may include which.

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::house {

using Names = std::set<std::string, std::less<>>;

struct FloorTable {
  std::map<std::string, Names, std::less<>> on;              ///< floor -> the floors that it stands directly on
  std::map<std::string, Names, std::less<>> rooms;           ///< "floor/room" -> the rooms that it stands directly on
  std::map<std::string, std::string, std::less<>> floor_of;  ///< public header's file name -> its floor
  std::map<std::string, Names, std::less<>> outside;         ///< prefix of a path between <> -> floors and headers

  /// The floor itself and all floors that it stands on, however deep.
  Names reachable(std::string_view floor) const;
  /// The room itself and all rooms that it stands on, however deep.
  Names reachable_rooms(std::string_view room) const;
  /// Whether the floor is divided into rooms.
  bool has_rooms(std::string_view floor) const;
};

/// Reads the table. Appends its faults (a line of another form, an unknown or repeated name, floors or rooms that stand
/// on each other in a circle) to `faults`.
FloorTable parse_floors(std::string_view text, std::vector<std::string>& faults);

}  // namespace tessera::house
