// SPDX-License-Identifier: Apache-2.0
#include "platform/core/static_vector.h"

#include <doctest/doctest.h>

TEST_CASE("a full vector keeps what it has and counts what it dropped") {
  touchline::StaticVector<int, 2> v;
  CHECK(v.push_back(1));
  CHECK(v.push_back(2));
  CHECK_FALSE(v.push_back(3));
  CHECK(v.size() == 2);
  CHECK(v.dropped() == 1);
  v.clear();
  CHECK(v.dropped() == 0);
}
