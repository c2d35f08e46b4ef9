#pragma once
// `tessellate --strict`: what a mesh lacks of the file's faces.

#include <string>
#include <vector>

#include "stages/load.h"
#include "stages/mesh.h"
#include "tessera/status.h"

namespace tessera::cli {

/// Returns a sentence for each kind of fault: parts of the file that were skipped, loops that could not be used, solids
/// whose mesh has open edges, and bounds that are not proven. `warnings`: those of reading.
std::vector<std::string> mesh_faults(const std::vector<std::string>& warnings, const Meshed& made);

/// Returns the same with a sentence for the shapes all of whose shells are closed, if their meshes are not. It counts the
/// open edges of the meshes. Errors: those of check() and closed_shells().
Result<std::vector<std::string>> mesh_faults(const Model& model, const Meshed& made);

/// Prints the faults on standard error. Returns an error that is already said, or ok if there are none.
Status complain_of(const std::string& output, const std::vector<std::string>& faults);

}  // namespace tessera::cli
