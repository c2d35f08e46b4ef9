// tessera section: where planes cut surfaces, as polylines in a drawing.

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "batch/batch.h"
#include "commands/commands.h"
#include "console/console.h"
#include "console/output.h"
#include "console/progress.h"
#include "io/format/output_formats.h"
#include "line/arguments.h"
#include "stages/write.h"
#include "tessera/sections.h"
#include "tessera/sections_file.h"

namespace tessera::cli {
namespace {

struct SectionCommandOptions {
  LoadOptions load;
  PackOptions pack;
  WriteOptions write;
  SectionOptions section;
  std::optional<Plane> plane;
  Vec3 axis{0, 0, 1};
  std::vector<double> at;
  std::size_t layers = 0;
};

/// The offsets of the planes; layers lie in the middles of equal parts of the model's extent.
std::vector<double> offsets_of(const SectionCommandOptions& options, const PatchSet& set) {
  if (options.plane) return {options.plane->offset};
  if (options.layers == 0) return options.at;
  const Box3 box = set.model_box();
  const double low = dot(options.axis, box.lower), high = dot(options.axis, box.upper);
  std::vector<double> offsets;
  for (std::size_t k = 0; k < options.layers; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(options.layers);
    offsets.push_back(low + (high - low) * share);
  }
  return offsets;
}

/// The sums of all planes.
struct Totals {
  std::size_t open = 0;
  double length = 0, bound = 0, gap = 0;

  explicit Totals(const Sections& sections) {
    for (const PlaneSection& plane : sections.planes) {
      open += plane.open_count;
      length += plane.length;
      bound = std::max(bound, plane.bound);
      gap = std::max(gap, plane.largest_gap);
    }
  }
};

Json planes_json(const Sections& sections) {
  Json planes = Json::array();
  for (const PlaneSection& plane : sections.planes) {
    planes.push_back(Json{{"offset", plane.offset},
                          {"polylines", plane.polyline_count},
                          {"open", plane.open_count},
                          {"length", plane.length},
                          {"contacts", plane.contact_count},
                          {"coplanar_patches", plane.coplanar_count}});
  }
  return planes;
}

Status report(const Job& job, const CommonOptions& common, const Loaded& loaded, const PatchSet& set,
              const Sections& sections, const Timings& timings) {
  const Totals totals(sections);
  const std::size_t polylines = sections.polylines.size();
  const bool is_proven = sections.unproven.empty() && set.fit_error().certified;
  const double bound = totals.bound + set.fit_error().distance;
  Report report = report_of(job, loaded);
  report.add("planes", planes_json(sections), counted(sections.planes.size(), "plane"));
  report.add("polylines", polylines, ", " + counted(polylines, "polyline"));
  report.add("closed", polylines - totals.open, " (" + std::to_string(polylines - totals.open) + " closed, ");
  report.add("open", totals.open, std::to_string(totals.open) + " open)");
  report.add("points", sections.points.size(), ", " + counted(sections.points.size(), "point"));
  report.add("length", totals.length, ", length " + readable(totals.length));
  report.add("tolerance", sections.tolerance);
  report.add("bound", bound, ", within " + readable(bound, 3) + " of the section");
  report.add("certified", is_proven, is_proven ? ", proven" : ", not proven");
  report.add("largest_gap", totals.gap, totals.gap > 0 ? ", joined over gaps up to " + readable(totals.gap, 3) : "");
  report.add("unproven_patches", sections.unproven.size());
  add_model_facts(report, loaded, set.patch_count(), set.fit_error());
  return report.print(job.output, common, timings);
}

Status run_section(const Job& job, const SectionCommandOptions& options, const CommonOptions& common,
                   Timings& timings) {
  Result<OutputFile> out = open_output(job.output);
  if (!out) return out.status();
  Result<Loaded> loaded = load(job, options.load, With::patches, timings);
  if (!loaded) return loaded.status();
  const Result<Packed> packed = pack_for_meshes(*loaded, options.pack, false, timings);
  if (!packed) return packed.status();
  const PatchSet& set = *packed->sets.front().set;
  const Result<Sections> sections = timings.measure("section", [&] {
    Progress progress("cutting");
    return make_sections(set, options.plane ? options.plane->normal : options.axis, offsets_of(options, set),
                         options.section, progress.execution());
  });
  if (!sections) return sections.status();
  Status status = timings.measure("write", [&] {
    const Status written =
        write_sections(*sections, format_path(job.output, options.write.format), *out, {.unit = loaded->model.unit});
    return written.ok() ? out->commit() : written;
  });
  if (status.ok()) status = report(job, common, *loaded, set, *sections, timings);
  return status.ok() ? loaded->status() : status;
}

std::string fault_of_section_file(const std::string& path) {
  if (path.empty()) return fault_of_name(path);
  return is_folder(path) || is_stream(path) ? "" : check_sections_format(path).message();
}

void add_planes(Command& command, SectionCommandOptions& options) {
  command.begin_group("Planes (one of)");
  const std::string form = "A,B,C,D";
  Option& plane =
      command.add("--plane", form, "The plane A x + B y + C z = D", [&options, form](const std::string& text) {
        const std::vector<double> n = parse_numbers("--plane", text, 4, form);
        options.plane = Plane{{n[0], n[1], n[2]}, n[3]};
        if (options.plane->normal == Vec3{}) throw UsageError("--plane", "A, B and C must not all be 0");
      });
  Option& at = command.add(
      "--at", "H", "The plane at this coordinate of the axis; may be repeated",
      [&options](const std::string& text) { options.at.push_back(parse_numbers("--at", text, 1, "H").front()); });
  at.repeated = true;
  Option& layers = command.add_count(
      "--layers", "N", "N planes across the axis, in the middles of equal parts of the model, 1 to 1000000", 1, 1000000,
      [&options](std::size_t count) { options.layers = count; });
  plane.exclude(at).exclude(layers);
  at.exclude(layers);
  command.one_of = {&plane, &at, &layers};
  command.begin_group("Sections");
  command
      .add_choice("--axis", {"x", "y", "z"}, "The axis that planes stand across [z]",
                  [&options](const std::string& name) {
                    options.axis = {name == "x" ? 1.0 : 0.0, name == "y" ? 1.0 : 0.0, name == "z" ? 1.0 : 0.0};
                  })
      .exclude(plane);
  command.add_length("--tolerance", "LENGTH", "Largest distance of a chord from the section [1e-4 of the model's size]",
                     [&options](double length) { options.section.tolerance = length; });
  command.add_choice("--limit", {"automatic", "below", "above"},
                     "Where a plane runs along a face: the section of planes just below or above it [automatic]",
                     [&options](const std::string& name) {
                       options.section.limit = name == "below"   ? PlaneLimit::below
                                               : name == "above" ? PlaneLimit::above
                                                                 : PlaneLimit::automatic;
                     });
  add_untrimmed(command, options.pack);
}

constexpr const char* section_footer =
    R"(.svg: one drawing in the planes' own coordinates (x,y across z; y,z across x; z,x across y), a layer per plane.
.dxf: R12, 3D polylines in the model's coordinates, a layer per plane. .ply: vertices and edges, in double.
Points lie on the surface and in the plane, and chords keep the tolerance (proven). Polylines go on from face to face
along shared edges; those of closed shapes are closed. automatic is below, or above where there is nothing below, as at
the bottom of a box. Several models become one file, or one file each if the output is a folder (then as .svg) or
contains {name}.

Examples:
  tessera section bearing_block.step --at 10 -o block.svg
  tessera section bearing_block.step --layers 1200 --tolerance 0.01 -o layers.dxf
  tessera section vase.json --plane 1,1,0,0.5 -o cut.ply)";

}  // namespace

void add_section(Command& tool, Session& session) {
  Command& command = tool.add_command("section", "Cut surfaces by planes: polylines as SVG, DXF or PLY");
  const auto options = std::make_shared<SectionCommandOptions>();
  add_models(command, options->load);
  command
      .add_text("-o,--output", "FILE",
                "The drawing (.svg, .dxf, .ply), a folder, a name with {name}, or - for standard output",
                options->write.output)
      .require()
      .check(fault_of_section_file);
  add_stream_format(command, {"svg", "dxf", "ply"}, options->write.format);
  add_planes(command, *options);
  add_reading(command, options->load);
  add_batch(command, session.common.batch);
  add_common(command, session.common);
  command.footer = section_footer;
  command.choose = [options, &session] {
    const std::vector<std::string> listed = listed_files(session.common.batch, options->load.files);
    check_input(options->load);
    check_stream_format(options->write.output, options->write.format);
    const Plan plan = plan_jobs(options->load.files, options->write.output, {"--output", ".svg"}, listed);
    check_batch(session.common.batch, plan);
    session.choose(plan, options, run_section);
  };
}

}  // namespace tessera::cli
