#include <png.h>

#include <fstream>
#include <new>
#include <string>
#include <system_error>

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

Status write_beside(const std::vector<char>& bytes, const std::filesystem::path& path) {
  std::filesystem::path part = path;
  part += ".part";
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  if (!file) return Status(StatusCode::io_error, path.string() + ": cannot be written");
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(part, path, error);
  if (file && !error) return {};
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  return Status(StatusCode::io_error, path.string() + ": " + (error ? error.message() : "cannot be written in full"));
}

}  // namespace

Status write_png(const Image& image, const std::filesystem::path& path) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    return Status(StatusCode::invalid_argument, "a picture's bytes don't fit its size");
  }
  try {
    std::vector<char> bytes;
    if (Status status = encode(image, bytes); !status.ok()) return status;
    return write_beside(bytes, path);
  } catch (const std::bad_alloc&) {
    return Status(StatusCode::out_of_memory, "out of memory");
  } catch (const std::exception& error) {
    return Status(StatusCode::io_error, path.string() + ": " + error.what());
  }
}

}  // namespace tessera::render
