// Writes OpenEXR by the reference implementation (openexr.com, "Technical Introduction to OpenEXR").

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <cstring>
#include <string>

#include "io/file/output_file.h"
#include "render/hit_image.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera::render {
namespace {

/// The file in memory: OpenEXR returns to its begin to write where the rows are.
class Bytes : public Imf::OStream {
 public:
  explicit Bytes(const std::string& name) : Imf::OStream(name.c_str()) {}

  void write(const char bytes[], int count) override {
    const std::size_t size = static_cast<std::size_t>(count);
    if (place_ + size > bytes_.size()) bytes_.resize(place_ + size);
    std::memcpy(bytes_.data() + place_, bytes, size);
    place_ += size;
  }
  std::uint64_t tellp() override { return place_; }
  void seekp(std::uint64_t place) override { place_ = place; }

  std::string_view content() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t place_ = 0;
};

/// The channels of a picture.
class Channels {
 public:
  explicit Channels(const HitImage& image)
      : width_(static_cast<std::size_t>(image.width)), header_(image.width, image.height) {
    header_.compression() = Imf::ZIP_COMPRESSION;
    add("Z", Imf::FLOAT, image.depths.data(), sizeof(float));
    constexpr const char* normal_names[] = {"N.X", "N.Y", "N.Z"};
    for (std::size_t c = 0; c < 3; ++c)
      add(normal_names[c], Imf::FLOAT, image.normals.data()->data() + c, 3 * sizeof(float));
    add("UV.U", Imf::FLOAT, image.parameters.data()->data(), 2 * sizeof(float));
    add("UV.V", Imf::FLOAT, image.parameters.data()->data() + 1, 2 * sizeof(float));
    add("surface", Imf::UINT, image.surfaces.data(), sizeof(std::uint32_t));
    add("patch", Imf::UINT, image.patches.data(), sizeof(std::uint32_t));
  }

  const Imf::Header& header() const { return header_; }
  const Imf::FrameBuffer& buffer() const { return buffer_; }

 private:
  /// OpenEXR only reads the memory, but takes pointers to non-const.
  template <class T>
  void add(const char* name, Imf::PixelType type, const T* first, std::size_t stride) {
    header_.channels().insert(name, Imf::Channel(type));
    char* const base = const_cast<char*>(reinterpret_cast<const char*>(first));
    buffer_.insert(name, Imf::Slice(type, base, stride, stride * width_));
  }

  std::size_t width_;
  Imf::Header header_;
  Imf::FrameBuffer buffer_;
};

}  // namespace

Status write_exr(const HitImage& image, OutputFile& out) {
  const auto fits = [&](std::size_t size) {
    return image.width > 0 && image.height > 0 &&
           size == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  };
  if (!fits(image.depths.size()) || !fits(image.normals.size()) || !fits(image.parameters.size()) ||
      !fits(image.surfaces.size()) || !fits(image.patches.size()))
    return Status(StatusCode::invalid_argument, "a picture's values don't fit its size");
  return guarded([&]() -> Status {
    Bytes bytes(out.path().string());
    const Channels channels(image);
    {
      Imf::OutputFile file(bytes, channels.header());
      file.setFrameBuffer(channels.buffer());
      file.writePixels(image.height);
    }
    out.write(bytes.content());
    return {};
  });
}

}  // namespace tessera::render
