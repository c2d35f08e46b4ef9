#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <string>
#include <vector>

#include "io/file/output_file.h"
#include "render/render.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera::render {
namespace {

using Message = std::array<char, 200>;

extern "C" void write_bytes(png_structp png, png_bytep bytes, std::size_t size) {
  static_cast<OutputFile*>(png_get_io_ptr(png))->write({reinterpret_cast<const char*>(bytes), size});
}

extern "C" void flush_nothing(png_structp) {}

extern "C" void keep_error(png_structp png, png_const_charp sentence) {
  Message& message = *static_cast<Message*>(png_get_error_ptr(png));
  std::snprintf(message.data(), message.size(), "%s", sentence);
  png_longjmp(png, 1);
}

extern "C" void drop_warning(png_structp, png_const_charp) {}

/// libpng's state while it writes a picture.
struct Encoder {
  explicit Encoder(OutputFile& out)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, keep_error, drop_warning)) {
    if (png == nullptr) return;
    info = png_create_info_struct(png);
    png_set_write_fn(png, &out, write_bytes, flush_nothing);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { png_destroy_write_struct(&png, &info); }

  Message message{};
  png_structp png;
  png_infop info = nullptr;
};

/// libpng only reads keyword and text, but takes pointers to non-const.
std::vector<png_text> as_png(const PngTexts& texts) {
  std::vector<png_text> chunks(texts.size());
  for (std::size_t k = 0; k < texts.size(); ++k) {
    chunks[k].compression = PNG_TEXT_COMPRESSION_NONE;
    chunks[k].key = const_cast<char*>(texts[k].first.c_str());
    chunks[k].text = const_cast<char*>(texts[k].second.c_str());
    chunks[k].text_length = texts[k].second.size();
  }
  return chunks;
}

/// Returns false if libpng fails: it returns here by longjmp, so nothing in this function may need a destructor.
bool encode(Encoder& encoder, const Image& image, const std::vector<png_text>& texts, const OutputFile& out) {
  const png_structp png = encoder.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, encoder.info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, encoder.info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (!texts.empty()) png_set_text(png, encoder.info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, encoder.info);
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.width);
  for (std::size_t at = 0; at < image.rgb.size(); at += row_bytes) {
    if (out.failed()) return true;
    png_write_row(png, image.rgb.data() + at);
  }
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

Status write_png(const Image& image, OutputFile& out, const PngTexts& texts) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != 3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
    return Status(StatusCode::invalid_argument, "a picture's bytes don't fit its size");
  }
  return guarded([&]() -> Status {
    const std::vector<png_text> chunks = as_png(texts);
    Encoder encoder(out);
    if (encoder.png == nullptr || encoder.info == nullptr) {
      return Status(StatusCode::out_of_memory, out.path().string() + ": out of memory");
    }
    if (encode(encoder, image, chunks, out)) return {};
    return Status(StatusCode::internal, out.path().string() + ": libpng: " + encoder.message.data());
  });
}

Status write_png(const Image& image, const std::filesystem::path& path) {
  return guarded([&]() -> Status {
    Result<OutputFile> out = OutputFile::make(path);
    if (!out) return out.status();
    Status status = write_png(image, *out);
    return status.ok() ? out->commit() : status;
  });
}

}  // namespace tessera::render
