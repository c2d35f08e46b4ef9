// The picture by POV-Ray's bicubic_patch, kept as its bounding tree in memory (type 1), in a process of its own. The
// surface is coloured by height, without light, in 16 bits per channel, so that its hits can be compared: red is the
// height within the picture's range, green is 1 where anything was hit. The time is the processor time of tracing that
// POV-Ray prints.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <regex>
#include <stdexcept>

#include "peers/ray_task.h"

namespace tessera::bench { namespace {

namespace fs = std::filesystem;

std::string vector_text(const Vec3& p) {
  char text[100];
  std::snprintf(text, sizeof text, "<%.15g, %.15g, %.15g>", p.x, p.y, p.z);
  return text;
}

/// The output of a program on both streams. Throws if the program fails.
std::string output_of(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("no process for " + command);
  std::string text;
  for (std::array<char, 4096> part; const std::size_t read = std::fread(part.data(), 1, part.size(), pipe);)
    text.append(part.data(), read);
  if (pclose(pipe) != 0) throw std::runtime_error(command + " failed:\n" + text);
  return text;
}

/// The version found at run time; empty if POV-Ray does not run.
std::string version() {
  try {
    std::smatch found;
    const std::string text = output_of("povray --version");
    return std::regex_search(text, found, std::regex("POV-Ray ([0-9.]*[0-9])")) ? found[1].str() : "";
  } catch (const std::runtime_error&) {
    return "";
  }
}

class Casting {
 public:
  explicit Casting(const RayTask& task) : task_(task) {
    std::string name = (fs::temp_directory_path() / "tessera-povray-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no folder " + name);
    folder_ = name;
    low_ = task.box.lower.z - 0.1 * task.size;
    height_ = task.box.upper.z + 0.1 * task.size - low_;
    write_scene();
  }
  ~Casting() { fs::remove_all(folder_); }
  Casting(const Casting&) = delete;
  Casting& operator=(const Casting&) = delete;

  double run() {
    const std::string side = std::to_string(task_.camera.side), picture = (folder_ / "out.ppm").string();
    const std::string text =
        output_of("cd '" + folder_.string() + "' && povray +Iscene.pov +Oout.ppm +FP16 File_Gamma=1.0 +W" + side +
                  " +H" + side + " -D -A +WT1");
    read_picture(picture);
    std::smatch found;
    const std::regex time(
        "Trace Time:[^(]*\\(([0-9.]+) seconds\\)\\s*using 1 thread\\(s\\) with ([0-9.]+) CPU-seconds");
    if (!std::regex_search(text, found, time)) throw std::runtime_error("POV-Ray says no time:\n" + text);
    return std::stod(found[2].str());
  }
  double t(std::size_t pixel) const {
    const auto channel = [&](std::size_t c) {
      const std::size_t at = 6 * pixel + 2 * c;
      return (256 * static_cast<unsigned char>(pixels_[at]) + static_cast<unsigned char>(pixels_[at + 1])) / 65535.0;
    };
    if (channel(1) < 0.5) return std::numeric_limits<double>::infinity();
    const Ray ray = task_.camera.ray(pixel);
    return (low_ + channel(0) * height_ - ray.origin.z) / ray.direction.z;
  }

 private:
  void write_scene() const {
    std::ofstream file(folder_ / "scene.pov");
    const RayCamera& camera = task_.camera;
    file << "#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\nbackground { rgb 0 }\ncamera { perspective location "
         << vector_text(camera.eye) << " right " << vector_text(camera.right) << " up " << vector_text(camera.up)
         << " direction " << vector_text(camera.forward) << " }\nunion {\n";
    for (std::size_t patch = 0; patch < task_.set.patch_count(); ++patch) {
      file << "bicubic_patch { type 1 flatness 0 u_steps 3 v_steps 3";  // 2^3 = facets_per_side
      for (const Vec3& p : task_.set.patch(patch).points()) file << ", " << vector_text(p);
      file << " }\n";
    }
    file << "pigment { gradient z color_map { [0 rgb <0, 1, 0>] [1 rgb <1, 1, 0>] } scale <1, 1, " << height_
         << "> translate <0, 0, " << low_ << "> }\nfinish { ambient 0 diffuse 0 emission 1 } }\n";
    file.close();
    if (!file) throw std::runtime_error("the scene for POV-Ray can't be written");
  }
  /// The next word of a picture's header; lines that begin with # are comments.
  static std::string word(std::ifstream& file) {
    std::string text;
    while (file >> text && text.starts_with('#')) std::getline(file, text);
    return text;
  }
  void read_picture(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string side = std::to_string(task_.camera.side);
    const bool expected = word(file) == "P6" && word(file) == side && word(file) == side && word(file) == "65535";
    file.get();
    pixels_.assign(std::istreambuf_iterator<char>(file), {});
    if (!expected || pixels_.size() != 6 * task_.camera.rays())
      throw std::runtime_error("POV-Ray's picture is not the one that was asked for");
  }

  const RayTask& task_;
  fs::path folder_;
  double low_ = 0, height_ = 1;
  std::string pixels_;
};

const bool registered = [] {
  static const std::string found = version();
  if (found.empty()) return false;
  ray_peers().push_back({"POV-Ray", [](const RayTask& task) {
                           const auto casting = std::make_shared<Casting>(task);
                           return std::vector<RayRun>{{"POV-Ray " + found, "bicubic_patch", 1,
                                                       [=] { return casting->run(); },
                                                       [=](std::size_t ray) { return casting->t(ray); }}};
                         }});
  return true;
}();

}}  // namespace tessera::bench
