#include "io/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "io/file.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

/// Where the file will lie: behind symbolic links, so that they stay links, even those whose target does not exist yet.
Result<fs::path> behind_links(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  fs::path target = fs::canonical(path, error);
  if (!error) return target;
  // What exists under no path, such as the pipe behind /dev/stdout, is opened by the name given.
  if (fs::exists(path, error)) return path;
  constexpr int most_links = 40;  // the system's own limit (path_resolution(7))
  target = path;
  for (int link = 0; link < most_links; ++link) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) return target;  // no link
    target = target.parent_path() / next;
  }
  return io_failure(path, "cannot be written", ELOOP);
}

/// A name beside `target` that no other writer has, in this process or another.
fs::path temporary_beside(const fs::path& target) {
  static std::atomic<unsigned> serial{0};
  fs::path temporary = target;
  temporary += ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(serial++);
  return temporary;
}

}  // namespace

OutputFile::OutputFile(Descriptor file, fs::path target, fs::path temporary)
    : file_(std::move(file)), target_(std::move(target)), temporary_(std::move(temporary)), buffer_(buffer_bytes) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : file_(std::move(other.file_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, fs::path())),
      buffer_(std::move(other.buffer_)),
      used_(std::exchange(other.used_, 0)),
      status_(std::move(other.status_)) {}

OutputFile::~OutputFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

Result<OutputFile> OutputFile::create(const fs::path& path) {
  const Result<fs::path> place = behind_links(path);
  if (!place) return place.status();
  const fs::path& target = *place;
  struct stat facts {};
  const bool exists = ::stat(target.c_str(), &facts) == 0;
  if (exists && S_ISDIR(facts.st_mode)) {
    return Status(StatusCode::io_error, path.string() + ": cannot be written: it is a directory");
  }
  if (exists && !S_ISREG(facts.st_mode)) {
    Descriptor file(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (!file.is_open()) return io_failure(path, "cannot be written", errno);
    return OutputFile(std::move(file), path, {});
  }
  // A rename would replace a file that its owner has protected from writing.
  if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    return io_failure(path, "cannot be written", errno);
  fs::path temporary = temporary_beside(target);
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.is_open()) {
    const int error = errno;
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    if (error == ENOENT) {
      return Status(StatusCode::io_error, path.string() + ": cannot be written: there is no folder " + folder.string());
    }
    return io_failure(path, "cannot be written in " + folder.string(), error);
  }
  if (exists) ::fchmod(file.number(), facts.st_mode & 07777);  // at worst the file gets the usual mode
  return OutputFile(std::move(file), target, std::move(temporary));
}

OutputFile OutputFile::standard_output() { return OutputFile(Descriptor(::dup(STDOUT_FILENO)), "standard output", {}); }

void OutputFile::write(std::string_view bytes) {
  if (bytes.size() > buffer_.size() - used_) {
    flush();
    if (bytes.size() >= buffer_.size()) return send(bytes);
  }
  if (bytes.empty()) return;
  std::memcpy(buffer_.data() + used_, bytes.data(), bytes.size());
  used_ += bytes.size();
}

void OutputFile::flush() {
  send({buffer_.data(), used_});
  used_ = 0;
}

void OutputFile::send(std::string_view bytes) {
  while (!bytes.empty() && status_.ok()) {
    const ssize_t sent = ::write(file_.number(), bytes.data(), bytes.size());
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) {
      status_ = io_failure(target_, "cannot be written", errno);
    } else {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
}

Status OutputFile::commit() {
  flush();
  const int error = file_.close();
  if (error != 0 && status_.ok()) status_ = io_failure(target_, "cannot be written", error);
  if (status_.ok() && !temporary_.empty()) {
    if (::rename(temporary_.c_str(), target_.c_str()) == 0) {
      temporary_.clear();
    } else {
      status_ = io_failure(target_, "cannot be written", errno);
    }
  }
  return std::move(status_);
}

}  // namespace tessera
