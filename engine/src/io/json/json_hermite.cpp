// Hermite patches in all their forms, and networks of them.

#include <algorithm>
#include <array>

#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Domain domain_of(const Fields& fields) { return fields.get("domain", Domain{}, read_domain); }

Net<Vec3> read_4_by_4(const JsonValue& value, std::string_view what) {
  Net<Vec3> net = read_vector_net(value, what);
  expect_shape(value, net, 4, 4, "[i][j] with i along u");
  return net;
}

HermiteNode read_node(const JsonValue& value) {
  const Fields fields(value, {"position", "du", "dv", "duv"});
  return {read_vector(fields.at("position")), read_vector(fields.at("du")), read_vector(fields.at("dv")),
          fields.get("duv", Vec3{}, read_vector)};
}

CornerTangents read_open_corner(const JsonValue& value) {
  const Fields fields(value, {"position", "du", "dv"});
  return {read_vector(fields.at("position")), read_vector(fields.at("du")), read_vector(fields.at("dv"))};
}

/// Reads the corners [i][j] of the domain.
template <class Corner, class Read>
std::array<Corner, 4> read_corners(const JsonValue& value, Read&& read) {
  const Net<Corner> net = read_net<Corner>(value, "corners", read);
  expect_shape(value, net, 2, 2, "[i][j] with i along u");
  std::array<Corner, 4> corners;
  std::copy(net.elements.begin(), net.elements.end(), corners.begin());
  return corners;
}

HermiteOrder read_order(const JsonValue& value) {
  return read_word(value, {"by_end", "by_kind"}) == 0 ? HermiteOrder::by_end : HermiteOrder::by_kind;
}

/// The knots of the file, or 0, 1, 2 ..
std::vector<double> network_knots(const Fields& fields, std::string_view key, std::size_t count) {
  std::vector<double> knots;
  if (const std::optional<JsonValue> given = fields.find(key)) {
    knots = read_numbers(*given);
    if (knots.size() != count)
      given->fail("expected " + std::to_string(count) + " knots, one per node, found " + std::to_string(knots.size()));
  }
  while (knots.size() < count) knots.push_back(static_cast<double>(knots.size()));
  return knots;
}

/// The factors of the file, or 1.
std::vector<double> network_factors(const Fields& fields, std::string_view key, std::size_t count) {
  const std::optional<JsonValue> given = fields.find(key);
  if (!given) return std::vector<double>(count, 1.0);
  std::vector<double> factors = read_numbers(*given);
  if (factors.size() != count)
    given->fail("expected " + std::to_string(count) + " factors, one per span, found " +
                std::to_string(factors.size()));
  return factors;
}

/// Replaces the twists of the nodes by estimates of the method `word`.
void estimate_twists(const JsonValue& word, Net<HermiteNode>& nodes, const std::vector<double>& u,
                     const std::vector<double>& v) {
  constexpr std::array estimates{TwistEstimate::zero, TwistEstimate::adini, TwistEstimate::bessel};
  const TwistEstimate estimate = estimates[read_word(word, {"zero", "adini", "bessel"})];
  nodes.elements = made(word, estimate_twists(estimate, u, v, nodes.elements));
}

}  // namespace

Surface read_hermite_patch(const JsonValue& value) {
  const SurfaceFields fields(value, {"geometry", "order", "corners", "domain"});
  const std::optional<JsonValue> corners = fields.find("corners");
  if (corners && (fields.find("geometry") || fields.find("order")))
    value.fail("\"corners\" cannot be combined with \"geometry\" or \"order\"");
  if (corners)
    return made(value, HermitePatch::from_corners(read_corners<HermiteNode>(*corners, read_node), domain_of(fields)));
  const Net<Vec3> geometry = read_4_by_4(fields.at("geometry"), "vectors");
  const HermiteOrder order = fields.get("order", HermiteOrder::by_end, read_order);
  return made(value, HermitePatch::make(geometry.elements, domain_of(fields), order));
}

Surface read_ferguson_patch(const JsonValue& value) {
  const SurfaceFields fields(value, {"corners", "domain"});
  const auto corners = read_corners<CornerTangents>(fields.at("corners"), read_open_corner);
  return made(value, HermitePatch::ferguson(corners, domain_of(fields)));
}

Surface read_adini_patch(const JsonValue& value) {
  const SurfaceFields fields(value, {"corners", "domain"});
  const auto corners = read_corners<CornerTangents>(fields.at("corners"), read_open_corner);
  return made(value, HermitePatch::adini(corners, domain_of(fields)));
}

Surface read_algebraic_patch(const JsonValue& value) {
  const SurfaceFields fields(value, {"coefficients", "domain"});
  const Net<Vec3> coefficients = read_4_by_4(fields.at("coefficients"), "coefficients");
  return made(value, HermitePatch::from_algebraic(coefficients.elements, domain_of(fields)));
}

Surface read_patch_through_points(const JsonValue& value) {
  const SurfaceFields fields(value, {"points", "u", "v", "domain"});
  const Net<Vec3> points = read_4_by_4(fields.at("points"), "points");
  const std::vector<double> u = read_numbers(fields.at("u")), v = read_numbers(fields.at("v"));
  return made(value, HermitePatch::through_points(points.elements, u, v, domain_of(fields)));
}

Surface read_hermite_network(const JsonValue& value) {
  const SurfaceFields fields(value, {"nodes", "factors_u", "factors_v", "knots_u", "knots_v", "twists"});
  const JsonValue grid = fields.at("nodes");
  Net<HermiteNode> nodes = read_net<HermiteNode>(grid, "nodes", read_node);
  if (nodes.rows < 2 || nodes.columns < 2) grid.fail("expected 2 x 2 nodes or more");
  const bool by_factors = fields.find("factors_u") || fields.find("factors_v");
  if (by_factors && (fields.find("knots_u") || fields.find("knots_v") || fields.find("twists")))
    value.fail("a network has factors, or knots and perhaps estimated twists, not both");
  if (by_factors)
    return made(value, HermiteNetwork::from_factors(nodes.rows, nodes.columns, nodes.elements,
                                                    network_factors(fields, "factors_u", nodes.rows - 1),
                                                    network_factors(fields, "factors_v", nodes.columns - 1)));
  const std::vector<double> u = network_knots(fields, "knots_u", nodes.rows);
  const std::vector<double> v = network_knots(fields, "knots_v", nodes.columns);
  if (const std::optional<JsonValue> twists = fields.find("twists")) estimate_twists(*twists, nodes, u, v);
  return made(value, HermiteNetwork::on_knots(u, v, nodes.elements));
}

}}  // namespace tessera::abi_0_1
