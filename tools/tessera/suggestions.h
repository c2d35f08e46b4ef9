#pragma once
// Suggests the word that was meant for one that was typed.

#include <string>
#include <string_view>
#include <vector>

namespace tessera::cli {

/// How many letters are to be put in, left out, changed, or swapped with their neighbour to make one word of the other
/// (Damerau, A technique for computer detection and correction of spelling errors, CACM 7(3), 1964; each place once).
std::size_t edit_distance(std::string_view from, std::string_view to);

/// The nearest of `words`, if it is near enough to be meant: a third of its letters, one at the least; or the only one
/// that begins so. Empty if there is none.
std::string nearest(const std::string& word, const std::vector<std::string>& words);
/// "; did you mean info?", or nothing.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& words);

/// "a, b or c".
std::string listed(const std::vector<std::string>& words, std::string_view last);

}  // namespace tessera::cli
