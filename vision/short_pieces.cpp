// SPDX-License-Identifier: Apache-2.0
#include "vision/short_pieces.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

struct Piece {
  int left, right, top, bottom;
  bool overflowed = false;
};

void include(Piece& piece, int x, int y) {
  piece.left = std::min(piece.left, x);
  piece.right = std::max(piece.right, x);
  piece.top = std::min(piece.top, y);
  piece.bottom = std::max(piece.bottom, y);
}

/// Follows the piece that (x, y) belongs to, moving its pixels from `from` to `to`, or away when `to` is null.
Piece move_piece(BitView from, const BitView* to, int x, int y, std::span<GridPoint> stack) {
  Piece piece{x, x, y, y};
  std::size_t waiting = 0;
  stack[waiting++] = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
  from.set(x, y, false);
  if (to != nullptr) to->set(x, y, true);
  while (waiting > 0) {
    const GridPoint at = stack[--waiting];
    for (int ny = at.y - 1; ny <= at.y + 1; ++ny) {
      for (int nx = at.x - 1; nx <= at.x + 1; ++nx) {
        if (!from.get(nx, ny)) continue;
        if (waiting == stack.size()) {
          piece.overflowed = true;
          continue;
        }
        from.set(nx, ny, false);
        if (to != nullptr) to->set(nx, ny, true);
        include(piece, nx, ny);
        stack[waiting++] = {static_cast<std::int16_t>(nx), static_cast<std::int16_t>(ny)};
      }
    }
  }
  return piece;
}

bool is_short(const Piece& piece, LineWidthView widths, int least_px) {
  const int wide = piece.right - piece.left;
  const int high = piece.bottom - piece.top;
  if (std::max(wide, high) + 1 < least_px) return true;
  const int block_x = std::min((piece.left + piece.right) / 2 / width_block_px, widths.width - 1);
  const int block_y = std::min((piece.top + piece.bottom) / 2 / width_block_px, widths.height - 1);
  const LineWidth& width = widths.at(block_x, block_y);
  return wide * 16 < least_length_in_widths * width.across_row &&
         high * 16 < least_length_in_widths * width.across_column;
}

}  // namespace

PieceCounts remove_short_pieces(BitView skeleton, LineWidthView widths, int least_px, BitView scratch,
                                std::span<GridPoint> stack) {
  PieceCounts counts;
  if (stack.empty()) return counts;
  copy(skeleton, scratch);
  clear(skeleton);
  const int words = words_for(skeleton.width);
  for (int y = 0; y < skeleton.height; ++y) {
    for (int i = 0; i < words; ++i) {
      while (scratch.row(y)[i] != 0) {
        const int x = i * bits_per_word + std::countr_zero(scratch.row(y)[i]);
        const Piece piece = move_piece(scratch, &skeleton, x, y, stack);
        if (piece.overflowed) {
          // What is left of it looks like pieces of its own: all that was not looked at stays.
          counts.overflowed = 1;
          or_with(skeleton, scratch);
          return counts;
        }
        if (is_short(piece, widths, least_px)) {
          (void)move_piece(skeleton, nullptr, x, y, stack);
          ++counts.removed;
          continue;
        }
        ++counts.kept;
      }
    }
  }
  return counts;
}

}  // namespace touchline
