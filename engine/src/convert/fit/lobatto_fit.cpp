#include "convert/fit/lobatto_fit.h"

#include "basis/small_matrix.h"

namespace tessera { inline namespace abi_0_1 {

LobattoTables::LobattoTables(int degree_of_all) : degree(degree_of_all), nodes(lobatto_parameters(degree)) {
  const Matrix matrix = lobatto_to_bernstein(degree);
  for (int i = 0; i <= degree; ++i)
    for (int k = 0; k <= degree; ++k) bernstein.push_back(static_cast<double>(matrix(i, k)));
  std::vector<double> values(nodes.size());
  for (std::size_t k = 0; k + 1 < nodes.size(); k += 2) {
    checks.push_back(0.5 * (nodes[k] + nodes[k + 1]));
    bernstein_values(degree, checks.back(), values.data());
    at_checks.insert(at_checks.end(), values.begin(), values.end());
  }
}

const LobattoTables& LobattoTables::of_degree_7() {
  static const LobattoTables tables(LobattoFit::degree);
  return tables;
}

}}  // namespace tessera::abi_0_1
