#include "io/file/output_file.h"

#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include "io/file/file.h"
#include "io/file/output_place.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

/// The caller's string.
class StringPlace final : public OutputPlace {
 public:
  explicit StringPlace(std::string& bytes) : bytes_(bytes) { bytes_.clear(); }
  std::ptrdiff_t take(std::string_view bytes) override {
    try {
      bytes_.append(bytes);
    } catch (...) {
      errno = ENOMEM;
      return -1;
    }
    return static_cast<std::ptrdiff_t>(bytes.size());
  }

 private:
  std::string& bytes_;
};

}  // namespace

OutputFile::OutputFile(std::unique_ptr<OutputPlace> place, fs::path target, const std::atomic<bool>* cancel)
    : place_(std::move(place)), target_(std::move(target)), cancel_(cancel) {}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

Result<OutputFile> OutputFile::opened(Result<OpenedPlace>&& from, const std::atomic<bool>* cancel) {
  if (!from) return from.status();
  return OutputFile(std::move(from->place), std::move(from->target), cancel);
}

Result<OutputFile> OutputFile::make(const fs::path& path, const std::atomic<bool>* cancel) {
  return guarded([&] { return opened(open_place(path), cancel); });
}

Result<OutputFile> OutputFile::standard_output(const std::atomic<bool>* cancel) {
  return guarded([&] { return opened(open_standard_output(), cancel); });
}

Result<OutputFile> OutputFile::memory(std::string& bytes, const fs::path& name, const std::atomic<bool>* cancel) {
  return guarded([&] { return Result<OutputFile>(OutputFile(std::make_unique<StringPlace>(bytes), name, cancel)); });
}

void OutputFile::fail(int error_number) {
  status_ = guarded([&] {
    if (error_number == ENOMEM) return Status(StatusCode::out_of_memory, target_.string() + ": out of memory");
    return io_failure(target_, "cannot be written", error_number);
  });
}

void OutputFile::write(std::string_view bytes) {
  if (bytes.size() > buffer_bytes - used_) {
    flush();
    if (bytes.size() >= buffer_bytes / 2) return send(bytes);
  }
  if (bytes.empty()) return;
  std::memcpy(buffer_.get() + used_, bytes.data(), bytes.size());
  used_ += bytes.size();
}

void OutputFile::flush() {
  send({buffer_.get(), used_});
  used_ = 0;
}

void OutputFile::send(std::string_view bytes) {
  see_cancel();
  while (!bytes.empty() && status_.ok()) {
    const std::ptrdiff_t sent = place_->take(bytes);
    if (sent < 0 && errno == EINTR) {
      see_cancel();
    } else if (sent < 0) {
      fail(errno);
    } else {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
}

void OutputFile::see_cancel() {
  if (status_.ok() && cancel_ && cancel_->load())
    status_ = guarded([] { return Status(StatusCode::cancelled, "cancelled by the caller"); });
}

fs::path OutputFile::temporary() const { return place_ ? place_->temporary() : fs::path(); }

Status OutputFile::commit() {
  flush();
  see_cancel();
  const int error = place_->close();
  if (error != 0 && status_.ok()) fail(error);
  if (!status_.ok()) return std::move(status_);
  if (const int unnamed = place_->publish(target_); unnamed != 0) fail(unnamed);
  return std::move(status_);
}

}}  // namespace tessera::abi_0_1
