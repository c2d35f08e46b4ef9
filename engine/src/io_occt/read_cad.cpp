#include <opencascade/Standard_Failure.hxx>
#include <opencascade/Standard_OutOfMemory.hxx>

#include <array>
#include <cerrno>
#include <fstream>
#include <string_view>
#include <system_error>

#include "io/file.h"
#include "io_occt/cad_file.h"
#include "io_occt/child_process.h"
#include "io_occt/markless_file.h"
#include "io_occt/model_bytes.h"
#include "io_occt/shape_model.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/io_occt.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {
namespace {

namespace fs = std::filesystem;
using Load = Result<CadFile>(const std::string& path);

struct CadFormat {
  std::string_view extension;
  Load* load;
};
constexpr std::array<CadFormat, 4> formats{
    {{".step", load_step}, {".stp", load_step}, {".iges", load_iges}, {".igs", load_iges}}};

const CadFormat* find_format(const fs::path& path) {
  const std::string extension = lower_extension(path);
  for (const CadFormat& format : formats)
    if (format.extension == extension) return &format;
  return nullptr;
}

/// The size of the file, if it can be read.
Result<std::uintmax_t> readable_size(const fs::path& path) {
  std::error_code error;
  const fs::file_status facts = fs::status(path, error);
  if (fs::is_directory(facts)) return Status(StatusCode::io_error, path.string() + ": is a directory, not a file");
  // Must be a regular file, because it is read twice: a pipe would end, or block whoever opens it.
  if (fs::exists(facts) && !fs::is_regular_file(facts))
    return Status(StatusCode::unsupported, path.string() + ": STEP and IGES are read from regular files only");
  if (!std::ifstream(path, std::ios::binary)) return io_failure(path, "cannot be opened", errno);
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return io_failure(path, "cannot be read", error.value());
  if (size == 0) return Status(StatusCode::parse_error, path.string() + ": the file is empty");
  return size;
}

/// Replaces the path of a copy at the begin of a message by the file's own path.
Status renamed(const Status& status, const std::string& copy, const std::string& path) {
  if (!status.message().starts_with(copy)) return status;
  return Status(status.code(), path + status.message().substr(copy.size()), status.index());
}

Result<Model> load_model(const std::string& path, Load* load) {
  try {
    const Result<MarklessFile> plain = MarklessFile::make(path);
    if (!plain) return plain.status();
    const Result<CadFile> file = load(plain->path());
    return file ? model_of(*file, path) : Result<Model>(renamed(file.status(), plain->path(), path));
  } catch (const Standard_OutOfMemory&) {
    return Status(StatusCode::out_of_memory, path + ": OpenCASCADE exceeded its memory limit");
  } catch (const std::bad_alloc&) {
    return Status(StatusCode::out_of_memory, path + ": OpenCASCADE exceeded its memory limit");
  } catch (const Standard_Failure& failure) {
    return Status(StatusCode::parse_error,
                  path + ": OpenCASCADE: " + failure.DynamicType()->Name() + ": " + failure.GetMessageString());
  }
}

Result<Model> read(const fs::path& path, Load* load) {
  return guarded([&]() -> Result<Model> {
    const Result<std::uintmax_t> size = readable_size(path);
    if (!size) return size.status();
    const std::string file = path.string();
    const ChildLimits limits{(std::size_t{512} << 20) + 256 * *size, static_cast<unsigned>(120 + *size / 20000)};
    const auto work = [&] { return to_bytes(guarded([&] { return load_model(file, load); })); };
    const Result<std::string> bytes = run_in_child(work, limits, "OpenCASCADE");
    if (!bytes) return Status(bytes.status().code(), file + ": " + bytes.status().message());
    Result<Model> model = model_from_bytes(*bytes);
    if (model) model->name = path.stem().string();
    return model;
  });
}

}  // namespace

Result<Model> read_step(const fs::path& path) { return read(path, load_step); }

Result<Model> read_iges(const fs::path& path) { return read(path, load_iges); }

bool is_cad_file(const fs::path& path) { return find_format(path) != nullptr; }

Result<Model> read_cad(const fs::path& path) {
  const CadFormat* const format = find_format(path);
  if (format) return read(path, format->load);
  return guarded([&]() -> Result<Model> {
    return Status(StatusCode::unsupported, path.string() + ": unsupported format \"" + lower_extension(path) +
                                               "\": CAD files are read as .step, .stp, .iges, .igs");
  });
}

}  // namespace tessera::inline abi_0_1
