// Files that are written whole or not at all: a temporary beside the target, which is renamed.

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "io/file/descriptor.h"
#include "io/file/file.h"
#include "io/file/output_file.h"
#include "io/file/output_place.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

/// The name of a temporary, where a signal handler can read it: in memory that is never freed, without a lock.
struct NamePlace {
  std::atomic<bool> taken = false, readable = false;
  std::array<char, PATH_MAX> name{};
};
// The one state of the process: a signal handler has no other way to the names.
std::array<NamePlace, 8> name_places;

/// The file's real place. Follows symbolic links, even dangling ones, so that they stay links.
Result<fs::path> behind_links(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error)) return path;
  fs::path target = fs::canonical(path, error);
  if (!error) return target;
  // An object that exists under no path, such as the pipe behind /dev/stdout, is opened by the caller's path.
  if (fs::exists(path, error)) return path;
  constexpr int max_links = 40;  // the system's own limit (path_resolution(7))
  target = path;
  for (int link = 0; link < max_links; ++link) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) return target;  // not a link
    target = target.parent_path() / next;
  }
  return io_failure(path, "cannot be written", ELOOP);
}

/// The name of a file that is removed at the end, unless it is released; remove_temporaries knows it as long.
class TemporaryName {
 public:
  TemporaryName() = default;
  explicit TemporaryName(fs::path path);
  TemporaryName(TemporaryName&& other) noexcept
      : path_(std::exchange(other.path_, fs::path())), place_(std::exchange(other.place_, no_place)) {}
  TemporaryName& operator=(TemporaryName&&) = delete;
  ~TemporaryName();

  bool empty() const { return path_.empty(); }
  const char* c_str() const { return path_.c_str(); }
  void release();

 private:
  static constexpr std::size_t no_place = ~std::size_t{0};
  fs::path path_;
  std::size_t place_ = no_place;  // among those that remove_temporaries sees
};

TemporaryName::TemporaryName(fs::path path) : path_(std::move(path)) {
  const std::string& name = path_.native();
  for (std::size_t k = 0; k < name_places.size() && name.size() < PATH_MAX; ++k) {
    if (name_places[k].taken.exchange(true)) continue;
    std::memcpy(name_places[k].name.data(), name.c_str(), name.size() + 1);
    name_places[k].readable = true;
    place_ = k;
    return;
  }
}

TemporaryName::~TemporaryName() {
  if (!empty()) ::unlink(c_str());
  release();
}

void TemporaryName::release() {
  path_.clear();
  if (place_ == no_place) return;
  name_places[place_].readable = false;
  name_places[place_].taken = false;
  place_ = no_place;
}

bool is_same_file(int descriptor, const char* path) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(path, &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

/// Removes a temporary that nobody holds locked: its writer was killed.
bool remove_abandoned(const char* path) {
  const Descriptor file(::open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  return file.is_open() && ::flock(file.number(), LOCK_EX | LOCK_NB) == 0 && is_same_file(file.number(), path) &&
         ::unlink(path) == 0;
}

/// A temporary beside its target.
struct Temporary {
  TemporaryName name;
  Descriptor file;
  int error = 0;  ///< errno of a failure
};

/// Holds signals back on this thread: a handler that calls remove_temporaries() comes before a file is created, or
/// after its name is known. One that runs on another thread meanwhile leaves the file to the next writer.
class HeldSignals {
 public:
  HeldSignals() {
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;
  ~HeldSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

/// The path of a temporary: `target` with an ending. Where the folder takes no name that long, the end of the target's
/// name is left out, and a hash of all of it tells such names apart (FNV-1a, Fowler, Noll, Vo 1991).
fs::path temporary_path(const fs::path& target, std::size_t longest, int number) {
  const std::string name = target.filename().string(), ending = ".tessera-" + std::to_string(number) + ".tmp";
  if (name.size() + ending.size() <= longest) return target.parent_path() / (name + ending);
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  char digits[24];
  const int length = std::snprintf(digits, sizeof digits, "~%016llx", static_cast<unsigned long long>(hash));
  const std::string end = std::string(digits, static_cast<std::size_t>(length)) + ending;
  return target.parent_path() / (name.substr(0, longest > end.size() ? longest - end.size() : 0) + end);
}

/// The most bytes that a name in the target's folder may have.
std::size_t longest_name(const fs::path& target) {
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const long most = ::pathconf(folder.c_str(), _PC_NAME_MAX);
  return most > 0 ? static_cast<std::size_t>(most) : NAME_MAX;
}

/// Creates `target`.tessera-0.tmp, or the next one that no living writer has, and locks it as long as it is open.
Temporary open_temporary(const fs::path& target) {
  constexpr int max_writers = 1000;  // of one target at once
  const std::size_t longest = longest_name(target);
  for (int number = 0, tries = 0; number < max_writers && tries < 2 * max_writers; ++tries) {
    fs::path path = temporary_path(target, longest, number);
    const HeldSignals held;
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.is_open()) {
      // Another writer may have taken the file for abandoned before it was locked: then this name is not ours.
      if (::flock(file.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) continue;
      if (!is_same_file(file.number(), path.c_str())) continue;
      return {TemporaryName(std::move(path)), std::move(file), 0};
    }
    if (errno != EEXIST) return {{}, {}, errno};
    if (!remove_abandoned(path.c_str())) ++number;
  }
  return {{}, {}, EEXIST};
}

/// A file that is open, and its temporary name, if it is to get another.
class FilePlace final : public OutputPlace {
 public:
  explicit FilePlace(Descriptor to, TemporaryName name = {}) : file_(std::move(to)), temporary_(std::move(name)) {}

  std::ptrdiff_t take(std::string_view bytes) override { return ::write(file_.number(), bytes.data(), bytes.size()); }
  int close() override {
    lock_ = Descriptor(::dup(file_.number()));  // until the file has its name
    return file_.close();
  }
  int publish(const fs::path& target) override {
    if (temporary_.empty()) return 0;
    if (::rename(temporary_.c_str(), target.c_str()) != 0) return errno;
    temporary_.release();
    lock_.close();
    return 0;
  }
  fs::path temporary() const override { return temporary_.empty() ? fs::path() : fs::path(temporary_.c_str()); }

 private:
  Descriptor lock_;
  Descriptor file_;
  TemporaryName temporary_;
};

Result<OpenedPlace> opened(Descriptor file, const fs::path& target, TemporaryName name = {}) {
  return OpenedPlace{std::make_unique<FilePlace>(std::move(file), std::move(name)), target};
}

}  // namespace

void remove_temporaries() noexcept {
  for (const NamePlace& place : name_places) {
    if (place.readable.load()) ::unlink(place.name.data());
  }
}

Result<OpenedPlace> open_place(const fs::path& path) {
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
    return opened(std::move(file), path);
  }
  // A rename would replace a file that its owner has write-protected.
  if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    return io_failure(path, "cannot be written", errno);
  Temporary temporary = open_temporary(target);
  if (!temporary.file.is_open()) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    if (temporary.error == ENOENT) {
      return Status(StatusCode::io_error, path.string() + ": cannot be written: there is no folder " + folder.string());
    }
    return io_failure(path, "cannot be written in " + folder.string(), temporary.error);
  }
  if (exists) ::fchmod(temporary.file.number(), facts.st_mode & 07777);  // if it fails, the file has the usual mode
  return opened(std::move(temporary.file), target, std::move(temporary.name));
}

Result<OpenedPlace> open_standard_output() {
  const fs::path name = "standard output";
  Descriptor file(::dup(STDOUT_FILENO));
  if (!file.is_open()) return io_failure(name, "cannot be written", errno);
  return opened(std::move(file), name);
}

}}  // namespace tessera::abi_0_1
