#include "io/text_formats.h"

#include <algorithm>
#include <cstring>

#include "io/mesh/mesh_formats.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera::test {
namespace {

class Content {
 public:
  template <class T>
  void add(const T& value) {
    const auto* const bytes = reinterpret_cast<const char*>(&value);
    text_.append(bytes, sizeof value);
  }
  void add(const std::string& text) {
    add(text.size());
    text_ += text;
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.size());
    for (const T& value : values) add(value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void add_trims(const ModelSurface& surface, Content& content, std::string& unsound) {
  for (const TrimLoop& loop : *surface.trims) {
    content.add(loop.hole);
    for (const Curve& curve : loop.curves) {
      const Interval range = curve.domain();
      for (const double t : {range.from, (range.from + range.to) / 2, range.to}) {
        const Vec3 p = evaluate_jet(curve, t).position;
        if (!is_finite(p)) unsound = "a trim that is not finite";
        content.add(p);
      }
    }
  }
}

/// Evaluation may fail only for these kinds: the values of the functions, or their differences, are not finite there.
bool may_have_functions(const Surface& surface) {
  return std::holds_alternative<ParametricSurface>(surface) || std::holds_alternative<RuledSurface>(surface) ||
         std::holds_alternative<CoonsPatch>(surface);
}

Reading reading_of(const Result<Model>& model) {
  Reading reading{.status = model.status()};
  if (!model) return reading;
  Content content;
  if (model->surfaces.empty()) reading.unsound = "no surface";
  for (const ModelSurface& surface : model->surfaces) {
    content.add(*surface.name);
    content.add(std::string(kind_name(surface.surface)));
    content.add(*surface.placement);
    const Domain d = domain(surface.surface);
    if (!(d.u0 < d.u1 && d.v0 < d.v1)) reading.unsound = "an empty domain";
    content.add(d);
    for (const auto& [s, t] : {std::pair(0.0, 0.0), {0.25, 0.8}, {0.7, 0.4}, {1.0, 1.0}}) {
      const Result<SurfaceJet> jet = evaluate_jet(surface, d.u_at(s), d.v_at(t));
      const bool placed_too_far = jet.status().code() == StatusCode::non_finite && *surface.placement != Affine{};
      if (jet ? !is_finite(jet->position) : !placed_too_far && !may_have_functions(surface.surface))
        reading.unsound = "a position that is not finite";
      if (jet) content.add(jet->position);
      if (jet) content.add(jet->du);
    }
    add_trims(surface, content, reading.unsound);
  }
  content.add(model->warnings.size());
  reading.content = content.take();
  reading.parts = model->surfaces.size();
  return reading;
}

Reading reading_of(const Result<Mesh>& mesh) {
  Reading reading{.status = mesh.status()};
  if (!mesh) return reading;
  Content content;
  for (const auto* values : {&mesh->positions, &mesh->normals, &mesh->parameters}) content.add(*values);
  for (const auto* values : {&mesh->indices, &mesh->patches, &mesh->quads, &mesh->quad_patches}) content.add(*values);
  reading.content = content.take();
  reading.parts = mesh->triangle_count() + 2 * mesh->quad_count();
  const std::size_t vertices = mesh->vertex_count();
  for (const auto* indices : {&mesh->indices, &mesh->quads})
    if (std::any_of(indices->begin(), indices->end(), [&](auto index) { return index >= vertices; }))
      reading.unsound = "an index beyond the vertices";
  return reading;
}

template <auto Parse>
Reading parsed_as(std::string_view text, std::string_view name) {
  return reading_of(Parse(text, name));
}
template <auto Parse>
Reading parsed_faces(std::string_view text, std::string_view name) {
  return reading_of(Parse(text, name, {.keep_quads = true}));
}
Reading opened_model(const std::filesystem::path& path) { return reading_of(read_model(path)); }
Reading opened_mesh(const std::filesystem::path& path) { return reading_of(read_mesh(path, {.keep_quads = true})); }

}  // namespace

std::vector<std::string> TextFormat::samples() const {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(TESSERA_SOURCE_DIR "/tests/corpus/" + name))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const std::filesystem::path& file : files) texts.push_back(content_of(file));
  return texts;
}

const std::vector<TextFormat>& text_formats() {
  static const std::vector<TextFormat> formats{
      {"bpt", ".bpt", parsed_as<parse_bpt>, opened_model},
      {"bv", ".bv", parsed_as<parse_bv>, opened_model},
      {"g2", ".g2", parsed_as<parse_g2>, opened_model},
      {"json", ".json", parsed_as<parse_json_model>, opened_model},
      {"obj", ".obj", parsed_as<parse_obj_freeform>, opened_model},
      {"rib", ".rib", parsed_as<parse_rib>, opened_model},
      {"obj_mesh", ".obj", parsed_faces<parse_obj>, opened_mesh},
      {"ply", ".ply", parsed_faces<parse_ply>, opened_mesh},
      {"gltf", ".gltf", parsed_faces<parse_gltf>, opened_mesh},
  };
  return formats;
}

bool is_binary(const std::string& sample) {
  return sample.find("format binary") != std::string::npos || sample.starts_with("glTF");
}

std::string with_blanks(const TextFormat& format, const std::string& text, std::string_view blank) {
  const bool has_strings = format.name == "json" || format.name == "gltf" || format.name == "rib";
  std::string result;
  bool in_string = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (has_strings && text[k] == '"' && (k == 0 || text[k - 1] != '\\')) in_string = !in_string;
    if (text[k] == ' ' && !in_string)
      result += blank;
    else
      result += text[k];
  }
  return result;
}

}  // namespace tessera::test
