#include "io/cad/model_bytes.h"

#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace tessera::inline abi_0_1 {
namespace {

class Writer {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put_list(std::span<const T> list) {
    put(std::uint64_t{list.size()});
    bytes_.append(reinterpret_cast<const char*>(list.data()), list.size_bytes());
  }
  void put_text(std::string_view text) { put_list(std::span<const char>(text)); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Each call returns false if the bytes end too early, and then leaves its output unspecified.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  bool take(T& value) {
    if (rest_.size() < sizeof value) return false;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return true;
  }
  /// Reads a count of things that take at least `least` bytes each.
  bool take_count(std::size_t& count, std::size_t least) {
    std::uint64_t stated = 0;
    if (!take(stated) || stated > rest_.size() / least) return false;
    count = static_cast<std::size_t>(stated);
    return true;
  }
  template <class List>
  bool take_list(List& list) {
    using T = typename List::value_type;
    std::size_t count = 0;
    if (!take_count(count, sizeof(T))) return false;
    list.resize(count);
    if (count > 0) std::memcpy(list.data(), rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
    return true;
  }

 private:
  std::string_view rest_;
};

void put_surface(Writer& out, const BSplineSurface& surface) {
  out.put(surface.degree_u());
  out.put(surface.degree_v());
  out.put_list(surface.knots_u());
  out.put_list(surface.knots_v());
  out.put_list(surface.points());
  out.put_list(surface.weights());
  out.put(surface.domain());
}

bool take_surface(Reader& in, std::optional<BSplineSurface>& surface) {
  int degree_u = 0, degree_v = 0;
  std::vector<double> knots_u, knots_v, weights;
  std::vector<Vec3> points;
  Domain domain;
  const bool whole = in.take(degree_u) && in.take(degree_v) && in.take_list(knots_u) && in.take_list(knots_v) &&
                     in.take_list(points) && in.take_list(weights) && in.take(domain);
  if (!whole) return false;
  const Result<BSplineSurface> made =
      weights.empty() ? BSplineSurface::polynomial(degree_u, knots_u, degree_v, knots_v, points, domain)
                      : BSplineSurface::rational(degree_u, knots_u, degree_v, knots_v, points, weights, domain);
  if (made) surface = *made;
  return made.ok();
}

void put_curve(Writer& out, const Curve& curve) {
  out.put(curve.degree());
  out.put_list(curve.points());
  out.put_list(curve.weights());
  out.put_list(curve.knots());
  out.put(curve.domain());
}

bool take_curve(Reader& in, std::vector<Curve>& curves) {
  int degree = 0;
  std::vector<Vec3> points;
  std::vector<double> weights, knots;
  Interval domain;
  const bool whole =
      in.take(degree) && in.take_list(points) && in.take_list(weights) && in.take_list(knots) && in.take(domain);
  if (!whole) return false;
  const Result<Curve> made = weights.empty() ? Curve::b_spline(degree, points, knots, domain)
                                             : Curve::nurbs(degree, points, weights, knots, domain);
  if (made) curves.push_back(*made);
  return made.ok();
}

bool take_trims(Reader& in, std::vector<TrimLoop>& trims) {
  std::size_t loops = 0;
  if (!in.take_count(loops, 1)) return false;
  for (std::size_t k = 0; k < loops; ++k) {
    TrimLoop& loop = trims.emplace_back();
    std::uint8_t hole = 0;
    std::size_t curves = 0;
    if (!in.take(hole) || hole > 1 || !in.take_count(curves, 1)) return false;
    loop.hole = hole == 1;
    for (std::size_t c = 0; c < curves; ++c)
      if (!take_curve(in, loop.curves)) return false;
  }
  return true;
}

bool take_surfaces(Reader& in, Model& model) {
  std::size_t count = 0;
  if (!in.take_count(count, 1)) return false;
  for (std::size_t k = 0; k < count; ++k) {
    std::string name;
    std::optional<BSplineSurface> surface;
    Affine placement;
    std::vector<TrimLoop> trims;
    if (!in.take_list(name) || !take_surface(in, surface) || !in.take(placement) || !take_trims(in, trims))
      return false;
    model.surfaces.push_back({std::move(name), *std::move(surface), placement, std::move(trims)});
  }
  return true;
}

bool take_model(Reader& in, Model& model) {
  std::size_t warnings = 0;
  if (!in.take_list(model.name) || !take_surfaces(in, model) || !in.take_count(warnings, 1)) return false;
  for (std::size_t k = 0; k < warnings; ++k)
    if (!in.take_list(model.warnings.emplace_back())) return false;
  return true;
}

void put_status(Writer& out, const Status& status) {
  out.put(status.code());
  out.put(status.index());
  out.put_text(status.message());
}

Status put_model(Writer& out, const Model& model) {
  out.put_text(model.name);
  out.put(std::uint64_t{model.surfaces.size()});
  for (const ModelSurface& surface : model.surfaces) {
    const BSplineSurface* const spline = std::get_if<BSplineSurface>(&surface.surface);
    if (!spline) return Status(StatusCode::internal, "a surface of this kind has no form as bytes");
    out.put_text(*surface.name);
    put_surface(out, *spline);
    out.put(*surface.placement);
    out.put(std::uint64_t{surface.trims->size()});
    for (const TrimLoop& loop : *surface.trims) {
      out.put(std::uint8_t{loop.hole});
      out.put(std::uint64_t{loop.curves.size()});
      for (const Curve& curve : loop.curves) put_curve(out, curve);
    }
  }
  out.put(std::uint64_t{model.warnings.size()});
  for (const std::string& warning : model.warnings) out.put_text(warning);
  return {};
}

}  // namespace

std::string to_bytes(const Result<Model>& model) {
  Status status = model.status();
  if (model) {
    Writer out;
    put_status(out, {});
    status = put_model(out, *model);
    if (status.ok()) return out.take();
  }
  Writer out;
  put_status(out, status);
  return out.take();
}

Result<Model> model_from_bytes(std::string_view bytes) {
  Reader in(bytes);
  StatusCode code{};
  std::ptrdiff_t index = 0;
  std::string message;
  Model model;
  if (in.take(code) && in.take(index) && in.take_list(message)) {
    if (code != StatusCode::ok) return Status(code, message, index);
    if (take_model(in, model)) return model;
  }
  return Status(StatusCode::internal, std::string(damaged_model));
}

}  // namespace tessera::inline abi_0_1
