#include <png.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/guard.h"
#include "io/output_file.h"
#include "render/render.h"

namespace tessera::render {
namespace {

Status encode(const Image& image, std::vector<char>& bytes) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  // A first call would ask for the size by encoding everything: the bound is enough.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  bytes.resize(size);
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    return Status(StatusCode::internal, std::string("libpng: ") + header.message);
  }
  bytes.resize(size);
  return {};
}

}  // namespace

Status write_png(const Image& image, const std::filesystem::path& path) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    return Status(StatusCode::invalid_argument, "a picture's bytes don't fit its size");
  }
  return guarded([&]() -> Status {
    std::vector<char> bytes;
    if (Status status = encode(image, bytes); !status.ok()) return status;
    Result<OutputFile> file = OutputFile::create(path);
    if (!file) return file.status();
    file->write({bytes.data(), bytes.size()});
    return file->commit();
  });
}

}  // namespace tessera::render
