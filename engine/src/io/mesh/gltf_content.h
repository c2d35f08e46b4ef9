#pragma once
// The content of a glTF file that is written: numbers in one buffer, materials of colours, meshes and nodes.

#include <tiny_gltf.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/colour.h"
#include "tessera/geometry.h"
#include "tessera/mesh.h"

namespace tessera { inline namespace abi_0_1 {

/// Builds a file of one scene with one node at its top. For meshes of triangles that are valid.
class GltfContent {
 public:
  /// `bytes`: the sum of byte_count() of all meshes that will be added.
  explicit GltfContent(std::size_t bytes);

  /// The bytes of a mesh in the buffer.
  static std::size_t byte_count(const Mesh& mesh) {
    return 4 * (mesh.positions.size() + mesh.normals.size() + mesh.parameters.size() + mesh.indices.size());
  }

  /// The node that holds all others.
  tinygltf::Node& root() { return model_.nodes[0]; }
  /// Names a node. Bytes of the name that are not UTF-8 become U+FFFD.
  static void name(tinygltf::Node& node, const std::string& name);
  /// Adds a child of the root. The node may move when another one is added.
  tinygltf::Node& add_node(const std::string& name);
  /// Adds a mesh of these primitives, and returns its index.
  int add_mesh(const std::string& name, std::vector<tinygltf::Primitive> primitives);
  /// The material of a colour; without a colour a grey one.
  int material(const std::optional<Colour>& colour);

  /// Adds the vertices of a mesh: positions, normals of unit length, parameters. Its primitives come next, before
  /// another mesh.
  void add_vertices(const Mesh& mesh);
  /// Adds a primitive without a material: triangles of the mesh whose vertices were added last. It refers to the
  /// vertices from `first` on, `count` of them, so primitives may share vertices and none is stored twice.
  tinygltf::Primitive add_primitive(std::span<const std::uint32_t> indices, std::size_t first, std::size_t count);

  tinygltf::Model take() && { return std::move(model_); }

 private:
  /// The accessors of a range of vertices; -1: the mesh lacks the attribute.
  struct Accessors {
    int positions = -1, normals = -1, parameters = -1;
  };
  /// Where the vertices and indices of the last mesh lie.
  struct Views {
    int positions = -1, normals = -1, parameters = -1, indices = -1;
  };

  tinygltf::BufferView view(int target, std::size_t bytes) const;
  int add_view(const std::vector<float>& values, std::size_t components);
  int add_accessor(int view, int type, int component, std::size_t offset, std::size_t count);
  int add_vertex_accessor(int view, int type, std::size_t first, std::size_t count);
  Accessors accessors(std::size_t first, std::size_t count);
  void add_box(tinygltf::Accessor& accessor, std::size_t first, std::size_t count) const;
  void append(const void* values, std::size_t bytes);

  tinygltf::Model model_;
  const Mesh* mesh_ = nullptr;
  Views views_;
  std::map<std::pair<std::size_t, std::size_t>, Accessors> ranges_;  ///< of mesh_, by first and count
  std::map<std::array<float, 4>, int> materials_;                    ///< by colour
};

}}  // namespace tessera::abi_0_1
