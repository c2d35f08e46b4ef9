// tessera-cad-reader: reads a CAD file for another process, which it does not outlive.

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>
#include <system_error>

#include "io/cad/cad_reader.h"
#include "io/cad/kept_model.h"
#include "io/cad/model_bytes.h"
#include "io_occt/load_model.h"

namespace tessera { inline namespace abi_0_1 { namespace {

constexpr const char* usage =
    "tessera-cad-reader FORMAT FILE PROCESS\n\n"
    "Reads a CAD file for tessera, which starts this program by itself; people read CAD files by \"tessera info "
    "FILE\".\n"
    "FORMAT is STEP, IGES or BREP; PROCESS is the number of the process that starts it, with which it ends. The model\n"
    "goes to standard output, for programs of the same version.\n";

/// Bytes of data of this process, as RLIMIT_DATA counts them; 0 if the system does not say.
std::size_t data_bytes() {
  std::FILE* const file = std::fopen("/proc/self/statm", "re");
  if (!file) return 0;
  unsigned long size = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  const int found = std::fscanf(file, "%lu %lu %lu %lu %lu %lu", &size, &resident, &shared, &text, &library, &data);
  std::fclose(file);
  return found == 6 ? data * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

/// Lowers a limit; never raises one.
template <class Resource>
void lower(Resource resource, rlim_t value) {
  rlimit now{};
  if (::getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min(now.rlim_cur, value);
  ::setrlimit(resource, &now);
}

void set_limits(const char* path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const CadReaderLimits limits = cad_reader_limits(error ? 0 : size);
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_CPU, limits.cpu_seconds);
  if (const std::size_t now = data_bytes(); now > 0) lower(RLIMIT_DATA, now + limits.memory_bytes);
}

/// Ends with the process that it serves. Standard output is for the model alone: OpenCASCADE prints elsewhere.
int private_output(pid_t server) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != server) ::_exit(cad_reader_failed);
  const int output = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(nowhere, stream);
  return output;
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(descriptor, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(done));
  }
  return true;
}

CadReaderExit serve(const char* format, const char* path, pid_t server) {
  const int output = private_output(server);
  set_limits(path);
  if (!write_all(output, cad_reader_greeting())) return cad_reader_failed;
  const std::string bytes = to_bytes(load_model(format, path));
  const std::uint64_t size = bytes.size();
  char head[sizeof size];
  std::memcpy(head, &size, sizeof size);
  return write_all(output, {head, sizeof head}) && write_all(output, bytes) ? cad_reader_done : cad_reader_failed;
}

}}}  // namespace tessera::abi_0_1

int main(int count, char** words) {
  using namespace tessera;
  const bool help = count == 2 && (std::strcmp(words[1], "--help") == 0 || std::strcmp(words[1], "-h") == 0);
  if (count == 2 && std::strcmp(words[1], "--version") == 0) {
    std::fputs(cad_reader_greeting().c_str(), stdout);
    return cad_reader_done;
  }
  if (count != 4) {
    std::fputs(usage, help ? stdout : stderr);
    return help ? cad_reader_done : cad_reader_misused;
  }
  // Ends without destructors: those of OpenCASCADE take time, and have crashed after damaged files.
  try {
    ::_exit(serve(words[1], words[2], static_cast<pid_t>(std::atol(words[3]))));
  } catch (const std::bad_alloc&) {
    ::_exit(cad_reader_out_of_memory);
  } catch (...) {
    ::_exit(cad_reader_failed);
  }
}
