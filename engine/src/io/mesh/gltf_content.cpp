// Section numbers are those of the glTF 2.0 Specification (Khronos Group, 2021).

#include "io/mesh/gltf_content.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <type_traits>

#include "io/file/base64.h"
#include "io/mesh/meshopt.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is written in the machine's own byte order");

/// Appends a text as it is, or a number in the shortest form that reads back as the same.
template <class Part>
void append_part(std::string& text, const Part& part) {
  if constexpr (std::is_arithmetic_v<Part>) {
    std::array<char, 32> digits;
    text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), part).ptr);
  } else {
    text += part;
  }
}
template <class... Parts>
void append(std::string& text, const Parts&... parts) {
  (append_part(text, parts), ...);
}

/// A list of numbers within brackets.
template <class Numbers>
std::string list(const Numbers& numbers) {
  std::string text;
  for (const auto number : numbers) append(text, text.empty() ? "[" : ",", number);
  return text + "]";
}

/// A name in quotes. JSON holds UTF-8 only: invalid bytes become U+FFFD.
std::string quoted(std::string_view name) {
  return nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
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

/// `,"name":"bolt"`, or nothing.
std::string name_member(std::string_view name) { return name.empty() ? "" : ",\"name\":" + quoted(name); }

/// The members of a node, the first one without the comma before it. The vertices of its mesh are relative to its
/// origin.
std::string members(const GltfNode& node) {
  std::string text;
  const std::array<Vec3, 3>& c = node.placement.columns;
  const Vec3 t = node.placement.point(node.origin);
  if (c != Affine().columns)
    append(text, ",\"matrix\":",
           list(std::array{c[0].x, c[0].y, c[0].z, 0., c[1].x, c[1].y, c[1].z, 0., c[2].x, c[2].y, c[2].z, 0., t.x, t.y,
                           t.z, 1.}));
  else if (!(t == Vec3{}))
    append(text, ",\"translation\":", list(std::array{t.x, t.y, t.z}));
  if (node.mesh >= 0) append(text, ",\"mesh\":", node.mesh);
  text += name_member(node.name);
  return text.empty() ? text : text.substr(1);
}

/// The members `min` and `max` of positions, which the format requires: their bounding box.
std::string box_members(const float* p, std::size_t count) {
  std::array<double, 3> least{p[0], p[1], p[2]}, most = least;
  for (std::size_t k = 0; k < count; ++k, p += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      least[c] = std::min(least[c], double{p[c]});
      most[c] = std::max(most[c], double{p[c]});
    }
  return ",\"max\":" + list(most) + ",\"min\":" + list(least);
}

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

/// Sizes are multiples of 4 (section 4.4.3).
std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }
std::size_t padded_sum(std::span<const std::string> texts) {
  return std::accumulate(texts.begin(), texts.end(), std::size_t{0},
                         [](std::size_t sum, const std::string& text) { return sum + padded(text.size()); });
}

constexpr const char* separator = ",\n";  // objects have lines of their own, for those who read .gltf
constexpr std::size_t base64_piece = std::size_t{1} << 14;
constexpr const char* meshopt_extension = "EXT_meshopt_compression";
constexpr int array_buffer = 34962, element_array_buffer = 34963;  // targets of views, section 5.11.5
constexpr int unsigned_int = 5125, float_32 = 5126;                // types of components, section 5.1.3

using WriteBuffer = FunctionRef<void(FunctionRef<void(std::string_view)>)>;

/// Writes the chunks of a .glb file (section 4.4); `bytes` is the length of the buffer.
void write_binary(OutputFile& out, std::string json, std::size_t bytes, WriteBuffer write_buffer) {
  json.resize(padded(json.size()), ' ');
  const auto number = [&](std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    out.write(bytes_of(std::span(&word, 1)));
  };
  out.write("glTF");
  number(2), number(12 + 8 + json.size() + 8 + bytes);
  number(json.size()), out.write("JSON"), out.write(json);
  number(bytes), out.write(std::string_view("BIN\0", 4));
  write_buffer([&](std::string_view part) { out.write(part); });
}

/// Writes JSON with the buffer within it.
void write_base64(OutputFile& out, const std::array<std::string, 2>& json, WriteBuffer write_buffer) {
  out.write(json[0]);
  Base64Encoder encoder;
  write_buffer([&](std::string_view bytes) {
    for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), base64_piece)))
      out.write(encoder.encode(bytes.substr(0, base64_piece)));
  });
  out.write(encoder.finish());
  out.write(json[1]);
}

}  // namespace

template <class... Parts>
int GltfContent::Objects::add(const Parts&... parts) {
  if (count > 0) text += separator;
  append(text, "{", parts..., "}");
  return count++;
}

GltfContent::GltfContent(const GltfNode& root) : root_(root) { material({}); }

void GltfContent::add_node(const GltfNode& node) { nodes_.add(members(node)); }

int GltfContent::add_mesh(std::string_view name, std::span<const GltfPrimitive> primitives) {
  std::string text;
  for (const GltfPrimitive& primitive : primitives) {
    append(text, text.empty() ? "" : ",", "{\"attributes\":{\"POSITION\":", primitive.positions);
    if (primitive.normals >= 0) append(text, ",\"NORMAL\":", primitive.normals);
    if (primitive.parameters >= 0) append(text, ",\"TEXCOORD_0\":", primitive.parameters);
    append(text, "},\"indices\":", primitive.indices, ",\"material\":", primitive.material, "}");
  }
  return meshes_.add("\"primitives\":[", text, "]", name_member(name));
}

int GltfContent::material(const std::optional<Colour>& colour) {
  std::array<float, 4> key{-1, -1, -1, -1};
  if (colour) key = {colour->red, colour->green, colour->blue, colour->alpha};
  const auto [known, is_new] = colours_.try_emplace(key, materials_.count);
  if (!is_new) return known->second;
  std::array<double, 4> factor{0.8, 0.8, 0.8, 1};
  if (colour) factor = {linear(colour->red), linear(colour->green), linear(colour->blue), colour->alpha};
  // Both sides are seen, since surfaces need not be closed.
  return materials_.add(factor[3] < 1 ? "\"alphaMode\":\"BLEND\"," : "",
                        "\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":", list(factor),
                        ",\"metallicFactor\":0,\"roughnessFactor\":0.5}");
}

void GltfContent::add_vertices(const Mesh& mesh) {
  mesh_ = &mesh;
  ranges_.clear();
  const auto add_values = [&](const std::vector<float>& values, std::size_t components, const Mesh* normals_of) {
    if (values.empty()) return -1;
    const int view = add_view(values.size(), components);
    numbers_.push_back({.view = view, .normals_of = normals_of, .values = values});
    return view;
  };
  mesh_views_.positions = add_values(mesh.positions, 3, nullptr);
  mesh_views_.normals = add_values(mesh.normals, 3, are_unit(mesh.normals) ? nullptr : &mesh);
  mesh_views_.parameters = add_values(mesh.parameters, 2, nullptr);
  index_view_ = add_view(mesh.indices.size(), 0);
  index_bytes_ = 0;
}

GltfPrimitive GltfContent::add_primitive(IndexRuns indices, std::size_t first, std::size_t count) {
  const Attributes& vertices = attributes(first, count);
  GltfPrimitive primitive{vertices.positions, vertices.normals, vertices.parameters};
  std::size_t index_count = 0;
  for (const std::span<const std::uint32_t>& run : indices) index_count += run.size();
  primitive.indices =
      accessors_.add("\"bufferView\":", index_view_, ",\"byteOffset\":", index_bytes_,
                     ",\"componentType\":", unsigned_int, ",\"count\":", index_count, ",\"type\":\"SCALAR\"");
  index_bytes_ += 4 * index_count;
  numbers_.push_back(
      {.view = index_view_, .indices = std::move(indices), .first_vertex = static_cast<std::uint32_t>(first)});
  return primitive;
}

/// Adds a view of the next numbers of the buffer: vectors of vertices, or indices, which have 0 components.
int GltfContent::add_view(std::size_t count, std::size_t components) {
  views_.push_back({bytes_, count, components});
  bytes_ += views_.back().bytes();
  return static_cast<int>(views_.size()) - 1;
}

int GltfContent::add_vertex_accessor(int view, std::size_t components, std::size_t first, std::size_t count) {
  if (view < 0) return -1;
  const bool are_positions = view == mesh_views_.positions;
  return accessors_.add("\"bufferView\":", view, ",\"byteOffset\":", 4 * components * first,
                        ",\"componentType\":", float_32, ",\"count\":", count, ",\"type\":\"VEC", components, "\"",
                        are_positions ? box_members(&mesh_->positions[3 * first], count) : "");
}

const GltfContent::Attributes& GltfContent::attributes(std::size_t first, std::size_t count) {
  const auto [known, is_new] = ranges_.try_emplace({first, count});
  if (is_new)
    known->second = {add_vertex_accessor(mesh_views_.positions, 3, first, count),
                     add_vertex_accessor(mesh_views_.normals, 3, first, count),
                     add_vertex_accessor(mesh_views_.parameters, 2, first, count)};
  return known->second;
}

/// The views, and what the extension states of the packed ones, which follow each other in the first buffer.
std::string GltfContent::views_json(std::span<const std::string> packed) const {
  Objects objects;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < views_.size(); ++k) {
    const View& view = views_[k];
    const bool is_vectors = view.components > 0;
    std::string stride, extension;
    if (is_vectors) append(stride, ",\"byteStride\":", view.stride());
    if (!packed.empty()) {
      append(extension, ",\"extensions\":{\"", meshopt_extension, "\":{\"buffer\":0,\"byteOffset\":", begin,
             ",\"byteLength\":", packed[k].size(), ",\"byteStride\":", view.stride(),
             ",\"count\":", view.bytes() / view.stride(), ",\"mode\":\"", is_vectors ? "ATTRIBUTES" : "TRIANGLES",
             "\"}}");
      begin += padded(packed[k].size());
    }
    objects.add("\"buffer\":", packed.empty() ? 0 : 1, ",\"byteLength\":", view.bytes(), ",\"byteOffset\":", view.begin,
                stride, ",\"target\":", is_vectors ? array_buffer : element_array_buffer, extension);
  }
  return objects.text;
}

/// The file's JSON: before the text of the first buffer, if that is not binary, and after it.
std::array<std::string, 2> GltfContent::json(bool binary, std::span<const std::string> packed) const {
  std::vector<int> children(static_cast<std::size_t>(nodes_.count));
  std::iota(children.begin(), children.end(), 1);
  Objects nodes;
  const std::string root = members(root_);
  nodes.add(root, root.empty() || children.empty() ? "" : ",",
            children.empty() ? "" : "\"children\":" + list(children));
  if (nodes_.count > 0) append(nodes.text, separator, nodes_.text);
  const auto array = [](const char* name, const std::string& objects) {
    return std::string(",\n\"") + name + "\":[\n" + objects + "\n]";
  };
  std::array<std::string, 2> text;
  append(text[0],
         "{\"asset\":{\"generator\":\"Tessera\",\"version\":\"2.0\"},\n\"scene\":0,\"scenes\":[{\"nodes\":[0]}]",
         array("nodes", nodes.text), array("meshes", meshes_.text), array("materials", materials_.text),
         array("accessors", accessors_.text), array("bufferViews", views_json(packed)));
  std::string unpacked;
  if (!packed.empty()) {
    for (const char* const list : {"extensionsUsed", "extensionsRequired"})
      append(text[0], ",\n\"", list, "\":[\"", meshopt_extension, "\"]");
    append(unpacked, ",\n{\"byteLength\":", bytes_, ",\"extensions\":{\"", meshopt_extension,
           "\":{\"fallback\":true}}}");
  }
  append(text[0], ",\n\"buffers\":[{\"byteLength\":", packed.empty() ? bytes_ : padded_sum(packed));
  if (!binary) text[0] += ",\"uri\":\"data:application/octet-stream;base64,";
  text[1] = std::string(binary ? "}" : "\"}") + unpacked + (binary ? "]}" : "]}\n");
  return text;
}

void GltfContent::write_numbers(const Numbers& numbers, FunctionRef<void(std::string_view)> write) {
  write(numbers.normals_of ? bytes_of(std::span<const float>(unit_normals(*numbers.normals_of)))
                           : bytes_of(numbers.values));
  for (std::span<const std::uint32_t> run : numbers.indices) {
    if (numbers.first_vertex == 0) {
      write(bytes_of(run));
      continue;
    }
    std::array<std::uint32_t, 4096> shifted;
    while (!run.empty()) {
      const std::span part = run.first(std::min(run.size(), shifted.size()));
      std::ranges::transform(part, shifted.begin(), [&](std::uint32_t index) { return index - numbers.first_vertex; });
      write(bytes_of(std::span<const std::uint32_t>(shifted).first(part.size())));
      run = run.subspan(part.size());
    }
  }
}

std::string GltfContent::packed_view(std::size_t index) const {
  const View& view = views_[index];
  const auto [first, last] = std::ranges::equal_range(numbers_, static_cast<int>(index), {}, &Numbers::view);
  if (view.components > 0) {
    std::string packed;
    write_numbers(*first, [&](std::string_view bytes) { packed = pack_attributes(bytes, view.stride()); });
    return packed;
  }
  std::vector<std::uint32_t> indices(view.count);
  char* end = reinterpret_cast<char*>(indices.data());
  for (auto numbers = first; numbers != last; ++numbers)
    write_numbers(*numbers, [&](std::string_view bytes) { end = std::ranges::copy(bytes, end).out; });
  return pack_triangles(indices);
}

Status GltfContent::write(OutputFile& out, bool binary, bool packed) const {
  std::vector<std::string> views;
  if (packed) {
    if (!has_meshopt())
      return {StatusCode::unsupported, "this build of Tessera does not pack glTF: it lacks meshoptimizer"};
    views.resize(views_.size());
    const Status status =
        parallel_for(views.size(), 1, {}, [&](std::size_t k, std::size_t) { views[k] = packed_view(k); });
    if (!status.ok()) return status;
  }
  const std::array<std::string, 2> text = json(binary, views);
  const auto write_buffer = [&](FunctionRef<void(std::string_view)> write) {
    if (!packed) {
      for (const Numbers& numbers : numbers_) write_numbers(numbers, write);
    }
    for (const std::string& view : views) {
      write(view);
      write(std::string_view("\0\0\0", padded(view.size()) - view.size()));
    }
  };
  if (binary)
    write_binary(out, text[0] + text[1], packed ? padded_sum(views) : bytes_, write_buffer);
  else
    write_base64(out, text, write_buffer);
  return {};
}

}}  // namespace tessera::abi_0_1
