// SPDX-License-Identifier: Apache-2.0
#include "tests/support/fake_gpiod.h"

#include <algorithm>

namespace touchline::fake {
namespace {

Gpiod the_fake;

}  // namespace

Gpiod& gpiod() { return the_fake; }
void reset_gpiod() { the_fake = Gpiod(); }
int requested_lines() {
  return static_cast<int>(std::count(the_fake.requested.begin(), the_fake.requested.end(), true));
}

}  // namespace touchline::fake
