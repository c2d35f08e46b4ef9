#include "io/rib/rib_archives.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "io/file/gzip.h"
#include "io/file/relative_path.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

Status failure(const TextCursor& at, const std::string& sentence, StatusCode code) {
  return Status(code, at.place() + ": ReadArchive: " + sentence);
}

}  // namespace

Result<const RibArchive*> RibArchives::open(const TextCursor& at, std::string_view name) {
  std::string found;
  for (const std::string& file : {open_.back(), open_.front()}) {
    const Result<fs::path> path = path_beside(file, name);
    if (!path) return failure(at, path.status().message(), path.status().code());
    std::error_code error;
    if (found.empty() && fs::exists(*path, error)) found = path->string();
  }
  if (found.empty()) return nullptr;
  if (const Status status = check_below(open_.front(), found); !status.ok())
    return failure(at, status.message(), status.code());
  const auto is_open = [&](const std::string& path) { return fs::path(path).lexically_normal() == found; };
  if (std::any_of(open_.begin(), open_.end(), is_open))
    return failure(at, "the file " + found + " reads itself", StatusCode::parse_error);
  if (open_.size() > max_depth)
    return failure(at, "archives are nested deeper than " + std::to_string(max_depth) + " files",
                   StatusCode::unsupported);
  const Result<const RibArchive*> archive = load(at, found);
  if (!archive) return archive;
  constexpr std::size_t slack = std::size_t{1} << 20;
  opened_bytes_ += (*archive)->text.size();
  if (opened_bytes_ > max_copies * files_bytes_ + slack)
    return failure(at, "the archives stand for more than " + std::to_string(max_copies) + " times their files",
                   StatusCode::unsupported);
  open_.push_back(found);
  return archive;
}

Result<const RibArchive*> RibArchives::load(const TextCursor& at, const std::string& path) {
  auto& archive = read_[path];
  if (archive) return archive.get();
  Result<std::string> bytes = read_regular_file(path);
  if (bytes && is_gzip(path, *bytes)) bytes = unpack_gzip(*bytes, path);
  if (!bytes) return failure(at, bytes.status().message(), bytes.status().code());
  files_bytes_ += bytes->size();
  archive = std::make_unique<const RibArchive>(RibArchive{path, *std::move(bytes)});
  return archive.get();
}

}}  // namespace tessera::abi_0_1
