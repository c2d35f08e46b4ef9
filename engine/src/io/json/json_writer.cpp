// Writes .json models (tools/models/FORMAT.md): a surface is one spline of all its patches if these share borders,
// which keeps its parameters; otherwise one per patch. A patch on [0,1]^2 is a Bezier patch.

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "io/spline/model_formats.h"
#include "io/spline/patch_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// `text` in quotes. Bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text) {
  return nlohmann::json(std::string(text)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// The knots of patches between these borders: each inner one as often as the degree.
std::vector<double> knots_of(std::span<const double> breaks, int degree) {
  std::vector<double> knots{breaks.front()};
  for (const double border : breaks) knots.insert(knots.end(), static_cast<std::size_t>(degree), border);
  knots.push_back(breaks.back());
  return knots;
}

class JsonModelWriter {
 public:
  explicit JsonModelWriter(OutputFile& out) : out_(out) {}

  void begin() { write("{\n  \"format\": \"tessera\",\n  \"version\": 1,\n  \"surfaces\": ["); }
  void end() { write("\n  ]\n}\n"); }

  /// Returns false if the surface has trims that are left out.
  bool write_patches(const WrittenSurface& surface) {
    return write_as_nets(surface, out_, [this](const WrittenSurface& net) { write_surface(net); });
  }

 private:
  void write_surface(const WrittenSurface& surface) {
    const PatchNet net(surface);
    const BezierPatch& patch = surface.patches.front();
    write(surfaces_++ == 0 ? "\n" : ",\n");
    const bool is_patch = surface.patches.size() == 1 && surface.patch_domain(0) == Domain{};
    write("    {\n      \"kind\": ", is_patch ? "\"bezier\"" : net.is_rational() ? "\"nurbs\"" : "\"b_spline\"");
    if (!surface.name.empty()) write(",\n      \"name\": ", json_string(surface.name));
    if (!is_patch) {
      write(",\n      \"degree\": ");
      write_numbers(std::array<double, 2>{1.0 * patch.degree_u(), 1.0 * patch.degree_v()});
      write(",\n      \"knots_u\": ");
      write_numbers(knots_of(surface.breaks_u, patch.degree_u()));
      write(",\n      \"knots_v\": ");
      write_numbers(knots_of(surface.breaks_v, patch.degree_v()));
    }
    write_net(net, "points", [&](const PatchNet::Place& at) {
      const Vec3& p = at.patch->point(at.i, at.j);
      write_numbers(std::array{p.x, p.y, p.z});
    });
    if (net.is_rational())
      write_net(net, "weights", [&](const PatchNet::Place& at) { out_.write_number(at.patch->weight(at.i, at.j)); });
    write_trims(surface.trims);
    write("\n    }");
  }

  /// Writes rows along u.
  template <class Write>
  void write_net(const PatchNet& net, std::string_view key, Write&& write_element) {
    write(",\n      \"", key, "\": [");
    for (std::size_t i = 0; i < net.count_u(); ++i) {
      write(i == 0 ? "\n        [" : ",\n        [");
      for (std::size_t j = 0; j < net.count_v(); ++j) {
        if (j > 0) write(", ");
        write_element(net.place(i, j));
      }
      write("]");
    }
    write("\n      ]");
  }

  void write_trims(std::span<const TrimLoop> loops) {
    bool any = false;
    for (const TrimLoop& loop : loops) {
      if (loop.curves.empty()) continue;
      write(any ? ",\n        {" : ",\n      \"trims\": [\n        {");
      any = true;
      if (loop.hole) write("\"hole\": true, ");
      write("\"curves\": [");
      for (const Curve& curve : loop.curves) {
        write(&curve == &loop.curves.front() ? "\n          " : ",\n          ");
        write_curve(curve);
      }
      write("\n        ]}");
    }
    if (any) write("\n      ]");
  }

  /// Writes a curve in the parameters; its third coordinate means nothing.
  void write_curve(const Curve& curve) {
    write("{\"kind\": ", curve.is_rational() ? "\"nurbs\"" : "\"b_spline\"", ", \"degree\": ");
    out_.write_number(curve.degree());
    write(", \"knots\": ");
    write_numbers(curve.knots());
    write(", \"points\": [");
    for (const Vec3& p : curve.points()) {
      if (&p != &curve.points().front()) write(", ");
      write_numbers(std::array{p.x, p.y});
    }
    if (curve.is_rational()) {
      write("], \"weights\": ");
      write_numbers(curve.weights());
    } else {
      write("]");
    }
    write(", \"domain\": ");
    write_numbers(std::array{curve.domain().from, curve.domain().to});
    write("}");
  }

  void write_numbers(std::span<const double> numbers) {
    write("[");
    for (const double& number : numbers) {
      if (&number != &numbers.front()) write(", ");
      out_.write_number(number);
    }
    write("]");
  }

  template <class... Texts>
  void write(const Texts&... texts) {
    (out_.write(std::string_view(texts)), ...);
  }

  OutputFile& out_;
  std::size_t surfaces_ = 0;  // written so far
};

}  // namespace

Status write_json_model(std::span<const WrittenSurface> surfaces, OutputFile& out, std::vector<std::string>& warnings) {
  JsonModelWriter writer(out);
  writer.begin();
  for (std::size_t k = 0; k < surfaces.size() && !out.failed(); ++k)
    if (!writer.write_patches(surfaces[k]))
      warnings.push_back(trims_left_out(k, surfaces[k], "its patches do not share their borders"));
  writer.end();
  return {};
}

}}  // namespace tessera::abi_0_1
