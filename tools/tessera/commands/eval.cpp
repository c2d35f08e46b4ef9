// tessera eval: points, derivatives and normals of surfaces as a table.

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "commands/commands.h"
#include "console/output.h"
#include "console/progress.h"
#include "line/arguments.h"
#include "stages/load.h"
#include "table/csv.h"
#include "tessera/evaluate.h"

namespace tessera::cli {
namespace {

struct EvalOptions {
  LoadOptions load;
  std::string output, places, format = "csv";
  std::optional<Extent> grid;
  int derivatives = 0;
  Team* team = nullptr;  ///< null: this process alone
};

/// A vector of a row: its name in JSON, the begin of its columns' names in CSV, and the number of derivatives from
/// which on it is written.
struct Column {
  std::string_view name, prefix;
  Vec3 SurfaceJet::*vector;
  int derivatives;
};
constexpr std::array<Column, 6> columns{{{"position", "", &SurfaceJet::position, 0},
                                         {"du", "du", &SurfaceJet::du, 1},
                                         {"dv", "dv", &SurfaceJet::dv, 1},
                                         {"duu", "duu", &SurfaceJet::duu, 2},
                                         {"duv", "duv", &SurfaceJet::duv, 2},
                                         {"dvv", "dvv", &SurfaceJet::dvv, 2}}};

/// Text in memory, written as an OutputFile is.
class TextBuffer {
 public:
  void write(std::string_view bytes) { text_ += bytes; }
  void write(char c) { text_ += c; }
  void write_number(std::uint32_t value) { text_ += std::to_string(value); }
  void write_number(double value, int digits) {
    char number[32];
    text_.append(number, std::to_chars(number, number + 32, value, std::chars_format::general, digits).ptr);
  }
  bool failed() const { return false; }
  std::string take() { return std::exchange(text_, {}); }

 private:
  std::string text_;
};

/// Rows as CSV or JSON, all numbers with 17 digits. `is_first`: whether the next row is the first of all.
template <class Out>
class RowWriter {
 public:
  RowWriter(Out& out, bool json, int derivatives, bool is_first = true)
      : out_(out), json_(json), first_(is_first), derivatives_(derivatives) {}

  void begin() {
    if (json_) return out_.write("{\"rows\": [");
    out_.write("surface,u,v");
    for (const Column& column : columns) {
      if (column.derivatives <= derivatives_) write_names(column.prefix);
    }
    write_names("n");
    out_.write('\n');
  }

  void write(const SurfacePlace& place, const SurfaceJet& jet, const UnitNormal& normal) {
    if (json_) out_.write(first_ ? "\n{\"surface\": " : ",\n{\"surface\": ");
    first_ = false;
    out_.write_number(place.surface);
    out_.write(json_ ? ", \"u\": " : ",");
    out_.write_number(place.u, digits);
    out_.write(json_ ? ", \"v\": " : ",");
    out_.write_number(place.v, digits);
    for (const Column& column : columns) {
      if (column.derivatives <= derivatives_) write_vector(column.name, jet.*column.vector);
    }
    if (json_ && normal.kind == NormalKind::undefined) {
      out_.write(", \"normal\": null");
    } else {
      write_vector("normal", normal.direction);
    }
    out_.write(json_ ? "}" : "\n");
  }

  /// `more`: members of the JSON object besides the rows.
  void end(const Json& more) {
    if (!json_) return;
    out_.write("\n]");
    for (const Json::Member& member : more.members()) out_.write(", \"" + member.name + "\": " + member.value.text());
    out_.write("}\n");
  }

 private:
  static constexpr int digits = 17;

  void write_names(std::string_view prefix) {
    for (const char axis : {'x', 'y', 'z'}) {
      out_.write(',');
      out_.write(prefix);
      out_.write(axis);
    }
  }

  void write_vector(std::string_view name, const Vec3& v) {
    if (json_) {
      out_.write(", \"");
      out_.write(name);
      out_.write("\": [");
    } else {
      out_.write(',');
    }
    out_.write_number(v.x, digits);
    out_.write(json_ ? ", " : ",");
    out_.write_number(v.y, digits);
    out_.write(json_ ? ", " : ",");
    out_.write_number(v.z, digits);
    if (json_) out_.write(']');
  }

  Out& out_;
  bool json_, first_;
  int derivatives_;
};

/// The places to evaluate, computed by number, so that a large grid takes no memory.
struct Places {
  std::size_t count = 0;
  std::function<SurfacePlace(std::size_t)> at;
};

Places grid_places(const Extent& grid, const Model& model) {
  const auto count_u = static_cast<std::size_t>(grid.first), count_v = static_cast<std::size_t>(grid.second);
  return {model.surfaces.size() * count_u * count_v,
          [=, &model, u = uniform_parameters(grid.first), v = uniform_parameters(grid.second)](std::size_t k) {
            const std::size_t surface = k / (count_u * count_v);
            const Domain d = domain(model.surfaces[surface].surface);
            return SurfacePlace{static_cast<std::uint32_t>(surface), d.u_at(u[k / count_v % count_u]),
                                d.v_at(v[k % count_v])};
          }};
}

/// Evaluates one surface after the other.
class Evaluator {
 public:
  Evaluator(const Model& model, const FitOptions& fit) : model_(model), fit_(fit) {}

  Result<SurfaceJet> jet(const SurfacePlace& place) const {
    Result<SurfaceJet> jet = evaluate_jet(model_.surfaces[place.surface], place.u, place.v);
    if (!jet) return jet;
    for (const Column& column : columns) {
      if (!is_finite(*jet.*column.vector))
        return Status(StatusCode::non_finite, "its points or derivatives are too large for double");
    }
    return jet;
  }

  /// The normal of the jet where tangents span a plane. Otherwise the limit: by r_uv for a function at a collapsed
  /// border, and on the surface's patches for all else.
  Result<UnitNormal> normal(const SurfacePlace& place, const SurfaceJet& jet) {
    constexpr double min_sine = 1e-10;
    if (length(cross(normalized(jet.du), normalized(jet.dv))) > min_sine) {
      const Vec3 across = normalized(cross(jet.du, jet.dv));
      if (is_finite(across) && across != Vec3{}) return UnitNormal{across, NormalKind::regular};
    }
    const ModelSurface& surface = model_.surfaces[place.surface];
    if (std::holds_alternative<ParametricSurface>(surface.surface)) {
      const UnitNormal limit = limit_at_border(domain(surface.surface), place, jet);
      if (limit.kind == NormalKind::limit) return limit;
    }
    if (!patches_ || converted_ != place.surface) {
      Result<PatchGrid> patches = to_bezier(surface, fit_);
      if (!patches) return patches.status();
      patches_ = *std::move(patches);
      converted_ = place.surface;
    }
    const auto at = grid_parameters(surface.surface, place.u, place.v);
    const auto where = patches_->locate(at[0], at[1]);
    return where ? unit_normal(patches_->patches()[where->patch], where->u, where->v) : UnitNormal{};
  }

 private:
  /// Near a border u = u0 where r_v vanishes, r_v is (u - u0) r_uv, so that r_u x r_uv is the normal's direction; it is
  /// negated at u1, where u - u1 < 0. The same holds with u and v exchanged.
  static UnitNormal limit_at_border(const Domain& d, const SurfacePlace& place, const SurfaceJet& jet) {
    constexpr double vanishing = 1e-10, min_sine = 1e-6;
    const auto side = [](double t, double from, double to) { return t == from ? 1.0 : t == to ? -1.0 : 0.0; };
    const bool by_u = length(jet.dv) <= vanishing * length(jet.du);
    const double sign = by_u ? side(place.u, d.u0, d.u1) : side(place.v, d.v0, d.v1);
    if (sign == 0 || (!by_u && length(jet.du) > vanishing * length(jet.dv))) return {};
    const Vec3 mixed = normalized(jet.duv);
    const Vec3 across = by_u ? cross(normalized(jet.du), mixed) : cross(mixed, normalized(jet.dv));
    return length(across) > min_sine ? UnitNormal{normalized(sign * across), NormalKind::limit} : UnitNormal{};
  }

  const Model& model_;
  FitOptions fit_;
  std::optional<PatchGrid> patches_;
  std::uint32_t converted_ = 0;
};

/// Writes a row for each place of a run.
template <class Out>
Status write_rows(const Loaded& loaded, const Places& places, const PartRun& run, Evaluator& evaluator,
                  RowWriter<Out>& rows, const Out& out, Progress& progress) {
  for (std::size_t k = run.begin; k < run.end && !out.failed(); ++k) {
    if (k % 1024 == 0) {
      if (interrupted()) return Status(StatusCode::cancelled, "interrupted");
      progress.tell(static_cast<double>(k) / static_cast<double>(places.count));
    }
    const SurfacePlace place = places.at(k);
    const Result<SurfaceJet> jet = evaluator.jet(place);
    const Result<UnitNormal> normal = jet ? evaluator.normal(place, *jet) : jet.status();
    if (!normal) return loaded.in_surface(place.surface, normal.status());
    rows.write(place, *jet, *normal);
  }
  return {};
}

bool writes_json(const Job& job, const EvalOptions& options, const CommonOptions& common) {
  return options.format == "json" || (common.json && job.output.empty());
}

/// Writes the rows of all places, which a team shares, a million at a time.
Status write_rows_of_team(const Loaded& loaded, const Places& places, const EvalOptions& options, bool json,
                          OutputFile& out) {
  constexpr std::size_t places_at_once = std::size_t{1} << 20;
  Evaluator evaluator(loaded.model, options.load.fit);
  Progress progress("evaluating");
  TextBuffer buffer;
  for (std::size_t first = 0; first < places.count; first += places_at_once) {
    PartRun run = options.team->run_of(std::min(places_at_once, places.count - first));
    run.begin += first, run.end += first;
    RowWriter<TextBuffer> rows(buffer, json, options.derivatives, run.begin == 0);
    const Status own = write_rows(loaded, places, run, evaluator, rows, buffer, progress);
    const Result<std::vector<std::string>> texts = options.team->gather(own, buffer.take());
    if (!texts) return texts.status();
    for (const std::string& text : *texts) out.write(text);
  }
  return {};
}

Status write_all_rows(const Loaded& loaded, const Places& places, const EvalOptions& options, bool json,
                      OutputFile& out) {
  if (options.team) return write_rows_of_team(loaded, places, options, json, out);
  Evaluator evaluator(loaded.model, options.load.fit);
  Progress progress("evaluating");
  RowWriter<OutputFile> rows(out, json, options.derivatives);
  return write_rows(loaded, places, {0, places.count}, evaluator, rows, out, progress);
}

Result<Places> places_of(const EvalOptions& options, const Model& model) {
  if (options.grid) return grid_places(*options.grid, model);
  Result<std::vector<SurfacePlace>> read = read_places(options.places, model);
  if (!read) return read.status();
  const std::size_t count = read->size();
  return Places{count, [list = *std::move(read)](std::size_t k) { return list[k]; }};
}

Status report(const Job& job, const CommonOptions& common, const Loaded& loaded, std::size_t rows,
              const Timings& timings) {
  Report report = report_of(job, loaded);
  report.add("rows", rows);
  report.add("surfaces", loaded.model.surfaces.size());
  report.add("trimmed_surfaces", loaded.trimmed());
  report.add("warnings", loaded.model.warnings);
  return report.print({}, common, timings);
}

Status run_eval(const Job& job, const EvalOptions& options, const CommonOptions& common, Timings& timings) {
  Result<OutputFile> out = open_output(job.output, !options.team || options.team->leads());
  if (!out) return out.status();
  const Result<Loaded> loaded = load(job, options.load, With::surfaces, timings);
  if (!loaded) return loaded.status();
  const Result<Places> places = places_of(options, loaded->model);
  if (!places) return places.status();
  const bool json = writes_json(job, options, common);
  RowWriter<OutputFile> frame(*out, json, options.derivatives);
  frame.begin();
  Status status = timings.measure("evaluate", [&] { return write_all_rows(*loaded, *places, options, json, *out); });
  if (!status.ok()) return status;
  frame.end(common.timings ? Json{{"seconds", timings.as_json()}} : Json::object());
  status = out->commit();
  if (status.ok() && common.json && !job.output.empty()) status = report(job, common, *loaded, places->count, timings);
  return status.ok() ? loaded->status() : status;
}

constexpr const char* eval_footer =
    R"(--params takes a table with the header line surface,u,v. Surfaces are counted from 0. u and v lie in the surface's
own domain ([0,1] for a Bezier patch; canonical parameters for a quadric). # begins a comment.
Rows have surface,u,v and the position x,y,z; with --derivs 1 also dux,duy,duz,dvx,dvy,dvz; with --derivs 2 also
duux..duuz,duvx..duvz,dvvx..dvvz; then the unit normal nx,ny,nz, along r_u x r_v. Numbers have 17 significant digits.
At a degenerate point (a pole) the normal is the limit. If there is none, it is 0,0,0 (null in JSON).
JSON: {"rows": [{"surface", "u", "v", "position", "du", "dv", "duu", "duv", "dvv", "normal"}, ...]}
Several models give one table, or one table each if the output is a folder or contains {name}. With --json, rows on
standard output are JSON; rows in a file have the --format, and standard output has a summary.

Examples:
  tessera eval teapot.bpt --grid 5x5 -o points.csv
  tessera eval teapot.bpt --params places.csv --derivs 2 --format json)";

/// Adds --grid and --params.
void add_places(Command& command, EvalOptions& options) {
  command.begin_group("Places (one of)");
  Option& grid =
      command.add("--grid", "NxM", "N x M points on every surface, from border to border, 2 to 65536 each",
                  [&options](const std::string& text) { options.grid = parse_extent("--grid", text, 2, 65536); });
  Option& places = command.add_text("--params", "FILE.csv", "The places in this table", options.places);
  places.check(fault_of_name).exclude(grid);
  command.one_of = {&grid, &places};
}

}  // namespace

void add_eval(Command& tool, Session& session) {
  Command& command = tool.add_command("eval", "Evaluate surfaces: positions, derivatives, normals");
  const auto options = std::make_shared<EvalOptions>();
  options->team = session.team;
  add_models(command, options->load);
  command
      .add_text("-o,--output", "FILE", "The file to write, a folder, or a name with {name} [standard output]",
                options->output)
      .check(fault_of_name);
  add_places(command, *options);
  command.begin_group("Rows");
  command.add_count("--derivs", "ORDER", "Derivatives up to this order, 0 to 2 [0]", 0, 2,
                    [options](std::size_t order) { options->derivatives = static_cast<int>(order); });
  command.add_choice("--format", {"csv", "json"}, "Format of the rows [csv]",
                     [options](const std::string& name) { options->format = name; });
  add_reading(command, options->load);
  add_common(command, session.common);
  command.footer = eval_footer;
  command.choose = [options, &session] {
    check_input(options->load);
    if (options->team) check_input_of_team(options->load);
    const std::string extension = "." + options->format;
    const Plan plan = plan_jobs(options->load.files, options->output, {"--output", extension});
    check_overwriting("--output", plan.outputs(), {options->places});
    session.choose(plan, options, run_eval);
  };
}

}  // namespace tessera::cli
