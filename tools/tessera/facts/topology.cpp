#include "facts/topology.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "stages/pack.h"
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

/// The shapes of a model; its surfaces as one if it has none.
std::vector<Shape> shapes_of(const Model& model) {
  if (!model.shapes.empty()) return model.shapes;
  std::vector<Shape> one(1);
  for (const ModelSurface& surface : model.surfaces) one[0].faces.push_back({surface});
  return one;
}

std::string name_of(const Model& model, std::size_t shape) {
  const std::string& name = *model.shapes[shape].name;
  return "shape " + std::to_string(shape) + (name.empty() ? "" : " (" + name + ")");
}

std::string shells_text(const TopologyFacts& facts) {
  return "shells: " + std::to_string(facts.closed_shells) + " closed, " + std::to_string(facts.open_shells) + " open";
}

std::string edges_text(const TopologyFacts& facts) {
  return counted(facts.edges, "edge") + ": " + std::to_string(facts.two) + " of two faces, " +
         std::to_string(facts.one) + " of one, " + std::to_string(facts.more) + " of more";
}

void add_counts(Json& object, const TopologyFacts& facts) {
  object["closed_shells"] = facts.closed_shells;
  object["open_shells"] = facts.open_shells;
  object["vertices"] = facts.vertices;
  object["edges"] = facts.edges;
  object["edges_of_one_face"] = facts.one;
  object["edges_of_two_faces"] = facts.two;
  object["edges_of_more_faces"] = facts.more;
  object["degenerate_edges"] = facts.points;
  object["largest_gap"] = facts.gap;
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

Result<std::optional<JoinedFacts>> count_joined(const Model& model) {
  if (model.surfaces.size() > max_joined_faces) return std::optional<JoinedFacts>();
  Model joined;
  joined.shapes = shapes_of(model);
  joined.instances = model.instances;
  if (model.shapes.empty()) joined.instances.resize(1);
  double largest = 0;
  bool any = false;
  for (Shape& shape : joined.shapes) {
    Result<std::optional<JoinedShape>> made = joined_if_free(shape);
    if (!made) return made.status();
    if (!*made) continue;
    shape = std::move((*made)->shape);
    largest = std::max(largest, (*made)->distance);
    any = true;
  }
  if (!any) return std::optional<JoinedFacts>();
  const Result<TopologyFacts> topology = count_topology(joined);
  if (!topology) return topology.status();
  return std::optional<JoinedFacts>({*topology, largest});
}

void add_topology(Report& report, const Model& model, const TopologyFacts& facts) {
  Json object{{"shapes", facts.shapes}, {"instances", facts.instances}, {"solids", facts.solids}};
  add_counts(object, facts);
  object["largest_gap_shape"] = facts.gap > 0 ? Json(*model.shapes[facts.gap_shape].name) : Json();
  object["gap_samples"] = gap_samples;
  report.add("topology", object);
  if (facts.shapes == 0) return;
  const std::string gap = facts.gap > 0 ? readable(facts.gap, 3) + ", at " + name_of(model, facts.gap_shape) +
                                              ", edge " + std::to_string(facts.gap_edge)
                                        : "0";
  report.say("\n  shapes           " + counted(facts.shapes, "shape") + " at " + counted(facts.instances, "place") +
             "\n  solids           " + counted(facts.solids, "solid") + "; " + shells_text(facts) +
             "\n  edges            " + edges_text(facts) + "\n  largest gap      " + gap + "; sampled, " +
             std::to_string(gap_samples) + " points of each edge");
}

void add_joined(Report& report, const std::optional<JoinedFacts>& facts) {
  if (!facts) return report.add("joined_topology", {});
  const TopologyFacts& joined = facts->topology;
  Json object{{"distance", facts->distance}};
  add_counts(object, joined);
  report.add("joined_topology", object,
             "\n  if joined        " + edges_text(joined) + "; " + shells_text(joined) + "; within " +
                 readable(facts->distance, 3) + ", largest gap " + readable(joined.gap, 3));
}

}  // namespace tessera::cli
