#include "ray/border/root_fan.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {

RootFan::RootFan(const SetView& set, const Adjacency& borders, const LeafRoot& root, double apart)
    : set_(set), borders_(borders), apart_(apart) {
  places_[count_++] = root;
  for (std::size_t k = 0; k < count_; ++k) spread(places_[k]);
}

void RootFan::spread(const LeafRoot& from) {
  for (int edge = 0; edge < 4; ++edge) {
    const EdgeLink& link = borders_.across(from.patch, edge);
    if (!link.exists()) continue;
    if (reaches_edge(from, edge, apart_)) add(carried_over(from, edge, link));
    const int pole = pole_of_edge(set_, from, edge, apart_);
    if (pole < 0) continue;
    LeafRoot at_pole = from;  // all of the collapsed edge is one point, which is also the end of this edge
    (edge < 2 ? at_pole.v : at_pole.u) = pole;
    add(carried_over(at_pole, edge, link));
  }
}

void RootFan::add(const LeafRoot& place) {
  const auto is_there = [&](const LeafRoot& other) {
    return other.patch == place.patch && other.u == place.u && other.v == place.v;
  };
  if (count_ < most && std::none_of(places_.begin(), places_.begin() + count_, is_there)) places_[count_++] = place;
}

}}  // namespace tessera::abi_0_1
