#include "io/cad/kept_model.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "base/text.h"
#include "io/cad/model_bytes.h"
#include "tessera/cad.h"
#include "tessera/guard.h"
#include "tessera/version.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t head_size = greeting_size + sizeof(std::uint64_t);

Status parse_error(const std::string& name, const std::string& what) {
  return Status(StatusCode::parse_error, name + ": a model that was read before, " + what);
}

/// Checks what stands before a model. `bytes` begin as one.
Status check_head(std::string_view bytes, const std::string& name) {
  if (bytes.size() < head_size)
    return parse_error(name, "cut off after " + counted(bytes.size(), "byte") + ", expected " +
                                 std::to_string(head_size) + " before the model");
  const std::string_view greeting = bytes.substr(0, greeting_size);
  if (greeting != cad_reader_greeting())
    return Status(StatusCode::unsupported, name + ": a model that was read before by " + quoted_words(greeting) +
                                               ", expected " + quoted_words(cad_reader_greeting()) +
                                               ": read the file that it was made of");
  std::uint64_t stated = 0;
  std::memcpy(&stated, bytes.data() + greeting_size, sizeof stated);
  if (const std::size_t found = bytes.size() - head_size; found != stated)
    return parse_error(name, "found " + counted(found, "byte") + ", expected " + std::to_string(stated));
  return {};
}

/// Errors: unsupported (a surface without a form as bytes; index = the surface).
Status check_kinds(const Model& model) {
  for (std::size_t k = 0; k < model.surfaces.size(); ++k)
    if (!std::holds_alternative<BSplineSurface>(model.surfaces[k].surface))
      return in_surface(model, k, Status(StatusCode::unsupported, "it must be a B-spline, as those of read_cad() are"));
  for (const Shape& shape : model.shapes)
    for (const ShapeFace& face : shape.faces)
      if (!std::holds_alternative<BSplineSurface>(face.surface))
        return Status(StatusCode::unsupported,
                      "a face of shape \"" + *shape.name + "\" must be a B-spline, as those of read_cad() are");
  return {};
}

}  // namespace

std::string cad_reader_greeting() {
  std::string text = std::string(greeting_begin) + TESSERA_VERSION + ", models " + std::to_string(model_bytes_version);
  text.resize(greeting_size - 1, ' ');
  return text + '\n';
}

std::string quoted_words(std::string_view words) {
  constexpr std::size_t longest = 200;
  std::string text(words.substr(0, std::min(words.find_last_not_of(" \n") + 1, longest)));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  return '"' + text + '"';
}

bool begins_as_kept_model(std::string_view bytes) { return bytes.starts_with(greeting_begin); }

Result<Model> read_kept_model(std::string_view bytes, const std::string& name) {
  if (Status status = check_head(bytes, name); !status.ok()) return status;
  Result<Model> model = model_from_bytes(bytes.substr(head_size));
  if (model) return model;
  const Status& status = model.status();
  if (status.message().starts_with(damaged_model))
    return Status(StatusCode::parse_error, name + ": " + status.message());
  return model;
}

Result<std::string> cad_model_bytes(const Model& model) {
  return guarded([&]() -> Result<std::string> {
    if (Status status = check_kinds(model); !status.ok()) return status;
    const std::string bytes = to_bytes(model);
    const std::uint64_t size = bytes.size();
    std::string all = cad_reader_greeting();
    all.reserve(head_size + bytes.size());
    all.append(reinterpret_cast<const char*>(&size), sizeof size);
    return all += bytes;
  });
}

}}  // namespace tessera::abi_0_1
