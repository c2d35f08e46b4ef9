// Free-form curves and surfaces of Wavefront OBJ ("Object Files (.obj)", Appendix B1 of the Advanced Visualizer
// manual). Attributes (cstype, deg, step, bmat) hold until they are stated anew. An element (surf, curv, curv2) gathers
// its body (parm, trim, hole ...) and is made at its `end`. Statements about polygons and pictures are skipped and
// counted.

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/file/make_room.h"
#include "io/obj/freeform.h"
#include "io/obj/obj_index.h"
#include "io/obj/obj_notes.h"
#include "io/obj/obj_trims.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

enum class ElementKind : std::uint8_t { none, surf, curv, curv2 };

/// The body of an element, between `surf`, `curv` or `curv2` and its `end`.
struct Element {
  ElementKind kind = ElementKind::none;
  std::string_view statement;
  std::optional<TextCursor> place;
  Domain range;
  std::vector<std::uint32_t> points;
  std::vector<TrimLoop> loops;
};

bool begins_with_letter(std::string_view word) {
  return !word.empty() && ((word[0] >= 'a' && word[0] <= 'z') || (word[0] >= 'A' && word[0] <= 'Z'));
}

class ObjFreeformReader {
 public:
  ObjFreeformReader(std::string_view text, std::string_view name)
      : cursor_(text, name, {.separators = "/", .continuation = '\\'}), size_(text.size()), curves_(text.size()) {}

  Result<Model> read() {
    for (cursor_.skip_space(); !cursor_.at_end(); cursor_.skip_space()) {
      if (Status status = read_statement(); !status.ok()) return status;
      if (!cursor_.take_line_end()) return cursor_.expected("the end of the line");
    }
    if (element_.kind != ElementKind::none)
      return element_.place->failure("the file ends within this " + std::string(element_.statement) +
                                     ": it has no end statement");
    if (model_.surfaces.empty())
      return Status(StatusCode::unsupported,
                    std::string(cursor_.name()) + ": no free-form surface in it; polygon meshes are read by `check`");
    if (!notes_.empty()) model_.warnings.push_back(notes_.sentence());
    return std::move(model_);
  }

 private:
  struct Statement {
    std::string_view keyword;
    Status (ObjFreeformReader::*read)();
  };
  static const std::array<Statement, 20> statements;

  Status read_statement() {
    const std::string_view keyword = cursor_.peek_token();
    for (const Statement& statement : statements) {
      if (statement.keyword != keyword) continue;
      place_ = cursor_;
      cursor_.skip(keyword);
      cursor_.skip_blanks();
      return (this->*statement.read)();
    }
    if (!begins_with_letter(keyword))
      return cursor_.expected("a statement (is the line above to be continued, without a \\ at its end?)");
    notes_.add(keyword, cursor_);
    cursor_.skip_line();
    return {};
  }

  // Vertices.

  /// Reads up to `most` finite numbers to the end of the line; `count` is how many.
  template <std::size_t most>
  Status read_values(std::array<double, most>& values, std::size_t least, std::string_view what, std::size_t& count) {
    for (count = 0; count < most; ++count) {
      cursor_.skip_blanks();
      if (count >= least && cursor_.at_line_end()) break;
      if (!cursor_.take_finite(values[count])) return cursor_.expected(what);
    }
    return {};
  }

  /// Reads a vertex. A weight may follow, or a colour, or both.
  Status read_vertex() {
    std::array<double, 7> p;
    std::size_t count = 0;
    constexpr std::string_view what = "3 finite coordinates after v, perhaps a weight and a colour of 3";
    if (Status status = read_values(p, 3, what, count); !status.ok()) return status;
    if (count == 5) return cursor_.expected(what);
    if (vertices_.size() == std::numeric_limits<std::uint32_t>::max())
      return cursor_.failure("there are more vertices than 32-bit indices can tell apart");
    make_room(vertices_, size_ - cursor_.remaining(), size_);
    vertices_.push_back({p[0], p[1], p[2], count == 4 || count == 7 ? p[3] : 1});
    return {};
  }

  Status read_parameter_vertex() {
    std::array<double, 3> p;
    std::size_t count = 0;
    if (Status status = read_values(p, 1, "1 to 3 finite coordinates after vp", count); !status.ok()) return status;
    if (parameter_vertices_.size() == std::numeric_limits<std::uint32_t>::max())
      return cursor_.failure("there are more vp lines than 32-bit indices can tell apart");
    // Special points have one coordinate: the second is NaN, and a curve that refers to such a point fails.
    const double v = count > 1 ? p[1] : std::numeric_limits<double>::quiet_NaN();
    make_room(parameter_vertices_, size_ - cursor_.remaining(), size_);
    parameter_vertices_.push_back({p[0], v, 0, count > 2 ? p[2] : 1});
    return {};
  }

  Status count_texture_vertex() { return left_aside(texture_vertices_); }
  Status count_normal() { return left_aside(normals_); }
  Status left_aside(std::size_t& count) {
    ++count;
    notes_.add(place_.peek_token(), place_);
    cursor_.skip_line();
    return {};
  }

  // Attributes.

  Status read_type() {
    bool rational = false;
    std::string_view word = cursor_.peek_token();
    if (word == "rat") {
      rational = true;
      cursor_.skip(word);
      cursor_.skip_blanks();
      word = cursor_.peek_token();
    }
    constexpr std::array<std::pair<std::string_view, FreeformType>, 5> types{{{"bezier", FreeformType::bezier},
                                                                              {"bspline", FreeformType::bspline},
                                                                              {"cardinal", FreeformType::cardinal},
                                                                              {"taylor", FreeformType::taylor},
                                                                              {"bmatrix", FreeformType::bmatrix}}};
    for (const auto& [name, type] : types) {
      if (name != word) continue;
      cursor_.skip(word);
      state_.type = type;
      state_.rational = rational;
      return {};
    }
    return cursor_.expected("bezier, bspline, cardinal, taylor or bmatrix after cstype, perhaps with rat before it");
  }

  Status read_degree() { return read_pair(&FreeformLine::degree, "1 or 2 degrees after deg"); }
  Status read_step() { return read_pair(&FreeformLine::step, "1 or 2 steps after step"); }
  Status read_pair(std::optional<std::int64_t> FreeformLine::*member, std::string_view what) {
    std::int64_t u = 0, v = 0;
    if (!cursor_.take_number(u)) return cursor_.expected(what);
    state_.u.*member = u;
    (state_.v.*member).reset();
    cursor_.skip_blanks();
    if (cursor_.at_line_end()) return {};
    if (!cursor_.take_number(v)) return cursor_.expected(what);
    state_.v.*member = v;
    return {};
  }

  Status read_matrix() { return read_list(&FreeformLine::matrix, "bmat"); }
  Status read_parameters() { return read_list(&FreeformLine::parm, "parm"); }
  /// Reads the numbers after `bmat u` and the like.
  Status read_list(std::vector<double> FreeformLine::*member, std::string_view statement) {
    const std::string_view direction = cursor_.peek_token();
    if (direction != "u" && direction != "v") return cursor_.expected("u or v after " + std::string(statement));
    cursor_.skip(direction);
    std::vector<double>& values = (direction == "u" ? state_.u : state_.v).*member;
    values.clear();
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) {
      double value = 0;
      if (!cursor_.take_finite(value))
        return cursor_.expected("finite numbers after " + std::string(statement) + " " + std::string(direction));
      values.push_back(value);
    }
    if (values.empty())
      return cursor_.expected("numbers after " + std::string(statement) + " " + std::string(direction));
    return {};
  }

  // Names.

  Status read_object() { return read_name(object_); }
  Status read_group() { return read_name(group_); }
  /// Reads the rest of the line, at most 200 bytes of it.
  Status read_name(std::string& name) {
    constexpr std::size_t longest = 200;
    const char* const begin = cursor_.position();
    cursor_.skip_line();
    std::string_view line(begin, static_cast<std::size_t>(cursor_.position() - begin));
    line = line.substr(0, std::min(line.find(" #"), line.find("\t#")));
    std::size_t size = std::min(line.size(), longest);
    while (size < line.size() && size > 0 && (static_cast<unsigned char>(line[size]) & 0xC0) == 0x80) --size;
    line = line.substr(0, size);  // cuts between characters of UTF-8
    name.assign(line);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    name.erase(name.find_last_not_of(' ') + 1);
    surface_name_ = object_ + (object_.empty() || group_.empty() ? "" : "/") + group_;
    return {};
  }

  // Elements.

  Status begin(ElementKind kind) {
    if (element_.kind != ElementKind::none)
      return element_.place->failure("this " + std::string(element_.statement) + " has no end statement before the " +
                                     "next element");
    element_.kind = kind;
    element_.place = place_;
    element_.statement = place_.peek_token();
    element_.points.clear();
    element_.loops.clear();
    return {};
  }

  Status read_range(double& from, double& to, std::string_view what) {
    for (double* const value : {&from, &to}) {
      cursor_.skip_blanks();
      if (!cursor_.take_finite(*value)) return cursor_.expected(what);
    }
    return {};
  }

  Status read_surface() {
    if (Status status = begin(ElementKind::surf); !status.ok()) return status;
    constexpr std::string_view what = "4 finite numbers after surf, the ranges of u and v";
    if (Status status = read_range(element_.range.u0, element_.range.u1, what); !status.ok()) return status;
    if (Status status = read_range(element_.range.v0, element_.range.v1, what); !status.ok()) return status;
    return read_points();
  }

  Status read_curve() {
    if (Status status = begin(ElementKind::curv); !status.ok()) return status;
    Status status = read_range(element_.range.u0, element_.range.u1, "2 finite numbers after curv, the range of u");
    return status.ok() ? read_points() : status;
  }

  Status read_points() {
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) {
      std::uint32_t index = 0;
      Status status = read_obj_index(cursor_, "an index of a control point", "vertices", vertices_.size(), index);
      for (const bool normal : {false, true}) {
        if (!status.ok()) return status;
        if (!cursor_.take('/')) break;
        if (!normal && !cursor_.at_end() && *cursor_.position() == '/') continue;  // the form a//c
        std::uint32_t unused = 0;
        status = normal
                     ? read_obj_index(cursor_, "an index of a normal", "vn lines", normals_, unused)
                     : read_obj_index(cursor_, "an index of a texture vertex", "vt lines", texture_vertices_, unused);
      }
      if (!status.ok()) return status;
      element_.points.push_back(index);
    }
    return element_.points.size() < 2 ? cursor_.expected("at least 2 control points") : Status();
  }

  Status read_curve2() {
    if (Status status = begin(ElementKind::curv2); !status.ok()) return status;
    for (cursor_.skip_blanks(); !cursor_.at_line_end(); cursor_.skip_blanks()) {
      const TextCursor before = cursor_;
      std::uint32_t index = 0;
      Status status =
          read_obj_index(cursor_, "an index of a control point", "vp lines", parameter_vertices_.size(), index);
      if (!status.ok()) return status;
      const double v = parameter_vertices_[index].y;
      if (v != v) return before.expected("the index of a vp line with 2 coordinates");
      element_.points.push_back(index);
    }
    return element_.points.size() < 2 ? cursor_.expected("at least 2 control points") : Status();
  }

  Status read_trim() { return read_loop(false); }
  Status read_hole() { return read_loop(true); }
  Status read_loop(bool hole) {
    if (element_.kind != ElementKind::surf)
      return place_.failure("a " + std::string(place_.peek_token()) + " belongs between a surf and its end");
    TrimLoop loop{{}, hole};
    Status status = curves_.read_loop(cursor_, loop.curves);
    if (status.ok()) element_.loops.push_back(std::move(loop));
    return status;
  }

  Status read_end() {
    switch (element_.kind) {
      case ElementKind::none:
        return place_.failure("this end has no surf, curv or curv2 above");
      case ElementKind::curv:
        notes_.add("curv", *element_.place);
        break;
      case ElementKind::curv2: {
        Result<std::vector<Curve>> curves = freeform_curves(state_, {parameter_vertices_, element_.points});
        if (!curves) return in_element(curves.status(), "curv2 " + std::to_string(curves_.size() + 1));
        curves_.add(*std::move(curves));
        break;
      }
      case ElementKind::surf:
        if (Status status = make_surfaces(state_); !status.ok()) return status;
        break;
    }
    state_.u.parm.clear();
    state_.v.parm.clear();
    element_.kind = ElementKind::none;
    return {};
  }

  Status in_element(const Status& status, const std::string& what) const {
    return Status(status.code(), element_.place->place() + ": " + what + ": " + status.message(),
                  static_cast<std::ptrdiff_t>(model_.surfaces.size()));
  }

  Status make_surfaces(const FreeformState& state) {
    Result<std::vector<Surface>> surfaces = freeform_surfaces(state, {vertices_, element_.points}, element_.range);
    const std::string& name = *surface_name_;
    if (!surfaces)
      return in_element(surfaces.status(),
                        "surface " + std::to_string(model_.surfaces.size()) + (name.empty() ? "" : " (" + name + ")"));
    const Shared<std::vector<TrimLoop>> trims = std::move(element_.loops);
    for (std::size_t k = 0; k < surfaces->size(); ++k) {
      const Shared<std::string> piece =
          surfaces->size() == 1 ? surface_name_ : Shared<std::string>(name + "[" + std::to_string(k) + "]");
      make_room(model_.surfaces, size_ - cursor_.remaining(), size_);
      model_.surfaces.push_back({piece, std::move((*surfaces)[k]), {}, trims});
    }
    return {};
  }

  // The patches of release 2.11: 16 points, the range [0,1]^2 ("Superseded statements").

  Status read_old_bezier() { return read_old_patch(FreeformType::bezier, {0, 1}); }
  Status read_old_cardinal() { return read_old_patch(FreeformType::cardinal, {0, 1}); }
  Status read_old_b_spline() { return read_old_patch(FreeformType::bspline, {-3, -2, -1, 0, 1, 2, 3, 4}); }
  Status read_old_patch(FreeformType type, std::vector<double> parameters) {
    if (Status status = begin(ElementKind::surf); !status.ok()) return status;
    if (Status status = read_points(); !status.ok()) return status;
    element_.range = {};
    const FreeformLine line{3, {}, {}, std::move(parameters)};
    Status status = make_surfaces({type, false, line, line});
    element_.kind = ElementKind::none;
    return status;
  }

  TextCursor cursor_, place_ = cursor_;
  std::size_t size_;
  std::vector<Homogeneous> vertices_, parameter_vertices_;
  std::size_t texture_vertices_ = 0, normals_ = 0;
  FreeformState state_;
  std::string object_, group_;
  Shared<std::string> surface_name_;
  Element element_;
  ObjTrimCurves curves_;
  Model model_;
  ObjNotes notes_;
};

// Sorted by frequency in files: the commonest statement first.
constexpr std::array<ObjFreeformReader::Statement, 20> ObjFreeformReader::statements{{
    {"v", &ObjFreeformReader::read_vertex},         {"vt", &ObjFreeformReader::count_texture_vertex},
    {"vn", &ObjFreeformReader::count_normal},       {"vp", &ObjFreeformReader::read_parameter_vertex},
    {"parm", &ObjFreeformReader::read_parameters},  {"surf", &ObjFreeformReader::read_surface},
    {"end", &ObjFreeformReader::read_end},          {"trim", &ObjFreeformReader::read_trim},
    {"hole", &ObjFreeformReader::read_hole},        {"curv", &ObjFreeformReader::read_curve},
    {"curv2", &ObjFreeformReader::read_curve2},     {"cstype", &ObjFreeformReader::read_type},
    {"deg", &ObjFreeformReader::read_degree},       {"bmat", &ObjFreeformReader::read_matrix},
    {"step", &ObjFreeformReader::read_step},        {"g", &ObjFreeformReader::read_group},
    {"o", &ObjFreeformReader::read_object},         {"bzp", &ObjFreeformReader::read_old_bezier},
    {"bsp", &ObjFreeformReader::read_old_b_spline}, {"cdp", &ObjFreeformReader::read_old_cardinal},
}};

}  // namespace

Result<Model> parse_obj_freeform(std::string_view text, std::string_view name) {
  return guarded([&] { return ObjFreeformReader(text, name).read(); });
}

}}  // namespace tessera::abi_0_1
