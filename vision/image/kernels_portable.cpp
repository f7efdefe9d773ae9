// SPDX-License-Identifier: Apache-2.0
#include "vision/image/kernels.h"
#include "vision/image/luma_window.h"
#include "vision/image/ridge_block_words.h"

namespace touchline {

Kernels portable_kernels() {
  if constexpr (!vector_registers) return word_kernels();
  return {"portable", nullptr, ridge::find_ridges};
}
Kernels word_kernels() { return {"words", nullptr, ridge_words::find_ridges}; }

}  // namespace touchline
