// SPDX-License-Identifier: Apache-2.0
// The search of ridge_search.h for processors with vector registers, in columns of 32 pixels from the top down: what a
// strip of eight rows leaves of sums and colours, the next ones use. Included by each file of kernels alone, and
// compiled there for that file's processor: everything is local to the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "vision/image/ridge_looks_loops.h"

namespace touchline {
namespace {
namespace ridge {

/// Rows that stay: a strip and the farthest steps above and below it.
inline constexpr int kept_rows = 32;
static_assert(kept_rows >= strip_rows + 2 * max_ridge_reach_px);

/// What an image holds from (x, y) on, Count samples; a copy where that reaches beyond the image's memory. Samples left
/// and right of the row mean nothing.
template <std::size_t Count>
[[gnu::always_inline]] inline const std::uint8_t* samples_at(const ImageView<const std::uint8_t>& image, int x, int y,
                                                             std::uint8_t (&copy)[Count]) {
  constexpr auto count = static_cast<std::ptrdiff_t>(Count);
  const std::ptrdiff_t first = std::ptrdiff_t{image.stride} * y + x;
  const std::ptrdiff_t end = std::ptrdiff_t{image.stride} * (image.height - 1) + image.width;
  if (first >= 0 && first + count <= end) return image.data + first;
  for (std::ptrdiff_t i = 0; i < count; ++i) copy[i] = first + i >= 0 && first + i < end ? image.data[first + i] : 0;
  return copy;
}

/// The search of 32 pixels of each row.
class Column {
 public:
  Column(const RidgeSearch& search, int x0) : s_(search), x0_(x0) {
    const auto [inner, inside] = ridge::column_pixels(x0, search.roi.width);
    inner_ = inner;
    inside_ = inside;
  }

  void search() {
    for (int y0 = 0; y0 < s_.roi.height; y0 += strip_rows) search_strip(y0);
  }

 private:
  /// The pixels whose block has a reach; `first`: 0 along the row, 32 along the column.
  [[nodiscard]] [[gnu::always_inline]] static std::uint32_t pixels_of(const Reaches& of_block, int reach, int first) {
    using Bytes = std::uint8_t __attribute__((vector_size(8)));
    const Bytes bytes = __builtin_convertvector((of_block >> static_cast<std::uint32_t>(reach) & 1U) * 255U, Bytes);
    std::uint64_t bits = 0;
    __builtin_memcpy(&bits, &bytes, sizeof bytes);
    return static_cast<std::uint32_t>(bits >> first);
  }

  template <typename Mask>
  [[gnu::always_inline]] auto* bytes_at(const Mask& mask, int y) const {
    using Word = std::remove_reference_t<decltype(*mask.words)>;
    using Byte = std::conditional_t<std::is_const_v<Word>, const unsigned char, unsigned char>;
    return reinterpret_cast<Byte*>(mask.words + std::ptrdiff_t{mask.stride} * y) + x0_ / 8;
  }
  template <typename Mask>
  [[gnu::always_inline]] std::uint32_t pixels_at(const Mask& mask, int y) const {
    std::uint32_t bits = 0;
    __builtin_memcpy(&bits, bytes_at(mask, y), sizeof bits);
    return bits;
  }
  [[gnu::always_inline]] void add_pixels(const BitView& mask, int y, std::uint32_t more) const {
    const std::uint32_t bits = pixels_at(mask, y) | more;
    __builtin_memcpy(bytes_at(mask, y), &bits, sizeof bits);
  }

  void search_strip(int y0) {
    std::uint32_t open[strip_rows];
    std::uint32_t any = 0;
    for (int r = 0; r < strip_rows; ++r) {
      const int y = y0 + r;
      // What is a line already stays one.
      const bool inside = y >= 1 && y + 1 < s_.roi.height;
      open[r] = static_cast<std::uint32_t>(inside ? pixels_at(s_.roi, y) & ~pixels_at(s_.strong, y) & inner_ : 0);
      any |= open[r];
    }
    if (any == 0) return;
    const Looks looks = looks_at(s_.widths, x0_ / width_block_px, y0 / width_block_px);
    if ((looks.row | looks.column) == 0) return;
    keep_green(y0);
    Rows wanted;
    __builtin_memcpy(&wanted, open, sizeof wanted);
    Found found;
    if (looks.row != 0) look_along_rows(y0, looks, wanted, found);
    if (looks.column != 0) look_along_columns(y0, looks, wanted, found);
    for (int r = 0; r < strip_rows; ++r) {
      if (found.weak[r] == 0) continue;
      add_pixels(s_.weak, y0 + r, found.weak[r]);
      add_pixels(s_.strong, y0 + r, found.strong[r]);
    }
  }

  /// Calls keep(y) for the rows of a strip's surroundings that are not kept yet.
  template <typename Keep>
  [[gnu::always_inline]] static void keep_rows(int first, int end, int& next, Keep keep) {
    for (int y = next > first ? next : first; y < end; ++y) keep(y);
    next = end;
  }

  void keep_green(int y0) {
    keep_rows(y0 - max_ridge_reach_px, y0 + strip_rows + max_ridge_reach_px, next_green_, [&](int y) {
      std::uint64_t bits = 0;
      if (y >= 1 && y + 1 < s_.green.height) {  // a side at the border has no neighbour
        __builtin_memcpy(&bits, bytes_at(s_.green, y) - margin_px / 8, sizeof bits);
        bits &= inside_;
      }
      const int at = y & (kept_rows - 1);
      green_[at] = bits;
      if (at < strip_rows) green_[kept_rows + at] = bits;  // so that a strip's rows lie in one piece
    });
  }
  [[nodiscard]] [[gnu::always_inline]] Windows green_from(int y) const {
    Windows rows;
    __builtin_memcpy(&rows, green_ + (y & (kept_rows - 1)), sizeof rows);
    return rows;
  }
  /// Where the window's middle is set.
  [[gnu::always_inline]] static Rows middle_of(Windows rows) {
    return __builtin_convertvector(rows >> margin_px, Rows);
  }

  void keep_sums(int y0) {
    keep_rows(y0 - max_ridge_reach_px, y0 + strip_rows + max_ridge_reach_px, next_sum_, [&](int y) {
      if (y < 0 || y >= s_.image.y.height) return;
      std::uint8_t copy[window_px];
      const std::uint8_t* row = samples_at(s_.image.y, x0_ - margin_px, y, copy) + margin_px;
      const Pixels middle(row);
      across_.set(y & (kept_rows - 1), 0, Pixels(row - 1) + middle + middle + Pixels(row + 1));
    });
  }

  void keep_colours(int y0) {
    constexpr int reach = max_ridge_reach_px / 2;
    keep_rows(y0 / 2 - reach, (y0 + strip_rows) / 2 + reach, next_colour_, [&](int y) {
      if (y < 0 || y >= s_.image.cb.height) return;
      std::uint8_t copies[2][window_px / 2];
      const std::uint8_t* cb = samples_at(s_.image.cb, (x0_ - margin_px) / 2, y, copies[0]);
      const std::uint8_t* cr = samples_at(s_.image.cr, (x0_ - margin_px) / 2, y, copies[1]);
      Colour* out = colours_[y & (kept_rows / 2 - 1)];
      const std::int32_t axis_cb = s_.axis_cb, axis_cr = s_.axis_cr;
      for (int i = 0; i < window_px / 2; ++i) {
        const int b = cb[i] - 128, r = cr[i] - 128;
        out[i].greenness = b * axis_cb + r * axis_cr;
        out[i].chroma = (b < 0 ? -b : b) + (r < 0 ? -r : r);
      }
    });
  }

  /// One look at a strip: the open pixels that stand out and can become more than they are. `bars`: of both sides, what
  /// a row's pixels have to exceed by the margin.
  template <typename Bars>
  [[gnu::always_inline]] void look(int reach, const Pixels (&here)[strip_rows], Bars bars, Rows open,
                                   const Found& found, Bright& bright) const {
    Pixels above[strip_rows];
    for (int r = 0; r < strip_rows; ++r) above[r] = here[r] - bars(r);
    const Rows weak = bits_above(above, 0);
    const Rows strong = bits_above(above, static_cast<std::int16_t>(s_.strong_margin - s_.weak_margin));
    bright.add(reach, weak & open & ~(found.strong | (found.weak & ~strong)), strong);
  }

  void look_along_rows(int y0, const Looks& looks, Rows wanted, Found& found) {
    Sums<strip_rows, window_px> sums;
    sum_down(y0, sums);
    Pixels here[strip_rows];
    for (int r = 0; r < strip_rows; ++r) here[r] = Pixels(&sums.sum[r][margin_px]) - all(s_.weak_margin);
    const Windows green = green_from(y0);
    Bright bright;
    for (std::uint32_t left = looks.row; left != 0; left &= left - 1) {
      const int reach = first_bit(left);
      const Rows open = wanted & pixels_of(looks.of_block, reach, 0) & middle_of(green << reach & green >> reach);
      const auto bars = [&](int r) __attribute__((always_inline)) {
        const std::int16_t* middle = &sums.bar[r][margin_px];
        return larger(Pixels(middle - reach), Pixels(middle + reach));
      };
      look(reach, here, bars, open, found, bright);
    }
    if (bright.count != 0) compare_colours<true>(y0, bright, found);
  }

  void look_along_columns(int y0, const Looks& looks, Rows wanted, Found& found) {
    keep_sums(y0);
    const auto at = [](int y) __attribute__((always_inline)) { return y & (kept_rows - 1); };
    Pixels here[strip_rows];
    for (int r = 0; r < strip_rows; ++r) here[r] = Pixels(across_.sum[at(y0 + r)]) - all(s_.weak_margin);
    Bright bright;
    for (std::uint32_t left = looks.column; left != 0; left &= left - 1) {
      const int reach = first_bit(left);
      const Rows open =
          wanted & pixels_of(looks.of_block, reach, 32) & middle_of(green_from(y0 - reach) & green_from(y0 + reach));
      const auto bars = [&](int r) __attribute__((always_inline)) {
        return larger(Pixels(across_.bar[at(y0 + r - reach)]), Pixels(across_.bar[at(y0 + r + reach)]));
      };
      look(reach, here, bars, open, found, bright);
    }
    if (bright.count != 0) compare_colours<false>(y0, bright, found);
  }

  void sum_down(int y0, Sums<strip_rows, window_px>& sums) const {
    std::uint8_t copies[strip_rows + 2][window_px];
    const std::uint8_t* rows[strip_rows + 2];
    for (int r = 0; r < strip_rows + 2; ++r) {
      const int y = y0 + r - 1;
      const int last = s_.image.y.height - 1;
      rows[r] = samples_at(s_.image.y, x0_ - margin_px, y < 0 ? 0 : y > last ? last : y, copies[r]);
    }
    for (int x = 0; x < window_px; x += column_px) {
      // a + 2 b + c is (a + b) + (b + c), and each pair serves two rows.
      Pixels here(rows[1] + x);
      Pixels pair = Pixels(rows[0] + x) + here;
      for (int r = 0; r < strip_rows; ++r) {
        const Pixels below(rows[r + 2] + x);
        const Pixels next = here + below;
        sums.set(r, x, pair + next);
        here = below;
        pair = next;
      }
    }
  }

  /// Of the pixels that are bright enough, the ones whiter than both sides. One loop over all of them, and no branch
  /// but its end: no processor could foresee one.
  template <bool AlongRow>
  void compare_colours(int y0, Bright& bright, Found& found) {
    keep_colours(y0);
    const std::ptrdiff_t stride = s_.image.y.stride;
    const std::uint8_t* luma = s_.image.y.data + stride * y0 + x0_;
    std::ptrdiff_t steps[max_looks];
    for (int k = 0; k < bright.looks; ++k) steps[k] = AlongRow ? bright.reach[k] : bright.reach[k] * stride;
    std::uint32_t weak[strip_rows] = {}, strong[strip_rows] = {};
    std::uint32_t strong_looks[max_looks * strip_rows];
    __builtin_memcpy(strong_looks, bright.strong, sizeof strong_looks);
    bright.left[bright.count] = 0;
    const std::uint32_t* next = bright.left;
    const std::uint32_t* which_next = bright.which;
    for (std::uint32_t left = *next; left != 0;) {
      const std::size_t which = *which_next;
      const std::size_t row = which % strip_rows;
      const std::size_t look = which / strip_rows;
      const auto x = static_cast<std::size_t>(first_bit(left));
      const std::uint32_t flag = left & (0U - left);
      left &= left - 1U;
      const std::ptrdiff_t done = left == 0 ? 1 : 0;
      next += done;
      which_next += done;
      const std::uint32_t begin = *next;
      left = left == 0 ? begin : left;

      const std::uint8_t* at = luma + static_cast<std::size_t>(stride) * row + x;
      const auto reach = static_cast<std::size_t>(bright.reach[look]);
      const std::ptrdiff_t step = steps[look];
      const std::size_t dx = AlongRow ? reach : 0, dy = AlongRow ? 0 : reach;
      const std::size_t y = static_cast<std::size_t>(y0) + row;
      const Colour& here = colour_at(x, y);
      const std::int32_t both = whiter(here, at[0], colour_at(x - dx, y - dy), at[-step]) &
                                whiter(here, at[0], colour_at(x + dx, y + dy), at[step]);
      const std::uint32_t both_flag = flag & static_cast<std::uint32_t>(both >> 31);
      weak[row] = static_cast<std::uint32_t>(weak[row] | both_flag);
      strong[row] = static_cast<std::uint32_t>(strong[row] | (strong_looks[which] & both_flag));
    }
    Found more;
    __builtin_memcpy(&more.weak, weak, sizeof weak);
    __builtin_memcpy(&more.strong, strong, sizeof strong);
    found.weak |= more.weak;
    found.strong |= more.strong;
  }
  [[nodiscard]] [[gnu::always_inline]] const Colour& colour_at(std::size_t x, std::size_t y) const {
    return colours_[y / 2 % (kept_rows / 2)][(x + margin_px) / 2];
  }

  const RidgeSearch& s_;
  int x0_;
  std::uint32_t inner_;   // pixels of the column, but for the image's border
  std::uint64_t inside_;  // of the window, inside the image
  // Rows that are kept, each at its number modulo kept_rows, and the first that is not yet.
  int next_green_ = -kept_rows, next_sum_ = -kept_rows, next_colour_ = -kept_rows;
  std::uint64_t green_[kept_rows + strip_rows] = {};
  Sums<kept_rows, column_px> across_ = {};  // of each row, along it
  Colour colours_[kept_rows / 2][window_px / 2] = {};
};

inline void find_ridges(const RidgeSearch& search) {
  for (int x0 = 0; x0 < search.roi.width; x0 += column_px) Column(search, x0).search();
}

}  // namespace ridge
}  // namespace
}  // namespace touchline
