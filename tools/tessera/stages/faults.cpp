#include "stages/faults.h"

#include <algorithm>

#include "tessera/topology.h"

namespace tessera::cli {
namespace {

/// Whether a shape has shells, and all are closed.
Result<bool> is_closed(const Shape& shape) {
  const Result<std::vector<bool>> shells = closed_shells(shape);
  if (!shells) return shells.status();
  std::size_t faces = 0;
  for (const Shell& shell : shape.shells) faces += shell.faces.size();
  return !shells->empty() && faces >= shape.faces.size() && std::ranges::find(*shells, false) == shells->end();
}

/// Adds the open edges of a mesh that should have none.
Status add_open(const Mesh& mesh, std::size_t& open, std::size_t& meshes) {
  if (mesh.triangle_count() + mesh.quad_count() == 0) return {};
  const Result<MeshReport> report = check(mesh);
  if (!report) return report.status();
  open += report->open_edges + report->non_manifold_edges;
  meshes += report->open_edges + report->non_manifold_edges > 0;
  return {};
}

/// Counts the open edges of all meshes of closed shapes, and these meshes.
Status count_open(const Model& model, const Meshed& made, std::size_t& open, std::size_t& meshes) {
  bool are_all_closed = !model.shapes.empty();
  for (std::size_t k = 0; k < model.shapes.size(); ++k) {
    const Result<bool> closed = is_closed(model.shapes[k]);
    if (!closed) return closed.status();
    are_all_closed &= *closed;
    if (*closed && made.by_shapes)
      if (Status status = add_open(made.assembly.shapes[k].mesh, open, meshes); !status.ok()) return status;
  }
  return are_all_closed && !made.by_shapes ? add_open(made.mesh, open, meshes) : Status();
}

/// Whether the numbers of the file are too coarse for the tolerances.
bool is_too_coarse(const Meshed& made) { return !made.keeps_tolerances && made.rough.empty(); }

}  // namespace

void warn_of_rounding(const std::string& output, const Meshed& made) {
  if (!is_too_coarse(made)) return;
  warn(output + ": floats of this file move vertices by up to " + readable(made.rounding, 3) +
       " because the model lies far from zero, so it does not keep the tolerance; .glb does, and .ply and .obj with "
       "positions in double");
}

void warn_of_surfaces(const Loaded& loaded, const Meshed& made) {
  const auto say = [&](std::size_t surface, const std::string& what) {
    warn(loaded.in_surface(surface, {StatusCode::unsupported, what}).message());
  };
  for (const std::size_t surface : made.crossed)
    say(surface, "its trimming loops cannot be made a polygon: parts of it are left out");
  for (const RoughSurface& rough : made.rough)
    say(rough.surface,
        "it cannot keep the tolerance, because of rough trimming loops, the rounding of positions, or the limit of "
        "segments: its mesh is proven to lie within " +
            readable(rough.bound, 3));
}

std::vector<std::string> mesh_faults(const MeshOptions& options, const std::vector<std::string>& warnings,
                                     const Meshed& made) {
  std::vector<std::string> faults;
  if (!options.strict) return faults;
  if (!warnings.empty()) faults.push_back(counted(warnings.size(), "part") + " of the file skipped or changed");
  if (made.whole_faces > 0)
    faults.push_back(counted(made.whole_faces, "surface") + " whole, because loops could not be used");
  if (!made.crossed.empty())
    faults.push_back(counted(made.crossed.size(), "surface") + " left out in part, because loops are no polygon");
  if (!made.rough.empty()) faults.push_back(counted(made.rough.size(), "surface") + " beyond the tolerance");
  if (!made.proven) faults.push_back("the bound is sampled, not proven");
  if (is_too_coarse(made)) faults.push_back("the numbers of the file are too coarse for the tolerance");
  if (made.patches_without_angle > 0)
    faults.push_back(counted(made.patches_without_angle, "patch", "patches") + " without a proven angle");
  return faults;
}

Result<std::vector<std::string>> mesh_faults(const MeshOptions& options, const Model& model, const Meshed& made) {
  std::vector<std::string> faults = mesh_faults(options, model.warnings, made);
  if (!options.strict) return faults;
  std::size_t open = 0, meshes = 0;
  if (Status status = count_open(model, made, open, meshes); !status.ok()) return status;
  if (open > 0) faults.push_back(counted(open, "open edge") + " in the mesh of " + counted(meshes, "closed shape"));
  return faults;
}

Status complain_of(const std::string& output, const std::vector<std::string>& faults) {
  if (faults.empty()) return {};
  std::string text;
  for (const std::string& fault : faults) text += (text.empty() ? "" : "; ") + fault;
  complain(output + ": the mesh is written, but not as --strict demands: " + text);
  return already_said(StatusCode::invalid_argument);
}

}  // namespace tessera::cli
