#include "compare/deviation_files.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#include "console/progress.h"
#include "render/caption.h"
#include "render/colours.h"
#include "render/mesh_patches.h"

namespace tessera::cli {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written in the machine's own byte order");

/// The bar of colours: from 0, or from the deviation to the inside where surfaces are closed.
render::ColourBar deviation_bar(double full, bool has_sides) {
  const std::string end = readable(full, 3);
  if (!has_sides) return {render::error_colour, {{0, "0"}, {0.5, readable(full / 2, 3)}, {1, end}}};
  return {[](double place) { return render::deviation_colour(2 * place - 1); },
          {{0, "-" + end}, {0.5, "0"}, {1, "+" + end}}};
}

template <class T>
void write_values(OutputFile& out, std::span<const T> values) {
  out.write(std::string_view(reinterpret_cast<const char*>(values.data()), values.size_bytes()));
}

}  // namespace

Status draw_deviations(const ComparedModel& model, const Mesh& mesh, const DeviationPicture& picture, OutputFile& out,
                       Timings& timings) {
  const auto phase = timings.phase("draw");
  render::MeshPatches faces;
  if (Status status = faces.add(mesh); !status.ok()) return status;
  Result<PatchSet> set = faces.pack();
  if (!set) return set.status();
  const Result<RayScene> rays = RayScene::make(*set, {}, Progress("building the scene").execution());
  if (!rays) return rays.status();
  render::Settings settings = picture.view;
  settings.shade = render::Shade::error;
  settings.samples = 2;  // distances are slow
  settings.signed_error = model.is_closed();
  settings.error = [&](const Vec3& point) { return model.deviation(point) / picture.full; };
  settings.normal = [&](const Hit& hit) { return faces.normal(hit); };
  Progress progress("casting rays");
  Result<render::Image> image = render::render(*rays, rays->box(), settings, progress.execution());
  if (!image) return image.status();
  render::add_colour_bar(*image, deviation_bar(picture.full, model.is_closed()));
  render::add_caption(*image, {picture.caption});
  return render::write_png(*image, out);
}

Status write_deviation_ply(const Mesh& mesh, std::span<const float> deviations, OutputFile& out) {
  const bool doubles = !mesh.model_positions.empty() || mesh.origin != Vec3{};
  const std::string type = doubles ? "double " : "float ";
  out.write("ply\nformat binary_little_endian 1.0\ncomment Tessera: quality is the deviation from a model\n");
  out.write("element vertex " + std::to_string(mesh.vertex_count()) + "\n");
  for (const char* const name : {"x", "y", "z"}) out.write("property " + type + name + "\n");
  out.write("property float quality\nelement face " + std::to_string(mesh.triangle_count()) +
            "\nproperty list uchar uint vertex_indices\nend_header\n");
  for (std::size_t k = 0; k < mesh.vertex_count() && !out.failed(); ++k) {
    const Vec3 p = render::position_of(mesh, k);
    if (doubles)
      write_values<double>(out, std::array{p.x, p.y, p.z});
    else
      write_values<float>(out, std::array{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    write_values<float>(out, std::array{deviations[k]});
  }
  for (std::size_t k = 0; k < mesh.triangle_count() && !out.failed(); ++k) {
    out.write(char{3});
    write_values<std::uint32_t>(out, std::span(mesh.indices).subspan(3 * k, 3));
  }
  return {};
}

}  // namespace tessera::cli
