// .bv, the files of BezierView (SurfLab, University of Florida). A file is a list of segments: the number of the kind,
// the degrees and the control points, the second parameter running fastest, all separated by white space. A "group n
// name" line between segments names those that follow. The layouts are those of the program's page
// (www.cise.ufl.edu/research/SurfLab/bview).

#include <array>
#include <string>

#include "io/file/make_room.h"
#include "io/file/passed_over.h"
#include "io/file/text_cursor.h"
#include "surface/net/patch_pool.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr PartName polyhedra{"polyhedron", "polyhedra"}, triangles{"triangular patch", "triangular patches"},
    pn_triangles{"PN triangle", "PN triangles"}, pn_quads{"PN quad", "PN quads"};

/// Largest degree of a segment that is skipped: its numbers are skipped one by one.
constexpr std::int64_t degree_limit = 1000;

bool is_group(std::string_view token) {
  constexpr std::string_view word = "group";
  if (token.size() != word.size()) return false;
  for (std::size_t k = 0; k < word.size(); ++k) {
    if ((token[k] | 0x20) != word[k]) return false;
  }
  return true;
}

class BvReader {
 public:
  BvReader(std::string_view text, std::string_view name)
      : cursor_(text, name), size_(text.size()), passed_over_(name) {}

  Result<Model> read() {
    for (cursor_.skip_space(); !cursor_.at_end(); cursor_.skip_space()) {
      const Status status = is_group(cursor_.peek_token()) ? read_group() : read_segment();
      if (!status.ok()) return status;
    }
    if (model_.surfaces.empty()) {
      return passed_over_.empty() ? cursor_.expected("a segment of surfaces") : passed_over_.nothing_else();
    }
    model_.warnings = passed_over_.warnings();
    return std::move(model_);
  }

 private:
  Status read_group() {
    cursor_.skip(cursor_.peek_token());
    std::int64_t number = 0;
    cursor_.skip_blanks();
    if (!cursor_.take_number(number)) return cursor_.expected("the number of the group");
    cursor_.skip_blanks();
    const char *const begin = cursor_.position(), *end = begin;
    for (; !cursor_.at_line_end(); cursor_.skip_blanks()) {
      cursor_.skip(cursor_.peek_token());
      end = cursor_.position();
    }
    group_ = surface_name({begin, static_cast<std::size_t>(end - begin)});
    return {};
  }

  Status read_segment() {
    const TextCursor begin = cursor_;
    std::int64_t kind = 0;
    if (cursor_.take_number(kind)) {
      ++segment_;
      if (kind == 4 || kind == 5 || kind == 8) return read_patch(kind == 4, kind == 8);
      if (kind == 1) return pass_over_polyhedron(begin);
      if (kind == 3 || kind == 9) return pass_over_triangle(begin, kind == 9);
      if (kind == 10) return pass_over_pn_quad(begin);
    }
    return begin.expected("a group line or the kind of a segment (1, 3, 4, 5, 8, 9 or 10)");
  }

  std::string segment() const { return "segment " + std::to_string(segment_); }

  Status read_integer(std::string_view what, std::int64_t low, std::int64_t high, std::int64_t& value) {
    cursor_.skip_space();
    const TextCursor before = cursor_;
    if (cursor_.take_number(value) && value >= low && value <= high) return {};
    return before.expected(std::string(what) + " of " + segment() + ", from " + std::to_string(low) + " to " +
                           std::to_string(high));
  }

  Status read_patch(bool equal_degrees, bool rational) {
    std::int64_t degree_u = 0, degree_v = 0;
    Status status = read_integer("the degree along u", 1, max_degree, degree_u);
    degree_v = degree_u;
    if (status.ok() && !equal_degrees) status = read_integer("the degree along v", 1, max_degree, degree_v);
    if (!status.ok()) return status;
    const auto wanted = static_cast<std::size_t>((degree_u + 1) * (degree_v + 1));
    for (std::size_t k = 0; k < wanted && status.ok(); ++k) status = read_point(rational, k, wanted);
    if (!status.ok()) return status;
    const auto points = std::span<const Vec3>(points_).first(wanted);
    const int m = static_cast<int>(degree_u), n = static_cast<int>(degree_v);
    Result<BezierPatch> patch =
        rational ? BezierPatch::rational(m, n, points, std::span<const double>(weights_).first(wanted))
                 : BezierPatch::polynomial(m, n, points);
    if (!patch) return refused_element(cursor_, patch.status(), segment() + ": ");
    make_room(model_.surfaces, size_ - cursor_.remaining(), size_);
    model_.surfaces.push_back({group_, pool_.placed(*patch)});
    return {};
  }

  /// Reads point k. The file holds rational points as x w, y w, z w, w.
  Status read_point(bool rational, std::size_t k, std::size_t wanted) {
    Vec3& point = points_[k];
    for (double* const coordinate : {&point.x, &point.y, &point.z}) {
      if (!read_finite(*coordinate)) return point_failure(rational, k, wanted);
    }
    if (!rational) return {};
    cursor_.skip_space();
    const TextCursor before = cursor_;
    double& weight = weights_[k];
    if (!read_finite(weight)) return point_failure(rational, k, wanted);
    if (!(weight > 0)) {
      return before.expected("a weight above 0 for control point " + std::to_string(k + 1) + " of " + segment());
    }
    point = {point.x / weight, point.y / weight, point.z / weight};
    if (is_finite(point)) return {};
    return before.failure("control point " + std::to_string(k + 1) + " of " + segment() +
                          " is too large for double after the division by its weight");
  }

  bool read_finite(double& value) {
    cursor_.skip_space();
    return cursor_.take_finite(value);
  }

  Status point_failure(bool rational, std::size_t found, std::size_t wanted) const {
    const std::string count =
        std::to_string(found) + " of " + std::to_string(wanted) + " control points of " + segment();
    if (cursor_.at_end()) return cursor_.failure("the file ends after " + count);
    return cursor_.expected((rational ? "4 finite numbers (x w, y w, z w, w)" : "3 finite numbers") +
                            std::string(" for a control point (after ") + count + ")");
  }

  /// Skips vertices, then faces: each the number of its corners, and their indices.
  Status pass_over_polyhedron(const TextCursor& begin) {
    constexpr std::int64_t limit = std::int64_t{1} << 60;
    std::int64_t vertices = 0, faces = 0, corners = 0, index = 0;
    Status status = read_integer("the number of vertices", 0, limit, vertices);
    if (status.ok()) status = read_integer("the number of faces", 0, limit, faces);
    if (status.ok()) status = pass_over_numbers(3 * vertices, "a coordinate of the vertices");
    for (std::int64_t k = 0; k < faces && status.ok(); ++k) {
      status = read_integer("the number of corners of a face", 0, limit, corners);
      for (std::int64_t c = 0; c < corners && status.ok(); ++c) {
        status = read_integer("the index of a corner", 0, vertices - 1, index);
      }
    }
    if (status.ok()) passed_over_.add(polyhedra, begin);
    return status;
  }

  /// Skips the points of a triangle, stored in rows, and the normals of a PN triangle likewise.
  Status pass_over_triangle(const TextCursor& begin, bool normals) {
    std::int64_t degree = 0, normal_degree = 0;
    Status status = read_integer("the degree", 0, degree_limit, degree);
    if (status.ok() && normals) status = read_integer("the degree of the normals", 0, degree_limit, normal_degree);
    const auto points = [](std::int64_t n) { return (n + 1) * (n + 2) / 2; };
    if (status.ok()) status = pass_over_numbers(3 * points(degree), "a coordinate of the control points");
    if (status.ok() && normals) status = pass_over_numbers(3 * points(normal_degree), "a coordinate of the normals");
    if (status.ok()) passed_over_.add(normals ? pn_triangles : triangles, begin);
    return status;
  }

  Status pass_over_pn_quad(const TextCursor& begin) {
    std::array<std::int64_t, 4> degrees{};
    for (std::int64_t& degree : degrees) {
      Status status = read_integer("a degree", 0, degree_limit, degree);
      if (!status.ok()) return status;
    }
    const auto points = [](std::int64_t m, std::int64_t n) { return (m + 1) * (n + 1); };
    Status status = pass_over_numbers(3 * points(degrees[0], degrees[1]), "a coordinate of the control points");
    if (status.ok()) status = pass_over_numbers(3 * points(degrees[2], degrees[3]), "a coordinate of the normals");
    if (status.ok()) passed_over_.add(pn_quads, begin);
    return status;
  }

  Status pass_over_numbers(std::int64_t count, std::string_view what) {
    for (std::int64_t k = 0; k < count; ++k) {
      cursor_.skip_space();
      double value = 0;
      if (!cursor_.take_number(value)) return cursor_.expected(std::string(what) + " of " + segment());
    }
    return {};
  }

  TextCursor cursor_;
  std::size_t size_;
  PassedOver passed_over_;
  Model model_;
  PatchPool pool_;
  Shared<std::string> group_;
  std::size_t segment_ = 0;
  std::array<Vec3, (max_degree + 1) * (max_degree + 1)> points_;
  std::array<double, (max_degree + 1) * (max_degree + 1)> weights_;
};

}  // namespace

Result<Model> parse_bv(std::string_view text, std::string_view name) {
  return guarded([&] { return BvReader(text, name).read(); });
}

}}  // namespace tessera::abi_0_1
