#pragma once
// The pixels of a .png file that a command has written, read by libpng.

#include <png.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

namespace tessera::test {

/// Rows from the top, three bytes per pixel.
struct Picture {
  unsigned width = 0, height = 0;
  std::vector<unsigned char> rgb;
};

/// Throws if there is no such picture.
inline Picture read_picture(const std::filesystem::path& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) throw std::runtime_error(image.message);
  image.format = PNG_FORMAT_RGB;
  Picture picture{image.width, image.height, {}};
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr);
  return picture;
}

}  // namespace tessera::test
