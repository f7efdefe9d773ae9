// SPDX-License-Identifier: Apache-2.0
// The tables of kernels that this processor runs, for tests that all of them give the same.
#pragma once

#include <vector>

#include "platform/processor/fastest_kernels.h"

namespace touchline::test {

/// The portable one first.
inline std::vector<Kernels> runnable_tables() {
  std::vector<Kernels> tables;
  for (int i = 0; i < kernel_tables; ++i) {
    if (kernel_table(i).name != nullptr) tables.push_back(kernel_table(i));
  }
  return tables;
}

/// And the one of processors without vector registers.
inline std::vector<Kernels> all_tables() {
  std::vector<Kernels> tables = runnable_tables();
  tables.push_back(word_kernels());
  return tables;
}

}  // namespace touchline::test
