#pragma once
// Reads the one free-form surface of a Wavefront file: enough of the format for the peers' cases, and no more.

#include <filesystem>

#include "convert/peer_surface.h"

namespace tessera::test {

/// Throws on a file that it does not understand.
PeerSurface read_obj_surface(const std::filesystem::path& path);

}  // namespace tessera::test
