// SPDX-License-Identifier: Apache-2.0
// Disjoint-set forest on storage of the caller (Tarjan and van Leeuwen 1984: linking by weight, path halving).
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace touchline {

using SetId = std::uint16_t;
inline constexpr std::size_t max_sets = 65535;

/// Elements 0..size-1, each in one set. A weight per element is given at the start and summed at the root: its size
/// (1), or whatever the caller counts.
class DisjointSet {
 public:
  /// Both spans have the same size, at most max_sets. Starts with no element.
  DisjointSet(std::span<SetId> parents, std::span<std::int32_t> weights) : parents_(parents), weights_(weights) {
    assert(parents.size() == weights.size() && parents.size() <= max_sets);
  }

  void clear() { size_ = 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool full() const { return size_ == parents_.size(); }

  /// A new set of one element, with the next id; not to be called when full().
  SetId add(std::int32_t weight = 1) {
    assert(!full());
    const SetId id = static_cast<SetId>(size_++);
    parents_[id] = id;
    weights_[id] = weight;
    return id;
  }

  /// The root of the element's set. Halves the path on its way, so that later calls are short.
  SetId find(SetId element) {
    assert(element < size_);
    while (parents_[element] != element) {
      parents_[element] = parents_[parents_[element]];
      element = parents_[element];
    }
    return element;
  }
  [[nodiscard]] bool is_root(SetId element) const { return parents_[element] == element; }
  /// Of the whole set, when `root` is a root.
  [[nodiscard]] std::int32_t weight(SetId root) const { return weights_[root]; }

  /// Joins two sets; the heavier root stays, of equals the lower id, so that the result does not depend on the order of
  /// a and b.
  SetId unite(SetId a, SetId b) {
    SetId keep = find(a);
    SetId lose = find(b);
    if (keep == lose) return keep;
    if (weights_[lose] > weights_[keep] || (weights_[lose] == weights_[keep] && lose < keep)) std::swap(keep, lose);
    return attach(lose, keep);
  }

  /// Hangs root `child` under root `root`, whatever their weights are; `root` stays the root.
  SetId attach(SetId child, SetId root) {
    assert(is_root(child) && is_root(root) && child != root);
    parents_[child] = root;
    weights_[root] += weights_[child];
    return root;
  }

 private:
  std::span<SetId> parents_;
  std::span<std::int32_t> weights_;
  std::size_t size_ = 0;
};

}  // namespace touchline
