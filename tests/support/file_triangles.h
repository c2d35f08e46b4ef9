#pragma once
// The triangles of mesh files, read in double by code that shares nothing with the library's readers. For files that
// the library writes, without quads.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tessera/geometry.h"

namespace tessera::test {

using FileTriangle = std::array<Vec3, 3>;

namespace file_triangles {

template <class T>
T take(const char*& at) {
  T value{};
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}
template <class T>
Vec3 take_vector(const char*& at) {
  const double x = take<T>(at), y = take<T>(at), z = take<T>(at);
  return {x, y, z};
}

inline std::vector<FileTriangle> of_stl(const std::string& bytes) {
  const char* at = bytes.data() + 80;
  std::vector<FileTriangle> triangles(take<std::uint32_t>(at));
  for (FileTriangle& triangle : triangles) {
    at += 12;
    for (Vec3& corner : triangle) corner = take_vector<float>(at);
    at += 2;
  }
  return triangles;
}

inline std::vector<FileTriangle> of_obj(const std::string& text) {
  std::vector<Vec3> points;
  std::vector<FileTriangle> triangles;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string keyword, corner;
    words >> keyword;
    if (keyword == "v") {
      Vec3 point;
      words >> point.x >> point.y >> point.z;
      points.push_back(point);
    } else if (keyword == "f") {
      FileTriangle& triangle = triangles.emplace_back();
      for (Vec3& of : triangle) words >> corner, of = points.at(std::stoul(corner) - 1);
    }
  }
  return triangles;
}

inline std::vector<FileTriangle> of_ply(const std::string& bytes) {
  std::size_t vertices = 0, faces = 0, face_bytes = 0, vertex_bytes = 0;
  bool is_double = false, is_face = false;
  const std::string mark = "end_header\n";
  std::istringstream header(bytes.substr(0, bytes.find(mark)));
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "element") (second == "vertex" ? vertices : faces) = std::stoul(third), is_face = second == "face";
    if (first != "property") continue;
    if (third == "x") is_double = second == "double";
    (is_face ? face_bytes : vertex_bytes) += second == "double" ? 8 : second == "list" ? 13 : 4;
  }
  const char* at = bytes.data() + bytes.find(mark) + mark.size();
  std::vector<Vec3> points(vertices);
  for (Vec3& point : points) {
    const char* own = at;
    point = is_double ? take_vector<double>(own) : take_vector<float>(own);
    at += vertex_bytes;
  }
  std::vector<FileTriangle> triangles(faces);
  for (FileTriangle& triangle : triangles) {
    const char* own = at + 1;
    for (Vec3& corner : triangle) corner = points.at(take<std::uint32_t>(own));
    at += face_bytes;
  }
  return triangles;
}

/// Reads one mesh below nodes of which one moves it, and one turns +Z to +Y; returns it as it was before the turn.
inline std::vector<FileTriangle> of_glb(const std::string& bytes) {
  const char* at = bytes.data() + 12;
  const auto text_bytes = take<std::uint32_t>(at);
  const auto json = nlohmann::json::parse(bytes.substr(20, text_bytes));
  const char* const numbers = bytes.data() + 20 + text_bytes + 8;
  Vec3 origin;
  for (const auto& node : json["nodes"])
    if (node.contains("translation")) {
      const auto& t = node["translation"];
      origin = {t[0], t[1], t[2]};
    } else if (node.contains("matrix")) {
      const auto m = node["matrix"].get<std::vector<double>>();
      const std::vector<double> turn{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0};
      if (!std::equal(turn.begin(), turn.end(), m.begin())) throw std::runtime_error("another turn than upwards");
      if (m[12] != 0 || m[13] != 0 || m[14] != 0) origin = {m[12], -m[14], m[13]};
    }
  const auto place = [&](int accessor) {
    const auto& of = json["accessors"][static_cast<std::size_t>(accessor)];
    const auto& view = json["bufferViews"][of["bufferView"].get<std::size_t>()];
    return numbers + view.value("byteOffset", 0) + of.value("byteOffset", 0);
  };
  std::vector<FileTriangle> triangles;
  for (const auto& mesh : json["meshes"])
    for (const auto& primitive : mesh["primitives"]) {
      const int indices = primitive["indices"], positions = primitive["attributes"]["POSITION"];
      const std::size_t count = json["accessors"][static_cast<std::size_t>(indices)]["count"];
      const char* index = place(indices);
      for (std::size_t k = 0; k < count / 3; ++k) {
        FileTriangle& triangle = triangles.emplace_back();
        for (Vec3& corner : triangle) {
          const char* point = place(positions) + 12 * std::size_t{take<std::uint32_t>(index)};
          corner = origin + take_vector<float>(point);
        }
      }
    }
  return triangles;
}

}  // namespace file_triangles

inline std::vector<FileTriangle> triangles_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (path.ends_with(".stl")) return file_triangles::of_stl(bytes);
  if (path.ends_with(".obj")) return file_triangles::of_obj(bytes);
  if (path.ends_with(".ply")) return file_triangles::of_ply(bytes);
  if (path.ends_with(".glb")) return file_triangles::of_glb(bytes);
  throw std::runtime_error(path + ": no reader");
}

/// The largest distance of a sphere's surface from corners and middles of triangles.
inline double distance_from_sphere(const std::vector<FileTriangle>& triangles, const Vec3& centre, double radius) {
  double largest = 0;
  for (const FileTriangle& t : triangles)
    for (const Vec3& point : {t[0], t[1], t[2], (1.0 / 3) * (t[0] + t[1] + t[2])})
      largest = std::max(largest, std::abs(length(point - centre) - radius));
  return largest;
}

}  // namespace tessera::test
