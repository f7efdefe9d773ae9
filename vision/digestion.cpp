// SPDX-License-Identifier: Apache-2.0
#include "vision/digestion.h"

#include <bit>
#include <cassert>

#include "vision/image/bit_ops.h"
#include "vision/image/neighbour_words.h"
#include "vision/live_nodes.h"

namespace touchline {
namespace {

using namespace live_nodes;

/// Lines 19 to 27 of Algorithm 1 for one pixel: the heaviest live node of the disc eats the others. Of equal ones the
/// first in raster order wins. Weights are compared as they were before this meal.
class Meal {
 public:
  Meal(const SkeletonIndex& skeleton, const DigestionMemory& memory) : skeleton_(skeleton), memory_(memory) {}

  void join(const Guests& guests) {
    for (std::size_t i = 0; i < guests.words; ++i) {
      guests.window.remove(guests.row[i], guests.inside[i]);
      for_each_bit(guests.inside[i], [&](int b) { compare(guests.window, guests.row[i], static_cast<unsigned>(b)); });
    }
  }
  [[nodiscard]] PixelIndex winner() const { return winner_; }  // no_pixel when there is no live node
  void finish() const {
    memory_.weight[winner_] = sum_;
    window_.add(row_, Rows{1} << bit_);
  }

 private:
  void compare(const Window& window, int row, unsigned bit) {
    const PixelIndex node = skeleton_.number_of(window.x + static_cast<int>(bit % strip_px),
                                                window.y + row + static_cast<int>(bit / strip_px));
    const std::int32_t own = memory_.weight[node];
    sum_ += own;
    PixelIndex loser = node;
    if (own > best_ || (own == best_ && node < winner_)) {
      loser = winner_;
      winner_ = node;
      best_ = own;
      window_ = window;
      row_ = row;
      bit_ = bit;
      if (loser == no_pixel) return;  // the first guest
    }
    memory_.weight[loser] = 0;
    memory_.parent[loser] = winner_;
  }

  const SkeletonIndex& skeleton_;
  const DigestionMemory& memory_;
  PixelIndex winner_ = no_pixel;
  std::int32_t best_ = 0;
  std::int32_t sum_ = 0;
  Window window_{};  // of the winner
  int row_ = 0;
  unsigned bit_ = 0;
};

/// Lets the disc around a pixel eat. An end point has weight 0 and is no live node; it still belongs to the one that
/// rules its neighbourhood.
void digest_around(const SkeletonIndex& skeleton, PixelIndex pixel, const LiveNodes& live,
                   const DigestionMemory& memory) {
  const bool is_free = memory.parent[pixel] == pixel && memory.weight[pixel] == 0;
  Meal meal(skeleton, memory);
  live.visit_disc(skeleton.pixel(pixel), [&](const Guests& guests) {
    const bool alone = guests.words == 1 && (guests.inside[0] & (guests.inside[0] - 1)) == 0;
    if (alone && !is_free && live.has_one_window()) return;  // nobody is eaten
    meal.join(guests);
  });
  if (meal.winner() == no_pixel) return;
  meal.finish();
  if (is_free) memory.parent[pixel] = meal.winner();
}

/// The weights of 64 pixels by their numbers of neighbours, as two bits each: 0, low, medium, high.
struct WeightBits {
  BitWord units, twos;
};
WeightBits weight_bits(const NeighbourWords& n) {
  const NeighbourCount count = count_neighbours(n);
  return {(count.two & ~count.odd) | count.four, (count.two & count.odd) | count.four};
}

/// Every pixel its own set, with the weight of its neighbourhood; those with a weight are live.
void prepare(const SkeletonIndex& skeleton, const DigestionParameters& p, const DigestionMemory& memory,
             LiveNodes& live) {
  const std::int32_t weights[4] = {0, p.low_weight, p.medium_weight, p.high_weight};
  const auto all_if = [](int weight) { return weight > 0 ? ~BitWord{0} : BitWord{0}; };
  const BitWord low = all_if(p.low_weight);
  const BitWord medium = all_if(p.medium_weight);
  const BitWord high = all_if(p.high_weight);
  const int words = words_for(skeleton.width());
  PixelIndex i = 0;
  for (int y = skeleton.first_row(); y < skeleton.height(); ++y) {
    const BitWord* row = skeleton.row(y);
    for (int k = 0; k < words; ++k) {
      if (row[k] == 0) continue;
      const WeightBits bits = weight_bits(neighbour_words(skeleton.row(y - 1), row, skeleton.row(y + 1), k, words));
      live.set_row(k, y,
                   row[k] & ((bits.units & ~bits.twos & low) | (~bits.units & bits.twos & medium) |
                             (bits.units & bits.twos & high)));
      for_each_bit(row[k], [&](int b) {
        memory.parent[i] = i;
        memory.weight[i] = weights[(bits.units >> b & 1U) | (bits.twos >> b & 1U) << 1U];
        ++i;
      });
    }
  }
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
  LiveNodes live(memory.live, skeleton.width(), skeleton.height(), parameters.radius_px);
  prepare(skeleton, parameters, memory, live);
  for (PixelIndex i = 0; i < count; ++i) {
    digest_around(skeleton, i, live, memory);
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
