#pragma once
// Finds the models of a report: files, or all files below a folder.

#include <filesystem>
#include <set>
#include <span>

#include "tessera/cad.h"
#include "tessera/io.h"

namespace tessera::bench {

/// Whether it is a CAD file, and these are read.
inline bool is_cad(const std::filesystem::path& path) {
#ifdef TESSERA_HAS_CAD_READER
  return is_cad_file(path);
#else
  (void)path;
  return false;
#endif
}

/// Whether the ending of the name is that of a model.
inline bool is_model(const std::filesystem::path& path) {
  static const std::set<std::string> known{".bpt", ".bv", ".g2", ".json", ".obj", ".rib"};
  return known.contains(path.extension().string()) || is_cad(path);
}

/// The files in the order of their names; the project's own models if none is named.
inline std::set<std::filesystem::path> model_files(std::span<const char* const> named) {
  std::set<std::filesystem::path> files;
  const auto add = [&](const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) files.insert(path);
    if (std::filesystem::is_directory(path))
      for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
        if (is_model(entry.path())) files.insert(entry.path());
  };
  for (const char* path : named) add(path);
  if (named.empty()) add(std::filesystem::path(TESSERA_SOURCE_DIR) / "tools" / "models");
  return files;
}

/// Folder and file.
inline std::string short_name(const std::filesystem::path& path) {
  return path.parent_path().filename().string() + "/" + path.filename().string();
}

}  // namespace tessera::bench
