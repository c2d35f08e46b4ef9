#include "facts/trims.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "tessera/trim_region.h"

namespace tessera::cli {
namespace {

std::string_view name_of(LoopFault fault) {
  constexpr std::array<std::string_view, 5> names{"empty", "gap", "retraced", "outside", "open"};
  return names[static_cast<std::size_t>(fault)];
}

Result<TrimRegion> region_of(const ModelSurface& surface, const PatchGrid& grid) {
  const Result<Shared<std::vector<TrimLoop>>> loops = grid_trims(surface);
  if (!loops) return loops.status();
  return TrimRegion::make(**loops, grid);
}

void add_surface(std::size_t k, const ModelSurface& surface, const PatchGrid& grid, TrimFacts& facts) {
  ++facts.trimmed;
  facts.loops += surface.trims->size();
  const Result<TrimRegion> region = region_of(surface, grid);
  if (!region) {
    const Status& status = region.status();
    SurfaceRemark remark;
    remark.surface = k;
    remark.text = "its loops cannot be used: " + status.message();
    if (status.index() != Status::no_index) remark.loop = static_cast<std::size_t>(status.index());
    facts.remarks.push_back(std::move(remark));
    return;
  }
  for (const LoopRemark& of : region->remarks()) facts.remarks.push_back({k, of.loop, of.fault, of.size, of.text});
}

}  // namespace

TrimFacts find_trims(const Loaded& loaded) {
  TrimFacts facts;
  for (std::size_t k = 0; k < loaded.model.surfaces.size(); ++k)
    if (!loaded.model.surfaces[k].trims->empty()) add_surface(k, loaded.model.surfaces[k], loaded.grids[k], facts);
  return facts;
}

void add_trims(Report& report, const TrimFacts& facts, const Model& model) {
  constexpr std::size_t limit = 20;  // lines; --json prints all
  const std::size_t count = facts.remarks.size();
  report.add("trimmed_surfaces", facts.trimmed);
  report.add("loops", facts.loops);
  Json list = Json::array();
  for (const SurfaceRemark& remark : facts.remarks)
    list.push_back({{"surface", remark.surface},
                    {"loop", remark.loop ? Json(*remark.loop) : Json()},
                    {"fault", remark.fault ? std::string(name_of(*remark.fault)) : "unusable"},
                    {"size", remark.size},
                    {"text", remark.text}});
  report.add("loop_remarks", list);
  if (facts.trimmed == 0) return;
  report.say("\n  trims            " + std::to_string(facts.trimmed) + " of " + counted(model.surfaces.size(), "face") +
             ", " + counted(facts.loops, "loop") + (count > 0 ? ", " + counted(count, "remark") + ":" : ""));
  for (std::size_t k = 0; k < std::min(limit, count); ++k) {
    const SurfaceRemark& remark = facts.remarks[k];
    const std::string& name = *model.surfaces[remark.surface].name;
    report.say("\n    surface " + std::to_string(remark.surface) + (name.empty() ? "" : " (" + name + ")") + ": " +
               remark.text);
  }
  if (count > limit) report.say("\n    and " + std::to_string(count - limit) + " more");
}

}  // namespace tessera::cli
