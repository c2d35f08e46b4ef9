#include "house/include_rules.h"

#include <regex>
#include <sstream>

namespace tessera::house {
namespace {

struct Include {
  int line;
  char open;  // < or ", or 0 where it is neither
  std::string path;
};

// Replaces block comments by blanks, so that quoted code does not count as code; lines keep their numbers. "/*" in a
// line comment or a string begins no block comment.
std::string without_block_comments(std::string text) {
  enum class State { code, line_comment, block_comment, string } state = State::code;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::string_view pair = std::string_view(text).substr(k, 2);
    if (state == State::block_comment) {
      const bool ends = pair == "*/";
      for (std::size_t j = k; j < k + (ends ? 2 : 1); ++j) {
        if (text[j] != '\n') text[j] = ' ';
      }
      if (ends) state = State::code, ++k;
    } else if (text[k] == '\n') {
      state = State::code;
    } else if (state == State::string) {
      if (text[k] == '\\')
        ++k;
      else if (text[k] == '"')
        state = State::code;
    } else if (state == State::code) {
      if (pair == "//") state = State::line_comment;
      if (pair == "/*") state = State::block_comment, text[k] = ' ', text[++k] = ' ';
      if (text[k] == '"') state = State::string;
    }
  }
  return text;
}

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex directive(R"(^\s*#\s*(?:include|import|include_next)\b\s*(.*)$)");
  static const std::regex target(R"re(^(?:<([^>]*)>|"([^"]*)").*$)re");
  std::vector<Include> includes;
  std::istringstream stream(without_block_comments(text));
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    std::smatch found;
    if (!std::regex_match(line, found, directive)) continue;
    const std::string rest = found[1];
    if (std::regex_match(rest, found, target)) {
      includes.push_back({number, rest[0], found[1].matched ? found[1].str() : found[2].str()});
    } else {
      includes.push_back({number, 0, rest});
    }
  }
  return includes;
}

// The part of a path before its first slash, and the part after it.
std::pair<std::string, std::string> split_at_slash(const std::string& path) {
  const std::size_t slash = path.find('/');
  if (slash == std::string::npos) return {"", path};
  return {path.substr(0, slash), path.substr(slash + 1)};
}

// The floor and room of a file, and its name if it is a public header.
struct Place {
  std::string floor;
  std::string room;    // "floor/room"; empty on a floor without rooms
  std::string header;  // empty for a file of engine/src
};

// The room of a path "floor/room/file"; empty for "floor/file".
std::string room_of(const std::string& path) {
  const std::size_t last = path.rfind('/');
  return path.find('/') == last ? "" : path.substr(0, last);
}

std::string check_outside(const Include& include, const Place& place, const FloorTable& table) {
  if (include.path.find_first_of("./") == std::string::npos) return "";  // the C++ standard library
  const std::string& owner = place.header.empty() ? place.floor : place.header;
  for (const auto& [prefix, places] : table.outside) {
    const bool is_folder = prefix.back() == '/';
    if (is_folder ? include.path.starts_with(prefix) : include.path == prefix) {
      return places.contains(owner) ? "" : "<" + include.path + "> is not for " + owner;
    }
  }
  return "<" + include.path + "> is in no line of the table, so it is for nobody";
}

std::string check_inside(const Include& include, const Place& place, const FloorTable& table, const Names& known) {
  const std::string quoted = "\"" + include.path + "\"";
  const auto [folder, name] = split_at_slash(include.path);
  const Names allowed = table.reachable(place.floor);
  if (folder == "tessera") {
    const auto header = table.floor_of.find(name);
    if (header == table.floor_of.end()) return quoted + " is not a public header of the table";
    if (!known.contains("include/" + include.path)) return quoted + " does not exist";
    if (!allowed.contains(header->second))
      return quoted + " belongs to " + header->second + ", not below " + place.floor;
    return "";
  }
  if (!place.header.empty()) return quoted + " is private, in a public header";
  if (!table.on.contains(folder)) return quoted + " does not have the form floor/file.h";
  if (!known.contains("src/" + include.path)) return quoted + " does not exist";
  if (!allowed.contains(folder)) return quoted + " is not below " + place.floor;
  if (folder == place.floor && !place.room.empty() &&
      !table.reachable_rooms(place.room).contains(room_of(include.path)))
    return quoted + " is in a room that is not below " + place.room;
  return "";
}

}  // namespace

std::vector<std::string> check_includes(const SourceFile& file, const FloorTable& table, const Names& known) {
  Place place;
  const std::string public_folder = "include/tessera/";
  if (file.path.starts_with(public_folder)) {
    place.header = file.path.substr(public_folder.size());
    const auto owner = table.floor_of.find(place.header);
    if (owner == table.floor_of.end()) return {file.path + ": this public header is not in the table of floors"};
    place.floor = owner->second;
  } else {
    const auto [top, rest] = split_at_slash(file.path);
    place.floor = split_at_slash(rest).first;
    if (top != "src" || !table.on.contains(place.floor)) return {file.path + ": this file is on no floor of the table"};
    place.room = room_of(rest);
    if (place.room.empty() ? table.has_rooms(place.floor) : !table.rooms.contains(place.room))
      return {file.path + ": this file is in no room of the table"};
  }
  std::vector<std::string> faults;
  for (const Include& include : includes_of(file.text)) {
    std::string fault;
    if (include.open == '<') {
      fault = check_outside(include, place, table);
    } else if (include.open == '"') {
      fault = check_inside(include, place, table, known);
    } else {
      fault = "#include of something that is neither <path> nor \"path\": " + include.path;
    }
    if (!fault.empty()) faults.push_back(file.path + ":" + std::to_string(include.line) + ": " + fault);
  }
  return faults;
}

Names quoted_includes(const std::string& text) {
  Names names;
  for (const Include& include : includes_of(text))
    if (include.open == '"') names.insert(include.path);
  return names;
}

std::map<std::string, Names, std::less<>> floors_of_cmake(const std::string& text) {
  static const std::regex call(R"(tessera_floor\s*\(([^)]*)\))");
  std::map<std::string, Names, std::less<>> floors;
  for (auto found = std::sregex_iterator(text.begin(), text.end(), call); found != std::sregex_iterator(); ++found) {
    std::istringstream words((*found)[1].str());
    std::string floor;
    words >> floor;
    Names below;
    bool in_below = false;
    for (std::string word; words >> word;) {
      if (in_below) below.insert(word);
      if (word == "BELOW") in_below = true;
      if (word == "SOURCES") in_below = false;
    }
    floors.emplace(floor, below);
  }
  return floors;
}

}  // namespace tessera::house
