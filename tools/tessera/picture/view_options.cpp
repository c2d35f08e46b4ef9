#include "picture/view_options.h"

#include "line/arguments.h"
#include "render/camera.h"

namespace tessera::cli {
namespace {

render::Camera parse_camera(const std::string& text) {
  const std::vector<double> n = parse_numbers("--camera", text, 7, "ex,ey,ez,tx,ty,tz,fovdeg");
  render::Camera camera;
  camera.eye = {n[0], n[1], n[2]};
  camera.target = {n[3], n[4], n[5]};
  camera.fov_degrees = n[6];
  const Status status = render::check(camera);
  if (!status.ok()) throw UsageError("--camera", status.message());
  return camera;
}

}  // namespace

std::vector<const Option*> add_picture_view(Command& command, const std::string& default_size,
                                            render::Settings& settings) {
  const auto set_size = [&settings](const std::string& text) {
    const Extent size = parse_extent("--size", text, 1, 16384);
    settings.width = size.first;
    settings.height = size.second;
  };
  const auto set_up = [&settings](const std::string& text) {
    settings.up = text == "x" ? render::Up::x : text == "y" ? render::Up::y : render::Up::z;
  };
  const auto set_camera = [&settings](const std::string& text) { settings.camera = parse_camera(text); };
  return {&command.add("--size", "WxH", "Pixels of the picture, 1 to 16384 each [" + default_size + "]", set_size),
          &command.add("--camera", "EX,EY,EZ,TX,TY,TZ,FOV",
                       "Eye, target, field of view in degrees over the picture's shorter side [a view from above that "
                       "fits the model]",
                       set_camera),
          &command.add_choice("--up", {"x", "y", "z"}, "The axis that points up [z]", set_up)};
}

void turn_camera(render::Settings& settings) {
  if (settings.camera) settings.camera->up = render::from_z_up({0, 0, 1}, settings.up);
}

}  // namespace tessera::cli
