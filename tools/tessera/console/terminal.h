#pragma once
// Whether the streams are terminals, and their colours and sizes.

#include <string>

namespace tessera::cli {

bool output_is_terminal();
bool errors_are_terminal();

/// The size of a stream's terminal in characters. For other streams: COLUMNS and LINES, or else 80 x 24.
struct TerminalSize {
  int columns = 80, rows = 24;
};
TerminalSize terminal_size();

enum class Colours {
  none,         ///< plain characters, no escape sequence
  palette_256,  ///< indices of xterm's 6 x 6 x 6 cube and greys
  full,         ///< 24 bits
};

/// The colours of standard output. `when`: "never", "always" (24 bits for any output), or "auto": none unless it is a
/// terminal whose TERM has colours and NO_COLOR (no-color.org) is not set; 24 bits if COLORTERM says so.
Colours output_colours(const std::string& when);

/// Whether standard error is a terminal that understands escape sequences.
bool errors_take_escapes();

}  // namespace tessera::cli
