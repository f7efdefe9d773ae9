// SPDX-License-Identifier: Apache-2.0
#include "vision/image/carpet_rows_loops.h"
#include "vision/image/carpet_rows_words.h"
#include "vision/image/edge_rows_loops.h"
#include "vision/image/kernels.h"
#include "vision/image/luma_bands_words.h"
#include "vision/image/ridge_block_words.h"
#include "vision/image/vector_registers.h"

namespace touchline {

Kernels portable_kernels() {
  if constexpr (!vector_registers) return word_kernels();
  return {"portable",        nullptr,           ridge::find_ridges,  bands::hsv_rows,
          bands::white_rows, carpet::kernels(), edge_rows::kernels()};
}
Kernels word_kernels() {
  return {
      "words", nullptr, ridge_words::find_ridges, band_words::hsv_rows, band_words::white_rows, carpet_words::kernels(),
      {}};
}

LumaBand portable_band(const HsvBandPlan& plan, std::uint8_t cb, std::uint8_t cr) {
  LumaBand band;
  bands::hsv_samples(plan, &cb, &cr, 1, &band.low, &band.high);
  return band;
}

}  // namespace touchline
