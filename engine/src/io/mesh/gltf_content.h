#pragma once
// The content of a glTF file that is written: numbers in one buffer, materials of colours, meshes and nodes.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/function_ref.h"
#include "io/file/output_file.h"
#include "tessera/colour.h"
#include "tessera/geometry.h"
#include "tessera/mesh.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Triangles with one material: indices of accessors, -1 for attributes that the mesh lacks, and of the material.
struct GltfPrimitive {
  int positions = -1, normals = -1, parameters = -1, indices = -1, material = 0;
};

/// Where a node stands, and what it shows.
struct GltfNode {
  std::string_view name = {};
  int mesh = -1;          ///< -1: none
  Affine placement = {};  ///< of the mesh, whose vertices are relative to the origin
  Vec3 origin = {};
};

/// Builds a file of one scene with one node at its top. For meshes of triangles that are valid. Numbers are not copied:
/// write() takes them from the meshes, which must live until then.
class GltfContent {
 public:
  /// The bytes of a mesh in the buffer.
  static std::size_t byte_count(const Mesh& mesh) {
    return 4 * (mesh.positions.size() + mesh.normals.size() + mesh.parameters.size() + mesh.indices.size());
  }

  /// The node at the top, whose name must live until write().
  explicit GltfContent(const GltfNode& root);
  /// Adds a node below the top. Bytes of names that are not UTF-8 become U+FFFD.
  void add_node(const GltfNode& node);
  /// Adds a mesh of these primitives, and returns its index.
  int add_mesh(std::string_view name, std::span<const GltfPrimitive> primitives);
  /// The material of a colour; without a colour a grey one, which is 0.
  int material(const std::optional<Colour>& colour);

  /// Adds the vertices of a mesh: positions, normals of unit length, parameters. Its primitives come next, before
  /// another mesh.
  void add_vertices(const Mesh& mesh);
  /// Runs of the indices of a mesh, one after the other.
  using IndexRuns = std::vector<std::span<const std::uint32_t>>;
  /// Adds a primitive without a material: triangles of the mesh whose vertices were added last. It refers to the
  /// vertices from `first` on, `count` of them, so primitives may share vertices and none is stored twice.
  GltfPrimitive add_primitive(IndexRuns indices, std::size_t first, std::size_t count);

  /// Writes the file, as .glb or as .gltf with the numbers in base64. `packed`: whether the numbers are packed by
  /// EXT_meshopt_compression, all of them before any is written. Failures are the file's. Errors: unsupported (a build
  /// without meshoptimizer), out_of_memory.
  Status write(OutputFile& out, bool binary, bool packed) const;

 private:
  /// Objects of an array in JSON, as text.
  struct Objects {
    std::string text;
    int count = 0;
    /// Appends an object: texts as they are, numbers in the shortest form. Returns its index.
    template <class... Parts>
    int add(const Parts&... parts);
  };
  /// The accessors of a range of vertices, or the views of the last mesh; -1: the mesh lacks the attribute.
  struct Attributes {
    int positions = -1, normals = -1, parameters = -1;
  };
  /// A run of the buffer's bytes: vectors, or indices, which have 0 components.
  struct View {
    std::size_t begin, count, components;
    std::size_t stride() const { return 4 * std::max<std::size_t>(components, 1); }
    std::size_t bytes() const { return 4 * count; }
  };
  /// A part of the buffer: the normals of a mesh, made of unit length, other numbers, or indices less the first vertex.
  struct Numbers {
    int view;
    const Mesh* normals_of = nullptr;
    std::span<const float> values = {};
    IndexRuns indices = {};
    std::uint32_t first_vertex = 0;
  };

  int add_view(std::size_t count, std::size_t components);
  int add_vertex_accessor(int view, std::size_t components, std::size_t first, std::size_t count);
  const Attributes& attributes(std::size_t first, std::size_t count);
  std::string packed_view(std::size_t view) const;
  std::string views_json(std::span<const std::string> packed) const;
  std::array<std::string, 2> json(bool binary, std::span<const std::string> packed) const;
  static void write_numbers(const Numbers& numbers, FunctionRef<void(std::string_view)> write);

  GltfNode root_;
  Objects nodes_, meshes_, materials_, accessors_;
  std::vector<View> views_;
  std::vector<Numbers> numbers_;  ///< by view
  std::size_t bytes_ = 0;         ///< of the buffer so far
  const Mesh* mesh_ = nullptr;
  Attributes mesh_views_;
  int index_view_ = -1;                                               ///< of mesh_
  std::size_t index_bytes_ = 0;                                       ///< of mesh_ so far
  std::map<std::pair<std::size_t, std::size_t>, Attributes> ranges_;  ///< of mesh_, by first and count
  std::map<std::array<float, 4>, int> colours_;                       ///< materials
};

}}  // namespace tessera::abi_0_1
