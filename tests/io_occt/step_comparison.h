#pragma once
// Compares the models that both readers of STEP make of a file.

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera::test {

/// How two models of one file differ.
struct StepComparison {
  std::set<std::string> kinds;        ///< as step_differences.h names them; empty: the models are the same
  std::vector<std::string> findings;  ///< one sentence for each difference
  std::size_t shapes = 0, faces = 0, edges = 0, solids = 0, instances = 0;  ///< of Tessera's model
  double area = 0, volume = 0;   ///< the largest difference that gaps explain, as shares
  double gap = 0, peer_gap = 0;  ///< the largest of edge_gaps(), of either model

  void add(const std::string& kind, const std::string& finding);
};

/// Compares two models of a file.
///
/// - Equal: the numbers of shapes, faces, edges that are neither points nor seams, solids, instances; names; colours.
/// - Areas of faces, in the order of each shape or else as near as any, and volumes of solids: within the errors of the
///   measures, and within the area that lies between both models' curves of a face's edges.
/// - Places: the centroids of all faces of all instances.
/// - Loops leave the rectangles of Tessera's faces by no more than they leave their edges, and 1e-7 of the size.
/// - Shells are closed where OpenCASCADE's are, and so are meshes at 1e-3 of the size. Gaps are not larger than 1.5
///   times OpenCASCADE's plus 1e-6 of the size.
StepComparison compare_models(const Result<Model>& ours, const Result<Model>& theirs);

}  // namespace tessera::test
