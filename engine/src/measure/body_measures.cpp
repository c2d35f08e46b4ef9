// Volumes, centroids and inertia of solids.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/text.h"
#include "measure/body_sums.h"
#include "measure/shape_integrals.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"
#include "tessera/measures.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The shells of a solid, or one shell of none.
struct ShellGroup {
  std::uint32_t solid = no_id, shell = no_id;
  std::vector<std::size_t> shells;
};

/// Groups the shells of a shape. Errors: invalid_argument (a solid that is open).
Result<std::vector<ShellGroup>> groups_of(const Shape& shape) {
  std::vector<ShellGroup> groups;
  for (std::uint32_t solid = 0; solid < shape.solid_count; ++solid) groups.push_back({solid, no_id, {}});
  for (std::size_t k = 0; k < shape.shells.size(); ++k) {
    const Shell& shell = shape.shells[k];
    const std::string open = open_edges_of(shape, shell.faces);
    if (shell.solid != no_id) {
      if (!open.empty())
        return Status(StatusCode::invalid_argument, "solid " + std::to_string(shell.solid) + ": " + open,
                      static_cast<std::ptrdiff_t>(shell.solid));
      groups[shell.solid].shells.push_back(k);
    } else if (open.empty()) {
      groups.push_back({no_id, static_cast<std::uint32_t>(k), {k}});
    }
  }
  std::erase_if(groups, [](const ShellGroup& group) { return group.shells.empty(); });
  return groups;
}

/// Puts skins together: those within the largest bound cavities.
BodyMeasures body_of(std::vector<Skin> skins, const Vec3& centre) {
  std::ranges::stable_sort(skins, std::greater<>(), [](const Skin& skin) { return skin.moments.value[0]; });
  const Box3& outer = skins.front().box;
  const double slack = 1e-6 * outer.diagonal();
  const Box3 around{outer.lower - Vec3{slack, slack, slack}, outer.upper + Vec3{slack, slack, slack}};
  ExactSums sums;
  Box3 box;
  double gap = 0;
  bool proven = true;
  for (std::size_t k = 0; k < skins.size(); ++k) {
    Integrals moments = skins[k].moments;
    const double sign = k > 0 && around.contains(skins[k].box) ? -1 : 1;
    sums.add(moments, sign);
    box.extend(skins[k].box);
    gap = std::max(gap, skins[k].gap);
    proven = proven && skins[k].proven;
  }
  BodyMeasures body = body_of(sums.sums(), centre, box);
  body.gap = gap, body.proven = proven;
  return body;
}

Result<std::vector<BodyMeasures>> solids_of(const Shape& shape, const MeasureOptions& options,
                                            const Execution& execution) {
  const Result<std::vector<ShellGroup>> groups = groups_of(shape);
  if (!groups) return groups.status();
  std::vector<bool> needed(shape.faces.size());
  for (const ShellGroup& group : *groups)
    for (const std::size_t shell : group.shells)
      for (const std::uint32_t face : shape.shells[shell].faces) needed[face] = true;
  std::vector<BodyMeasures> bodies;
  if (groups->empty()) return bodies;
  ShapeIntegrals integrals(shape);
  if (Status status = integrals.run(needed, options, execution); !status.ok()) return status;
  for (const ShellGroup& group : *groups) {
    const std::string name =
        group.solid != no_id ? "solid " + std::to_string(group.solid) : "shell " + std::to_string(group.shell);
    std::vector<Skin> skins;
    for (const std::size_t shell : group.shells)
      if (Status status = integrals.add_skins(shape.shells[shell], skins); !status.ok())
        return Status(status.code(), name + ": " + status.message(),
                      group.solid != no_id ? static_cast<std::ptrdiff_t>(group.solid) : Status::no_index);
    BodyMeasures body = body_of(std::move(skins), integrals.centre());
    body.solid = group.solid, body.shell = group.shell;
    if (!std::isfinite(body.volume.value + body.volume.error))
      return Status(StatusCode::invalid_argument, name + ": its volume is beyond the range of numbers");
    bodies.push_back(body);
  }
  return bodies;
}

/// "shape 2 (nut): ...".
Status in_shape(const Model& model, std::size_t shape, const Status& status) {
  const std::string& name = *model.shapes[shape].name;
  return Status(status.code(),
                "shape " + std::to_string(shape) + (name.empty() ? "" : " (" + name + ")") + ": " + status.message(),
                static_cast<std::ptrdiff_t>(shape));
}

}  // namespace

Result<std::vector<BodyMeasures>> measure_solids(const Shape& shape, const MeasureOptions& options,
                                                 const Execution& execution) {
  return guarded([&]() -> Result<std::vector<BodyMeasures>> {
    if (Status status = check_options(options); !status.ok()) return status;
    if (Status status = check_topology(shape); !status.ok()) return status;
    return solids_of(shape, options, execution);
  });
}

Result<std::vector<BodyMeasures>> measure_solids(const Model& model, const MeasureOptions& options,
                                                 const Execution& execution) {
  return guarded([&]() -> Result<std::vector<BodyMeasures>> {
    if (Status status = check_options(options); !status.ok()) return status;
    if (Status status = check_topology(model); !status.ok()) return status;
    std::vector<bool> is_used(model.shapes.size());
    for (const Instance& instance : model.instances) is_used[instance.shape] = true;
    std::vector<std::vector<BodyMeasures>> of_shapes(model.shapes.size());
    Execution shapes{.cancel = execution.cancel, .progress = {}, .report = execution.report};
    for (std::size_t k = 0; k < model.shapes.size(); ++k) {
      if (!is_used[k]) continue;
      Result<std::vector<BodyMeasures>> found = solids_of(model.shapes[k], options, shapes);
      if (!found) return in_shape(model, k, found.status());
      of_shapes[k] = *std::move(found);
      if (execution.progress && k + 1 < model.shapes.size())
        execution.progress(static_cast<double>(k + 1) / static_cast<double>(model.shapes.size()));
    }
    std::vector<BodyMeasures> all;
    for (std::size_t k = 0; k < model.instances.size(); ++k)
      for (const BodyMeasures& body : of_shapes[model.instances[k].shape]) {
        all.push_back(placed(body, *model.instances[k].placement));
        all.back().instance = static_cast<std::uint32_t>(k), all.back().shape = model.instances[k].shape;
      }
    if (execution.progress) execution.progress(1);
    return all;
  });
}

Result<BodyMeasures> measure_enclosed(std::span<const ModelSurface> surfaces, const MeasureOptions& options,
                                      const Execution& execution) {
  return guarded([&]() -> Result<BodyMeasures> {
    if (Status status = check_options(options); !status.ok()) return status;
    if (surfaces.empty()) return Status(StatusCode::invalid_argument, "there are no surfaces");
    Shape shape;
    Shell shell;
    for (const ModelSurface& surface : surfaces) {
      shell.faces.push_back(static_cast<std::uint32_t>(shape.faces.size()));
      shape.faces.push_back({surface});
      std::vector<TrimLoop> loops = *surface.trims;
      for (TrimLoop& loop : loops) loop.coedges.clear();
      shape.faces.back().trims = std::move(loops);
    }
    ShapeIntegrals integrals(shape);
    Status status = integrals.run(std::vector<bool>(surfaces.size(), true), options, execution);
    if (!status.ok()) return status;
    Skin skin = integrals.whole_skin();
    BodyMeasures body = body_of(std::vector{std::move(skin)}, integrals.centre());
    if (!std::isfinite(body.volume.value + body.volume.error))
      return Status(StatusCode::invalid_argument, "the volume is beyond the range of numbers");
    return body;
  });
}

}}  // namespace tessera::abi_0_1
