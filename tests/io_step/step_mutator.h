#pragma once
// Seeded changes of STEP texts, as faults of writers and of transfers make them, and worse.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tessera::test {

/// Changes a few values, instances or bytes of a text at a time. Equal seeds make equal changes.
class StepMutator {
 public:
  explicit StepMutator(std::uint64_t seed) : random_(seed) {}

  std::string mutated(std::string text) {
    const std::size_t changes = 1 + below(below(4) == 0 ? 12 : 3);
    for (std::size_t k = 0; k < changes && !text.empty(); ++k) change(text);
    return text;
  }

 private:
  struct Token {
    std::size_t begin, length;
  };
  using Tokens = std::vector<Token>;

  std::size_t below(std::size_t count) { return random_() % count; }
  template <class T>
  const auto& any(const T& values) {
    return values[below(values.size())];
  }

  static bool is_in(char c, std::string_view set) { return set.find(c) != std::string_view::npos; }
  static constexpr std::string_view digits = "0123456789", number_signs = "0123456789+-.E",
                                    letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";

  /// The words that begin with one of `first`, after one of `before`, and go on with `rest`.
  static Tokens tokens(const std::string& text, std::string_view before, std::string_view first,
                       std::string_view rest) {
    Tokens out;
    for (std::size_t at = 1; at < text.size(); ++at) {
      if (!is_in(text[at], first) || !is_in(text[at - 1], before)) continue;
      std::size_t end = at + 1;
      while (end < text.size() && is_in(text[end], rest)) ++end;
      out.push_back({at, end - at});
      at = end - 1;
    }
    return out;
  }
  static Tokens numbers(const std::string& text) { return tokens(text, "(, ", "+-.0123456789", number_signs); }
  static Tokens references(const std::string& text) { return tokens(text, "(, ", "#", digits); }
  static Tokens kinds(const std::string& text) { return tokens(text, "=)( ", letters.substr(0, 26), letters); }
  static Tokens flags(const std::string& text) { return tokens(text, ", ", ".", "TFU."); }
  static Tokens lines(const std::string& text) {
    Tokens out;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
      out.push_back({at, end + 1 - at});
      at = end + 1;
    }
    return out;
  }

  void put(std::string& text, const Tokens& tokens, std::string_view by) {
    if (tokens.empty()) return;
    const Token& one = any(tokens);
    text.replace(one.begin, one.length, by);
  }
  void put_another(std::string& text, const Tokens& tokens) {
    if (tokens.empty()) return;
    const Token& other = any(tokens);
    put(text, tokens, text.substr(other.begin, other.length));
  }
  void swap(std::string& text, const Tokens& tokens) {
    if (tokens.empty()) return;
    Token a = any(tokens), b = any(tokens);
    if (a.begin > b.begin) std::swap(a, b);
    if (a.begin == b.begin) return;
    const std::string first = text.substr(a.begin, a.length), second = text.substr(b.begin, b.length);
    text.replace(b.begin, b.length, first);
    text.replace(a.begin, a.length, second);
  }
  void move_number(std::string& text) {
    const Tokens all = numbers(text);
    if (all.empty()) return;
    const Token& one = any(all);
    static constexpr std::array factors{-1.0, 1 + 1e-12, 1 + 1e-6, 1.01, 2.0, 1e3, 1e-3, 1e15};
    char* end = nullptr;
    const std::string word = text.substr(one.begin, one.length);
    const double value = std::strtod(word.c_str(), &end);
    char out[40];
    std::snprintf(out, sizeof out, word.find('.') == std::string::npos ? "%.0f" : "%#.17G",
                  std::clamp(value, -1e15, 1e15) * any(factors));
    text.replace(one.begin, one.length, out);
  }

  void change(std::string& text) {
    static constexpr std::array<std::string_view, 22> reals{
        "0.",    "-0.",    "1.",  "-1.", "1.E308", "-1.E308", "1.E-308", "1.E150", "1.E-150", "1.E16", "1.E9",
        "1.E-9", "1.E400", "0.5", "90.", "360.",   "1.E-7",   "2",       "0",      "-1",      "$",     "1000000000"};
    switch (below(12)) {
      case 0:
        text[below(text.size())] ^= static_cast<char>(1U << below(8));
        return;
      case 1:
      case 2:
        return put(text, numbers(text), any(reals));
      case 3:
        return put_another(text, numbers(text));
      case 4:
        return move_number(text);
      case 5:
        return swap(text, references(text));
      case 6:
      case 7:
        return put_another(text, references(text));
      case 8:
        return put(text, lines(text), "");
      case 9:
        return put(text, flags(text), any(std::array<std::string_view, 3>{".T.", ".F.", ".U."}));
      case 10:
        return put_another(text, kinds(text));
      default:
        text.resize(below(8) == 0 ? below(text.size()) : text.size());
        return swap(text, numbers(text));
    }
  }

  std::mt19937_64 random_;
};

}  // namespace tessera::test
