#pragma once
// Finds the functions of a source file and their lengths.

#include <string>
#include <vector>

namespace tessera::house {

/// A function with a body of more than one line.
struct FunctionLength {
  std::size_t line;    ///< of the opening brace, from 1
  std::size_t length;  ///< lines between the braces
  std::string head;    ///< the text before the opening brace, on one line
};

/// Returns the functions of a text that clang-format has formatted: a body ends at the first brace in the column in
/// which its head begins. Lambdas and local classes belong to the function around them.
std::vector<FunctionLength> function_lengths(const std::string& text);

}  // namespace tessera::house
