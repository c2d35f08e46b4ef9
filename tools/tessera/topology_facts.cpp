#include "topology_facts.h"

#include <vector>

#include "console.h"
#include "tessera/topology.h"

namespace tessera::cli {
namespace {

/// Adds the counts of one shape for each of its `instances`.
Status add_shape(const Shape& shape, std::size_t instances, TopologyFacts& facts) {
  const Result<EdgeUses> uses = edge_uses(shape);
  if (!uses) return uses.status();
  const Result<std::vector<bool>> closed = closed_shells(shape);
  if (!closed) return closed.status();
  facts.solids += instances * shape.solid_count;
  facts.vertices += instances * shape.vertices.size();
  for (const bool is_closed : *closed) (is_closed ? facts.closed_shells : facts.open_shells) += instances;
  for (std::size_t k = 0; k < shape.edges.size(); ++k) {
    if (shape.edges[k].degenerate) {
      facts.points += instances;
      continue;
    }
    facts.edges += instances;
    const std::size_t count = (*uses)[k].size();
    if (count > 0) (count == 1 ? facts.one : count == 2 ? facts.two : facts.more) += instances;
  }
  return {};
}

Status add_gaps(const Model& model, std::size_t k, TopologyFacts& facts) {
  const Result<std::vector<double>> gaps = edge_gaps(model.shapes[k], gap_samples);
  if (!gaps) return gaps.status();
  for (std::size_t edge = 0; edge < gaps->size(); ++edge) {
    if (!((*gaps)[edge] > facts.gap)) continue;
    facts.gap = (*gaps)[edge];
    facts.gap_shape = k;
    facts.gap_edge = edge;
  }
  return {};
}

std::string name_of(const Model& model, std::size_t shape) {
  const std::string& name = *model.shapes[shape].name;
  return "shape " + std::to_string(shape) + (name.empty() ? "" : " (" + name + ")");
}

}  // namespace

Result<TopologyFacts> count_topology(const Model& model) {
  TopologyFacts facts;
  facts.shapes = model.shapes.size();
  facts.instances = model.instances.size();
  std::vector<std::size_t> instances(model.shapes.size(), 0);
  for (const Instance& instance : model.instances) ++instances[instance.shape];
  for (std::size_t k = 0; k < model.shapes.size(); ++k) {
    if (Status status = add_shape(model.shapes[k], instances[k], facts); !status.ok()) return status;
    if (Status status = add_gaps(model, k, facts); !status.ok()) return status;
  }
  return facts;
}

std::string topology_lines(const Model& model, const TopologyFacts& facts) {
  if (facts.shapes == 0) return {};
  const std::string gap = facts.gap > 0 ? readable(facts.gap, 3) + ", at " + name_of(model, facts.gap_shape) +
                                              ", edge " + std::to_string(facts.gap_edge)
                                        : "0";
  return "\n  shapes           " + counted(facts.shapes, "shape") + " at " + counted(facts.instances, "place") +
         "\n  solids           " + counted(facts.solids, "solid") + "; shells: " + std::to_string(facts.closed_shells) +
         " closed, " + std::to_string(facts.open_shells) + " open" + "\n  edges            " +
         counted(facts.edges, "edge") + ": " + std::to_string(facts.two) + " of two faces, " +
         std::to_string(facts.one) + " of one, " + std::to_string(facts.more) + " of more" + "\n  largest gap      " +
         gap + "; sampled, " + std::to_string(gap_samples) + " points of each edge";
}

Json topology_json(const Model& model, const TopologyFacts& facts) {
  return {{"shapes", facts.shapes},
          {"instances", facts.instances},
          {"solids", facts.solids},
          {"closed_shells", facts.closed_shells},
          {"open_shells", facts.open_shells},
          {"vertices", facts.vertices},
          {"edges", facts.edges},
          {"edges_of_one_face", facts.one},
          {"edges_of_two_faces", facts.two},
          {"edges_of_more_faces", facts.more},
          {"degenerate_edges", facts.points},
          {"largest_gap", facts.gap},
          {"largest_gap_shape", facts.gap > 0 ? Json(*model.shapes[facts.gap_shape].name) : Json()},
          {"gap_samples", gap_samples}};
}

std::string unit_line(const Model& model) {
  if (model.unit.empty()) return {};
  const bool other = !model.file_unit.empty() && model.file_unit != model.unit;
  return "\n  unit             " + model.unit + (other ? " (in the file: " + model.file_unit + ")" : "");
}

}  // namespace tessera::cli
