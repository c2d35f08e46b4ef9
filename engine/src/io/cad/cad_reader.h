#pragma once
// The program tessera-cad-reader, which reads CAD files by OpenCASCADE: its arguments are a format, a file and the
// process that it serves. It prints a greeting, the number of bytes of a model, and these bytes.

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "tessera/cad.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

struct CadExtension {
  std::string_view extension;  ///< ".stp"
  CadFormat format;
};
inline constexpr std::array<CadExtension, 8> cad_extensions{{{".brep", CadFormat::brep},
                                                             {".brp", CadFormat::brep},
                                                             {".iges", CadFormat::iges},
                                                             {".igs", CadFormat::iges},
                                                             {".p21", CadFormat::step},
                                                             {".step", CadFormat::step},
                                                             {".stp", CadFormat::step},
                                                             {".stpz", CadFormat::step}}};

/// The format of the extension, also before .gz; by_extension if it is of no CAD file.
CadFormat cad_format_of(const std::filesystem::path& path);
/// ", .brep, .brp, ...": the end of a list of formats.
std::string listed_cad_extensions();

/// Bounds on one file. They end a reader that a damaged file sends astray.
struct CadReaderLimits {
  std::uint64_t memory_bytes = 0;
  unsigned cpu_seconds = 0;
};
inline CadReaderLimits cad_reader_limits(std::uint64_t file_bytes) {
  return {(std::uint64_t{512} << 20) + 256 * file_bytes, static_cast<unsigned>(120 + file_bytes / 20000)};
}

/// Exit statuses; as in <sysexits.h>.
enum CadReaderExit { cad_reader_done = 0, cad_reader_misused = 64, cad_reader_failed = 70, cad_reader_out_of_memory };

/// Finds the reader: `named`, or the environment's, or the first that lies beside this program or library, in a
/// libexec folder or on PATH. `format`: for an error's words. Errors: unsupported (there is none).
Result<std::string> reader_for(const std::filesystem::path& named, std::string_view format);

struct CadReaderRun {
  std::string reader;  ///< the program
  std::string_view format;
  std::string file;
  std::string name = {};  ///< in messages; empty: the file
  std::uint64_t file_bytes = 0;
  const std::atomic<bool>* cancel = nullptr;
  std::chrono::milliseconds startup = std::chrono::minutes(1);  ///< for the greeting, which comes before any work
};
/// Reads the file. Messages begin with its name. Errors: those of the file, io_error (not started), unsupported
/// (another version), out_of_memory, cancelled, internal.
Result<Model> run_cad_reader(const CadReaderRun& run);

}}  // namespace tessera::abi_0_1
