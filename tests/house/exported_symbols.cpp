#include "house/exported_symbols.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <sstream>

namespace tessera::house {
namespace {

constexpr std::array<std::string_view, 46> internal_export{
    "tessera::ApartTasks::ApartTasks",
    "tessera::ApartTasks::run",
    "tessera::ApartTasks::~ApartTasks",
    "tessera::allocate_aligned",
    "tessera::arena_threads",
    "tessera::in_own_arena",
    "tessera::parallel_for",
    "tessera::fetch_room",
    "tessera::resize_lists",
    "tessera::without_other_tasks",
    "tessera::ray_kernels",
    "tessera::UniformGrid::make",
    "tessera::UniformGrid::run",
    "tessera::PatchSet::Impl::box",
    "tessera::TrimRegion::Impl::for_points",
    "tessera::EdgeRuns::EdgeRuns",
    "tessera::EdgeRuns::curve",
    "tessera::EdgeRuns::pieces",
    "tessera::curve_parameter",
    "tessera::edge_parameter",
    "tessera::check_parts",
    "tessera::ViewChecks::add",
    "tessera::ViewChecks::status",
    "tessera::usable_isa",
    "tessera::BoxTree::BoxTree",
    "tessera::BoxTree::touches",
    "tessera::are_near",
    "tessera::tabled_curve_parameter",
    "tessera::tabled_edge_parameter",
    "tessera::tree_towards",
    "tessera::gauss_rule",
    "tessera::piece_directions",
    "tessera::lobatto_parameters",
    "tessera::lobatto_to_bernstein",
    "tessera::LobattoTables::of_degree_7",
    "tessera::io_failure",
    "tessera::OutputFile::make",
    "tessera::OutputFile::OutputFile",
    "tessera::OutputFile::~OutputFile",
    "tessera::OutputFile::write",
    "tessera::OutputFile::commit",
    "tessera::PlyLayout::check",
    "tessera::PlyLayout::file_bytes",
    "tessera::PlyLayout::pack",
    "tessera::PlyLayout::range",
    "tessera::PlyLayout::record_bytes",
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// Whether the text has the word, followed by one of these characters if any are listed.
bool has_word(const std::string& text, const std::string& word, std::string_view followed_by = {}) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if (at > 0 && is_word(text[at - 1])) continue;
    if (end < text.size() && is_word(word.back()) && is_word(text[end])) continue;
    if (followed_by.empty() || (end < text.size() && followed_by.find(text[end]) != std::string_view::npos))
      return true;
  }
  return false;
}

/// Whether the header defines the class, rather than only declares it.
bool defines_class(const std::string& header, const std::string& name) {
  for (const char* keyword : {"class ", "struct ", "class [[nodiscard]] "})
    if (has_word(header, keyword + name, " ")) return true;
  return false;
}

/// The name without arguments, types in front, template arguments and ABI tags: "tessera::GridPlan::make".
std::string plain_name(std::string_view symbol) {
  std::string name;
  int depth = 0;
  for (std::size_t k = 0; k < symbol.size(); ++k) {
    const bool is_operator = name.ends_with("::operator");
    const char c = symbol[k];
    if (is_operator && (c == '<' || c == '>' || c == '-' || c == '(')) {  // part of the operator's name
      const std::size_t end = symbol.find('(', k + 1);
      name += symbol.substr(k, end - k);
      break;
    }
    if (c == '<') ++depth;
    if (depth == 0 && c == '(') break;
    if (depth == 0 && c == '[') break;
    if (depth == 0 && c == ' ' && !name.ends_with("operator")) {
      name.clear();
      continue;
    }
    if (depth == 0) name += c;
    if (c == '>') --depth;
  }
  return name;
}

std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = name.find("::"); end != std::string::npos; end = name.find("::", begin)) {
    parts.push_back(name.substr(begin, end - begin));
    begin = end + 2;
  }
  parts.push_back(name.substr(begin));
  return parts;
}

}  // namespace

bool is_declared(std::string_view symbol, const std::string& header) {
  if (symbol.find("(anonymous namespace)") != std::string_view::npos) return false;
  std::vector<std::string> parts = parts_of(plain_name(symbol));
  if (parts.size() < 2 || parts[0] != "tessera") return false;
  if (std::find(parts.begin(), parts.end(), "Impl") != parts.end()) return false;
  for (std::size_t k = 1; k + 1 < parts.size(); ++k) {
    if (!defines_class(header, parts[k])) return false;
  }
  const std::string& last = parts.back();
  if (parts.size() == 2) return has_word(header, last, "(");
  return has_word(header, last[0] == '~' ? last.substr(1) : last);
}

bool takes_inner_types(std::string_view symbol, const std::vector<std::string>& headers) {
  constexpr std::string_view scope = "tessera::";
  const std::size_t arguments = symbol.find('(');
  for (std::size_t at = symbol.find(scope, arguments); at < symbol.size(); at = symbol.find(scope, at)) {
    at += scope.size();
    std::size_t end = at;
    while (end < symbol.size() && is_word(symbol[end])) ++end;
    const std::string type(symbol.substr(at, end - at));
    if (symbol.substr(end).starts_with("::Impl")) return true;
    if (std::none_of(headers.begin(), headers.end(), [&](const std::string& text) { return has_word(text, type); }))
      return true;
  }
  return false;
}

bool is_internal_export(std::string_view symbol) {
  return std::find(internal_export.begin(), internal_export.end(), plain_name(symbol)) != internal_export.end();
}

std::vector<Symbol> symbols_of(std::string_view listing) {
  static const std::regex inline_namespace(R"(\btessera::abi_\d+_\d+::)");
  std::vector<Symbol> symbols;
  std::istringstream stream{std::regex_replace(std::string(listing), inline_namespace, "tessera::")};
  for (std::string line; std::getline(stream, line);) {
    const std::size_t type = line.find(' ');
    if (type == std::string::npos || type + 3 > line.size()) continue;
    symbols.push_back({line[type + 1], line.substr(type + 3)});
  }
  return symbols;
}

}  // namespace tessera::house
