// tessera measure: boxes, areas, volumes, centroids and inertia of models, each with its bound.

#include "tessera/measures.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "batch/batch.h"
#include "commands/commands.h"
#include "console/progress.h"
#include "line/arguments.h"
#include "stages/load.h"

namespace tessera::cli {
namespace {

struct MeasureCommandOptions {
  LoadOptions load;
  MeasureOptions measure;
  bool inertia = false, enclosed = false, require_solids = false;
};

/// All that is measured of one file.
struct MeasuredModel {
  const std::string& file;
  const Model& model;
  bool inertia;
  MeasuredBox box;
  AreaMeasures areas;
  std::vector<BodyMeasures> bodies;
  std::optional<BodyMeasures> total;
  std::string fault;  ///< why there are no bodies
};

/// "12.5 mm^2 within 1e-9", with as many digits as the bound leaves.
std::string number_text(double value, double error) {
  std::array<char, 64> text;
  const double share = value != 0 ? error / std::abs(value) : 1;
  const int digits = share > 0 && share < 1 ? std::min(17, 2 + static_cast<int>(-std::log10(share))) : 3;
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}
std::string bound_text(double error) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.1e", error);
  return text.data();
}
std::string unit_text(const Model& model, int power) {
  if (model.unit.empty()) return "";
  return " " + model.unit + (power > 1 ? "^" + std::to_string(power) : "");
}
std::string measured_text(double value, double error, const std::string& unit) {
  return number_text(value, error) + unit + " within " + bound_text(error);
}
std::string point_text(const Vec3& p, double error) {
  return "(" + number_text(p.x, error) + ", " + number_text(p.y, error) + ", " + number_text(p.z, error) + ")";
}
std::string point_text(const MeasuredPoint& point) {
  return point_text(point.value, point.error) + " within " + bound_text(point.error);
}

Json json_of(const Measured& measured) { return {{"value", measured.value}, {"error", measured.error}}; }
Json json_of(const MeasuredPoint& point) { return {{"value", to_json(point.value)}, {"error", point.error}}; }
Json json_of(const Inertia& inertia) {
  Json moments = Json::array({inertia.moments[0], inertia.moments[1], inertia.moments[2]});
  Json axes = Json::array({to_json(inertia.axes[0]), to_json(inertia.axes[1]), to_json(inertia.axes[2])});
  return {{"xx", inertia.xx},
          {"yy", inertia.yy},
          {"zz", inertia.zz},
          {"xy", inertia.xy},
          {"yz", inertia.yz},
          {"zx", inertia.zx},
          {"error", inertia.error},
          {"moments", moments},
          {"moments_error", inertia.moments_error},
          {"axes", axes}};
}

Json body_json(const BodyMeasures& body, bool inertia) {
  const auto id = [](std::uint32_t of) { return of == no_id ? Json() : Json(of); };
  Json json{{"instance", id(body.instance)},
            {"solid", id(body.solid)},
            {"shell", id(body.shell)},
            {"volume", json_of(body.volume)},
            {"centroid", json_of(body.centroid)}};
  if (inertia) json["inertia"] = json_of(body.inertia);
  json["gap"] = body.gap;
  json["proven"] = body.proven;
  return json;
}

void add_box(Report& report, const MeasuredModel& found) {
  const MeasuredBox& box = found.box;
  const double error = std::max(max_abs(box.lower_error), max_abs(box.upper_error));
  report.add("box",
             {{"lower", to_json(box.box.lower)},
              {"upper", to_json(box.box.upper)},
              {"lower_error", to_json(box.lower_error)},
              {"upper_error", to_json(box.upper_error)},
              {"proven", box.proven}},
             "\n  box              " + point_text(box.box.lower, error) + " to " + point_text(box.box.upper, error) +
                 " within " + bound_text(error));
}

void add_area(Report& report, const MeasuredModel& found) {
  const SurfaceMeasures& total = found.areas.total;
  report.add("area", json_of(total.area),
             "\n  area             " + measured_text(total.area.value, total.area.error, unit_text(found.model, 2)) +
                 (total.proven ? "" : ", in part sampled"));
  report.add("area_centroid", json_of(total.centroid),
             "\n  centroid         " + point_text(total.centroid) + ", of the area");
  report.add("area_proven", total.proven);
  Json faults = Json::array();
  for (const Status& fault : found.areas.faults) faults.push_back(fault.message());
  report.add("loop_faults", faults);
}

void add_inertia(Report& report, const Inertia& inertia, const Model& model) {
  const auto row = [&](const char* name, double value) {
    report.say(std::string("\n  inertia ") + name + "       " +
               measured_text(value, inertia.error, unit_text(model, 5)));
  };
  row("xx", inertia.xx), row("yy", inertia.yy), row("zz", inertia.zz);
  row("xy", inertia.xy), row("yz", inertia.yz), row("zx", inertia.zx);
  for (std::size_t k = 0; k < 3; ++k)
    report.say("\n  principal " + std::to_string(k + 1) + "      " +
               measured_text(inertia.moments[k], inertia.moments_error, unit_text(model, 5)) + " about " +
               point_text(inertia.axes[k], 1e-6));
}

void add_bodies(Report& report, const MeasuredModel& found) {
  report.add("bodies", found.bodies.size(), "\n  bodies           " + std::to_string(found.bodies.size()));
  report.add("bodies_fault", found.fault.empty() ? Json() : Json(found.fault),
             found.fault.empty() ? "" : ", " + found.fault);
  Json each = Json::array();
  for (const BodyMeasures& body : found.bodies) each.push_back(body_json(body, found.inertia));
  if (!found.total) {
    for (const char* const name : {"volume", "volume_centroid", "gap", "volume_proven"}) report.add(name, Json());
  } else {
    const BodyMeasures& total = *found.total;
    report.add("volume", json_of(total.volume),
               "\n  volume           " +
                   measured_text(total.volume.value, total.volume.error, unit_text(found.model, 3)) +
                   (total.proven ? "" : ", in part sampled"));
    report.add("volume_centroid", json_of(total.centroid),
               "\n  centroid         " + point_text(total.centroid) + ", of the volume");
    report.add("gap", total.gap,
               "\n  largest gap      " + readable(total.gap) + unit_text(found.model, 1) + " between faces, sampled");
    report.add("volume_proven", total.proven);
  }
  if (found.inertia) report.add("inertia", found.total ? json_of(found.total->inertia) : Json());
  if (found.inertia && found.total) add_inertia(report, found.total->inertia, found.model);
  report.add("each_body", each);
}

/// Measures what solids there are, and says why if there are none. Errors: cancelled, out_of_memory.
Status measure_bodies(const Model& model, const MeasureCommandOptions& options, const Execution& execution,
                      MeasuredModel& found) {
  Status status;
  if (options.enclosed) {
    const Result<BodyMeasures> body = measure_enclosed(model.surfaces, options.measure, execution);
    status = body.status();
    if (body) found.bodies = {*body};
  } else {
    Result<std::vector<BodyMeasures>> bodies = measure_solids(model, options.measure, execution);
    status = bodies.status();
    if (bodies) found.bodies = *std::move(bodies);
  }
  if (status.code() == StatusCode::cancelled || status.code() == StatusCode::out_of_memory) return status;
  if (!status.ok()) found.fault = status.message();
  if (found.bodies.empty()) {
    if (found.fault.empty()) found.fault = "the model has no solids";
    return {};
  }
  const Result<BodyMeasures> total = total_of(found.bodies);
  if (!total) return total.status();
  found.total = *total;
  return {};
}

Status run_measure(const Job& job, const MeasureCommandOptions& options, const CommonOptions& common,
                   Timings& timings) {
  const std::string& file = job.inputs[0];
  const Result<Loaded> loaded = load(job, options.load, With::surfaces, timings);
  if (!loaded) return loaded.status();
  const Model& model = loaded->model;
  MeasuredModel found{file, model, options.inertia, {}, {}, {}, {}, {}};
  const Status status = timings.measure("measure", [&]() -> Status {
    const Result<MeasuredBox> box = measure_box(model, options.measure, Progress("box").execution());
    if (!box) return box.status();
    Result<AreaMeasures> areas = measure_surfaces(model, options.measure, Progress("areas").execution());
    if (!areas) return areas.status();
    found.box = *box, found.areas = *std::move(areas);
    Progress progress("volumes");
    return measure_bodies(model, options, progress.execution(), found);
  });
  if (!status.ok()) return in_file(file, status);
  Report report;
  report.add("model", file, file + ": ");
  report.add("surfaces", model.surfaces.size(), counted(model.surfaces.size(), "surface"));
  report.add("unit", model.unit.empty() ? Json() : Json(model.unit));
  add_box(report, found);
  add_area(report, found);
  add_bodies(report, found);
  report.add("warnings", model.warnings);
  if (Status printed = report.print({}, common, timings); !printed.ok()) return printed;
  if (!options.require_solids || found.total) return {};
  complain(file + ": " + found.fault);
  return already_said(StatusCode::invalid_argument);
}

constexpr const char* measure_footer =
    R"(Each number is followed by a bound: the true number is within it. Bounds hold whatever rounding does. "In part
sampled" says that some of a bound is only sampled: where expressions are fitted, and where trims of a quadric run
along no parameter. The slits that a file leaves between faces along their edges are sampled, and part of the bounds
of volume, centroid and inertia. Inertia is about the centroid, for a density of 1.
Bodies are the solids of CAD files, and closed shells; cavities are taken away. --enclosed takes all surfaces of a
model as the skin of one body instead, and does not look for gaps.
The exit status is 1 only if a model cannot be read or measured, or has no solids that are closed with
--require-solids.

Examples:
  tessera measure part.step
  tessera measure ball.json --enclosed --inertia --json)";

}  // namespace

void add_measure(Command& tool, Session& session) {
  Command& command = tool.add_command("measure", "Measure boxes, areas, volumes, centroids and inertia, with bounds");
  const auto options = std::make_shared<MeasureCommandOptions>();
  add_models(command, options->load);
  command.add_length("--accuracy", "SHARE", "Error of each part of an integral, from 1e-14 to 1e-2 [1e-10]",
                     [options](double value) {
                       if (value < 1e-14 || value > 1e-2)
                         throw UsageError("--accuracy", "expected a number from 1e-14 to 1e-2");
                       options->measure.accuracy = value;
                     });
  command.add_flag("--inertia", "Print the inertia about the centroid too, and its principal axes", options->inertia);
  command.add_flag("--enclosed", "Take all surfaces as the closed skin of one body, with normals to one side",
                   options->enclosed);
  command.add_flag("--require-solids", "Exit with 1 if a model has no closed solids", options->require_solids);
  add_reading(command, options->load);
  add_batch(command, session.common.batch);
  add_common(command, session.common);
  command.footer = measure_footer;
  command.choose = [options, &session] {
    const std::vector<std::string> listed = listed_files(session.common.batch, options->load.files);
    check_input(options->load);
    const Plan plan = plan_jobs(options->load.files, "", {"MODEL", "", false}, listed);
    session.choose(plan, options, run_measure);
  };
}

}  // namespace tessera::cli
