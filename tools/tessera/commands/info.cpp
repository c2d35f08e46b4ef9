// tessera info: reports what models hold.

#include <memory>

#include "batch/batch.h"
#include "commands/commands.h"
#include "console/memory.h"
#include "facts/counts.h"
#include "facts/joins.h"
#include "facts/topology.h"
#include "facts/trims.h"
#include "line/arguments.h"
#include "stages/pack.h"
#include "tessera/execution.h"

namespace tessera::cli {
namespace {

struct InfoOptions {
  LoadOptions load;
  std::size_t max_joins = 20000;
};

/// All that is known of one file.
struct Findings {
  const std::string& file;
  const Model& model;
  const PatchSet& set;
  ModelCounts counts;
  TrimFacts trims;
  TopologyFacts topology;
  std::optional<JoinedFacts> joined;  ///< empty if no edges are to be joined
  std::optional<Joins> joins;         ///< empty if they are left out
  Isa isa;
};

std::string range_text(const Range& of) { return "[" + readable(of.least) + ", " + readable(of.largest) + "]"; }
Json range_json(const Range& range) { return Json::array({range.least, range.largest}); }

std::string point_text(const Vec3& v) {
  return "(" + readable(v.x) + ", " + readable(v.y) + ", " + readable(v.z) + ")";
}

void add_surfaces(Report& report, const Findings& found) {
  const ModelCounts& counts = found.counts;
  const std::size_t surfaces = found.model.surfaces.size();
  const auto bytes = file_bytes(found.file);
  report.add("model", found.file, found.file + ": ");
  report.add("file_bytes", bytes ? Json(*bytes) : Json());
  report.add("name", found.model.name);
  report.add("surfaces", surfaces,
             counted(surfaces, "surface") + ", " + counted(found.set.patch_count(), "Bezier patch", "Bezier patches") +
                 (bytes ? ", read from " + readable_bytes(*bytes) : ""));
  Json kinds = Json::object();
  std::string kinds_text, degrees_text;
  for (const auto& [kind, count] : counts.kinds) {
    kinds[std::string(kind)] = count;
    kinds_text += (kinds_text.empty() ? "" : ", ") + std::to_string(count) + " " + std::string(kind);
  }
  for (const auto& [degree, count] : counts.degrees)
    degrees_text += (degrees_text.empty() ? "" : ", ") + std::to_string(count) + " of " + std::to_string(degree.first) +
                    " x " + std::to_string(degree.second);
  report.add("kinds", kinds,
             "\n  kinds            " + kinds_text + "\n  degrees          " + degrees_text + "\n  rational         " +
                 std::to_string(counts.rational) + " of the patches" + "\n  parameters       " + range_text(counts.u) +
                 " x " + range_text(counts.v));
  if (counts.on_unit_square < surfaces)
    report.say(" in all; " + std::to_string(counts.on_unit_square) + " of " + std::to_string(surfaces) +
               " on [0, 1]^2");
}

/// Adds the unit; null in JSON and no words if none is stated.
void add_unit(Report& report, const Model& model) {
  const auto json = [](const std::string& unit) { return unit.empty() ? Json() : Json(unit); };
  const bool other = !model.file_unit.empty() && model.file_unit != model.unit;
  report.add("unit", json(model.unit), model.unit.empty() ? "" : "\n  unit             " + model.unit);
  report.add("file_unit", json(model.file_unit),
             !model.unit.empty() && other ? " (in the file: " + model.file_unit + ")" : "");
}

void add_patches(Report& report, const Findings& found) {
  const ModelCounts& counts = found.counts;
  Json degrees = Json::array();
  for (const auto& [degree, count] : counts.degrees)
    degrees.push_back({{"degree_u", degree.first}, {"degree_v", degree.second}, {"patches", count}});
  report.add(
      "parameters",
      {{"u", range_json(counts.u)}, {"v", range_json(counts.v)}, {"surfaces_on_unit_square", counts.on_unit_square}});
  report.add("patches", found.set.patch_count());
  report.add("degrees", degrees);
  report.add("rational_patches", counts.rational);
  report.add("collapsed_sides", counts.collapsed_sides,
             "\n  collapsed sides  " + std::to_string(counts.collapsed_sides));
  report.add("patches_with_collapsed_sides", counts.patches_with_collapsed_sides,
             " on " + std::to_string(counts.patches_with_collapsed_sides) + " patches");
}

void add_memory(Report& report, const Findings& found) {
  const ModelCounts& counts = found.counts;
  const Box3& box = found.set.box();
  report.add("control_points", counts.control_points,
             "\n  control points   " + std::to_string(counts.control_points) + ", of the patches");
  report.add("fit_error", fit_json(found.set.fit_error()));
  report.add(
      "box", {{"lower", to_json(box.lower)}, {"upper", to_json(box.upper)}},
      "\n  bounding box     " + point_text(box.lower) + " to " + point_text(box.upper) + ", of the control points");
  report.add("size", box.diagonal());
  report.add("memory_bytes",
             {{"model", counts.model_bytes}, {"patches", counts.patch_bytes}, {"blocks", counts.block_bytes}},
             "\n  memory           model " + readable_bytes(counts.model_bytes) + ", patches " +
                 readable_bytes(counts.patch_bytes) + ", blocks " + readable_bytes(counts.block_bytes));
  report.add("warnings", found.model.warnings);
}

Report report_of(const Findings& found) {
  Report report;
  add_surfaces(report, found);
  add_trims(report, found.trims, found.model);
  add_topology(report, found.model, found.topology);
  add_joined(report, found.joined);
  add_unit(report, found.model);
  add_patches(report, found);
  add_joins(report, found.joins);
  add_memory(report, found);
  const std::string used(name(found.isa));
  std::vector<std::string> isas;
  for (const Isa isa : available_isas()) isas.emplace_back(name(isa));
  report.add("isa", {{"available", isas}, {"used", used}}, "\n  instruction set  " + used + ", of");
  for (const std::string& isa : isas) report.say(" " + isa);
  report.say(fit_line(found.set.fit_error()));
  return report;
}

Status run_info(const Job& job, const InfoOptions& options, const CommonOptions& common, Timings& timings) {
  const Result<Loaded> loaded = load(job, options.load, With::patches, timings);
  if (!loaded) return loaded.status();
  const Result<PatchSet> set = pack(*loaded, {.untrimmed = true}, timings);
  if (!set) return set.status();
  const Result<Isa> isa = default_isa();
  if (!isa) return isa.status();
  Findings found{job.inputs[0], loaded->model, *set, count_model(loaded->model, *set), {}, {}, {}, {}, *isa};
  const Model& model = loaded->model;
  if (loaded->trimmed() > 0) found.trims = timings.measure("trims", [&] { return find_trims(*loaded); });
  if (!model.shapes.empty()) {
    const Result<TopologyFacts> topology = timings.measure("edges", [&] { return count_topology(model); });
    if (!topology) return in_file(job.inputs[0], topology.status());
    found.topology = *topology;
  }
  const Result<std::optional<JoinedFacts>> joined =
      timings.measure("joined edges", [&] { return count_joined(model); });
  if (!joined && joined.status().code() == StatusCode::out_of_memory) return joined.status();
  if (joined) found.joined = *joined;  // else loops that a remark tells of
  if (options.max_joins > 0) {
    const Result<Joins> joins = timings.measure("joins", [&] { return find_joins(*set, options.max_joins); });
    if (!joins) return in_file(job.inputs[0], joins.status());
    found.joins = *joins;
  }
  return report_of(found).print({}, common, timings);
}

constexpr const char* info_footer =
    R"(Joins: two patches have a border at the same place. They meet as C1 (one derivative across the border), as G1 (one
normal, to 0.11 degrees), as C0 (one border, to 1e-6 of the two patches' size; the largest angle between the
normals is printed), or with a gap (the ends agree within 1e-4 of the model's size, the borders do not). Open
borders have no neighbour. Contacts in the middle of a border, or along trims, are not found.
Trims: faces with loops, and a remark on each loop that had to be repaired: gaps that a line closes, parts beyond
the domain or over each other, loops that enclose nothing.
Edges, of models from CAD files: counts are those of all instances. An edge of two faces may be the seam of one.
The largest gap is the distance of two faces' points at equal parameters of their edge; the file's own tolerance is
no bound of it.
If joined: the edges that faces share once those that run side by side are joined, where files state none or free
ones, as IGES does: within 1e-4 of the size of a shape. Models of more than 20000 surfaces are left out.
Memory: surfaces with their points, weights, knots and trims; patches; blocks packed for evaluation.

Examples:
  tessera info teapot.bpt
  tessera info 'models/*.json' --json --timings)";

}  // namespace

void add_info(Command& tool, Session& session) {
  Command& command = tool.add_command("info", "Describe models: surfaces, joins, sizes, memory");
  const auto options = std::make_shared<InfoOptions>();
  add_models(command, options->load);
  command.add_count("--joins", "COUNT", "Measure at most this many joins; 0 leaves them out [20000]", 0, 1'000'000'000,
                    [options](std::size_t count) { options->max_joins = count; });
  add_reading(command, options->load);
  add_batch(command, session.common.batch);
  add_common(command, session.common);
  command.footer = info_footer;
  command.choose = [options, &session] {
    const std::vector<std::string> listed = listed_files(session.common.batch, options->load.files);
    check_input(options->load);
    const Plan plan = plan_jobs(options->load.files, "", {"MODEL", "", false}, listed);
    session.choose(plan, options, run_info);
  };
}

}  // namespace tessera::cli
