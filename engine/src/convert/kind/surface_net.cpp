#include "convert/kind/surface_net.h"

#include <algorithm>

#include "base/saturated.h"
#include "surface/net/patch_pieces.h"
#include "surface/net/validate.h"

namespace tessera { inline namespace abi_0_1 {

SurfaceNet::SurfaceNet(int m, std::vector<double> along_u, int n, std::vector<double> along_v, bool rational)
    : degree_u(m), degree_v(n), breaks_u(std::move(along_u)), breaks_v(std::move(along_v)) {
  points.resize(saturated_product(rows(), columns()));
  if (rational) weights.resize(points.size());
}

Result<PatchGrid> SurfaceNet::patches() const {
  const std::size_t count_u = breaks_u.size() - 1, count_v = breaks_v.size() - 1;
  const std::size_t m = static_cast<std::size_t>(degree_u), n = static_cast<std::size_t>(degree_v), order = n + 1;
  PatchPieces pieces(degree_u, degree_v, saturated_product(count_u, count_v), !weights.empty());
  for (std::size_t patch = 0; patch < count_u * count_v; ++patch) {
    const std::size_t a = patch / count_v, b = patch % count_v;
    for (std::size_t i = 0; i <= m; ++i) {
      const std::size_t from = index(a * m + i, b * n);
      std::copy_n(&points[from], order, pieces.points(patch) + i * order);
      if (!weights.empty()) std::copy_n(&weights[from], order, pieces.weights(patch) + i * order);
    }
    const auto place = [&](std::size_t k) {
      return place_in_rows(k, order) + " of patch " + place_in_rows(patch, count_v);
    };
    const std::size_t size = (m + 1) * order;
    if (Status status = check_points({pieces.points(patch), size}, place); !status.ok()) return status;
    if (weights.empty()) continue;
    if (Status status = check_weights({pieces.weights(patch), size}, place); !status.ok()) return status;
  }
  return PatchGrid::make(breaks_u, breaks_v, pieces.take());
}

SurfaceNet transposed(const SurfaceNet& net) {
  SurfaceNet result(net.degree_v, net.breaks_v, net.degree_u, net.breaks_u, !net.weights.empty());
  for (std::size_t i = 0; i < net.rows(); ++i)
    for (std::size_t j = 0; j < net.columns(); ++j) {
      result.points[result.index(j, i)] = net.points[net.index(i, j)];
      if (!net.weights.empty()) result.weights[result.index(j, i)] = net.weights[net.index(i, j)];
    }
  return result;
}

}}  // namespace tessera::abi_0_1
