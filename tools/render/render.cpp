#include "render/render.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "render/random.h"
#include "render/tile.h"
#include "tessera/guard.h"

namespace tessera::render {
namespace {

constexpr int tile_side = band_height;
constexpr double exposure = 0.58;

/// The curve of Narkowicz, ACES filmic tone mapping curve, 2016.
double tone(double x) {
  x *= exposure;
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

/// IEC 61966-2-1.
double to_srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }

/// The mean of a pixel's samples. Maps bright samples before averaging: otherwise edges in front of the sky would show
/// steps.
Vec3 average(const Vec3* colours, int count, bool lit) {
  Vec3 sum;
  for (int k = 0; k < count; ++k) {
    const Vec3& c = colours[k];
    sum += lit ? Vec3{tone(c.x), tone(c.y), tone(c.z)} : c;
  }
  sum = (1.0 / count) * sum;
  return lit ? Vec3{to_srgb(sum.x), to_srgb(sum.y), to_srgb(sum.z)} : sum;
}

std::uint8_t to_byte(double x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0, 1.0) * 255 + 0.5); }

/// Draws the samples that lie on a line: those that appear no farther from an edge than half a line's width.
void draw_edges(const View& view, Workspace& work) {
  const Vec3 ink = view.settings.shade == Shade::lambert ? Vec3{0.012, 0.014, 0.02} : Vec3{0.10, 0.11, 0.14};
  const double width = std::max(1.2, std::min(view.settings.width, view.settings.height) / 800.0);  // pixels
  constexpr double slant = 8;  // on surfaces that are seen at less than 7 degrees, lines are thinner
  for (std::size_t k = 0; k < work.hits.size(); ++k) {
    const Hit& hit = work.hits[k];
    if (hit.kind != HitKind::hit) continue;
    const double reach = 0.5 * width * hit.t * view.camera.pixel();
    const std::optional<Vec3> edge = view.settings.nearest_edge(hit, slant * reach);
    if (!edge) continue;
    const Vec3 &along = work.rays[k].direction, apart = hit.position - *edge;
    if (length(apart - dot(apart, along) * along) < reach) work.colours[k] = ink;
  }
}

Status draw(const View& view, const Tile& tile, Workspace& work, Image& image) {
  if (Status status = trace(view, tile, work); !status.ok()) return status;
  const bool lit = view.settings.shade == Shade::lambert;
  if (lit) {
    if (Status status = shade_lit(view, work); !status.ok()) return status;
  } else {
    shade_flat(view, work);
  }
  if (view.settings.nearest_edge) draw_edges(view, work);
  const int count = view.settings.samples * view.settings.samples;
  const Vec3* next = work.colours.data();
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    for (int x = tile.x; x < tile.x + tile.width; ++x, next += count) {
      const Vec3 colour = average(next, count, lit);
      const std::size_t at =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
      image.rgb[at] = to_byte(colour.x), image.rgb[at + 1] = to_byte(colour.y), image.rgb[at + 2] = to_byte(colour.z);
    }
  }
  return {};
}

/// Draws tiles on all threads of the caller's arena; stops at the first failure.
class Drawing {
 public:
  Drawing(const View& view, const Execution& execution, Image& image)
      : view_(view),
        execution_(execution),
        image_(image),
        columns_((image.width + tile_side - 1) / tile_side),
        tiles_(columns_ * ((image.height + tile_side - 1) / tile_side)) {}

  Status run() { return run(0, tiles_); }
  /// Draws the tiles of a band, if it is one of the picture.
  Status run_band(std::uint64_t band) {
    return run(static_cast<int>(band) * columns_, (static_cast<int>(band) + 1) * columns_);
  }
  std::uint64_t bands() const { return static_cast<std::uint64_t>(tiles_ / columns_); }

 private:
  Status run(int first, int end) {
    tbb::parallel_for(first, end, [this](int index) { draw_tile(index); });
    if (execution_.cancel && execution_.cancel->load()) return Status(StatusCode::cancelled, "cancelled by the caller");
    return status_;
  }

  void draw_tile(int index) {
    if (failed_ || (execution_.cancel && execution_.cancel->load(std::memory_order_relaxed))) return;
    Tile tile{index % columns_ * tile_side, index / columns_ * tile_side, 0, 0};
    tile.width = std::min(tile_side, image_.width - tile.x);
    tile.height = std::min(tile_side, image_.height - tile.y);
    // Isolated: a thread that waits for rays must not begin another tile in the same workspace.
    Status status = tbb::this_task_arena::isolate([&] { return draw(view_, tile, workspaces_.local(), image_); });
    const std::lock_guard lock(mutex_);
    if (!status.ok()) {
      if (!failed_) status_ = std::move(status);
      failed_ = true;
      return;
    }
    ++done_;
    if (execution_.progress) execution_.progress(static_cast<double>(done_) / tiles_);
  }

  const View& view_;
  const Execution& execution_;
  Image& image_;
  tbb::enumerable_thread_specific<Workspace> workspaces_;
  int columns_, tiles_;
  std::mutex mutex_;
  std::atomic<bool> failed_ = false;
  Status status_;
  int done_ = 0;
};

}  // namespace

Status check(const Settings& settings, const Box3& box) {
  constexpr int largest_side = 32768, max_samples = 16;
  const auto bad = [](const char* why) { return Status(StatusCode::invalid_argument, why); };
  if (box.empty() || !is_finite(box.lower) || !is_finite(box.upper))
    return bad("there is nothing to draw: the box is empty");
  if (std::min(settings.width, settings.height) < 1 || std::max(settings.width, settings.height) > largest_side)
    return bad("a picture's sides run from 1 to 32768 pixels");
  if (settings.samples < 1 || settings.samples > max_samples) return bad("samples run from 1 to 16");
  if (settings.shade == Shade::error && !settings.error) return bad("there is no error to be shaded");
  return settings.camera ? render::check(*settings.camera) : Status();
}

Status trace(const View& view, const Tile& tile, Workspace& work) {
  const int side = view.settings.samples;
  work.samples.clear();
  work.rays.clear();
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    for (int x = tile.x; x < tile.x + tile.width; ++x) {
      const auto pixel = static_cast<std::uint32_t>(y * view.settings.width + x);
      for (int k = 0; k < side * side; ++k) {
        const Point2 at = stratified(pixel, k, side, Purpose::pixel);
        work.samples.push_back({pixel, k});
        work.rays.push_back(view.camera.through(x + at.x, y + at.y));
      }
    }
  }
  work.hits.resize(work.rays.size());
  return view.scene.closest(work.rays, work.hits, Execution{.cancel = view.cancel, .progress = {}});
}

namespace {

/// Prepares a picture and draws it by draw(drawing).
template <class Draw>
Result<Image> render_by(const RayScene& scene, const Box3& box, const Settings& settings, const Execution& execution,
                        const Draw& draw_picture) {
  if (Status status = check(settings, box); !status.ok()) return status;
  return guarded([&]() -> Result<Image> {
    Image image{settings.width, settings.height, {}};
    image.rgb.resize(3 * static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height));
    const Camera camera = choose_camera(settings, box);
    const Environment environment(box, camera.eye, settings.up);
    const PixelRays rays(camera, settings.width, settings.height);
    const View view{scene, environment, rays, settings, box.diagonal(), execution.cancel};
    Drawing drawing(view, execution, image);
    if (Status status = draw_picture(drawing); !status.ok()) return status;
    return image;
  });
}

}  // namespace

Result<Image> render(const RayScene& scene, const Box3& box, const Settings& settings, const Execution& execution) {
  return render_by(scene, box, settings, execution, [](Drawing& drawing) { return drawing.run(); });
}

Result<Image> render_bands(const RayScene& scene, const Box3& box, const Settings& settings,
                           const std::function<Result<std::uint64_t>()>& next_band, const Execution& execution) {
  return render_by(scene, box, settings, execution, [&](Drawing& drawing) -> Status {
    for (;;) {
      const Result<std::uint64_t> band = next_band();
      if (!band) return band.status();
      if (*band >= drawing.bands()) return {};
      if (Status status = drawing.run_band(*band); !status.ok()) return status;
    }
  });
}

}  // namespace tessera::render
