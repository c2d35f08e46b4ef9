// tessera info: what a model holds.

#include <map>
#include <memory>
#include <sstream>

#include "commands.h"
#include "console.h"
#include "model_file.h"
#include "tessera/isa.h"

namespace tessera::cli {
namespace {

struct Options {
  ModelFile model;
  bool json = false;
};

struct Summary {
  std::map<std::string_view, std::size_t> kinds;       // -> surfaces
  std::map<std::pair<int, int>, std::size_t> degrees;  // (along u, along v) -> patches
  std::size_t rational = 0, control_points = 0;
  std::size_t collapsed_edges = 0, patches_with_collapsed_edges = 0;
};

Summary summarize(const Model& model, const PatchSet& set) {
  Summary summary;
  for (const ModelSurface& surface : model.surfaces) ++summary.kinds[kind_name(surface.surface)];
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const BezierPatch& patch = set.patch(k);
    ++summary.degrees[{patch.degree_u(), patch.degree_v()}];
    summary.rational += patch.is_rational();
    summary.control_points += patch.points().size();
    const EdgeMask collapsed = patch.collapsed_edges();
    for (const Edge edge : {Edge::u0, Edge::u1, Edge::v0, Edge::v1}) summary.collapsed_edges += collapsed.has(edge);
    summary.patches_with_collapsed_edges += collapsed.any();
  }
  return summary;
}

Json to_json(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

Json as_json(const Options& options, const Model& model, const PatchSet& set, Isa used) {
  const Summary summary = summarize(model, set);
  Json kinds = Json::object(), degrees = Json::array(), isas = Json::array();
  for (const auto& [kind, count] : summary.kinds) kinds[std::string(kind)] = count;
  for (const auto& [degree, count] : summary.degrees) {
    degrees.push_back({{"degree_u", degree.first}, {"degree_v", degree.second}, {"patches", count}});
  }
  for (const Isa isa : available_isas()) isas.push_back(std::string(name(isa)));
  return {{"model", options.model.path},
          {"name", model.name},
          {"surfaces", model.surfaces.size()},
          {"kinds", kinds},
          {"patches", set.patch_count()},
          {"degrees", degrees},
          {"rational_patches", summary.rational},
          {"collapsed_edges", summary.collapsed_edges},
          {"patches_with_collapsed_edges", summary.patches_with_collapsed_edges},
          {"control_points", summary.control_points},
          {"fit_error", fit_json(set)},
          {"box", {{"lower", to_json(set.box().lower)}, {"upper", to_json(set.box().upper)}}},
          {"size", set.box().diagonal()},
          {"memory_bytes", set.memory_bytes()},
          {"warnings", warnings_json(model)},
          {"isa", {{"available", isas}, {"used", std::string(name(used))}}}};
}

std::string as_text(const Options& options, const Model& model, const PatchSet& set, Isa used) {
  const Summary summary = summarize(model, set);
  const auto point = [](const Vec3& v) {
    return "(" + readable(v.x) + ", " + readable(v.y) + ", " + readable(v.z) + ")";
  };
  std::ostringstream text;
  text << options.model.path << ": " << model.surfaces.size() << " surfaces, " << set.patch_count()
       << " Bezier patches\n  kinds            ";
  const char* between = "";
  for (const auto& [kind, count] : summary.kinds) {
    text << between << count << ' ' << kind;
    between = ", ";
  }
  text << "\n  degrees          ";
  between = "";
  for (const auto& [degree, count] : summary.degrees) {
    text << between << count << " of " << degree.first << " x " << degree.second;
    between = ", ";
  }
  text << "\n  rational         " << summary.rational << "\n  collapsed edges  " << summary.collapsed_edges << " on "
       << summary.patches_with_collapsed_edges << " patches\n  control points   " << summary.control_points
       << "\n  bounding box     " << point(set.box().lower) << " to " << point(set.box().upper)
       << ", of the control points"
       << "\n  memory           " << set.memory_bytes() << " bytes, packed\n  instruction set  " << name(used)
       << ", of";
  for (const Isa isa : available_isas()) text << ' ' << name(isa);
  text << '\n' << fit_line(set);
  return std::move(text).str();
}

Status run_info(const Options& options) {
  const Result<Model> model = open_model(options.model);
  if (!model) return model.status();
  const Result<PatchSet> set = make_patch_set(options.model, *model);
  if (!set) return set.status();
  const Result<Isa> used = default_isa();
  if (!used) return used.status();
  if (options.json) return print_json(as_json(options, *model, *set, *used));
  return print(as_text(options, *model, *set, *used));
}

}  // namespace

void add_info(CLI::App& app, Session& session) {
  CLI::App* const command = app.add_subcommand("info", "Say what a model holds");
  const auto options = std::make_shared<Options>();
  add_model(*command, options->model);
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer("Example:\n  tessera info teapot.bpt --json");
  command->callback([options, &session] { session.command = [options] { return run_info(*options); }; });
}

}  // namespace tessera::cli
