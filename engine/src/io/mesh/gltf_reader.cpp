// Meshes of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021): the primitives of all meshes in a scene, placed by
// their nodes. Section numbers are those of the specification.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "base/text.h"
#include "io/file/text_cursor.h"
#include "io/json/json_reader.h"
#include "io/mesh/gltf_numbers.h"
#include "io/mesh/mesh_formats.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The JSON of a file, and the binary chunk of a .glb file.
struct GltfText {
  std::string_view json;
  std::optional<std::string_view> binary = {};
};

constexpr std::string_view glb_magic = "glTF";
constexpr std::size_t glb_header = 12, chunk_header = 8;

Status gltf_error(std::string_view name, const std::string& sentence, StatusCode code = StatusCode::parse_error) {
  return Status(code, std::string(name) + ": " + sentence);
}

std::uint32_t u32_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Finds the chunks of a .glb file (section 4.4); unknown chunks are ignored, as it demands.
Result<GltfText> split_glb(std::string_view bytes, std::string_view name) {
  if (bytes.size() < glb_header + chunk_header)
    return gltf_error(name, "the file ends in its header, after " + counted(bytes.size(), "byte"));
  const std::uint32_t version = u32_at(bytes, 4), length = u32_at(bytes, 8);
  if (version != 2)
    return gltf_error(name,
                      "found version " + std::to_string(version) + " of the container, this reader knows version 2",
                      StatusCode::unsupported);
  if (length != bytes.size())
    return gltf_error(
        name, "the header states " + counted(length, "byte") + ", the file has " + std::to_string(bytes.size()));
  GltfText text;
  std::size_t chunk = 0;
  for (std::size_t at = glb_header; at < bytes.size(); ++chunk) {
    const std::size_t left = bytes.size() - at;
    const std::size_t size = left < chunk_header ? left : u32_at(bytes, at);
    if (left < chunk_header || size > left - chunk_header)
      return gltf_error(name, "chunk " + std::to_string(chunk + 1) + " is longer than the file: it needs " +
                                  std::to_string(left < chunk_header ? chunk_header : size) + " bytes, there are " +
                                  std::to_string(left < chunk_header ? left : left - chunk_header));
    const std::string_view type = bytes.substr(at + 4, 4), content = bytes.substr(at + chunk_header, size);
    if ((type == "JSON") != (chunk == 0)) return gltf_error(name, "expected one chunk of JSON, as the first one");
    if (chunk == 0) text.json = content;
    if (chunk == 1 && type == std::string_view("BIN\0", 4)) text.binary = content;
    at += chunk_header + size;
  }
  return text;
}

/// Reads `Count` numbers.
template <std::size_t Count>
std::array<double, Count> read_array(const JsonValue& value) {
  std::array<double, Count> numbers{};
  auto number = array_of(value, "an array of " + std::to_string(Count) + " numbers", Count).begin();
  for (double& x : numbers) {
    if (!(*number).is(JsonKind::number)) (*number).fail_expected("a number");
    x = (*number).number();
    ++number;
  }
  return numbers;
}

Vec3 read_vec3(const JsonValue& node, std::string_view key, const Vec3& otherwise) {
  const std::optional<JsonValue> value = node.find(key);
  if (!value) return otherwise;
  const auto [x, y, z] = read_array<3>(*value);
  return {x, y, z};
}

/// The rotation by a quaternion (x, y, z, w) of any length but 0.
Affine rotation(const JsonValue& value) {
  const auto [x, y, z, w] = read_array<4>(value);
  const double s = 2 / (x * x + y * y + z * z + w * w);
  if (!std::isfinite(s)) value.fail("expected a quaternion of length 1");
  return {.columns = {Vec3{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
                      Vec3{s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
                      Vec3{s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)}}};
}

/// The node's own transform (section 3.5.3).
Affine transform_of(const JsonValue& node) {
  if (const std::optional<JsonValue> matrix = node.find("matrix")) {
    const auto m = read_array<16>(*matrix);
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) matrix->fail("expected a last row of 0, 0, 0, 1");
    return {.columns = {Vec3{m[0], m[1], m[2]}, Vec3{m[4], m[5], m[6]}, Vec3{m[8], m[9], m[10]}},
            .translation = {m[12], m[13], m[14]}};
  }
  const std::optional<JsonValue> turn = node.find("rotation");
  Affine map = Affine::scaled(read_vec3(node, "scale", {1, 1, 1}));
  if (turn) map = rotation(*turn) * map;
  map.translation = read_vec3(node, "translation", {});
  return map;
}

/// Faces of a mesh: accessors within the file's buffers. Those that are absent are empty.
struct Primitive {
  GltfElements positions = {}, normals = {}, parameters = {}, indices = {};
  std::size_t mode;
  JsonValue source;

  bool has_the_vertices_of(const Primitive& other) const {
    return positions == other.positions && normals == other.normals && parameters == other.parameters;
  }
  std::size_t corner_count() const { return indices.empty() ? positions.count : indices.count; }
};

enum Mode : std::size_t { triangles = 4, triangle_strip = 5, triangle_fan = 6 };

/// Extensions that a file may require: they are read, or leave positions and indices as they are.
bool is_known(std::string_view extension) {
  for (const std::string_view begin : {"KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_"})
    if (extension.starts_with(begin)) return true;
  // Integers are read as any others; packed numbers are unpacked.
  return extension == "KHR_mesh_quantization" || extension == "EXT_meshopt_compression";
}

class GltfReader {
 public:
  GltfReader(const JsonValue& root, const GltfText& text, std::string_view name, const MeshReadOptions& options)
      : root_(root),
        numbers_(root, text.binary, name),
        name_(name),
        options_(options),
        file_bytes_(text.json.size() + (text.binary ? text.binary->size() : 0)) {}

  Mesh read() {
    check_asset();
    place_nodes();
    if (mesh_.indices.empty()) root_.fail("there are no triangles");
    if (!all_have_normals_) mesh_.normals.clear();
    if (!all_have_parameters_) mesh_.parameters.clear();
    say_warnings();
    return std::move(mesh_);
  }

 private:
  struct PlacedNode {
    JsonValue node;
    Affine map;
  };

  void check_asset() {
    const JsonValue version = member(member(root_, "asset"), "version");
    if (!read_text(version).starts_with("2."))
      version.fail("found version " + quote(version.string()) + ", this reader knows version 2.0",
                   StatusCode::unsupported);
    for (const JsonValue& extension : numbers_.list("extensionsRequired"))
      if (!is_known(read_text(extension)))
        extension.fail("the file needs the extension " + quote(extension.string()) +
                           ", which is not read; export the file without it",
                       StatusCode::unsupported);
  }

  /// The nodes at the top: those of the scene, or, without scenes, those that are nobody's children.
  std::vector<JsonValue> roots() {
    std::vector<JsonValue> found;
    const std::optional<JsonValue> index = root_.find("scene");
    if (index || !numbers_.list("scenes").empty()) {
      const JsonValue scene = index ? numbers_.element("scenes", *index) : numbers_.list("scenes")[0];
      if (numbers_.list("scenes").size() > 1) skipped_.insert("scenes beside the default one");
      if (const auto nodes = optional_member(scene, "nodes"))
        for (const JsonValue node : array(*nodes, "an array of nodes"))
          found.push_back(numbers_.element("nodes", node));
      return found;
    }
    std::set<std::size_t> children;
    for (const JsonValue& node : numbers_.list("nodes"))
      if (const auto list = optional_member(node, "children"))
        for (const JsonValue child : array(*list, "an array of nodes")) children.insert(read_count(child));
    for (std::size_t k = 0; k < numbers_.list("nodes").size(); ++k)
      if (!children.contains(k)) found.push_back(numbers_.list("nodes")[k]);
    return found;
  }

  /// Places the meshes of the scene, parents before children. A list and no recursion: a chain of nodes may be long.
  void place_nodes() {
    std::vector<PlacedNode> waiting;
    const auto add = [&](const std::vector<JsonValue>& nodes, const Affine& map) {
      for (std::size_t k = nodes.size(); k-- > 0;) waiting.push_back({nodes[k], map});
    };
    add(roots(), model_from(options_.up));
    if (root_.find("animations")) skipped_.insert("animations");
    while (!waiting.empty()) {
      const PlacedNode at = waiting.back();
      waiting.pop_back();
      if (!at.node.is(JsonKind::object)) at.node.fail_expected("an object");
      if (!placed_.insert(at.node.place()).second)
        at.node.fail("the node is a child of two nodes, or of itself; expected a tree");
      const Affine map = at.map * transform_of(at.node);
      if (!is_finite(map)) at.node.fail("the node's place in the scene is beyond the range of numbers");
      if (const auto mesh = at.node.find("mesh")) place_mesh(at.node, *mesh, map);
      std::vector<JsonValue> children;
      if (const auto list = at.node.find("children"))
        for (const JsonValue child : array(*list, "an array of nodes"))
          children.push_back(numbers_.element("nodes", child));
      add(children, map);
    }
  }

  void place_mesh(const JsonValue& node, const JsonValue& index, const Affine& map) {
    if (node.find("skin")) skipped_.insert("skins");
    const JsonValue mesh = numbers_.element("meshes", index);
    const auto [known, is_new] = meshes_.try_emplace(mesh.place());
    if (is_new) known->second = read_primitives(mesh);
    if (mesh_.positions.empty()) mesh_.origin = map.translation;
    const std::size_t first = mesh_.triangle_count();
    const Primitive* before = nullptr;
    std::size_t base = 0;
    for (const Primitive& primitive : known->second) {
      check_room(primitive);
      if (!before || !primitive.has_the_vertices_of(*before)) {
        base = mesh_.vertex_count();
        add_vertices(primitive, map);
      }
      add_triangles(primitive, base, map.determinant() < 0);
      before = &primitive;
    }
    if (mesh_.triangle_count() == first) return;
    const auto name = node.find("name"), other = optional_member(mesh, "name");
    const std::optional<JsonValue>& named = name ? name : other;
    mesh_.parts.push_back({named ? read_text(*named) : std::string(), first, mesh_.triangle_count() - first});
  }

  std::vector<Primitive> read_primitives(const JsonValue& mesh) {
    std::vector<Primitive> found;
    for (const JsonValue source : array(member(mesh, "primitives"), "an array of primitives")) {
      const JsonValue attributes = member(source, "attributes");
      const std::size_t mode = read_count(source, "mode", triangles);
      if (mode > triangle_fan) member(source, "mode").fail_expected("a mode of primitives from 0 to 6");
      const auto positions = optional_member(attributes, "POSITION");
      if (mode < triangles || !positions) {
        skipped_.insert(mode < triangles ? "primitives of points or lines" : "primitives without positions");
        continue;
      }
      if (source.find("targets")) skipped_.insert("morph targets");
      Primitive primitive{.positions = numbers_.elements(*positions, "VEC3"), .mode = mode, .source = source};
      const auto vertices = [&](std::string_view key, std::string_view type) {
        const std::optional<JsonValue> index = attributes.find(key);
        if (!index) return GltfElements();
        const GltfElements values = numbers_.elements(*index, type);
        if (values.count != primitive.positions.count)
          index->fail("there are " + std::to_string(values.count) + " elements for " +
                      std::to_string(primitive.positions.count) + " positions");
        return values;
      };
      primitive.normals = vertices("NORMAL", "VEC3");
      primitive.parameters = vertices("TEXCOORD_0", "VEC2");
      if (const auto indices = source.find("indices")) primitive.indices = read_indices(*indices);
      found.push_back(primitive);
    }
    return found;
  }

  GltfElements read_indices(const JsonValue& index) {
    const GltfElements indices = numbers_.elements(index, "SCALAR");
    const int type = indices.component_type;
    if (type != 5121 && type != 5123 && type != 5125)
      index.fail("expected indices of component type 5121, 5123 or 5125, found " + std::to_string(type));
    return indices;
  }

  /// A few nodes may place a large mesh many times: what they make is bounded by the file's size.
  void check_room(const Primitive& primitive) {
    constexpr std::size_t times = 64, extra = std::size_t{16} << 20;
    const std::size_t limit = times * (file_bytes_ + numbers_.loaded_bytes()) + extra;
    // A strip has a triangle of three indices per corner. A vertex has eight floats.
    made_ += 12 * primitive.corner_count() + 32 * primitive.positions.count;
    if (made_ > limit)
      primitive.source.fail("the copies of the meshes take more than " + std::to_string(times) +
                                " times the file and 16 MiB; read the meshes one by one",
                            StatusCode::unsupported);
    if (mesh_.vertex_count() + primitive.positions.count > std::numeric_limits<std::uint32_t>::max())
      primitive.source.fail("there are more vertices than 32-bit indices can tell apart", StatusCode::unsupported);
  }

  void add_vertices(const Primitive& primitive, const Affine& map) {
    const Vec3 offset = map.translation - mesh_.origin;
    const bool stays = map.columns == Affine().columns;
    const std::array<Vec3, 3>& c = map.columns;
    // Normals turn with the cofactors, which are the inverse transposed but for a factor.
    const Affine cofactors{.columns = {cross(c[1], c[2]), cross(c[2], c[0]), cross(c[0], c[1])}};
    const double sign = map.determinant() < 0 ? -1 : 1;
    const auto vector = [](const GltfElements& from, std::size_t k) {
      return Vec3{from.at(k, 0), from.at(k, 1), from.at(k, 2)};
    };
    for (std::size_t k = 0; k < primitive.positions.count; ++k) {
      const Vec3 p = vector(primitive.positions, k);
      append(mesh_.positions, stays && offset == Vec3{} ? p : map.vector(p) + offset);
    }
    for (std::size_t k = 0; k < primitive.normals.count; ++k) {
      const Vec3 n = vector(primitive.normals, k);
      append(mesh_.normals, stays ? n : sign * normalized(cofactors.vector(n)));
    }
    for (std::size_t k = 0; k < primitive.parameters.count; ++k)
      for (std::size_t component = 0; component < 2; ++component)
        mesh_.parameters.push_back(static_cast<float>(primitive.parameters.at(k, component)));
    all_have_normals_ &= !primitive.normals.empty();
    all_have_parameters_ &= !primitive.parameters.empty();
  }

  static void append(std::vector<float>& list, const Vec3& v) {
    for (const double x : {v.x, v.y, v.z}) list.push_back(static_cast<float>(x));
  }

  /// Adds triangles, strips and fans (section 3.7.2.1), the other way around if `mirrored`.
  void add_triangles(const Primitive& primitive, std::size_t base, bool mirrored) {
    const std::size_t corners = primitive.corner_count();
    if (corners < 3 || (primitive.mode == triangles && corners % 3 != 0))
      primitive.source.fail(
          "expected " +
          std::string(primitive.mode == triangles ? "3 corners for each triangle" : "at least 3 corners") + ", found " +
          std::to_string(corners));
    const auto vertex = [&](std::size_t corner) {
      if (primitive.indices.empty()) return static_cast<std::uint32_t>(base + corner);
      const auto index = static_cast<std::size_t>(primitive.indices.at(corner, 0));
      if (index >= primitive.positions.count)
        primitive.source.fail("index " + std::to_string(corner) + " is " + std::to_string(index) + ", but there are " +
                              std::to_string(primitive.positions.count) + " vertices");
      return static_cast<std::uint32_t>(base + index);
    };
    const std::size_t count = primitive.mode == triangles ? corners / 3 : corners - 2;
    for (std::size_t k = 0; k < count; ++k) {
      std::array<std::size_t, 3> at{3 * k, 3 * k + 1, 3 * k + 2};
      if (primitive.mode == triangle_strip) at = {k, k + 1 + k % 2, k + 2 - k % 2};
      if (primitive.mode == triangle_fan) at = {k + 1, k + 2, 0};
      if (mirrored) std::swap(at[1], at[2]);
      for (const std::size_t corner : at) mesh_.indices.push_back(vertex(corner));
    }
  }

  void say_warnings() {
    if (!options_.warnings) return;
    for (const std::string_view what : skipped_)
      options_.warnings->push_back(std::string(name_) + ": " + std::string(what) + " are not read");
  }

  JsonValue root_;
  GltfNumbers numbers_;
  std::string_view name_;
  const MeshReadOptions& options_;
  std::size_t file_bytes_, made_ = 0;
  Mesh mesh_;
  bool all_have_normals_ = true, all_have_parameters_ = true;
  std::set<std::size_t> placed_;
  std::map<std::size_t, std::vector<Primitive>> meshes_;
  std::set<std::string_view> skipped_;
};

}  // namespace

Result<Mesh> parse_gltf(std::string_view bytes, std::string_view name, const MeshReadOptions& options) {
  return guarded([&]() -> Result<Mesh> {
    GltfText text{bytes};
    if (bytes.starts_with(glb_magic)) {
      const Result<GltfText> split = split_glb(bytes, name);
      if (!split) return split.status();
      text = *split;
    }
    const Result<JsonDocument> document = JsonDocument::parse(text.json, name);
    if (!document) return document.status();
    try {
      return GltfReader(document->root(), text, name, options).read();
    } catch (const JsonFailure& failure) {
      return failure.status;
    }
  });
}

}}  // namespace tessera::abi_0_1
