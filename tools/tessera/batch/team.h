#pragma once
// Processes that work on one job together, as the ranks of tessera_mpi do.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/render.h"
#include "tessera/execution.h"
#include "tessera/part_hits.h"
#include "tessera/ray_scene.h"
#include "tessera/status.h"

namespace tessera::cli {

/// One process of a team. All make the same calls in the same order. An error of a call is that of all, and a job that
/// has failed makes no call but end_job().
class Team {
 public:
  virtual ~Team() = default;

  /// Whether this process writes results and reports.
  virtual bool leads() const = 0;
  /// Draws a picture with the others, who have the same scene. Only the leader's is complete.
  virtual Result<render::Image> draw(const RayScene& scene, const Box3& box, const render::Settings& settings,
                                     const Execution& execution) = 0;
  /// Finds the closest hits of rays with the others, who have the same scene; or, with `first_patch`, scenes of runs of
  /// the patches, of which this one's begins there. Only the leader's hits are complete.
  virtual Status closest(const RayScene& scene, std::optional<std::uint64_t> first_patch, std::span<const Ray> rays,
                         std::span<Hit> hits, const Execution& execution) = 0;
  /// The run of the patches that this process has if each has one.
  virtual PartRun run_of(std::size_t patches) const = 0;
  /// The box of all boxes.
  virtual Result<Box3> common_box(const Box3& own) = 0;
  /// Gives the leader the texts of all, unless a process has an error.
  virtual Result<std::vector<std::string>> gather(const Status& own, std::string text) = 0;
  /// Ends a job with its status in this process; returns that of the team.
  virtual Status end_job(const Status& own) = 0;
};

}  // namespace tessera::cli
