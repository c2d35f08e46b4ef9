#include "line/suggestions.h"

#include <algorithm>

namespace tessera::cli {

std::size_t edit_distance(std::string_view from, std::string_view to) {
  std::vector<std::size_t> before(to.size() + 1), last(to.size() + 1), row(to.size() + 1);
  for (std::size_t j = 0; j <= to.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= from.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= to.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (from[i - 1] != to[j - 1])});
      const bool swapped = i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[to.size()];
}

std::string nearest(const std::string& word, const std::vector<std::string>& words) {
  constexpr std::size_t longest = 64;  // a longer word is not a typing error
  if (word.size() > longest) return {};
  std::string found;
  std::size_t least = ~std::size_t{0};
  for (const std::string& candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least && distance <= std::max<std::size_t>(1, candidate.size() / 3)) {
      least = distance;
      found = candidate;
    }
  }
  if (!found.empty()) return found;
  constexpr std::size_t telling = 3;  // letters
  const auto begins = [&](const std::string& candidate) {
    return word.size() >= telling && candidate.starts_with(word);
  };
  return std::count_if(words.begin(), words.end(), begins) == 1 ? *std::find_if(words.begin(), words.end(), begins)
                                                                : "";
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& words) {
  const std::string meant = nearest(word, words);
  return meant.empty() ? "" : "; did you mean " + meant + "?";
}

std::string listed(const std::vector<std::string>& words, std::string_view last) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k > 0) text += k + 1 == words.size() ? " " + std::string(last) + " " : ", ";
    text += words[k];
  }
  return text;
}

}  // namespace tessera::cli
