#pragma once
// Counts how many surfaces a file states, in its text and by simpler means than a reader's. A reader must find as many.

#include <cstddef>
#include <filesystem>
#include <string>

namespace tessera::test {

/// Surfaces of a text format (.bpt, .bv, .g2, .obj, .rib): numbers of patches, lines and words that begin one.
std::size_t surfaces_stated(const std::filesystem::path& path);
/// Faces of a STEP file; each counts as often as assemblies use its product.
std::size_t step_faces(const std::string& text);
/// Trimmed surfaces of an IGES file, and others of which nothing else is made, by the directory's columns.
std::size_t iges_surfaces(const std::string& text);

/// Faces of a BREP text file in which each is used once.
std::size_t brep_faces(const std::string& text);

}  // namespace tessera::test
