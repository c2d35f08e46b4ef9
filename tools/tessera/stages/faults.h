#pragma once
// The faces of a file that its mesh lacks: warnings, and errors with --strict.

#include <string>
#include <vector>

#include "stages/mesh.h"

namespace tessera::cli {

/// Warns that the numbers of a file are too coarse for the tolerances, if they are.
void warn_of_rounding(const std::string& output, const Meshed& made);
/// Names the surfaces whose meshes are not what was wanted.
void warn_of_surfaces(const Loaded& loaded, const Meshed& made);

/// With --strict, returns a sentence for each kind of fault: parts of the file that were skipped, loops that could not
/// be used, bounds that are not proven. `warnings`: those of reading.
std::vector<std::string> mesh_faults(const MeshOptions& options, const std::vector<std::string>& warnings,
                                     const Meshed& made);

/// Returns the same with a sentence for the shapes all of whose shells are closed, if their meshes are not. It counts
/// the open edges of the meshes. Errors: those of check() and closed_shells().
Result<std::vector<std::string>> mesh_faults(const MeshOptions& options, const Model& model, const Meshed& made);

/// Prints the faults on standard error. Returns an error that is already said, or ok if there are none.
Status complain_of(const std::string& output, const std::vector<std::string>& faults);

}  // namespace tessera::cli
