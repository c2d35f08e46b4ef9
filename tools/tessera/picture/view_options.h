#pragma once
// Options of every picture: its size, its camera, and the axis that points up.

#include <string>
#include <vector>

#include "line/command_line.h"
#include "render/render.h"

namespace tessera::cli {

/// Adds --size, --camera and --up, and returns them. `default_size` stands in the help.
std::vector<const Option*> add_picture_view(Command& command, const std::string& default_size,
                                            render::Settings& settings);
/// Turns the camera of --camera upright. Call it after all options are read.
void turn_camera(render::Settings& settings);

}  // namespace tessera::cli
