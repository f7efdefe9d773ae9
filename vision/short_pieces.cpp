// SPDX-License-Identifier: Apache-2.0
// Connected pieces by runs of rows (A. Rosenfeld and J. L. Pfaltz, "Sequential Operations in Digital Picture
// Processing", JACM 13(4), 1966).
#include "vision/short_pieces.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

using Label = std::uint16_t;
constexpr Label no_piece = 0xFFFF;

/// Takes away the piece that `seed` belongs to; false when not all of its pixels found room.
bool take_away(BitView skeleton, GridPoint seed, std::span<GridPoint> stack) {
  bool complete = true;
  std::size_t waiting = 0;
  stack[waiting++] = seed;
  skeleton.set(seed.x, seed.y, false);
  while (waiting > 0) {
    const GridPoint at = stack[--waiting];
    for (int y = at.y - 1; y <= at.y + 1; ++y) {
      for (int x = at.x - 1; x <= at.x + 1; ++x) {
        if (!skeleton.get(x, y)) continue;
        if (waiting == stack.size()) {
          complete = false;
          continue;
        }
        skeleton.set(x, y, false);
        stack[waiting++] = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
      }
    }
  }
  return complete;
}

/// The runs of a row, from the left.
struct Runs {
  std::span<std::uint16_t> first, last;
  std::span<Label> piece;
  std::size_t size = 0;

  Runs(std::span<std::uint16_t> memory, std::size_t room)
      : first(memory.first(room)), last(memory.subspan(room, room)), piece(memory.subspan(2 * room, room)) {}

  void find(const BitWord* row, int words) {
    size = 0;
    for (int i = 0; i < words; ++i) {
      const int begin = i * bits_per_word;
      for (BitWord left = row[i]; left != 0;) {
        const int from = std::countr_zero(left);
        const int length = std::countr_one(left >> from);
        const int x = begin + from;
        if (size > 0 && last[size - 1] + 1 == x) {  // goes on from the word before
          last[size - 1] = static_cast<std::uint16_t>(x + length - 1);
        } else {
          first[size] = static_cast<std::uint16_t>(x);
          last[size++] = static_cast<std::uint16_t>(x + length - 1);
        }
        left &= from + length < bits_per_word ? ~BitWord{0} << (from + length) : 0;
      }
    }
  }
};

/// The pieces that reach the row that is looked at or the one above. Pieces that meet are a tree until the row's end.
class OpenPieces {
 public:
  OpenPieces(const PieceMemory& memory, std::size_t room)
      : parent_(memory.pieces.first(room)),
        seed_x_(memory.pieces.subspan(room, room)),
        free_(memory.pieces.subspan(2 * room, room)),
        low_(memory.corners.first(room)),
        high_(memory.corners.subspan(room, room)),
        free_count_(room) {
    for (std::size_t i = 0; i < room; ++i) free_[i] = static_cast<Label>(room - 1 - i);
  }

  [[nodiscard]] Label open(int x, int y) {
    assert(free_count_ > 0);
    const Label piece = free_[--free_count_];
    parent_[piece] = piece;
    seed_x_[piece] = static_cast<std::uint16_t>(x);
    low_[piece] = high_[piece] = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
    return piece;
  }
  [[nodiscard]] Label root(Label piece) const {
    while (parent_[piece] != piece) piece = parent_[piece];
    return piece;
  }
  /// The piece of both.
  [[nodiscard]] Label join(Label a, Label b) {
    if (a == b) return a;
    if (low_[b].y < low_[a].y) std::swap(a, b);  // the seed lies in the first row
    parent_[b] = a;
    low_[a].x = std::min(low_[a].x, low_[b].x);
    high_[a] = {std::max(high_[a].x, high_[b].x), std::max(high_[a].y, high_[b].y)};
    return a;
  }
  void extend(Label piece, int first, int last, int y) {
    low_[piece].x = std::min(low_[piece].x, static_cast<std::int16_t>(first));
    high_[piece] = {std::max(high_[piece].x, static_cast<std::int16_t>(last)), static_cast<std::int16_t>(y)};
  }
  [[nodiscard]] bool is_open(Label piece) const { return parent_[piece] != no_piece; }
  void close(Label piece) {
    parent_[piece] = no_piece;
    free_[free_count_++] = piece;
  }
  [[nodiscard]] bool is_joined(Label piece) const { return parent_[piece] != piece; }
  [[nodiscard]] GridPoint low(Label piece) const { return low_[piece]; }
  [[nodiscard]] GridPoint high(Label piece) const { return high_[piece]; }
  [[nodiscard]] GridPoint seed(Label piece) const { return {static_cast<std::int16_t>(seed_x_[piece]), low_[piece].y}; }

 private:
  std::span<Label> parent_;
  std::span<std::uint16_t> seed_x_;
  std::span<Label> free_;
  std::span<GridPoint> low_, high_;
  std::size_t free_count_;
};

bool is_short(GridPoint low, GridPoint high, LineWidthView widths, int least_px) {
  const int wide = high.x - low.x;
  const int tall = high.y - low.y;
  if (std::max(wide, tall) + 1 < least_px) return true;
  const int block_x = std::min((low.x + high.x) / 2 / width_block_px, widths.width - 1);
  const int block_y = std::min((low.y + high.y) / 2 / width_block_px, widths.height - 1);
  const LineWidth& width = widths.at(block_x, block_y);
  return wide * 16 < least_length_in_widths * width.across_row &&
         tall * 16 < least_length_in_widths * width.across_column;
}

/// Gives every run of row y the piece of the runs above that it touches, or a new one.
void join_rows(const Runs& above, Runs& here, int y, OpenPieces& pieces) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < here.size; ++i) {
    Label piece = no_piece;
    while (next < above.size && above.last[next] + 1 < here.first[i]) ++next;
    // The last run that touches this one may touch the next one too.
    for (std::size_t k = next; k < above.size && above.first[k] <= here.last[i] + 1; ++k) {
      const Label other = pieces.root(above.piece[k]);
      piece = piece == no_piece ? other : pieces.join(piece, other);
    }
    if (piece == no_piece) piece = pieces.open(here.first[i], y);
    pieces.extend(piece, here.first[i], here.last[i], y);
    here.piece[i] = piece;
  }
  for (std::size_t i = 0; i < here.size; ++i) here.piece[i] = pieces.root(here.piece[i]);
}

}  // namespace

PieceCounts remove_short_pieces(BitView skeleton, LineWidthView widths, int least_px, const PieceMemory& memory) {
  PieceCounts counts;
  const std::size_t room = max_skeleton_runs(skeleton.width);
  assert(memory.runs.size() >= 6 * room && memory.pieces.size() >= 3 * max_open_pieces(skeleton.width));
  assert(memory.corners.size() >= 2 * max_open_pieces(skeleton.width) && !memory.stack.empty());
  Runs above(memory.runs.first(3 * room), room);
  Runs here(memory.runs.subspan(3 * room, 3 * room), room);
  OpenPieces pieces(memory, max_open_pieces(skeleton.width));
  const int words = words_for(skeleton.width);
  for (int y = 0; y <= skeleton.height; ++y) {  // below the last row everything ends
    here.size = 0;
    if (y < skeleton.height) here.find(skeleton.row(y), words);
    join_rows(above, here, y, pieces);
    for (std::size_t i = 0; i < above.size; ++i) {
      const Label piece = above.piece[i];
      if (!pieces.is_open(piece)) continue;  // another of its runs came before
      if (!pieces.is_joined(piece)) {
        if (pieces.high(piece).y == y) continue;
        if (is_short(pieces.low(piece), pieces.high(piece), widths, least_px)) {
          if (!take_away(skeleton, pieces.seed(piece), memory.stack)) ++counts.overflowed;
          ++counts.removed;
        } else {
          ++counts.kept;
        }
      }
      pieces.close(piece);
    }
    std::swap(above, here);
  }
  return counts;
}

}  // namespace touchline
