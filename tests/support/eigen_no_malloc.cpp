// SPDX-License-Identifier: Apache-2.0
// Switches Eigen's allocations off before main, in every test program that links touchline_loc_checked.
#include <Eigen/Core>

namespace {
[[maybe_unused]] const bool switched_off = !Eigen::internal::set_is_malloc_allowed(false);
}
