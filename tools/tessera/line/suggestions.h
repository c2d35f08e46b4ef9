#pragma once
// Suggests a word for one that was mistyped.

#include <string>
#include <string_view>
#include <vector>

namespace tessera::cli {

/// The number of letters to insert, delete, change, or swap with their neighbour to turn one word into the other
/// (Damerau, A technique for computer detection and correction of spelling errors, CACM 7(3), 1964; each place once).
std::size_t edit_distance(std::string_view from, std::string_view to);

/// The nearest of `words` if it is near enough, which is a third of its letters, at least one; or the only one that
/// begins with `word`. Empty if there is none.
std::string nearest(const std::string& word, const std::vector<std::string>& words);
/// "; did you mean info?", or an empty text.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& words);

/// "a, b or c".
std::string listed(const std::vector<std::string>& words, std::string_view last);

}  // namespace tessera::cli
