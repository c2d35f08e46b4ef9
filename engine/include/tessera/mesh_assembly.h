#pragma once
// Meshes that stand in many places: the mesh of each shape of a model, made once, and its instances.
//
// Memory: results own theirs, arguments are not kept. Threads: any number of calls at once on const objects.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tessera/colour.h"
#include "tessera/geometry.h"
#include "tessera/mesh.h"
#include "tessera/model.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The mesh of a shape, in the shape's own space. Parts may have colours.
struct ShapeMesh {
  std::string name = {};  ///< may be empty
  Mesh mesh = {};         ///< without faces: its instances have a name and a place only
};

/// A mesh at its place.
struct MeshInstance {
  std::string name = {};              ///< may be empty
  std::size_t shape = 0;              ///< index into MeshAssembly::shapes
  Affine placement = {};              ///< from the shape's space to the assembly's
  std::optional<Colour> colour = {};  ///< for parts without a colour of their own
};

/// The meshes of shapes and the places where they stand, as write_assembly() of io.h writes them.
///
///   MeshAssembly assembly = *instances_of(model);  // and then, for each shape k:
///   auto set = make_patch_set(model.shapes[k]);
///   auto plan = Tessellation::make(*set, {.tolerance = 1e-3});
///   Mesh& mesh = assembly.shapes[k].mesh = *plan->allocate();
///   plan->run(*set, mesh.views());
///   mesh.parts = *parts_by_face(mesh, *set, model.shapes[k]);
///
/// A bound of a shape's mesh, times Affine::norm_bound() of the placement, is that of an instance.
struct MeshAssembly {
  std::string name = {};                     ///< may be empty
  std::vector<ShapeMesh> shapes = {};        ///< each stored once in glTF
  std::vector<MeshInstance> instances = {};  ///< of all shapes
  std::string unit = {};                     ///< of all lengths, as in Model::unit; empty: none is stated
};

/// Returns the names, places, colours and the unit of a model's shapes and instances, with meshes that are empty.
///
/// Errors: invalid_argument (an instance of no shape; index = the instance).
Result<MeshAssembly> instances_of(const Model& model);

/// Returns Mesh::parts by faces, as parts_by_surface() does: one part for each run of triangles and quads of one face.
///
/// - `set`: the set that mesh.patches refers to, made of `shape`.
///
/// A part has the name of its face, or "face 3" if that name is empty, and the face's colour.
///
/// Errors: count_mismatch (not one patch per triangle and per quad), invalid_argument (no such patch in the set, or no
/// such face in the shape; index = the triangle or quad).
Result<std::vector<MeshPart>> parts_by_face(const Mesh& mesh, const PatchSet& set, const Shape& shape);

/// Returns one mesh of all instances, in the assembly's space, for formats without instances.
///
/// - The origin is the centre of the box of all vertices. A single instance that is not moved keeps its mesh as it is.
/// - Positions are rounded once more to float: they move by at most 2^-25 of the box's diagonal. Positions in double
///   move by a few units in their last place, and are kept if all meshes have them.
/// - Normals turn with the inverse transpose of the placement. Faces turn around where the placement mirrors.
/// - Normals and parameters are kept if all meshes have them. Patches are not.
/// - Parts: those of each instance, named "instance/part". A mesh without parts becomes one, with the instance's name.
///
/// Errors: invalid_argument (an instance of no shape; index = the instance), non_finite (a placement, index = the
/// instance; instances that together are beyond the range of float), those that write_mesh() reports for a mesh (index
/// = the shape), count_mismatch (more than 2^32 - 1 vertices).
Result<Mesh> flatten(const MeshAssembly& assembly);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
