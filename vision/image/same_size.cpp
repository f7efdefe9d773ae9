// SPDX-License-Identifier: Apache-2.0
#include "vision/image/same_size.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "vision/image/unpack.h"
#include "vision/image/word_lanes.h"

namespace touchline {
namespace {

/// One coefficient of a diagonal matrix for every sample that there is; `halves` is the sample times two, and of luma
/// even.
template <std::size_t Count>
class Stretch {
 public:
  Stretch(std::int32_t factor, std::int32_t offset, std::int32_t halves) {
    std::int32_t sum = offset * 2 + (1 << colour_bits);  // rounds, too
    for (std::uint8_t& value : table_) {
      value = static_cast<std::uint8_t>(std::clamp<std::int32_t>(sum >> (colour_bits + 1), 0, 255));
      sum += factor * halves;
    }
  }
  [[nodiscard]] std::uint32_t operator()(std::uint32_t sample) const { return table_[sample]; }

 private:
  std::array<std::uint8_t, Count> table_;
};

std::uint32_t load_word(const std::uint8_t* from) {
  std::uint32_t word = 0;
  std::memcpy(&word, from, sizeof word);
  return word;
}

/// Two of luma from Y Cb Y Cr, the first in the lowest byte.
std::uint32_t two_lumas(const Stretch<256>& luma, std::uint32_t pixels) {
  return luma(pixels & 0xFFU) | luma(pixels >> 16U & 0xFFU) << 8U;
}

}  // namespace

void stretch_yuyv(const FrameView& frame, const Yuv420View& out) {
  const ColourMatrix matrix = colour_matrix(PixelFormat::yuyv);
  const Stretch<256> luma(matrix.y.a, matrix.y.offset, 2);
  const Stretch<511> blue(matrix.cb.b, matrix.cb.offset, 1);
  const Stretch<511> red(matrix.cr.c, matrix.cr.offset, 1);
  for (int y = 0; y < frame.height; y += 2) {
    const std::uint8_t* upper = frame.data + static_cast<std::ptrdiff_t>(y) * frame.stride_bytes;
    const std::uint8_t* lower = upper + frame.stride_bytes;
    std::uint8_t* luma_upper = out.y.row(y);
    std::uint8_t* luma_lower = out.y.row(y + 1);
    std::uint8_t* cb = out.cb.row(y / 2);
    std::uint8_t* cr = out.cr.row(y / 2);
    int x = 0;
    for (; x + 4 <= frame.width; x += 4, upper += 8, lower += 8) {
      const std::uint32_t a0 = load_word(upper), a1 = load_word(upper + 4);
      const std::uint32_t b0 = load_word(lower), b1 = load_word(lower + 4);
      const std::uint32_t above = two_lumas(luma, a0) | two_lumas(luma, a1) << 16U;
      const std::uint32_t below = two_lumas(luma, b0) | two_lumas(luma, b1) << 16U;
      std::memcpy(luma_upper + x, &above, sizeof above);
      std::memcpy(luma_lower + x, &below, sizeof below);
      const std::uint32_t c0 = odd_bytes(a0) + odd_bytes(b0), c1 = odd_bytes(a1) + odd_bytes(b1);
      const auto blues = static_cast<std::uint16_t>(blue(c0 & 0xFFFFU) | blue(c1 & 0xFFFFU) << 8U);
      const auto reds = static_cast<std::uint16_t>(red(c0 >> 16U) | red(c1 >> 16U) << 8U);
      std::memcpy(cb + x / 2, &blues, sizeof blues);
      std::memcpy(cr + x / 2, &reds, sizeof reds);
    }
    if (x < frame.width) {
      const std::uint32_t a = load_word(upper), b = load_word(lower);
      const auto above = static_cast<std::uint16_t>(two_lumas(luma, a));
      const auto below = static_cast<std::uint16_t>(two_lumas(luma, b));
      std::memcpy(luma_upper + x, &above, sizeof above);
      std::memcpy(luma_lower + x, &below, sizeof below);
      const std::uint32_t chroma = odd_bytes(a) + odd_bytes(b);
      cb[x / 2] = static_cast<std::uint8_t>(blue(chroma & 0xFFFFU));
      cr[x / 2] = static_cast<std::uint8_t>(red(chroma >> 16U));
    }
  }
}

void change_frame(const FrameView& frame, ChangeRows change, std::span<std::uint8_t> buffer, const Yuv420View& out) {
  RowPair rows;
  rows.columns = frame.width;
  rows.matrix = colour_matrix(frame.format);
  for (int y = 0; y < frame.height; y += 2) {
    for (int r = 0; r < 2; ++r) {
      rows.source[r] = unpack_row(frame, y + r, buffer.data() + std::ptrdiff_t{3} * frame.width * r);
      rows.y[r] = out.y.row(y + r);
    }
    rows.cb = out.cb.row(y / 2);
    rows.cr = out.cr.row(y / 2);
    change(rows);
  }
}

}  // namespace touchline
