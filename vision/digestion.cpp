// SPDX-License-Identifier: Apache-2.0
#include "vision/digestion.h"

#include <bit>
#include <cassert>
#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

constexpr int tile_px = 8;  // 8x8 pixels are one word

/// The live nodes, as bits in tiles.
class LiveNodes {
 public:
  LiveNodes(const DigestionMemory& memory, int width, int height)
      : tiles_(memory.tiles),
        rows_(memory.tile_rows),
        tiles_a_row_((width + tile_px - 1) / tile_px),
        tile_rows_((height + tile_px - 1) / tile_px),
        words_a_row_(words_for(tiles_a_row_)) {
    const auto tiles = static_cast<std::size_t>(tiles_a_row_) * static_cast<std::size_t>(tile_rows_);
    const auto words = static_cast<std::size_t>(words_a_row_) * static_cast<std::size_t>(tile_rows_);
    assert(tiles_.size() >= tiles && rows_.size() >= words);
    for (std::size_t i = 0; i < tiles; ++i) tiles_[i] = 0;
    for (std::size_t i = 0; i < words; ++i) rows_[i] = 0;
  }

  void add(GridPoint p) {
    tile(p.x / tile_px, p.y / tile_px) |= bit(p);
    row_word(p) |= row_bit(p);
  }
  void remove(GridPoint p) {
    BitWord& t = tile(p.x / tile_px, p.y / tile_px);
    t &= ~bit(p);
    if (t == 0) row_word(p) &= ~row_bit(p);
  }

  /// Calls visit(x, y) for every live node within `radius` of `centre`. visit may remove the node it is called with.
  template <typename Visit>
  void for_each_within(GridPoint centre, int radius, Visit visit) const {
    const int x0 = centre.x > radius ? centre.x - radius : 0;
    const int y0 = centre.y > radius ? centre.y - radius : 0;
    const int tx1 = min_of((centre.x + radius) / tile_px, tiles_a_row_ - 1);
    const int ty1 = min_of((centre.y + radius) / tile_px, tile_rows_ - 1);
    for (int ty = y0 / tile_px; ty <= ty1; ++ty) {
      for (int w = x0 / tile_px / bits_per_word; w <= tx1 / bits_per_word; ++w) {
        BitWord row = rows_[static_cast<std::size_t>(ty * words_a_row_ + w)];
        row &= between(x0 / tile_px - w * bits_per_word, tx1 - w * bits_per_word);
        for_each_bit(row, [&](int bit) { visit_tile(w * bits_per_word + bit, ty, centre, radius, visit); });
      }
    }
  }

 private:
  template <typename Visit>
  void visit_tile(int tx, int ty, GridPoint centre, int radius, Visit& visit) const {
    for_each_bit(tiles_[static_cast<std::size_t>(ty * tiles_a_row_ + tx)], [&](int b) {
      const int x = tx * tile_px + b % tile_px;
      const int y = ty * tile_px + b / tile_px;
      const int dx = x - centre.x;
      const int dy = y - centre.y;
      if (dx * dx + dy * dy <= radius * radius) visit(x, y);
    });
  }
  static int min_of(int a, int b) { return b < a ? b : a; }
  /// Bits first..last of a word; what lies outside the word is left out.
  static BitWord between(int first, int last) {
    const BitWord from = first <= 0 ? ~BitWord{0} : ~BitWord{0} << first;
    const BitWord to = last >= bits_per_word - 1 ? ~BitWord{0} : (BitWord{1} << (last + 1)) - 1;
    return from & to;
  }
  BitWord& tile(int tx, int ty) { return tiles_[static_cast<std::size_t>(ty * tiles_a_row_ + tx)]; }
  BitWord& row_word(GridPoint p) {
    return rows_[static_cast<std::size_t>(p.y / tile_px * words_a_row_ + p.x / tile_px / bits_per_word)];
  }
  static BitWord row_bit(GridPoint p) { return BitWord{1} << (p.x / tile_px % bits_per_word); }
  static BitWord bit(GridPoint p) { return BitWord{1} << (p.y % tile_px * tile_px + p.x % tile_px); }

  std::span<BitWord> tiles_;
  std::span<BitWord> rows_;
  int tiles_a_row_;
  int tile_rows_;
  int words_a_row_;
};

int initial_weight(int neighbours, const DigestionParameters& p) {
  if (neighbours <= 1) return 0;
  if (neighbours == 2) return p.low_weight;
  return neighbours == 3 ? p.medium_weight : p.high_weight;
}

/// Lines 19 to 27 of Algorithm 1 for one pixel: the heaviest live node of the disc eats the others. Of equal ones the
/// first in raster order wins. Weights are compared as they were before this meal.
PixelIndex digest_around(const SkeletonIndex& skeleton, PixelIndex pixel, int radius, LiveNodes& live,
                         const DigestionMemory& memory) {
  PixelIndex winner = no_pixel;
  std::int32_t sum = 0;
  const auto eat = [&](PixelIndex loser, PixelIndex by) {
    live.remove(skeleton.pixel(loser));
    memory.weight[loser] = 0;
    memory.parent[loser] = by;
  };
  live.for_each_within(skeleton.pixel(pixel), radius, [&](int x, int y) {
    const PixelIndex node = skeleton.at(x, y);
    sum += memory.weight[node];
    if (winner == no_pixel) {
      winner = node;
      return;
    }
    const std::int32_t best = memory.weight[winner];
    const std::int32_t own = memory.weight[node];
    if (own > best || (own == best && node < winner)) {
      eat(winner, node);
      winner = node;
    } else {
      eat(node, winner);
    }
  });
  if (winner != no_pixel) memory.weight[winner] = sum;
  return winner;
}

/// For an end point without a live node in its disc: the set of the pixel that it hangs on, or itself.
PixelIndex neighbour_set(const SkeletonIndex& skeleton, PixelIndex pixel, const DigestionMemory& memory) {
  const GridPoint at = skeleton.pixel(pixel);
  const std::uint8_t around = skeleton.neighbours(at);
  if (count_of(around) != 1) return pixel;
  const int k = std::countr_zero(around);
  const PixelIndex root = digestion_root(memory.parent, skeleton.at(at.x + neighbour_dx[k], at.y + neighbour_dy[k]));
  return memory.weight[root] > 0 ? root : pixel;
}

}  // namespace

PixelIndex digestion_root(std::span<PixelIndex> parent, PixelIndex pixel) {
  while (parent[pixel] != pixel) {  // path halving: every step goes up, so at most one step a member of the set
    parent[pixel] = parent[parent[pixel]];
    pixel = parent[pixel];
  }
  return pixel;
}

DigestionResult digest(const SkeletonIndex& skeleton, const DigestionParameters& parameters,
                       const DigestionMemory& memory) {
  const auto count = static_cast<PixelIndex>(skeleton.size());
  assert(memory.parent.size() >= count && memory.weight.size() >= count && parameters.radius_px >= 0);
  LiveNodes live(memory, skeleton.width(), skeleton.height());
  for (PixelIndex i = 0; i < count; ++i) {
    const int neighbours = count_of(skeleton.neighbours(skeleton.pixel(i)));
    memory.parent[i] = i;
    memory.weight[i] = initial_weight(neighbours, parameters);
    if (memory.weight[i] > 0) live.add(skeleton.pixel(i));
  }
  for (PixelIndex i = 0; i < count; ++i) {
    const PixelIndex winner = digest_around(skeleton, i, parameters.radius_px, live, memory);
    // An end point has weight 0 and is no live node; it still belongs to the one that rules its neighbourhood.
    if (winner != no_pixel && memory.parent[i] == i && memory.weight[i] == 0) memory.parent[i] = winner;
  }
  for (PixelIndex i = 0; i < count; ++i) {
    if (memory.parent[i] == i && memory.weight[i] == 0) memory.parent[i] = neighbour_set(skeleton, i, memory);
  }
  DigestionResult result;
  std::size_t found = 0;
  for (PixelIndex i = 0; i < count; ++i) {
    if (memory.weight[i] == 0) continue;
    if (found < memory.major_nodes.size()) {
      memory.major_nodes[found++] = {skeleton.pixel(i), memory.weight[i]};
    } else {
      ++result.dropped;
    }
  }
  result.major_nodes = memory.major_nodes.first(found);
  return result;
}

}  // namespace touchline
