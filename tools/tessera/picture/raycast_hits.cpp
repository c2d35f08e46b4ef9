// Hits of the user's rays.

#include <algorithm>

#include "console/output.h"
#include "console/progress.h"
#include "picture/raycast.h"
#include "table/hits.h"

namespace tessera::cli {
namespace {

/// Casts rays. The result is lists of hits: one or none per ray for closest hits, or all.
Result<HitLists> cast(const RaycastScene& scene, const RaycastOptions& options, std::span<const Ray> rays,
                      Timings& timings) {
  const auto phase = timings.phase("evaluate");
  Progress progress("casting rays");
  HitLists lists;
  if (options.all_hits) {
    const Status status = scene.rays.all(rays, lists, progress.execution());
    return status.ok() ? Result<HitLists>(std::move(lists)) : status;
  }
  std::vector<Hit> hits(rays.size());
  if (const Status status = scene.closest(options, rays, hits, progress.execution()); !status.ok()) return status;
  if (!options.writes()) return lists;
  lists.first.reserve(hits.size() + 1), lists.first.push_back(0);
  lists.hits.reserve(static_cast<std::size_t>(std::ranges::count(hits, HitKind::hit, &Hit::kind)));
  for (const Hit& hit : hits) {
    if (hit.kind == HitKind::hit) lists.hits.push_back(hit);
    lists.first.push_back(lists.hits.size());
  }
  return lists;
}

}  // namespace

Status write_ray_hits(const Job& job, const RaycastOptions& options, const CommonOptions& common,
                      const RaycastScene& scene, std::span<const Ray> rays, OutputFile& out, Timings& timings) {
  Result<HitLists> lists = cast(scene, options, rays, timings);
  if (!lists || !options.writes()) return lists.status();
  const HitCounts counts = use_own_parameters(scene.loaded.model, *lists);
  {
    const auto phase = timings.phase("write");
    write_hits(out, scene.loaded.model, *lists);
    if (Status status = out.commit(); !status.ok()) return status;
  }
  const bool exact = options.mode == RayMode::exact;
  Report report = report_of(job, scene.loaded);
  report.add("mode", name_of(options.mode));
  report.add("rays", counts.rays, counted(counts.rays, "ray"));
  report.add("hits", counts.hits, ", " + counted(counts.hits, "hit"));
  report.add("points", counts.points, options.all_hits ? ", " + counted(counts.points, "point") : "");
  report.add("unrefined", counts.unrefined,
             exact ? "" : ", " + std::to_string(counts.unrefined) + " of them on facets only");
  report.add("uncertified", counts.uncertified,
             exact ? ", " + std::to_string(counts.uncertified) + " of them uncertified" : "");
  report.add("incomplete", counts.incomplete);
  report.add("edge", counts.edge);
  add_model_facts(report, scene.loaded, scene.patch_count(), scene.set.fit_error());
  return report.print(job.output, common, timings);
}

}  // namespace tessera::cli
