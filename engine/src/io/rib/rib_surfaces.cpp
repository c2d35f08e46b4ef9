#include "io/rib/rib_surfaces.h"

#include <array>

#include "base/saturated.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The positions of a parameter list.
struct Positions {
  std::string_view name;
  std::vector<double> values;
  std::size_t components() const { return name == "Pz" ? 1 : name == "P" ? 3 : 4; }
};

Status read_positions(const RibSurfaceText& text, std::size_t points, Positions& positions) {
  RibLexer& lexer = text.lexer;
  while (lexer.at_string()) {
    std::string_view declaration;
    Status status = lexer.take_string("the name of a variable", declaration);
    if (!status.ok()) return status;
    const std::string_view name = variable_name(declaration);
    if (name == "P" || name == "Pw" || name == "Pz") {
      positions.name = name;
      status = lexer.take_array("a finite number for " + std::string(name), positions.values,
                                saturated_product(points, positions.components()));
    } else {
      status = lexer.skip_value();
    }
    if (!status.ok()) return status;
  }
  if (positions.name.empty()) {
    return lexer.expected("positions (\"P\", \"Pw\" or \"Pz\") of " + std::string(text.request));
  }
  const std::size_t wanted = saturated_product(points, positions.components());
  if (positions.values.size() == wanted) return {};
  return text.failure("expected " + std::to_string(wanted) + " numbers for " + std::string(positions.name) +
                      ", found " + std::to_string(positions.values.size()));
}

/// Makes the net [i][j], i along u, from the file's order, u first. `x` and `y` are those of a height field.
RibNet make_net(const Positions& positions, std::size_t count_u, std::size_t count_v, std::span<const double> x,
                std::span<const double> y) {
  RibNet net{.points = std::vector<Homogeneous>(count_u * count_v), .rational = positions.name == "Pw"};
  const std::size_t components = positions.components();
  for (std::size_t j = 0; j < count_v; ++j) {
    for (std::size_t i = 0; i < count_u; ++i) {
      const double* const p = positions.values.data() + (j * count_u + i) * components;
      net.points[i * count_v + j] =
          components == 1 ? Homogeneous{x[i], y[j], p[0], 0} : Homogeneous{p[0], p[1], p[2], net.rational ? p[3] : 0};
    }
  }
  return net;
}

/// Reads the type. Bilinear surfaces have directions without a basis.
Status read_type(const RibSurfaceText& text, RibDirection& u, RibDirection& v) {
  std::string_view type;
  Status status = text.lexer.take_string("\"bilinear\" or \"bicubic\"", type);
  if (!status.ok()) return status;
  if (type == "bicubic") {
    u.basis = &text.basis_u;
    v.basis = &text.basis_v;
    return {};
  }
  return type == "bilinear" ? Status() : text.failure("expected \"bilinear\" or \"bicubic\", found " + quote(type));
}

Status read_wrap(const RibSurfaceText& text, const std::string& direction, RibDirection& line) {
  Status status = text.lexer.take_integer("the number of points along " + direction, 1, rib_count_limit, line.points);
  std::string_view wrap;
  if (status.ok()) status = text.lexer.take_string("\"periodic\" or \"nonperiodic\"", wrap);
  if (!status.ok()) return status;
  line.periodic = wrap == "periodic";
  if (line.periodic || wrap == "nonperiodic") return {};
  return text.failure("expected \"periodic\" or \"nonperiodic\", found " + quote(wrap));
}

Result<std::vector<Surface>> read_mesh(const RibSurfaceText& text, const RibDirection& u, const RibDirection& v) {
  const auto count_u = static_cast<std::size_t>(u.points), count_v = static_cast<std::size_t>(v.points);
  Positions positions;
  Status status = read_positions(text, saturated_product(count_u, count_v), positions);
  if (!status.ok()) return status;
  Result<std::vector<double>> x = std::vector<double>(), y = std::vector<double>();
  if (positions.name == "Pz") {
    x = height_field_parameters(u);
    y = height_field_parameters(v);
    if (!x || !y) return refused_element(text, (x ? y : x).status());
  }
  RibNet net = make_net(positions, count_u, count_v, *x, *y);
  positions.values = std::vector<double>();  // {} would keep the memory
  Result<std::vector<Surface>> surfaces = mesh_surfaces(u, v, std::move(net));
  return surfaces ? std::move(surfaces) : refused_element(text, surfaces.status());
}

/// One direction of a NuPatch.
struct NurbsLine {
  std::int64_t points = 0, order = 0;
  std::vector<double> knots;
  std::array<double, 2> range{};

  int degree() const { return static_cast<int>(order) - 1; }
  /// The averages of the knots (Greville), the parameters of a height field's points.
  std::vector<double> greville() const {
    std::vector<double> averages;
    for (std::size_t k = 0; k < static_cast<std::size_t>(points); ++k) {
      double sum = 0;
      for (std::size_t d = 1; d <= static_cast<std::size_t>(degree()); ++d) sum += knots[k + d];
      averages.push_back(sum / degree());
    }
    return averages;
  }
};

Status read_line(const RibSurfaceText& text, const std::string& along, NurbsLine& line) {
  RibLexer& lexer = text.lexer;
  Status status = lexer.take_integer("the number of points along " + along, 1, rib_count_limit, line.points);
  if (status.ok()) status = lexer.take_integer("the order along " + along, 2, max_degree + 1, line.order);
  if (!status.ok()) return status;
  const auto wanted = static_cast<std::size_t>(line.points + line.order);
  status = lexer.take_array("a finite number for a knot along " + along, line.knots, wanted);
  if (!status.ok()) return status;
  if (line.knots.size() != wanted) {
    return text.failure("expected " + std::to_string(wanted) + " knots along " + along + ", found " +
                        std::to_string(line.knots.size()));
  }
  return lexer.take_numbers("the range along " + along + " (2 finite numbers)", line.range);
}

}  // namespace

std::string_view variable_name(std::string_view declaration) {
  const std::size_t space = declaration.find_last_of(" \t");
  return space == std::string_view::npos ? declaration : declaration.substr(space + 1);
}

Result<std::vector<Surface>> read_patch(const RibSurfaceText& text) {
  RibDirection u, v;
  Status status = read_type(text, u, v);
  if (!status.ok()) return status;
  u.points = v.points = u.basis ? 4 : 2;
  return read_mesh(text, u, v);
}

Result<std::vector<Surface>> read_patch_mesh(const RibSurfaceText& text) {
  RibDirection u, v;
  Status status = read_type(text, u, v);
  if (status.ok()) status = read_wrap(text, "u", u);
  if (status.ok()) status = read_wrap(text, "v", v);
  if (!status.ok()) return status;
  return read_mesh(text, u, v);
}

Result<std::vector<Surface>> read_nu_patch(const RibSurfaceText& text) {
  NurbsLine u, v;
  Status status = read_line(text, "u", u);
  if (status.ok()) status = read_line(text, "v", v);
  if (!status.ok()) return status;
  const auto count_u = static_cast<std::size_t>(u.points), count_v = static_cast<std::size_t>(v.points);
  Positions positions;
  status = read_positions(text, saturated_product(count_u, count_v), positions);
  if (!status.ok()) return status;
  const bool field = positions.name == "Pz";
  RibNet net = make_net(positions, count_u, count_v, field ? u.greville() : std::vector<double>(),
                        field ? v.greville() : std::vector<double>());
  positions.values = std::vector<double>();  // {} would keep the memory
  Result<BSplineSurface> surface = spline_surface(u.degree(), u.knots, v.degree(), v.knots, std::move(net),
                                                  Domain{u.range[0], u.range[1], v.range[0], v.range[1]});
  if (!surface) return refused_element(text, surface.status());
  std::vector<Surface> surfaces;
  surfaces.push_back(*std::move(surface));
  return surfaces;
}

}}  // namespace tessera::abi_0_1
