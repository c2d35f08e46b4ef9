#include "tessera/surface_file.h"

#include <string>
#include <utility>

#include "io/spline/surface_index.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {

class SurfaceFile::Content {
 public:
  explicit Content(SurfaceIndex of_file) : index(std::move(of_file)) {}
  SurfaceIndex index;
};

SurfaceFile::SurfaceFile(std::unique_ptr<Content> content) : content_(std::move(content)) {}
SurfaceFile::SurfaceFile(SurfaceFile&&) noexcept = default;
SurfaceFile& SurfaceFile::operator=(SurfaceFile&&) noexcept = default;
SurfaceFile::~SurfaceFile() = default;

Result<SurfaceFile> SurfaceFile::open(const std::filesystem::path& path) {
  return guarded([&]() -> Result<SurfaceFile> {
    Result<SurfaceIndex> index = SurfaceIndex::make(path);
    if (!index) return index.status();
    return SurfaceFile(std::make_unique<Content>(*std::move(index)));
  });
}

std::size_t SurfaceFile::size() const { return content_->index.surface_count(); }
std::uint64_t SurfaceFile::bytes() const { return content_->index.file().size(); }
const std::filesystem::path& SurfaceFile::path() const { return content_->index.file().path(); }

Result<Model> SurfaceFile::read(std::size_t first, std::size_t end) const {
  return guarded([&]() -> Result<Model> {
    if (first > end || end > size())
      return Status(StatusCode::invalid_argument, path().string() + ": the run from " + std::to_string(first) + " to " +
                                                      std::to_string(end) + " is not within its surfaces, 0 to " +
                                                      std::to_string(size()));
    return content_->index.read(first, end);
  });
}

}}  // namespace tessera::abi_0_1
