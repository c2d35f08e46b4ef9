#include "io_occt/load_model.h"

#include <opencascade/Standard_Failure.hxx>
#include <opencascade/Standard_OutOfMemory.hxx>

#include <array>

#include "io_occt/cad_file.h"
#include "io_occt/markless_file.h"
#include "io_occt/shape_model.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct Loader {
  std::string_view format;
  Result<CadFile> (*load)(const std::string& path);
};
constexpr std::array<Loader, 3> loaders{{{"STEP", load_step}, {"IGES", load_iges}, {"BREP", load_brep}}};

/// Replaces the path of a copy at the begin of a message by the file's own path.
Status renamed(const Status& status, const std::string& copy, const std::string& path) {
  if (!status.message().starts_with(copy)) return status;
  return Status(status.code(), path + status.message().substr(copy.size()), status.index());
}

Result<Model> load(const Loader& loader, const std::string& path) {
  try {
    const Result<MarklessFile> plain = MarklessFile::make(path);
    if (!plain) return plain.status();
    const Result<CadFile> file = loader.load(plain->path());
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

}  // namespace

Result<Model> load_model(std::string_view format, const std::string& path) {
  return guarded([&]() -> Result<Model> {
    for (const Loader& loader : loaders)
      if (loader.format == format) return load(loader, path);
    return Status(StatusCode::unsupported, path + ": this reader does not know the format " + std::string(format));
  });
}

}}  // namespace tessera::abi_0_1
