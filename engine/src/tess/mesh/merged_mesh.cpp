#include "tess/mesh/merged_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/function_ref.h"
#include "base/impl_access.h"
#include "tess/cells/parameter_map.h"
#include "tess/edges/position_bits.h"
#include "tess/write/mesh_views.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Numbers the distinct vertices, by a hash table with open addressing of the first vertex at each place.
template <class T>
void number(const std::vector<T>& positions, const std::vector<float>& normals,
            FunctionRef<bool(std::size_t, std::size_t)> have_same_parameters, std::vector<std::uint32_t>& numbers,
            std::vector<std::uint32_t>& sources) {
  const std::size_t count = positions.size() / 3;
  std::vector<std::uint32_t> table(std::bit_ceil(2 * count + 1), no_id);
  const auto is_same = [&](std::size_t a, std::size_t b) {
    return position_bits(&positions[3 * a]) == position_bits(&positions[3 * b]) &&
           (normals.empty() || position_bits(&normals[3 * a]) == position_bits(&normals[3 * b])) &&
           have_same_parameters(a, b);
  };
  numbers.resize(count);
  sources.clear();
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t slot = hash(position_bits(&positions[3 * k])) & (table.size() - 1);
    while (table[slot] != no_id && !is_same(table[slot], k)) slot = (slot + 1) & (table.size() - 1);
    if (table[slot] == no_id) {
      table[slot] = static_cast<std::uint32_t>(k);
      numbers[k] = static_cast<std::uint32_t>(sources.size());
      sources.push_back(static_cast<std::uint32_t>(k));
    } else {
      numbers[k] = numbers[table[slot]];
    }
  }
}

}  // namespace

Result<std::unique_ptr<Tessellation::Impl>> MergedMesh::make(const PatchSet& set, const TessellationOptions& options,
                                                             const Execution& execution) {
  Result<std::unique_ptr<ProvenMesh>> own = ProvenMesh::make(set, options, nullptr, execution);
  if (!own) return own.status();
  std::unique_ptr<MergedMesh> mesh(new MergedMesh(*std::move(own), options));
  if (Status status = mesh->find(set, {.cancel = execution.cancel}); !status.ok()) return status;
  return std::unique_ptr<Tessellation::Impl>(std::move(mesh));
}

Status MergedMesh::find(const PatchSet& set, const Execution& execution) {
  Mesh all = own_->allocate();
  if (Status status = own_->run(set, all.views(), execution); !status.ok()) return status;
  (void)renumber(set, all);
  return {};
}

std::vector<MergedMesh::Origin> MergedMesh::origins(const PatchSet& set) const {
  std::vector<Origin> origins;
  if (!parameters_) return origins;
  const ParameterMaps maps(impl_of(set), *parameters_);
  for (std::size_t patch = 0; patch < set.patch_count(); ++patch) {
    const Domain of = maps.of(patch).to;
    origins.resize(own_->before(patch + 1).vertices, {set.source(patch).surface, of.u1 - of.u0, of.v1 - of.v0});
  }
  return origins;
}

bool MergedMesh::renumber(const PatchSet& set, const Mesh& all) {
  const std::vector<float>& normals = has_normals_ ? all.normals : no_normals_;
  std::vector<std::uint32_t> numbers, sources;
  const std::vector<Origin> from = origins(set);
  const auto have_same_parameters = [&](std::size_t a, std::size_t b) {
    constexpr double near = 0x1p-16;  // of a patch: above the rounding of floats, far below a segment
    const auto apart = [&](std::size_t c) {
      return std::abs(double(all.parameters[2 * a + c]) - double(all.parameters[2 * b + c]));
    };
    return !parameters_ || (from[a].surface == from[b].surface && apart(0) <= near * std::min(from[a].u, from[b].u) &&
                            apart(1) <= near * std::min(from[a].v, from[b].v));
  };
  if (all.model_positions.empty())
    number(all.positions, normals, have_same_parameters, numbers, sources);
  else
    number(all.model_positions, normals, have_same_parameters, numbers, sources);
  const bool is_same = numbers == numbers_;
  numbers_ = std::move(numbers);
  sources_ = std::move(sources);
  is_stale_ = false;
  return is_same;
}

std::vector<EdgeVertex> MergedMesh::edge_vertices() const {
  std::vector<EdgeVertex> all = own_->edge_vertices();
  for (EdgeVertex& one : all) one.vertex = numbers_[one.vertex];
  const auto is_same = [](const EdgeVertex& a, const EdgeVertex& b) {
    return a.use == b.use && a.s == b.s && a.vertex == b.vertex;
  };
  all.erase(std::ranges::unique(all, is_same).begin(), all.end());
  return all;
}

MeshCapacity MergedMesh::capacity() const {
  MeshCapacity capacity = own_->capacity();
  capacity.vertices = sources_.size();
  return capacity;
}

Mesh MergedMesh::allocate() const {
  Mesh mesh = own_->allocate();
  for (std::vector<float>* values : {&mesh.positions, &mesh.normals})
    if (!values->empty()) values->resize(3 * sources_.size());
  if (!mesh.model_positions.empty()) mesh.model_positions.resize(3 * sources_.size());
  if (!mesh.parameters.empty()) mesh.parameters.resize(2 * sources_.size());
  if (!has_normals_) mesh.normals.clear();
  if (!parameters_) mesh.parameters.clear();
  return mesh;
}

Status MergedMesh::check(const MeshViews& out) const {
  if (Status status = check_views(out, capacity(), own_->has_f64_positions()); !status.ok()) return status;
  return check_attributes(out);
}

Status MergedMesh::check_attributes(const MeshViews& out) const {
  if (!out.normal.empty() && !has_normals_)
    return {StatusCode::invalid_argument, "normals of shared vertices need a crease angle"};
  if (!out.parameter.empty() && !parameters_)
    return {StatusCode::invalid_argument,
            "the plan has no parameters of shared vertices: ask for them when it is made"};
  return {};
}

MeshViews MergedMesh::views_for(const MeshViews& out, Mesh& own) const {
  const std::size_t count = numbers_.size();
  own.positions.resize(out.position.empty() ? 0 : 3 * count);
  own.normals.resize(out.normal.empty() ? 0 : 3 * count);
  own.parameters.resize(out.parameter.empty() ? 0 : 2 * count);
  own.model_positions.resize(out.model_position.empty() ? 0 : 3 * count);
  MeshViews views = own.views();
  if (out.position.empty()) views.position = {};
  views.patch = out.patch, views.indices = out.indices;
  views.quads = out.quads, views.quad_patch = out.quad_patch;
  return views;
}

void MergedMesh::gather(const MeshViews& own, const MeshViews& out) const {
  const auto take = [](const auto& from, std::size_t source, const auto& to, std::size_t vertex, int components) {
    for (int c = 0; c < components; ++c) to.at(vertex, c) = from.at(source, c);
  };
  for (std::size_t vertex = 0; vertex < sources_.size(); ++vertex) {
    if (!out.position.empty()) take(own.position, sources_[vertex], out.position, vertex, 3);
    if (!out.normal.empty()) take(own.normal, sources_[vertex], out.normal, vertex, 3);
    if (!out.model_position.empty()) take(own.model_position, sources_[vertex], out.model_position, vertex, 3);
    if (!out.parameter.empty()) take(own.parameter, sources_[vertex], out.parameter, vertex, 2);
  }
}

Status MergedMesh::run(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
  if (is_stale_) return {StatusCode::stale, "an update did not end: update the mesh again"};
  if (Status status = check(out); !status.ok()) return status;
  Mesh own;
  const MeshViews views = views_for(out, own);
  if (Status status = own_->run(set, views, execution); !status.ok()) return status;
  gather(views, out);
  const MeshCapacity size = capacity();
  for (std::uint32_t& corner : out.indices.first(3 * size.triangles)) corner = numbers_[corner];
  for (std::uint32_t& corner : out.quads.first(out.quads.empty() ? 0 : 4 * size.quads)) corner = numbers_[corner];
  return {};
}

Result<MeshChange> MergedMesh::update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                                      const Execution& execution) {
  if (!is_stale_)
    if (Status status = check_updated_views(out, capacity(), own_->has_f64_positions()); !status.ok()) return status;
  if (Status status = check_attributes(out); !status.ok()) return status;
  Mesh all = own_->allocate();
  const bool was_stale = std::exchange(is_stale_, true);
  Result<MeshChange> change = own_->update(set, edits, all.views(), execution);
  if (!change) {
    is_stale_ = was_stale;
    return change;
  }
  if (change->topology || was_stale) {
    change->topology = true;
    if (Status status = find(set, {.cancel = execution.cancel}); !status.ok()) return status;
  } else if (renumber(set, all)) {
    gather(all.views(), out);
  } else {
    *change = {true, std::max<std::size_t>(change->patches, 1)};
  }
  return change;
}

}}  // namespace tessera::abi_0_1
