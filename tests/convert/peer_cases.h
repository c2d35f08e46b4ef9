#pragma once
// Surfaces and the values that other programs expect of them, read from JSON and from Wavefront free-form files.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "convert/peer_surface.h"

namespace tessera::test {

/// One expected value. Derivatives by name: "du", "duv" ... The peer does not state components that are NaN.
struct PeerEval {
  double u = 0, v = 0;
  std::optional<Vec3> point;
  std::optional<Vec3> normal_up_to_sign;
  std::map<std::string, Vec3> derivatives;
  double point_tolerance = 0;
  double first_tolerance = 0, second_tolerance = 0;  ///< absolute, per component
};

struct PeerCase {
  PeerSurface surface;
  std::vector<PeerEval> evals;
};

struct PeerFile {
  std::string peer;
  std::vector<PeerCase> cases;
  std::vector<PeerSurface> invalid;    ///< surfaces that the peer rejects
  std::size_t rays = 0;                ///< whose hits are among the evaluations, as points of the surface
  std::vector<std::string> elsewhere;  ///< entries without a value of a surface, and why
};

/// Reads a file of peer_cases; `data` is the folder that holds it and the other test data. Throws on unknown content.
PeerFile read_peer_file(const std::filesystem::path& data, const std::filesystem::path& file);

}  // namespace tessera::test
