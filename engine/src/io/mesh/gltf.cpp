// glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021) by tinygltf. All numbers lie in one buffer: positions, normals
// and parameters of all vertices, then the indices. A part refers to the range of vertices that its indices span, so
// parts may share vertices and none is stored twice.

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <streambuf>
#include <string>

#include "io/mesh/mesh_formats.h"

namespace tessera::inline abi_0_1 {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is written in the machine's own byte order");

constexpr std::size_t max_bytes = std::numeric_limits<std::int32_t>::max();  // tinygltf keeps offsets in int

/// Passes tinygltf's output to the file, which remembers failures.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(OutputFile& out) : out_(out) {}

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    out_.write({bytes, static_cast<std::size_t>(count)});
    return count;
  }
  int_type overflow(int_type c) override {
    if (!traits_type::eq_int_type(c, traits_type::eof())) out_.write(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }

 private:
  OutputFile& out_;
};

/// JSON holds UTF-8 only: invalid bytes become U+FFFD.
std::string utf8(const std::string& name) {
  const std::string quoted = nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return nlohmann::json::parse(quoted).get<std::string>();
}

Vec3 vector_at(const std::vector<float>& values, std::size_t k) {
  return {values[3 * k], values[3 * k + 1], values[3 * k + 2]};
}

bool is_unit(const Vec3& normal) {
  constexpr double tolerance = 1e-3;  // of the squared length; the reference validator accepts 6.7e-3 of the length
  return std::abs(dot(normal, normal) - 1) <= tolerance;
}

/// The mesh's normals, of unit length. An undefined one becomes the mean of the triangles around, weighted by area, or
/// the z axis if that mean is undefined too.
std::vector<float> unit_normals(const Mesh& mesh) {
  std::vector<Vec3> sums(mesh.vertex_count());
  for (std::size_t k = 0; k < mesh.indices.size(); k += 3) {
    const Vec3 a = vector_at(mesh.positions, mesh.indices[k]), b = vector_at(mesh.positions, mesh.indices[k + 1]),
               c = vector_at(mesh.positions, mesh.indices[k + 2]);
    const Vec3 area = cross(b - a, c - a);
    for (std::size_t corner = 0; corner < 3; ++corner) sums[mesh.indices[k + corner]] += area;
  }
  std::vector<float> normals = mesh.normals;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    Vec3 normal = vector_at(mesh.normals, k);
    if (is_unit(normal)) continue;
    if (!(length(normal) > 0)) normal = sums[k];
    normal = length(normal) > 0 ? (1 / length(normal)) * normal : Vec3{0, 0, 1};
    normals[3 * k] = static_cast<float>(normal.x), normals[3 * k + 1] = static_cast<float>(normal.y);
    normals[3 * k + 2] = static_cast<float>(normal.z);
  }
  return normals;
}

bool are_unit(const std::vector<float>& normals) {
  for (std::size_t k = 0; k < normals.size() / 3; ++k)
    if (!is_unit(vector_at(normals, k))) return false;
  return true;
}

class GltfMesh {
 public:
  explicit GltfMesh(const Mesh& mesh) : mesh_(mesh), parts_(mesh.parts) {
    if (parts_.empty()) parts_.push_back({{}, 0, mesh.triangle_count()});
  }

  /// The size of the buffer.
  static std::size_t byte_count(const Mesh& mesh) {
    return 4 * (mesh.positions.size() + mesh.normals.size() + mesh.parameters.size() + mesh.indices.size());
  }

  tinygltf::Model make() && {
    model_.asset.generator = "Tessera";
    add_material();
    model_.buffers.resize(1);
    model_.buffers[0].data.reserve(byte_count(mesh_));
    positions_ = add_view(mesh_.positions, 3);
    if (!mesh_.normals.empty()) normals_ = add_view(are_unit(mesh_.normals) ? mesh_.normals : unit_normals(mesh_), 3);
    if (!mesh_.parameters.empty()) parameters_ = add_view(mesh_.parameters, 2);
    indices_ = static_cast<int>(model_.bufferViews.size());
    model_.bufferViews.push_back(view(TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, 4 * mesh_.indices.size()));
    add_root();
    for (const MeshPart& part : parts_)
      if (part.triangle_count > 0) add_part(part);
    return std::move(model_);
  }

 private:
  /// A grey material, seen from both sides: surfaces need not be closed.
  void add_material() {
    tinygltf::Material& material = model_.materials.emplace_back();
    material.doubleSided = true;
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.5;
    material.pbrMetallicRoughness.baseColorFactor = {0.8, 0.8, 0.8, 1};
  }

  /// A view of the next `bytes` of the buffer.
  tinygltf::BufferView view(int target, std::size_t bytes) const {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = model_.buffers[0].data.size();
    view.byteLength = bytes;
    view.target = target;
    return view;
  }

  int add_view(const std::vector<float>& values, std::size_t components) {
    tinygltf::BufferView added = view(TINYGLTF_TARGET_ARRAY_BUFFER, 4 * values.size());
    added.byteStride = 4 * components;
    model_.bufferViews.push_back(added);
    append(values.data(), values.size());
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  template <class T>
  void append(const T* values, std::size_t count) {
    std::vector<unsigned char>& bytes = model_.buffers[0].data;
    const std::size_t begin = bytes.size();
    bytes.resize(begin + count * sizeof(T));
    std::memcpy(bytes.data() + begin, values, count * sizeof(T));
  }

  /// Adds the node of the origin, the parent of all others.
  void add_root() {
    tinygltf::Node& root = model_.nodes.emplace_back();
    if (!(mesh_.origin == Vec3{})) root.translation = {mesh_.origin.x, mesh_.origin.y, mesh_.origin.z};
    model_.scenes.emplace_back().nodes = {0};
    model_.defaultScene = 0;
  }

  void add_part(const MeshPart& part) {
    const std::span indices = std::span(mesh_.indices).subspan(3 * part.first_triangle, 3 * part.triangle_count);
    const auto [least, most] = std::minmax_element(indices.begin(), indices.end());
    const std::size_t first = *least, count = *most - first + 1;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    primitive.attributes["POSITION"] = add_vertices(positions_, TINYGLTF_TYPE_VEC3, first, count);
    if (normals_ >= 0) primitive.attributes["NORMAL"] = add_vertices(normals_, TINYGLTF_TYPE_VEC3, first, count);
    if (parameters_ >= 0)
      primitive.attributes["TEXCOORD_0"] = add_vertices(parameters_, TINYGLTF_TYPE_VEC2, first, count);
    add_box(model_.accessors[static_cast<std::size_t>(primitive.attributes["POSITION"])], first, count);
    primitive.indices = add_indices(indices, *least);
    tinygltf::Node node;
    node.name = utf8(part.name);
    node.mesh = static_cast<int>(model_.meshes.size());
    tinygltf::Mesh& mesh = model_.meshes.emplace_back();
    mesh.name = node.name;
    mesh.primitives.push_back(std::move(primitive));
    model_.nodes[0].children.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
  }

  int add_accessor(int view, int type, int component, std::size_t offset, std::size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.byteOffset = offset;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }
  int add_vertices(int view, int type, std::size_t first, std::size_t count) {
    const std::size_t stride = model_.bufferViews[static_cast<std::size_t>(view)].byteStride;
    return add_accessor(view, type, TINYGLTF_COMPONENT_TYPE_FLOAT, first * stride, count);
  }
  /// Adds the indices of the part's triangles, counted from its first vertex.
  int add_indices(std::span<const std::uint32_t> indices, std::uint32_t first) {
    std::vector<std::uint32_t> own(indices.begin(), indices.end());
    for (std::uint32_t& index : own) index -= first;
    const std::size_t offset = model_.buffers[0].data.size() - model_.bufferViews.back().byteOffset;
    append(own.data(), own.size());
    return add_accessor(indices_, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, offset, own.size());
  }
  /// Adds the bounding box, which the format requires for positions.
  void add_box(tinygltf::Accessor& accessor, std::size_t first, std::size_t count) const {
    const float* p = &mesh_.positions[3 * first];
    std::array<float, 3> least{p[0], p[1], p[2]}, most = least;
    for (std::size_t k = 0; k < count; ++k, p += 3)
      for (std::size_t c = 0; c < 3; ++c) {
        least[c] = std::min(least[c], p[c]);
        most[c] = std::max(most[c], p[c]);
      }
    accessor.minValues.assign(least.begin(), least.end());
    accessor.maxValues.assign(most.begin(), most.end());
  }

  const Mesh& mesh_;
  std::vector<MeshPart> parts_;
  tinygltf::Model model_;
  int positions_ = -1, normals_ = -1, parameters_ = -1, indices_ = -1;
};

Status write(const Mesh& mesh, OutputFile& out, bool binary) {
  if (!mesh.quads.empty()) {
    const Result<Mesh> split = split_quads(mesh);
    return split ? write(*split, out, binary) : split.status();
  }
  if (mesh.triangle_count() == 0)
    return {StatusCode::invalid_argument, "the mesh has no triangles, glTF needs at least one"};
  if (const std::size_t bytes = GltfMesh::byte_count(mesh); bytes > max_bytes)
    return {StatusCode::unsupported, "the mesh takes " + std::to_string(bytes) + " bytes, a glTF file is limited to " +
                                         std::to_string(max_bytes)};
  const tinygltf::Model model = GltfMesh(mesh).make();
  FileBuffer buffer(out);
  std::ostream stream(&buffer);
  const bool pretty = !binary;
  if (tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, pretty, binary)) return {};
  return {StatusCode::internal, "tinygltf could not write the mesh"};
}

}  // namespace

Status write_glb(const Mesh& mesh, OutputFile& out) { return write(mesh, out, true); }
Status write_gltf(const Mesh& mesh, OutputFile& out) { return write(mesh, out, false); }

}  // namespace tessera::inline abi_0_1
