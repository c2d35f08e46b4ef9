// PNG files can be read back, and no partial file remains.

#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "render/render.h"

namespace tessera::render { namespace {

namespace fs = std::filesystem;

class PngFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tessera_png_" + std::to_string(getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

Image gradient(int width, int height) {
  Image image{width, height, {}};
  for (int k = 0; k < 3 * width * height; ++k) image.rgb.push_back(static_cast<std::uint8_t>(k * 7));
  return image;
}

std::vector<std::uint8_t> read_back(const fs::path& path) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&header, path.c_str()) == 0) return {};
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(header));
  if (png_image_finish_read(&header, nullptr, bytes.data(), 0, nullptr) == 0) return {};
  return bytes;
}

TEST_F(PngFiles, RoundTrip) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{17, 5}, std::pair{300, 200}}) {
    const Image image = gradient(width, height);
    const fs::path path = folder_ / "picture.png";
    const Status status = write_png(image, path);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(read_back(path), image.rgb);
    EXPECT_EQ(files(), 1u);  // an older one is replaced, nothing lies beside it
  }
}

TEST_F(PngFiles, WhatCannotBeWritten) {
  const Image image = gradient(4, 4);
  const fs::path nowhere = folder_ / "missing" / "picture.png";
  const Status status = write_png(image, nowhere);
  EXPECT_EQ(status.code(), StatusCode::io_error);
  EXPECT_NE(status.message().find(nowhere.string()), std::string::npos);
  const fs::path folder = folder_ / "folder.png";
  fs::create_directory(folder);
  std::ofstream(folder / "inside") << "x";
  EXPECT_EQ(write_png(image, folder).code(), StatusCode::io_error);
  EXPECT_EQ(write_png(image, {}).code(), StatusCode::io_error);
  EXPECT_EQ(files(), 1u);
}

TEST_F(PngFiles, AFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  EXPECT_EQ(write_png(gradient(64, 64), "/dev/full").code(), StatusCode::io_error);
}

TEST_F(PngFiles, ImagesThatDoNotFitTheirSize) {
  Image image = gradient(4, 4);
  image.rgb.pop_back();
  EXPECT_EQ(write_png(image, folder_ / "a.png").code(), StatusCode::invalid_argument);
  EXPECT_EQ(write_png(Image{}, folder_ / "a.png").code(), StatusCode::invalid_argument);
  EXPECT_EQ(write_png(Image{-1, -3, {1, 2, 3, 4, 5, 6, 7, 8, 9}}, folder_ / "a.png").code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(files(), 0u);
}

}}  // namespace tessera::render
