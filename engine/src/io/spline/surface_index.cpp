#include "io/spline/surface_index.h"

#include <algorithm>
#include <utility>

#include "io/file/gzip.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {

Result<SurfaceIndex::Format> SurfaceIndex::format_of(const FileWindows& file) {
  const std::filesystem::path& path = file.path();
  const std::string extension = lower_extension(path);
  std::string begin;
  if (const Status status = file.read(0, 2, begin); !status.ok()) return status;
  if (is_gzip(path, begin) || begin == "\x1f\x8b")
    return Status(StatusCode::unsupported,
                  path.string() + ": a file packed by gzip cannot be read in runs: unpack it first");
  if (extension == ".bpt") return Format::bpt;
  if (extension == ".g2") return Format::g2;
  return Status(StatusCode::unsupported,
                path.string() + ": unsupported format \"" + extension + "\": surfaces are read in runs from .bpt, .g2");
}

Result<SurfaceIndex> SurfaceIndex::make(const std::filesystem::path& path, const IndexOptions& options) {
  Result<FileWindows> file = FileWindows::open(path);
  if (!file) return file.status();
  const Result<Format> format = format_of(*file);
  if (!format) return format.status();
  SurfaceIndex index(*std::move(file), *format, options);
  const std::unique_ptr<ItemReader> reader = index.reader();
  ItemWalk walk(*reader, index.name_, {.keep = false});
  const Status status = index.go(walk, {}, [&](ReadItem& item) {
    if (item.is_surface() && walk.offset() - index.places_.back().offset >= options.step)
      index.places_.push_back(walk.place());
  });
  if (!status.ok()) return status;
  index.surfaces_ = walk.surface_count();
  return index;
}

Result<Model> SurfaceIndex::read(std::size_t first, std::size_t end) const {
  Model model;
  model.name = file_.path().stem().string();
  if (first == end) return model;
  const auto after = std::upper_bound(places_.begin(), places_.end(), first,
                                      [](std::size_t surface, const FilePlace& at) { return surface < at.surface; });
  const std::unique_ptr<ItemReader> items = reader();
  ItemWalk walk(*items, name_, {.first = first, .end = end == surfaces_ ? ItemRun::to_the_end : end});
  model.surfaces.reserve(end - first);
  const Status status = go(walk, *std::prev(after), [&](ReadItem& item) {
    if (item.surface) model.surfaces.push_back(*std::move(item.surface));
  });
  if (!status.ok()) return status;
  model.warnings = walk.warnings();
  return model;
}

std::unique_ptr<ItemReader> SurfaceIndex::reader() const {
  return format_ == Format::bpt ? make_bpt_reader(surfaces_) : make_g2_reader();
}

Status SurfaceIndex::go(ItemWalk& walk, const FilePlace& from, ItemWalk::Take take) const {
  std::string text;
  const auto load = [&](std::uint64_t offset, std::size_t bytes, std::string_view cuts) -> Result<TextWindow> {
    if (const Status status = file_.read(offset, bytes, text); !status.ok()) return status;
    const std::uint64_t beyond = file_.size() - offset - text.size();
    if (beyond == 0) return TextWindow{text, 0};
    const std::size_t kept = text.find_last_of(cuts) + 1;  // 0 if there is none
    return TextWindow{std::string_view(text).substr(0, kept), beyond + text.size() - kept};
  };
  return walk.go(from, options_.window, load, take);
}

}}  // namespace tessera::abi_0_1
