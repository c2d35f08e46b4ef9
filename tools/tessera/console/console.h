#pragma once
// Standard output and error, interruption, clocks.

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>

#include "console/json.h"
#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera::cli {

/// Writes to standard output. Errors: io_error, cancelled.
Status print(std::string_view text);
/// Writes to a file, or to standard output if `path` is empty. Errors: io_error, cancelled.
Status write_text(std::string_view text, const std::string& path);
/// Prints one JSON object on a line of its own: several files give as many lines.
Status print_json(const Json& object);

/// Prints the program's name, ": ..." and the end of the line on standard error.
void complain(const std::string& message);
/// Sets the name in messages; it is "tessera" before. The text must outlive all calls.
void set_program_name(const char* name);
void warn(const std::string& message);
/// An error whose message is already printed.
Status already_said(StatusCode code);
bool is_already_said(const Status& status);

/// Puts the file's name before the message of `status`, for errors that do not know the file.
Status in_file(const std::filesystem::path& file, const Status& status);

/// Makes Ctrl-C, a request to terminate and a terminal that hangs up set the flag of `interrupted`. If the process has
/// not ended 0.4 s later, or at the second of them, it ends at once, and leaves no temporary. A file that grows beyond
/// the limit becomes an error of writing.
void catch_signals();
const std::atomic<bool>& interrupted();
/// Ends the process by the signal that was caught, as its caller expects; returns if there was none.
void end_by_signal();

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// A number for people, with `digits` significant digits.
std::string readable(double value, int digits = 6);
/// [x, y, z].
inline Json to_json(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
/// "1 surface", "2 surfaces"; `plural` if an s is not enough.
std::string counted(std::size_t count, const std::string& noun, const std::string& plural = "");
/// "0.0123 s".
inline std::string readable_seconds(double seconds) { return readable(seconds, 3) + " s"; }

}  // namespace tessera::cli
