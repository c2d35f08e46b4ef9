// Where the program tessera-cad-reader lies.

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "io/cad/cad_reader.h"
#include "io/cad/kept_model.h"
#include "tessera/cad.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;
constexpr const char* program = "tessera-cad-reader";

/// The folders of this program and of this library.
std::vector<fs::path> own_folders() {
  std::vector<fs::path> folders;
  std::error_code error;
  if (const fs::path self = fs::read_symlink("/proc/self/exe", error); !error) folders.push_back(self.parent_path());
  Dl_info facts{};
  // A static library lies in the program, which is named as its caller called it: never a reason to look around here.
  if (::dladdr(reinterpret_cast<const void*>(&cad_reader_greeting), &facts) != 0 && facts.dli_fname) {
    const fs::path library = fs::path(facts.dli_fname).is_absolute() ? fs::canonical(facts.dli_fname, error) : "";
    if (!library.empty()) folders.push_back(library.parent_path());
  }
  return folders;
}

std::vector<fs::path> usual_places() {
  std::vector<fs::path> places;
  for (const fs::path& folder : own_folders()) {
    places.push_back(folder);
    // Libraries lie in lib, or one deeper, in lib/x86_64-linux-gnu.
    for (const char* const libexec : {"../libexec/tessera", "../../libexec/tessera"})
      places.push_back(folder / libexec);
  }
  places.emplace_back(TESSERA_LIBEXEC);
  return places;
}

/// The first executable file of this name in the folders of PATH.
std::string on_path() {
  const char* const path = std::getenv("PATH");
  std::string_view rest = path ? path : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(folder.size() + 1, rest.size()));
    std::error_code error;
    const fs::path file = fs::path(folder.empty() ? "." : folder) / program;
    if (fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0) return file.string();
  }
  return {};
}

}  // namespace

Result<std::string> reader_for(const fs::path& named, std::string_view format) {
  if (!named.empty()) return named.string();
  if (const char* const other = std::getenv("TESSERA_CAD_READER"); other && *other) return std::string(other);
  for (const fs::path& place : usual_places()) {
    std::error_code error;
    if (const fs::path file = place / program; fs::is_regular_file(file, error))
      return file.lexically_normal().string();
  }
  if (std::string file = on_path(); !file.empty()) return file;
  return Status(StatusCode::unsupported,
                std::string(format) + " files are read by the program tessera-cad-reader, which is neither beside " +
                    "this program, nor in its libexec/tessera, nor on PATH: install the package " +
                    "tessera-cad-reader, run tools/cad_reader.sh in Tessera's sources, which installs OpenCASCADE " +
                    "and builds it, or name it by TESSERA_CAD_READER");
}

Result<fs::path> find_cad_reader(const CadOptions& options) {
  return guarded([&]() -> Result<fs::path> {
    const Result<std::string> found = reader_for(options.reader, "CAD");
    if (!found) return found.status();
    return fs::path(*found);
  });
}

}}  // namespace tessera::abi_0_1
