#pragma once
// Whether the streams are terminals, and which colours and sizes these have.

#include <string>

namespace tessera::cli {

bool output_is_terminal();
bool errors_are_terminal();

/// Characters of the terminal that a stream goes to; COLUMNS and LINES, or else 80 x 24, where it goes to none.
struct TerminalSize {
  int columns = 80, rows = 24;
};
TerminalSize terminal_size();

enum class Colours {
  none,         ///< plain characters, no escape sequence
  palette_256,  ///< indices of xterm's 6 x 6 x 6 cube and greys
  full,         ///< 24 bits
};

/// The colours of standard output. `when`: "never", "always" (24 bits, whatever it is), or "auto": none unless it is a terminal
/// whose TERM knows colours and NO_COLOR (no-color.org) is not set; 24 bits if COLORTERM says so.
Colours output_colours(const std::string& when);

/// Whether standard error is a terminal that understands escape sequences.
bool errors_take_escapes();

}  // namespace tessera::cli
