#include "tess/closing/station_places.h"

#include <algorithm>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The largest number of vertices that are at no station.
std::size_t max_others(const StationVertices& met) {
  std::size_t count = 2 * met.blocks.back().gaps.size();
  for (const StationBlock& block : met.blocks) count += 2 * block.same.size();
  return count;
}

}  // namespace

BoundaryNumbers::BoundaryNumbers(std::span<const Division> divisions, std::span<const CutPatch> cuts,
                                 std::size_t inserted)
    : first_(divisions.size() + 1, 0), zeros_(divisions.size()), inserted_(static_cast<std::uint32_t>(inserted)) {
  for (const CutPatch& cut : cuts) first_[cut.patch] = static_cast<std::uint32_t>(cut.vertices.size());
  std::uint32_t next = 0;
  for (std::size_t patch = 0; patch < zeros_.size(); ++patch) {
    const Division& division = divisions[patch];
    const std::uint32_t of_cut = std::exchange(first_[patch], next);
    zeros_[patch] = next - (division.empty ? 0 : static_cast<std::uint32_t>(division.inner_count()));
    next += division.empty ? of_cut : static_cast<std::uint32_t>(division.ring_count());
  }
  first_.back() = next;
}

StationPlaces::StationPlaces(const PatchSet::Impl& set, const EdgeRuns& runs, const StationVertices& met,
                             const BoundaryNumbers& numbers, std::span<const std::uint8_t> is_open)
    : runs_(runs),
      met_(met),
      numbers_(numbers),
      is_open_(is_open),
      stations_(met.station_count),
      nodes_(numbers.count(), no_id),
      shape_vertices_(set.edges->vertices.size(), no_id),
      sets_(stations_ + max_others(met)),
      is_joined_(stations_ + max_others(met), 0) {
  unite_stations();
  unite_same();
  join_gaps();
  number_places();
}

void StationPlaces::unite_stations() {
  for (const StationBlock& block : met_.blocks)
    for (const StationBlock::Edge& edge : block.all_edges()) {
      if (!is_closed(edge)) continue;
      for (std::uint32_t k = edge.first; k < (&edge + 1)->first; ++k) {
        const Station& station = block.stations[k];
        const std::uint32_t id = block.first_station + k;
        for (std::uint32_t v = station.first; v < (&station + 1)->first; ++v)
          meet(nodes_[numbers_.of(block.vertices[v])], id);
        if (station.vertex == no_id) continue;
        is_joined_[id] = 1;
        meet(shape_vertices_[station.vertex], id);
      }
    }
}

void StationPlaces::meet(std::uint32_t& node, std::uint32_t station) {
  if (node == no_id)
    node = station;
  else
    unite(node, station);
}

void StationPlaces::unite(std::uint32_t a, std::uint32_t b) {
  is_joined_[a] = is_joined_[b] = 1;
  if (a != b) sets_.unite(a, b);
}

std::uint32_t StationPlaces::node_of(const PatchVertex& vertex) {
  std::uint32_t& node = nodes_[numbers_.of(vertex)];
  if (node == no_id) {
    node = stations_ + static_cast<std::uint32_t>(others_.size());
    others_.push_back(vertex);
  }
  return node;
}

void StationPlaces::unite_same() {
  for (const StationBlock& block : met_.blocks)
    for (const auto& [a, b] : block.same)
      if (const std::uint32_t of_a = node_of(a), of_b = node_of(b); of_a != of_b) unite(of_a, of_b);
}

void StationPlaces::join_gaps() {
  if (gaps().empty()) return;
  UnionFind lines(numbers_.count());
  for (const StationBlock& block : met_.blocks)
    for (const auto& [a, b] : block.same) lines.unite(numbers_.of(a), numbers_.of(b));
  std::vector<std::array<std::uint32_t, 2>> ends;  // by gap: the nodes of its vertices
  for (const StationBlock::Gap& gap : gaps()) {
    lines.unite(numbers_.of(gap.low.vertex), numbers_.of(gap.high.vertex));
    ends.push_back({node_of(gap.low.vertex), node_of(gap.high.vertex)});
  }
  const auto line_of = [&](const StationBlock::Gap& gap) { return lines.find(numbers_.of(gap.low.vertex)).member; };
  std::vector<std::uint32_t> places(numbers_.count(), no_id);  // by line: the place of its ends
  std::vector<std::uint8_t> is_apart(numbers_.count(), 0);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const std::uint32_t line = line_of(gaps()[k]);
    for (const std::uint32_t end : ends[k]) {
      if (end >= stations_) continue;
      const std::uint32_t place = sets_.find(end).member;
      is_apart[line] |= places[line] != no_id && places[line] != place;
      places[line] = place;
    }
  }
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const std::uint32_t line = line_of(gaps()[k]);
    for (const std::uint32_t end : ends[k])
      if (places[line] != no_id && !is_apart[line]) unite(end, places[line]);
  }
}

// A place gets its number with the first of its stations along which faces meet.
void StationPlaces::number_places() {
  places_.assign(stations_ + others_.size(), no_id);
  const auto for_stations = [&](bool that_meet, auto visit) {
    for (const StationBlock& block : met_.blocks)
      for (const StationBlock::Edge& edge : block.all_edges())
        if (is_closed(edge) && (!that_meet || runs_.meet(edge.edge)))
          for (std::uint32_t k = edge.first; k < (&edge + 1)->first; ++k) visit(block.first_station + k);
  };
  std::uint32_t next = 0;
  for_stations(true, [&](std::uint32_t station) {
    std::uint32_t& place = places_[is_joined_[station] ? sets_.find(station).member : station];
    if (place == no_id) place = next++;
    places_[station] = place;
  });
  for_stations(false, [&](std::uint32_t station) {
    if (is_joined_[station]) places_[station] = places_[sets_.find(station).member];
  });
  for (std::size_t k = 0; k < others_.size(); ++k)
    places_[stations_ + k] = places_[sets_.find(static_cast<std::uint32_t>(stations_ + k)).member];
  count_ = next;
}

bool StationPlaces::is_point(const StationBlock::Gap& gap) const {
  const auto place = [&](const SegmentEnd& end) { return places_[nodes_[numbers_.of(end.vertex)]]; };
  return place(gap.low) == place(gap.high) && place(gap.low) != no_id;
}

}}  // namespace tessera::abi_0_1
