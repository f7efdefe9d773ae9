// SPDX-License-Identifier: Apache-2.0
#include "vision/image/disjoint_set.h"

#include <doctest/doctest.h>

#include <random>
#include <vector>

using namespace touchline;

TEST_CASE("random unions agree with relabelling everything, and the root has the whole weight") {
  std::mt19937 random(1);
  constexpr std::size_t n = 300;
  std::vector<SetId> parents(n);
  std::vector<std::int32_t> weights(n);
  DisjointSet sets(parents, weights);
  std::vector<int> label(n);
  for (std::size_t i = 0; i < n; ++i) label[sets.add(static_cast<std::int32_t>(i))] = static_cast<int>(i);
  CHECK(sets.full());
  for (int step = 0; step < 250; ++step) {
    const auto a = static_cast<SetId>(random() % n), b = static_cast<SetId>(random() % n);
    const SetId root = sets.unite(a, b);
    CHECK(sets.is_root(root));
    const int from = label[a], to = label[b];
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (label[i] == from) label[i] = to;
      if (label[i] == to) sum += static_cast<std::int32_t>(i);
    }
    CHECK(sets.weight(root) == sum);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      REQUIRE((sets.find(static_cast<SetId>(i)) == sets.find(static_cast<SetId>(j))) == (label[i] == label[j]));
    }
  }
}

TEST_CASE("the heavier root stays, of equals the lower id, in either order") {
  std::vector<SetId> parents(4);
  std::vector<std::int32_t> weights(4);
  DisjointSet sets(parents, weights);
  for (const int weight : {5, 9, 9, 1}) sets.add(weight);
  CHECK(sets.unite(0, 1) == 1);
  CHECK(sets.weight(1) == 14);
  sets.clear();
  for (const int weight : {5, 9, 9, 1}) sets.add(weight);
  CHECK(sets.unite(2, 1) == 1);
  CHECK(sets.unite(1, 2) == 1);
  CHECK(sets.weight(1) == 18);
}

TEST_CASE("attach keeps the root that the caller names") {
  std::vector<SetId> parents(2);
  std::vector<std::int32_t> weights(2);
  DisjointSet sets(parents, weights);
  sets.add(100);
  sets.add(1);
  CHECK(sets.attach(0, 1) == 1);
  CHECK(sets.find(0) == 1);
  CHECK(sets.weight(1) == 101);
}
