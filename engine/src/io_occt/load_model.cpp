#include "io_occt/load_model.h"

#include <opencascade/Standard_Failure.hxx>
#include <opencascade/Standard_OutOfMemory.hxx>

#include <array>
#include <fstream>
#include <utility>

#include "io/file/memory_file.h"
#include "io_occt/cad_file.h"
#include "occt/guarded_calls.h"
#include "occt/shape_model.h"
#include "parallel/caller_arena.h"
#include "tessera/guard.h"
#include "tessera/io.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A file without the byte order mark that an editor may have put before it. OpenCASCADE would take the mark for text,
/// and in IGES it moves the columns of the first line. path() can be opened during the object's lifetime.
class MarklessFile {
 public:
  /// Uses the file itself, or a copy in memory if it has the mark. Errors: io_error.
  static Result<MarklessFile> make(const std::string& path);
  const std::string& path() const { return path_; }

 private:
  MarklessFile() = default;
  std::string path_;
  MemoryFile copy_;
};

constexpr std::string_view mark = "\xEF\xBB\xBF";

bool has_mark(const std::string& path) {
  std::array<char, mark.size()> begin{};
  std::ifstream file(path, std::ios::binary);
  return file.read(begin.data(), begin.size()) && std::string_view(begin.data(), begin.size()) == mark;
}

Result<MarklessFile> MarklessFile::make(const std::string& path) {
  MarklessFile result;
  result.path_ = path;
  if (!has_mark(path)) return result;
  const Result<std::string> bytes = read_file(path);
  if (!bytes) return bytes.status();
  Result<MemoryFile> copy = MemoryFile::make(std::string_view(*bytes).substr(mark.size()), path);
  if (!copy) return copy.status();
  result.copy_ = *std::move(copy);
  result.path_ = result.copy_.path();
  return result;
}

struct Loader {
  std::string_view format;
  Result<DescribedShape> (*load)(const std::string& path);
};
constexpr std::array<Loader, 3> loaders{{{"STEP", load_step}, {"IGES", load_iges}, {"BREP", load_brep}}};

/// Replaces the path of a copy at the begin of a message by the file's own path.
Status renamed(const Status& status, const std::string& copy, const std::string& path) {
  if (!status.message().starts_with(copy)) return status;
  return Status(status.code(), path + status.message().substr(copy.size()), status.index());
}

Status out_of_memory(const std::string& path) {
  return Status(StatusCode::out_of_memory, path + ": OpenCASCADE exceeded its memory limit");
}

/// The model, made by this thread alone: the limit of the program's memory holds for any number of cores.
Result<Model> model_of_file(const DescribedShape& file, const std::string& path) {
  Result<OcctModel> made = Status(StatusCode::internal, {});
  in_own_arena(1, [&] { made = guarded_occt([&] { return model_of(file, path); }); });
  if (made) return std::move(made->model);
  if (made.status().code() == StatusCode::out_of_memory) return out_of_memory(path);
  return made.status();
}

Result<Model> load(const Loader& loader, const std::string& path) {
  try {
    const Result<MarklessFile> plain = MarklessFile::make(path);
    if (!plain) return plain.status();
    const Result<DescribedShape> file = loader.load(plain->path());
    return file ? model_of_file(*file, path) : Result<Model>(renamed(file.status(), plain->path(), path));
  } catch (const Standard_OutOfMemory&) {
    return out_of_memory(path);
  } catch (const std::bad_alloc&) {
    return out_of_memory(path);
  } catch (const Standard_Failure& failure) {
    return Status(StatusCode::parse_error,
                  path + ": OpenCASCADE: " + failure.DynamicType()->Name() + ": " + failure.GetMessageString());
  }
}

}  // namespace

Result<Model> load_model(std::string_view format, const std::string& path) {
  return guarded([&]() -> Result<Model> {
    for (const Loader& loader : loaders)
      if (loader.format == format) return load(loader, path);
    return Status(StatusCode::unsupported, path + ": this reader does not know the format " + std::string(format));
  });
}

}}  // namespace tessera::abi_0_1
