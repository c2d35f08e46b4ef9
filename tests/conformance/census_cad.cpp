#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "conformance/census.h"

namespace tessera::test {
namespace {

using Count = std::size_t;

/// A STEP file as statements: "#12=WORD(...)" with its references.
struct Statement {
  std::string word;  // empty for a complex one, "(A() B())"
  std::vector<int> references;
};
using Statements = std::map<int, Statement>;

Statements statements_of(const std::string& text) {
  Statements statements;
  const std::regex form(R"re(^\s*#(\d+)\s*=\s*(\w*))re"), string(R"('[^']*')"), reference(R"(#(\d+))");
  std::istringstream stream(std::regex_replace(text, string, "''"));
  for (std::string line; std::getline(stream, line, ';');) {
    std::smatch match;
    if (!std::regex_search(line, match, form)) continue;
    Statement& statement = statements[std::stoi(match[1])];
    statement.word = match[2];
    const std::string rest = match.suffix();
    for (std::sregex_iterator at(rest.begin(), rest.end(), reference); at != std::sregex_iterator(); ++at)
      statement.references.push_back(std::stoi((*at)[1]));
  }
  return statements;
}

/// Adds all that `from` is made of.
void reach(const Statements& statements, int from, std::set<int>& reached) {
  std::vector<int> open{from};
  while (!open.empty()) {
    const int id = open.back();
    open.pop_back();
    if (!reached.insert(id).second || !statements.contains(id)) continue;
    for (const int next : statements.at(id).references) open.push_back(next);
  }
}

bool is_face(const Statement& statement) {
  return statement.word == "ADVANCED_FACE" || statement.word == "FACE_SURFACE";
}

/// Faces of the representations of a product, and of those that are stated to be the same as one of these.
Count faces_of(const Statements& statements, int product) {
  std::set<int> parts;
  for (const auto& [id, shape] : statements)
    if (shape.word == "PRODUCT_DEFINITION_SHAPE" && shape.references == std::vector{product})
      for (const auto& [other, link] : statements)
        if (link.word == "SHAPE_DEFINITION_REPRESENTATION" && link.references.at(0) == id)
          reach(statements, link.references.at(1), parts);
  for (const auto& [id, same] : statements)
    if (same.word == "SHAPE_REPRESENTATION_RELATIONSHIP" && parts.contains(same.references.at(0)))
      reach(statements, same.references.at(1), parts);
  Count faces = 0;
  for (const int part : parts) faces += statements.contains(part) && is_face(statements.at(part));
  return faces;
}

/// How often the whole uses a product: once at the top, otherwise once for each use of the products that it is a part
/// of.
Count uses_of(const Statements& statements, int product) {
  Count uses = 0, parents = 0;
  for (const auto& [id, use] : statements) {
    if (use.word != "NEXT_ASSEMBLY_USAGE_OCCURRENCE" || use.references.at(1) != product) continue;
    uses += uses_of(statements, use.references.at(0));
    ++parents;
  }
  return parents == 0 ? 1 : uses;
}

}  // namespace

std::size_t step_faces(const std::string& text) {
  const Statements statements = statements_of(text);
  Count faces = 0, all = 0;
  bool assembled = false;
  for (const auto& [id, statement] : statements) {
    all += is_face(statement);
    assembled = assembled || statement.word == "NEXT_ASSEMBLY_USAGE_OCCURRENCE";
    if (statement.word == "PRODUCT_DEFINITION") faces += faces_of(statements, id) * uses_of(statements, id);
  }
  return assembled ? faces : all;  // parts without a product are shapes too
}

std::size_t iges_surfaces(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> directory;  // two lines an entry, fields of eight columns
  std::set<int> trimmed;               // parts of trimmed surfaces (144), by the number of the first line of the entry
  for (std::string line; std::getline(stream, line);) {
    if (line.size() <= 72) continue;
    if (line[72] == 'D') directory.push_back(line);
    if (line[72] == 'P' && line.starts_with("144,")) trimmed.insert(std::atoi(line.c_str() + 4));
  }
  const auto field = [](const std::string& line, Count k) { return std::atoi(line.substr(8 * k, 8).c_str()); };
  Count surfaces = 0;
  for (Count k = 0; k + 1 < directory.size(); k += 2) {
    const int type = field(directory[k], 0), form = field(directory[k + 1], 4);
    // Columns 67 and 68 state a dependence; 0: the entity depends on nothing.
    const bool alone = std::atoi(directory[k].substr(66, 2).c_str()) == 0 && !trimmed.contains(static_cast<int>(k) + 1);
    const bool whole = type == 114 || type == 118 || type == 120 || type == 122 || type == 128 || type == 140;
    const bool bounded_plane = type == 108 && form == 1;
    const bool trimmed_face = type == 143 || type == 144;
    surfaces += trimmed_face || (alone && (whole || bounded_plane));
  }
  return surfaces;
}

std::size_t brep_faces(const std::string& text) {
  std::istringstream stream(text);
  Count faces = 0;
  for (std::string line; std::getline(stream, line);) faces += line == "Fa";
  return faces;
}

}  // namespace tessera::test
