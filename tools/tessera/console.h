#pragma once
// Standard output and error, interruption, clocks.

#include <atomic>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/output_file.h"
#include "tessera/status.h"

namespace tessera::cli {

using Json = nlohmann::ordered_json;

/// The file to be written, or standard output if `path` is empty. An interrupt keeps it from appearing. To be opened
/// before the work is done: a bad place is said at once. Errors: io_error.
Result<OutputFile> open_output(const std::string& path);
/// Writes to standard output. Errors: io_error, cancelled.
Status print(std::string_view text);
/// Writes to a file, or to standard output if `path` is empty. Errors: io_error, cancelled.
Status write_text(std::string_view text, const std::string& path);
/// One JSON object on a line of its own, so that several files give as many lines.
Status print_json(const Json& object);

/// "tessera: ..." and the end of the line, on standard error.
void complain(const std::string& message);
void warn(const std::string& message);
/// An error whose message is printed already.
Status already_said(StatusCode code);
bool is_already_said(const Status& status);

/// `status` with the file's name before its message, for errors that do not know the file.
Status in_file(const std::filesystem::path& file, const Status& status);

/// From now on Ctrl-C, a request to terminate and a terminal that hangs up set the flag of `interrupted`; the second
/// time they end the process, and no temporary stays. Files that grow beyond the limit become an error of writing.
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

/// A number for people, with so many significant digits.
std::string readable(double value, int digits = 6);
/// [x, y, z].
inline Json to_json(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }
/// "1 surface", "2 surfaces"; `plural` where it takes more than an s.
std::string counted(std::size_t count, const std::string& noun, const std::string& plural = "");
/// "0.0123 s".
inline std::string readable_seconds(double seconds) { return readable(seconds, 3) + " s"; }

}  // namespace tessera::cli
