#include "line/completion.h"

namespace tessera::cli {

std::string short_text(const Option& option) {
  std::string text = option.text.substr(0, option.text.find(" ["));
  return text.substr(0, text.find("; "));
}

std::string escaped(const std::string& text, const std::string& characters) {
  std::string out;
  for (const char c : text) {
    if (characters.find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string shell_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace tessera::cli
