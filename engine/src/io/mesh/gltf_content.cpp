// Section numbers are those of the glTF 2.0 Specification (Khronos Group, 2021).

#include "io/mesh/gltf_content.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

namespace tessera { inline namespace abi_0_1 {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is written in the machine's own byte order");

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

/// The light of an sRGB value (IEC 61966-2-1), which glTF's factors are in (section 3.9.2).
double linear(float value) {
  const double s = value;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

}  // namespace

GltfContent::GltfContent(std::size_t bytes) {
  model_.asset.generator = "Tessera";
  model_.buffers.resize(1);
  model_.buffers[0].data.reserve(bytes);
  model_.nodes.resize(1);
  model_.scenes.emplace_back().nodes = {0};
  model_.defaultScene = 0;
  material({});
}

void GltfContent::name(tinygltf::Node& node, const std::string& name) { node.name = utf8(name); }

tinygltf::Node& GltfContent::add_node(const std::string& node_name) {
  model_.nodes[0].children.push_back(static_cast<int>(model_.nodes.size()));
  tinygltf::Node& node = model_.nodes.emplace_back();
  name(node, node_name);
  return node;
}

int GltfContent::add_mesh(const std::string& name, std::vector<tinygltf::Primitive> primitives) {
  tinygltf::Mesh& mesh = model_.meshes.emplace_back();
  mesh.name = utf8(name);
  mesh.primitives = std::move(primitives);
  return static_cast<int>(model_.meshes.size()) - 1;
}

int GltfContent::material(const std::optional<Colour>& colour) {
  std::array<float, 4> key{-1, -1, -1, -1};
  if (colour) key = {colour->red, colour->green, colour->blue, colour->alpha};
  const auto [known, is_new] = materials_.try_emplace(key, static_cast<int>(model_.materials.size()));
  if (!is_new) return known->second;
  tinygltf::Material& material = model_.materials.emplace_back();
  material.doubleSided = true;  // surfaces need not be closed
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 0.5;
  material.pbrMetallicRoughness.baseColorFactor = {0.8, 0.8, 0.8, 1};
  if (colour)
    material.pbrMetallicRoughness.baseColorFactor = {linear(colour->red), linear(colour->green), linear(colour->blue),
                                                     double{colour->alpha}};
  if (colour && colour->alpha < 1) material.alphaMode = "BLEND";
  return known->second;
}

void GltfContent::add_vertices(const Mesh& mesh) {
  mesh_ = &mesh;
  ranges_.clear();
  views_ = {};
  views_.positions = add_view(mesh.positions, 3);
  if (!mesh.normals.empty()) views_.normals = add_view(are_unit(mesh.normals) ? mesh.normals : unit_normals(mesh), 3);
  if (!mesh.parameters.empty()) views_.parameters = add_view(mesh.parameters, 2);
  views_.indices = static_cast<int>(model_.bufferViews.size());
  model_.bufferViews.push_back(view(TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, 4 * mesh.indices.size()));
}

tinygltf::Primitive GltfContent::add_primitive(std::span<const std::uint32_t> indices, std::size_t first,
                                               std::size_t count) {
  const Accessors vertices = accessors(first, count);
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] = vertices.positions;
  if (vertices.normals >= 0) primitive.attributes["NORMAL"] = vertices.normals;
  if (vertices.parameters >= 0) primitive.attributes["TEXCOORD_0"] = vertices.parameters;
  std::vector<std::uint32_t> own(indices.begin(), indices.end());
  for (std::uint32_t& index : own) index -= static_cast<std::uint32_t>(first);
  const std::size_t offset = model_.buffers[0].data.size() - model_.bufferViews.back().byteOffset;
  append(own.data(), 4 * own.size());
  primitive.indices =
      add_accessor(views_.indices, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, offset, own.size());
  return primitive;
}

/// A view of the next `bytes` of the buffer.
tinygltf::BufferView GltfContent::view(int target, std::size_t bytes) const {
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = model_.buffers[0].data.size();
  view.byteLength = bytes;
  view.target = target;
  return view;
}

int GltfContent::add_view(const std::vector<float>& values, std::size_t components) {
  tinygltf::BufferView added = view(TINYGLTF_TARGET_ARRAY_BUFFER, 4 * values.size());
  added.byteStride = 4 * components;
  model_.bufferViews.push_back(added);
  append(values.data(), 4 * values.size());
  return static_cast<int>(model_.bufferViews.size()) - 1;
}

void GltfContent::append(const void* values, std::size_t bytes) {
  std::vector<unsigned char>& data = model_.buffers[0].data;
  const std::size_t begin = data.size();
  data.resize(begin + bytes);
  if (bytes > 0) std::memcpy(data.data() + begin, values, bytes);
}

int GltfContent::add_accessor(int view, int type, int component, std::size_t offset, std::size_t count) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.byteOffset = offset;
  accessor.componentType = component;
  accessor.type = type;
  accessor.count = count;
  model_.accessors.push_back(std::move(accessor));
  return static_cast<int>(model_.accessors.size()) - 1;
}

int GltfContent::add_vertex_accessor(int view, int type, std::size_t first, std::size_t count) {
  if (view < 0) return -1;
  const std::size_t stride = model_.bufferViews[static_cast<std::size_t>(view)].byteStride;
  return add_accessor(view, type, TINYGLTF_COMPONENT_TYPE_FLOAT, first * stride, count);
}

GltfContent::Accessors GltfContent::accessors(std::size_t first, std::size_t count) {
  const auto [known, is_new] = ranges_.try_emplace({first, count});
  if (!is_new) return known->second;
  Accessors added;
  added.positions = add_vertex_accessor(views_.positions, TINYGLTF_TYPE_VEC3, first, count);
  add_box(model_.accessors.back(), first, count);
  added.normals = add_vertex_accessor(views_.normals, TINYGLTF_TYPE_VEC3, first, count);
  added.parameters = add_vertex_accessor(views_.parameters, TINYGLTF_TYPE_VEC2, first, count);
  return known->second = added;
}

/// Adds the bounding box, which the format requires for positions.
void GltfContent::add_box(tinygltf::Accessor& accessor, std::size_t first, std::size_t count) const {
  const float* p = &mesh_->positions[3 * first];
  std::array<float, 3> least{p[0], p[1], p[2]}, most = least;
  for (std::size_t k = 0; k < count; ++k, p += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      least[c] = std::min(least[c], p[c]);
      most[c] = std::max(most[c], p[c]);
    }
  accessor.minValues.assign(least.begin(), least.end());
  accessor.maxValues.assign(most.begin(), most.end());
}

}}  // namespace tessera::abi_0_1
