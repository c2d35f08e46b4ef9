#pragma once
// The basis matrices of a degree, and random tensor patches over them.

#include <string>
#include <utility>

#include "support/random_patches.h"
#include "support/synthetic_sets.h"
#include "tessera/tensor_patch.h"

namespace tessera::test {

struct NamedBasis {
  const char* name;
  BasisMatrix basis;
};

/// A matrix of the user's: well-conditioned, with irregular entries.
inline BasisMatrix random_basis(Random& random, int degree) {
  const std::size_t size = static_cast<std::size_t>(degree) + 1;
  std::vector<double> entries(size * size);
  for (double& entry : entries) entry = uniform(random, -0.5, 0.5);
  for (std::size_t k = 0; k < size; ++k) entries[k * size + k] += static_cast<double>(size);
  return value_of(BasisMatrix::custom(degree, entries));
}

/// Every basis that there is of a degree.
inline std::vector<NamedBasis> bases_of(Random& random, int degree) {
  std::vector<NamedBasis> bases{{"Bezier", value_of(BasisMatrix::bezier(degree))},
                                {"power", value_of(BasisMatrix::power(degree))},
                                {"uniform B-spline", value_of(BasisMatrix::uniform_b_spline(degree))},
                                {"custom", random_basis(random, degree)}};
  if (degree == 3) {
    bases.push_back({"Hermite", value_of(BasisMatrix::hermite())});
    bases.push_back({"Catmull-Rom", value_of(BasisMatrix::catmull_rom())});
  }
  return bases;
}

inline TensorPatch random_tensor(Random& random, const BasisMatrix& basis_u, const BasisMatrix& basis_v,
                                 const Domain& domain = {}) {
  return value_of(
      TensorPatch::make(basis_u, basis_v, random_points(random, basis_u.degree(), basis_v.degree()), domain));
}

/// Calls check(patch, its bases in words) for a random patch over every pair of bases, of equal, mixed and the highest
/// degrees, on a domain that is not [0,1]^2.
template <class Check>
void for_all_pairs_of_bases(Random& random, Check check) {
  for (const auto& [m, n] : {std::pair{1, 1}, {3, 3}, {5, 3}, {2, 7}, {15, 1}, {11, 15}})
    for (const auto& [name_u, basis_u] : bases_of(random, m))
      for (const auto& [name_v, basis_v] : bases_of(random, n))
        check(random_tensor(random, basis_u, basis_v, {-2, 6, 0.5, 0.75}),
              std::string(name_u) + " " + std::to_string(m) + ", " + name_v + " " + std::to_string(n));
}

}  // namespace tessera::test
