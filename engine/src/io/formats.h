#pragma once
// Which files can be written, known before the work is done whose result they shall hold.

#include <filesystem>

#include "tessera/status.h"

namespace tessera {

/// Whether the extension of `path` names a format that write_mesh writes. Errors: unsupported, with a list of those.
Status check_mesh_format(const std::filesystem::path& path);

}  // namespace tessera
