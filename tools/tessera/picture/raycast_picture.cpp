// Pictures of scenes: files, and characters of a terminal.

#include <cmath>

#include "console/output.h"
#include "console/progress.h"
#include "picture/raycast.h"
#include "picture/terminal_picture.h"
#include "render/caption.h"
#include "render/colours.h"
#include "render/hit_image.h"

namespace tessera::cli {
namespace {

Result<render::Image> draw(const RaycastScene& scene, const RaycastOptions& options, const render::Settings& settings,
                           Timings& timings) {
  const auto phase = timings.phase("evaluate");
  Progress progress("casting rays");
  return options.team ? options.team->draw(scene.rays, scene.box(), settings, progress.execution())
                      : render::render(scene.rays, scene.box(), settings, progress.execution());
}

/// The error of a picture with its file; a team's names the process that failed.
Status named(const Job& job, const RaycastOptions& options, const Status& status) {
  return options.team ? status : in_file(job.output, status);
}

/// The bar that explains the colours of a shade; nothing for shades whose colours are no numbers.
std::optional<render::ColourBar> colour_bar(render::Shade shade, const RaycastScene& scene) {
  if (shade == render::Shade::error && scene.error) {
    const double red = scene.error->red;
    return render::ColourBar{render::error_colour, {{0, "0"}, {0.5, readable(red / 2, 3)}, {1, readable(red, 3)}}};
  }
  if (shade == render::Shade::curvature) {
    const double full = render::curvature_at(0.5, scene.box().diagonal());
    return render::ColourBar{[](double place) { return render::curvature_colour(2 * place - 1); },
                             {{0.25, readable(-full, 3)}, {0.5, "0"}, {0.75, readable(full, 3)}}};
  }
  if (shade == render::Shade::steps) {
    const auto steps = [](double place) { return std::pow(render::max_steps_shown, place); };
    return render::ColourBar{[steps](double place) { return render::cost_colour(steps(place)); },
                             {{0, "1"}, {0.5, readable(steps(0.5))}, {1, readable(steps(1))}}};
  }
  return {};
}

/// Writes the picture: with a bar if colours are numbers, and a caption if the model is trimmed or an error is shown.
Status write_colours(const Job& job, const RaycastOptions& options, const render::Settings& settings,
                     const RaycastScene& scene, OutputFile& out, Timings& timings) {
  Result<render::Image> image = draw(scene, options, settings, timings);
  if (!image) return named(job, options, image.status());
  if (!options.writes()) return {};
  if (const auto bar = colour_bar(settings.shade, scene)) render::add_colour_bar(*image, *bar);
  if (const std::vector<std::string> captions = scene.captions(); !captions.empty())
    render::add_caption(*image, captions);
  const std::string warning = scene.surfaces_caption();
  const auto phase = timings.phase("write");
  Status status =
      render::write_png(*image, out, warning.empty() ? render::PngTexts{} : render::PngTexts{{"Warning", warning}});
  return status.ok() ? out.commit() : status;
}

Status write_numbers(const Job& job, const RaycastOptions& options, const render::Settings& settings,
                     const RaycastScene& scene, OutputFile& out, Timings& timings) {
  const render::ClosestHits closest = [&](std::span<const Ray> rays, std::span<Hit> hits, const Execution& execution) {
    return scene.closest(options, rays, hits, execution);
  };
  const Result<render::HitImage> image = timings.measure("evaluate", [&] {
    Progress progress("casting rays");
    return render::cast_hits(closest, scene.box(), scene.loaded.model, settings, progress.execution());
  });
  if (!image) return named(job, options, image.status());
  if (!options.writes()) return {};
  const auto phase = timings.phase("write");
  Status status = render::write_exr(*image, out);
  return status.ok() ? out.commit() : status;
}

}  // namespace

Status draw_file(const Job& job, const RaycastOptions& options, const CommonOptions& common, const RaycastScene& scene,
                 OutputFile& out, Timings& timings) {
  const render::Settings settings = scene.settings(options);
  const bool numbers = is_exr(format_path(job.output, options.format));
  const Status written = numbers ? write_numbers(job, options, settings, scene, out, timings)
                                 : write_colours(job, options, settings, scene, out, timings);
  if (!written.ok()) return written;
  const std::vector<std::string> captions = scene.captions();
  Report report = report_of(job, scene.loaded);
  report.add("width", settings.width, std::to_string(settings.width));
  report.add("height", settings.height, " x " + std::to_string(settings.height) + ", " + scene.counted_parts());
  report.add("mode", name_of(options.mode));
  report.add("triangles", scene.meshes ? Json(scene.meshes->triangle_count()) : Json());
  report.add("caption", numbers || captions.empty() ? "" : captions.front());
  if (scene.error) scene.error->add_to(report);
  add_model_facts(report, scene.loaded, scene.patch_count(), scene.set.fit_error());
  report.say(fit_line(scene.set.fit_error()));
  return report.print(job.output, common, timings);
}

Status draw_characters(const RaycastOptions& options, const RaycastScene& scene, OutputFile& out, Timings& timings) {
  render::Settings settings = scene.settings(options);
  if (!options.sized) {
    const PixelSize size = picture_size(terminal_size());
    settings.width = size.width;
    settings.height = size.height;
  }
  const Colours colours = output_colours(options.colour);
  if (colours == Colours::none) {
    // Brightness alone shows a model if nothing else is in the picture.
    settings.background = {};
    if (!options.shaded) settings.shade = render::Shade::clay;
  }
  const Result<render::Image> image = draw(scene, options, settings, timings);
  if (!image) return in_file(scene.loaded.files[0], image.status());
  const auto phase = timings.phase("write");
  out.write(as_characters(*image, colours));
  const std::vector<std::string> captions = scene.captions();
  out.write(scene.loaded.files[0] + (captions.empty() ? "" : ": " + captions.front()) + "\n");
  return out.commit();
}

}  // namespace tessera::cli
