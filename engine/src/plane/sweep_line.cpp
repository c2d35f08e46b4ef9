#include "plane/sweep_line.h"

namespace tessera { inline namespace abi_0_1 {

void SweepLine::clear() {
  places_.assign(1, {});
  nodes_.assign(1, {});
  free_.clear();
  root_ = no_id;
  random_ = 1;
}

SweepLine::Found SweepLine::find(const SweepPoints& points, std::uint32_t rank) const {
  std::uint32_t below = bottom;
  for (std::uint32_t place = root_; place != no_id;) {
    const int above = side(points, place, rank);
    if (above == 0) return {place, true};
    if (above > 0) below = place;
    place = above > 0 ? nodes_[place].right : nodes_[place].left;
  }
  return {below, false};
}

std::uint32_t& SweepLine::link_to(std::uint32_t place) {
  const std::uint32_t parent = nodes_[place].parent;
  if (parent == no_id) return root_;
  return nodes_[parent].left == place ? nodes_[parent].left : nodes_[parent].right;
}

void SweepLine::rotate_up(std::uint32_t place) {
  const std::uint32_t parent = nodes_[place].parent;
  link_to(parent) = place;
  const bool was_left = nodes_[parent].left == place;
  std::uint32_t& to_parent = was_left ? nodes_[place].right : nodes_[place].left;
  (was_left ? nodes_[parent].left : nodes_[parent].right) = to_parent;
  if (to_parent != no_id) nodes_[to_parent].parent = parent;
  to_parent = parent;
  nodes_[place].parent = nodes_[parent].parent;
  nodes_[parent].parent = place;
}

std::uint32_t SweepLine::insert_above(std::uint32_t place) {
  std::uint32_t added = static_cast<std::uint32_t>(places_.size());
  if (free_.empty()) {
    places_.emplace_back();
    nodes_.emplace_back();
  } else {
    added = free_.back();
    free_.pop_back();
    places_[added] = {};
    nodes_[added] = {};
  }
  const std::uint32_t above = places_[place].above;
  places_[added].below = place;
  places_[added].above = above;
  places_[place].above = added;
  if (above != no_id) places_[above].below = added;
  // Marsaglia, Xorshift RNGs, 2003.
  random_ ^= random_ << 13, random_ ^= random_ >> 17, random_ ^= random_ << 5;
  nodes_[added].priority = random_;
  if (root_ == no_id) return root_ = added;
  const bool hangs_right = place != bottom && nodes_[place].right == no_id;
  const std::uint32_t parent = hangs_right ? place : above;
  (hangs_right ? nodes_[parent].right : nodes_[parent].left) = added;
  nodes_[added].parent = parent;
  while (nodes_[added].parent != no_id && nodes_[nodes_[added].parent].priority < random_) rotate_up(added);
  return added;
}

void SweepLine::erase(std::uint32_t place) {
  for (;;) {
    const auto [parent, left, right, priority] = nodes_[place];
    if (left == no_id || right == no_id) {
      const std::uint32_t child = left == no_id ? right : left;
      link_to(place) = child;
      if (child != no_id) nodes_[child].parent = parent;
      break;
    }
    rotate_up(nodes_[left].priority > nodes_[right].priority ? left : right);
  }
  const auto [below, above] = std::pair(places_[place].below, places_[place].above);
  places_[below].above = above;
  if (above != no_id) places_[above].below = below;
  free_.push_back(place);
}

}}  // namespace tessera::abi_0_1
