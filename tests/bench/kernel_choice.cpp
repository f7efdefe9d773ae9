// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/kernel_choice.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace touchline::bench {
namespace {

/// Slowest first.
std::vector<KernelChoice> runnable() {
  std::vector<KernelChoice> all{{word_kernels(), scalar_loc_kernels()}};
  for (int i = 0; i < kernel_tables; ++i) {
    const KernelChoice choice{kernel_table(i), loc_kernel_table(i)};
    const bool there = choice.vision.name != nullptr && choice.localization.name != nullptr;
    // Without vector registers the portable table is the one of words.
    if (there && std::string_view(choice.vision.name) != all.front().vision.name) all.push_back(choice);
  }
  return all;
}

}  // namespace

std::string kernel_names() {
  const std::vector<KernelChoice> all = runnable();
  std::string text;
  for (const KernelChoice& choice : all) {
    if (!text.empty()) text += &choice == &all.back() ? " or " : ", ";
    text += choice.vision.name;
  }
  return text;
}

KernelChoice kernels_named(const std::string& name) {
  const std::vector<KernelChoice> all = runnable();
  const auto found = std::find_if(all.begin(), all.end(), [&](const KernelChoice& c) { return name == c.vision.name; });
  if (found == all.end()) {
    throw std::runtime_error("--kernels " + (name.empty() ? "\"\"" : name) + ": this processor runs " + kernel_names() +
                             "; write one of these, or leave the option out for the fastest");
  }
  return *found;
}

}  // namespace touchline::bench
