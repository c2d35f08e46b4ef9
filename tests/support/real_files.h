#pragma once
// The files of folders of models, such as that of real ones.

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera::test {

/// The files below a folder, sorted. Leaves out the folder cad_corpus, whose files the survey reads, each in a process
/// of its own because some of them crash OpenCASCADE, and fault_cases, whose files have tests of their own.
inline std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (auto entry = std::filesystem::recursive_directory_iterator(folder); entry != end(entry); ++entry) {
    const std::filesystem::path name = entry->path().filename();
    if (entry->is_directory() && (name == "cad_corpus" || name == "fault_cases")) entry.disable_recursion_pending();
    if (entry->is_regular_file()) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The STEP files below a folder, sorted, with those of cad_corpus and fault_cases.
inline std::vector<std::filesystem::path> step_files_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::directory_entry& entry : std::filesystem::recursive_directory_iterator(folder)) {
    std::string extension = entry.path().extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const bool is_step = extension == ".stp" || extension == ".step" || extension == ".p21";
    if (entry.is_regular_file() && is_step) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace tessera::test
