// tessera project: the points of surfaces that are nearest to given ones, as a table.

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "batch/batch.h"
#include "commands/commands.h"
#include "console/console.h"
#include "console/output.h"
#include "console/progress.h"
#include "line/arguments.h"
#include "stages/pack.h"
#include "table/csv.h"
#include "tessera/nearest_points.h"
#include "tessera/surface.h"

namespace tessera::cli {
namespace {

struct ProjectOptions {
  LoadOptions load;
  PackOptions pack;
  std::string points, output;
  double max_distance = std::numeric_limits<double>::infinity();
};

/// Counts of the nearest points of a table.
struct ProjectCounts {
  std::size_t found = 0, certified = 0, ambiguous = 0, border = 0;
  double largest = 0, sum = 0;

  explicit ProjectCounts(const std::vector<NearestPoint>& nearest) {
    for (const NearestPoint& one : nearest) {
      certified += one.flags.certified;
      if (one.kind != NearestKind::found) continue;
      ++found;
      ambiguous += one.flags.ambiguous, border += one.flags.border;
      largest = std::max(largest, one.distance);
      sum += one.distance;
    }
  }
  double mean() const { return found > 0 ? sum / static_cast<double>(found) : 0; }
};

/// Writes a row for each point; fields of points without a nearest one are empty.
void write_table(OutputFile& out, const Model& model, const std::vector<NearestPoint>& nearest) {
  constexpr int digits = 17;
  out.write("point,found,distance,surface,patch,u,v,x,y,z,nx,ny,nz,certified,ambiguous,border,name\n");
  for (std::size_t k = 0; k < nearest.size() && !out.failed(); ++k) {
    const NearestPoint& one = nearest[k];
    out.write_number(k);
    if (one.kind != NearestKind::found) {
      out.write(",0,,,,,,,,,,,,,,,\n");
      continue;
    }
    const ModelSurface& surface = model.surfaces[one.surface];
    const auto own = own_parameters(surface.surface, one.u, one.v);
    out.write(",1,");
    out.write_number(one.distance, digits);
    out.write(',');
    out.write_number(one.surface);
    out.write(',');
    out.write_number(one.patch);
    for (const double value :
         {own[0], own[1], one.position.x, one.position.y, one.position.z, one.normal.x, one.normal.y, one.normal.z}) {
      out.write(',');
      out.write_number(value, digits);
    }
    for (const bool flag : {bool(one.flags.certified), bool(one.flags.ambiguous), bool(one.flags.border)})
      out.write(flag ? ",1" : ",0");
    out.write(',');
    const std::string& name = surface.name;
    write_field(out, name);
    out.write('\n');
  }
}

Status report(const Job& job, const CommonOptions& common, const Loaded& loaded, const PatchSet& set,
              const std::vector<NearestPoint>& nearest, const Timings& timings) {
  const ProjectCounts counts(nearest);
  Report report = report_of(job, loaded);
  report.add("points", nearest.size(), counted(nearest.size(), "point"));
  report.add("found", counts.found, ", " + std::to_string(counts.found) + " with a nearest one");
  report.add("certified", counts.certified, ", " + std::to_string(counts.certified) + " proven");
  report.add("ambiguous", counts.ambiguous,
             counts.ambiguous > 0 ? ", " + std::to_string(counts.ambiguous) + " of several as near" : "");
  report.add("border", counts.border);
  report.add("largest_distance", counts.largest, ", largest distance " + readable(counts.largest));
  report.add("mean_distance", counts.mean(), ", mean " + readable(counts.mean()));
  add_model_facts(report, loaded, set.patch_count(), set.fit_error());
  return report.print(job.output, common, timings);
}

Status run_project(const Job& job, const ProjectOptions& options, const CommonOptions& common, Timings& timings) {
  Result<OutputFile> out = open_output(job.output);
  if (!out) return out.status();
  const Result<std::vector<Vec3>> points = read_points(options.points);
  if (!points) return points.status();
  const Result<Loaded> loaded = load(job, options.load, With::patches, timings);
  if (!loaded) return loaded.status();
  const Result<PatchSet> set = pack(*loaded, options.pack, timings);
  if (!set) return set.status();
  const Result<PointScene> scene = timings.measure("build", [&] {
    Progress progress("building");
    return PointScene::make(*set, progress.execution());
  });
  if (!scene) return scene.status();
  std::vector<NearestPoint> nearest(points->size());
  Status status = timings.measure("evaluate", [&] {
    Progress progress("searching");
    return scene->nearest(*points, nearest, options.max_distance, progress.execution());
  });
  if (!status.ok()) return status;
  status = timings.measure("write", [&] {
    write_table(*out, loaded->model, nearest);
    return out->commit();
  });
  if (status.ok()) status = report(job, common, *loaded, *set, nearest, timings);
  return status.ok() ? loaded->status() : status;
}

constexpr const char* project_footer =
    R"(The table of points has a header line x,y,z, and a row for each point. The table that is written has a row for each
point: point,found,distance,surface,patch,u,v,x,y,z,nx,ny,nz,certified,ambiguous,border,name. certified: no other point of
the surfaces is nearer. ambiguous: another one is as near. border: the line to the point is not perpendicular to the
surface. Several models become one table, or one each if the output is a folder or contains {name}.

Examples:
  tessera project bearing_block.step --points scan.csv -o nearest.csv
  tessera project teapot.bpt --points scan.csv --max-distance 0.5 -o nearest.csv --json)";

}  // namespace

void add_project(Command& tool, Session& session) {
  Command& command = tool.add_command("project", "Find the nearest points of surfaces, with a proof");
  const auto options = std::make_shared<ProjectOptions>();
  add_models(command, options->load);
  command.add_text("--points", "FILE.csv", "The table of points to read", options->points)
      .require()
      .check(fault_of_name);
  command
      .add_text("-o,--output", "FILE.csv", "The table to write, a folder, a name with {name}, or - for standard output",
                options->output)
      .require()
      .check(fault_of_name);
  command.add_length("--max-distance", "LENGTH", "Surfaces farther away do not count [no limit]",
                     [options](double length) { options->max_distance = length; });
  add_untrimmed(command, options->pack);
  add_reading(command, options->load);
  add_batch(command, session.common.batch);
  add_common(command, session.common);
  command.footer = project_footer;
  command.choose = [options, &session] {
    const std::vector<std::string> listed = listed_files(session.common.batch, options->load.files);
    check_input(options->load);
    const Plan plan = plan_jobs(options->load.files, options->output, {"--output", ".csv"}, listed);
    check_batch(session.common.batch, plan);
    session.choose(plan, options, run_project);
  };
}

}  // namespace tessera::cli
