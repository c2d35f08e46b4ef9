// tessera info: reports what models hold.

#include <memory>
#include <sstream>

#include "batch/batch.h"
#include "commands/commands.h"
#include "console/memory.h"
#include "facts/counts.h"
#include "facts/joins.h"
#include "facts/topology.h"
#include "facts/trims.h"
#include "line/arguments.h"
#include "stages/load.h"
#include "tessera/execution.h"

namespace tessera::cli {
namespace {

struct InfoOptions {
  ModelOptions models;
  std::size_t max_joins = 20000;
};

/// All that is known of one file.
struct Findings {
  const std::string& file;
  const Loaded& loaded;
  const PatchSet& set;
  Facts facts;
  TrimFacts trims;
  TopologyFacts topology;
  std::optional<JoinedFacts> joined;  ///< empty if no edges are to be joined
  std::optional<Joins> joins;         ///< empty if they are left out
  Isa isa;
};

Json range_json(const Range& range) { return Json::array({range.least, range.largest}); }

/// Null if none is stated.
Json unit_json(const std::string& unit) { return unit.empty() ? Json() : Json(unit); }

Json memory_json(const Facts& facts) {
  return {{"model", facts.model_bytes}, {"patches", facts.patch_bytes}, {"blocks", facts.block_bytes}};
}

Json as_json(const Findings& found) {
  const Facts& facts = found.facts;
  Json kinds = Json::object(), degrees = Json::array(), isas = Json::array();
  for (const auto& [kind, count] : facts.kinds) kinds[std::string(kind)] = count;
  for (const auto& [degree, count] : facts.degrees) {
    degrees.push_back({{"degree_u", degree.first}, {"degree_v", degree.second}, {"patches", count}});
  }
  for (const Isa isa : available_isas()) isas.push_back(std::string(name(isa)));
  const auto bytes = file_bytes(found.file);
  return {{"model", found.file},
          {"file_bytes", bytes ? Json(*bytes) : Json()},
          {"name", found.loaded.model.name},
          {"surfaces", found.loaded.model.surfaces.size()},
          {"kinds", kinds},
          {"trimmed_surfaces", found.trims.trimmed},
          {"loops", found.trims.loops},
          {"loop_remarks", remarks_json(found.trims)},
          {"topology", topology_json(found.loaded.model, found.topology)},
          {"joined_topology", joined_json(found.joined)},
          {"unit", unit_json(found.loaded.model.unit)},
          {"file_unit", unit_json(found.loaded.model.file_unit)},
          {"parameters",
           {{"u", range_json(facts.u)}, {"v", range_json(facts.v)}, {"surfaces_on_unit_square", facts.on_unit_square}}},
          {"patches", found.set.patch_count()},
          {"degrees", degrees},
          {"rational_patches", facts.rational},
          {"collapsed_edges", facts.collapsed_edges},
          {"patches_with_collapsed_edges", facts.patches_with_collapsed_edges},
          {"joins", found.joins ? joins_json(*found.joins) : Json()},
          {"control_points", facts.control_points},
          {"fit_error", fit_json(found.set)},
          {"box", {{"lower", to_json(found.set.box().lower)}, {"upper", to_json(found.set.box().upper)}}},
          {"size", found.set.box().diagonal()},
          {"memory_bytes", memory_json(facts)},
          {"warnings", warnings_json(found.loaded.model)},
          {"isa", {{"available", isas}, {"used", std::string(name(found.isa))}}}};
}

std::string list_of_kinds(const Facts& facts) {
  std::string text;
  for (const auto& [kind, count] : facts.kinds)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(kind);
  return text;
}

std::string list_of_degrees(const Facts& facts) {
  std::string text;
  for (const auto& [degree, count] : facts.degrees)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " of " + std::to_string(degree.first) + " x " +
            std::to_string(degree.second);
  return text;
}

std::string parameters_text(const Facts& facts, std::size_t surfaces) {
  const auto range = [](const Range& of) { return "[" + readable(of.least) + ", " + readable(of.largest) + "]"; };
  return range(facts.u) + " x " + range(facts.v) +
         (facts.on_unit_square == surfaces ? ""
                                           : " in all; " + std::to_string(facts.on_unit_square) + " of " +
                                                 std::to_string(surfaces) + " on [0, 1]^2");
}

std::string as_text(const Findings& found) {
  const Facts& facts = found.facts;
  const auto point = [](const Vec3& v) {
    return "(" + readable(v.x) + ", " + readable(v.y) + ", " + readable(v.z) + ")";
  };
  const std::size_t surfaces = found.loaded.model.surfaces.size();
  const auto bytes = file_bytes(found.file);
  std::ostringstream text;
  text << found.file << ": " << counted(surfaces, "surface") << ", "
       << counted(found.set.patch_count(), "Bezier patch", "Bezier patches")
       << (bytes ? ", read from " + readable_bytes(*bytes) : "") << "\n  kinds            " << list_of_kinds(facts)
       << "\n  degrees          " << list_of_degrees(facts) << "\n  rational         " << facts.rational
       << " of the patches"
       << "\n  parameters       " << parameters_text(facts, surfaces) << trims_lines(found.trims, found.loaded)
       << topology_lines(found.loaded.model, found.topology) << joined_line(found.joined)
       << unit_line(found.loaded.model) << "\n  collapsed edges  " << facts.collapsed_edges << " on "
       << facts.patches_with_collapsed_edges << " patches\n"
       << (found.joins ? joins_text(*found.joins) : "  joins            left out, as --joins 0 says\n")
       << "  control points   " << facts.control_points << ", of the patches"
       << "\n  bounding box     " << point(found.set.box().lower) << " to " << point(found.set.box().upper)
       << ", of the control points"
       << "\n  memory           model " << readable_bytes(facts.model_bytes) << ", patches "
       << readable_bytes(facts.patch_bytes) << ", blocks " << readable_bytes(facts.block_bytes)
       << "\n  instruction set  " << name(found.isa) << ", of";
  for (const Isa isa : available_isas()) text << ' ' << name(isa);
  text << '\n' << fit_line(found.set);
  return std::move(text).str();
}

Status run_info(const Job& job, const InfoOptions& options, const CommonOptions& common, Timings& timings) {
  const Result<Loaded> loaded = load(job, options.models, With::patches, timings);
  if (!loaded) return loaded.status();
  ModelOptions whole = options.models;
  whole.untrimmed = true;
  const Result<PatchSet> set = pack(*loaded, whole, timings);
  if (!set) return set.status();
  const Result<Isa> isa = default_isa();
  if (!isa) return isa.status();
  Findings found{job.inputs[0], *loaded, *set, count_facts(loaded->model, *set), {}, {}, {}, {}, *isa};
  if (loaded->trimmed() > 0) {
    const auto phase = timings.phase("trims");
    found.trims = find_trims(*loaded);
  }
  if (!loaded->model.shapes.empty()) {
    const auto phase = timings.phase("edges");
    const Result<TopologyFacts> topology = count_topology(loaded->model);
    if (!topology) return in_file(job.inputs[0], topology.status());
    found.topology = *topology;
  }
  {
    const auto phase = timings.phase("joined edges");
    const Result<std::optional<JoinedFacts>> joined = count_joined(loaded->model);
    if (!joined && joined.status().code() == StatusCode::out_of_memory) return joined.status();
    if (joined) found.joined = *joined;  // else loops that a remark tells of
  }
  if (options.max_joins > 0) {
    const auto phase = timings.phase("joins");
    const Result<Joins> joins = find_joins(*set, options.max_joins);
    if (!joins) return in_file(job.inputs[0], joins.status());
    found.joins = *joins;
  }
  if (!common.json) return print(as_text(found));
  Json object = as_json(found);
  add_seconds(object, common, timings);
  return print_json(object);
}

constexpr const char* info_footer =
    "Joins: two patches have a border at the same place. They meet as C1 (one derivative across the border), as G1 "
    "(one\n"
    "normal, to 0.11 degrees), as C0 (one border, to 1e-6 of the two patches' size; the largest angle between the\n"
    "normals is printed), or with a gap (the ends agree within 1e-4 of the model's size, the borders do not). Open\n"
    "borders have no neighbour. Contacts in the middle of a border, or along trims, are not found.\n"
    "Trims: faces with loops, and a remark on each loop that had to be repaired: gaps that a line closes, parts "
    "beyond\n"
    "the domain or over each other, loops that enclose nothing.\n"
    "Edges, of models from CAD files: counts are those of all instances. An edge of two faces may be the seam of one.\n"
    "The largest gap is the distance of two faces' points at equal parameters of their edge; the file's own "
    "tolerance is\n"
    "no bound of it.\n"
    "If joined: the edges that faces share once those that run side by side are joined, where files state none or "
    "free\n"
    "ones, as IGES does: within 1e-4 of the size of a shape. Models of more than 20000 surfaces are left out.\n"
    "Memory: surfaces with their points, weights, knots and trims; patches; blocks packed for evaluation.\n"
    "\nExamples:\n"
    "  tessera info teapot.bpt\n"
    "  tessera info 'models/*.json' --json --timings";

}  // namespace

void add_info(Command& tool, Session& session) {
  Command& command = tool.add_command("info", "Describe models: surfaces, joins, sizes, memory");
  const auto options = std::make_shared<InfoOptions>();
  add_models(command, options->models);
  command.add_count("--joins", "COUNT", "Measure at most this many joins; 0 leaves them out [20000]", 0, 1'000'000'000,
                    [options](std::size_t count) { options->max_joins = count; });
  add_reading(command, options->models);
  add_batch(command, session.common.batch);
  add_common(command, session.common);
  command.footer = info_footer;
  command.choose = [options, &session] {
    const std::vector<std::string> listed = listed_files(session.common.batch, options->models.files);
    check_input(options->models);
    const Plan plan = plan_jobs(options->models.files, "", {"MODEL", "", false}, listed);
    session.command = [options, plan, &session] {
      return run_jobs(plan, session.common, [&](const Job& job, Timings& timings) {
        return run_info(job, *options, session.common, timings);
      });
    };
  };
}

}  // namespace tessera::cli
