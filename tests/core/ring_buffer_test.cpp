// SPDX-License-Identifier: Apache-2.0
#include "platform/core/ring_buffer.h"

#include <doctest/doctest.h>

TEST_CASE("the newest pushes the oldest out") {
  touchline::RingBuffer<int, 3> ring;
  CHECK(ring.empty());
  for (int i = 1; i <= 5; ++i) ring.push(i);
  CHECK(ring.size() == 3);
  CHECK(ring.oldest() == 3);
  CHECK(ring[1] == 4);
  CHECK(ring.newest() == 5);
}

TEST_CASE("after clear() it fills from the start") {
  touchline::RingBuffer<int, 2> ring;
  ring.push(1);
  ring.push(2);
  ring.clear();
  CHECK(ring.empty());
  ring.push(7);
  CHECK(ring.oldest() == 7);
  CHECK(ring.newest() == 7);
}
