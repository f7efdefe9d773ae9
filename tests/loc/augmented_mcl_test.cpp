// SPDX-License-Identifier: Apache-2.0
#include "loc/augmented_mcl.h"

#include <doctest/doctest.h>

using namespace touchline;

TEST_CASE("a steady likelihood draws only the constant share") {
  AugmentedMcl mcl;
  const AugmentedMclConfig config;
  CHECK(mcl.random_share(config) == config.random_share);
  for (int i = 0; i < 100; ++i) mcl.update(0.6F, config);
  CHECK(mcl.random_share(config) == config.random_share);
}

TEST_CASE("a drop of the likelihood draws many, a rise none") {
  AugmentedMcl mcl;
  const AugmentedMclConfig config;
  for (int i = 0; i < 100; ++i) mcl.update(0.6F, config);
  for (int i = 0; i < 3; ++i) mcl.update(0.1F, config);
  CHECK(mcl.random_share(config) > 0.4F);
  for (int i = 0; i < 30; ++i) mcl.update(0.9F, config);
  CHECK(mcl.random_share(config) == config.random_share);
}
