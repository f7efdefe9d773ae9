// SPDX-License-Identifier: Apache-2.0
// Zhang-Suen thinning on whole words. Neighbours are named as in the publication: p2 is north, then clockwise to p9,
// north-west.
#include "vision/image/thinning.h"

#include <bit>
#include <utility>

namespace touchline {
namespace {

constexpr int max_words = words_for(max_thinning_width);

/// The eight neighbours of 64 pixels.
struct Neighbours {
  BitWord p2, p3, p4, p5, p6, p7, p8, p9;
};

/// A row as seen from one of its words: itself and both neighbouring words' adjacent bits.
struct Triple {
  BitWord west, here, east;  // the pixel to the left, the pixel, the pixel to the right
};

Triple load(const BitWord* row, int i, int words) {
  if (row == nullptr) return {0, 0, 0};
  const BitWord before = i > 0 ? row[i - 1] : 0;
  const BitWord after = i + 1 < words ? row[i + 1] : 0;
  return {(row[i] << 1) | (before >> (bits_per_word - 1)), row[i], (row[i] >> 1) | (after << (bits_per_word - 1))};
}

/// Exactly one 0 -> 1 step in p2, p3, ..., p9, p2: A(p1) = 1.
BitWord one_transition(const Neighbours& n) {
  // Two adjacent steps exclude each other, so each pair is one bit.
  const BitWord a = (~n.p2 & n.p3) | (~n.p3 & n.p4);
  const BitWord b = (~n.p4 & n.p5) | (~n.p5 & n.p6);
  const BitWord c = (~n.p6 & n.p7) | (~n.p7 & n.p8);
  const BitWord d = (~n.p8 & n.p9) | (~n.p9 & n.p2);
  const BitWord ab = a ^ b;
  const BitWord cd = c ^ d;
  const BitWord several = (a & b) | (c & d) | (ab & cd);
  return (ab | cd) & ~several;
}

/// 2 <= B(p1) <= 6, given A(p1) = 1. The set neighbours are then one run around the pixel: a run of two or more holds
/// an orthogonal neighbour and a diagonal one beside it, and so does the run of the two or more that are not set.
BitWord two_to_six(const Neighbours& n) {
  const BitWord two_set =
      (n.p2 & (n.p9 | n.p3)) | (n.p4 & (n.p3 | n.p5)) | (n.p6 & (n.p5 | n.p7)) | (n.p8 & (n.p7 | n.p9));
  const BitWord at_most_one_clear =
      (n.p2 | (n.p9 & n.p3)) & (n.p4 | (n.p3 & n.p5)) & (n.p6 | (n.p5 & n.p7)) & (n.p8 | (n.p7 & n.p9));
  return two_set & ~at_most_one_clear;
}

/// The pixels of word i of a row that this pass deletes.
BitWord deleted(const BitWord* above, const BitWord* here, const BitWord* below, int i, int words, bool second) {
  const BitWord p1 = here[i];
  if (p1 == 0) return 0;
  const Triple north = load(above, i, words);
  const Triple middle = load(here, i, words);
  const Triple south = load(below, i, words);
  const Neighbours n = {north.here, north.east, middle.east, south.east,
                        south.here, south.west, middle.west, north.west};
  // First pass: p2 p4 p6 = 0 and p4 p6 p8 = 0. Second: p2 p4 p8 = 0 and p2 p6 p8 = 0.
  const BitWord kept_by_side = second ? n.p2 & n.p8 & (n.p4 | n.p6) : n.p4 & n.p6 & (n.p2 | n.p8);
  return p1 & ~kept_by_side & one_transition(n) & two_to_six(n);
}

/// One pass over the image. Deletions of a row are kept back until the row below has been looked at.
class Pass {
 public:
  Pass(BitView mask, std::span<ThinningScratch> scratch)
      : mask_(mask),
        words_(words_for(mask.width)),
        all_words_(words_ == max_words ? ~std::uint32_t{0} : (std::uint32_t{1} << words_) - 1),
        changed_(scratch.first(static_cast<std::size_t>(mask.height))),
        changed_before_(scratch.subspan(static_cast<std::size_t>(mask.height), static_cast<std::size_t>(mask.height))) {
    for (std::uint32_t& row : changed_) row = all_words_;  // everything is new
    for (std::uint32_t& row : changed_before_) row = 0;
  }

  /// True when a pixel was deleted.
  bool run(bool second) {
    bool any = false;
    std::uint32_t near_above = 0;
    std::uint32_t near_here = recently_changed(0);
    std::uint32_t pending = 0;  // words of the row above whose deletions wait in deletions_[(y - 1) & 1]
    for (int y = 0; y < mask_.height; ++y) {
      const std::uint32_t near_below = y + 1 < mask_.height ? recently_changed(y + 1) : 0;
      const std::uint32_t deleted_words = look_at_row(y, spread(near_above | near_here | near_below), second);
      apply(y - 1, pending);
      // The older mark of this row is not read again in this pass: it takes the new one.
      if (y > 0) changed_before_[static_cast<std::size_t>(y) - 1] = pending;
      pending = deleted_words;
      any = any || deleted_words != 0;
      near_above = near_here;
      near_here = near_below;
    }
    apply(mask_.height - 1, pending);
    changed_before_[static_cast<std::size_t>(mask_.height) - 1] = pending;
    std::swap(changed_, changed_before_);
    return any;
  }

 private:
  [[nodiscard]] std::uint32_t recently_changed(int y) const {
    return changed_[static_cast<std::size_t>(y)] | changed_before_[static_cast<std::size_t>(y)];
  }
  [[nodiscard]] std::uint32_t spread(std::uint32_t words) const {
    return (words | words << 1 | words >> 1) & all_words_;
  }

  std::uint32_t look_at_row(int y, std::uint32_t candidates, bool second) {
    if (candidates == 0) return 0;
    const BitWord* above = y > 0 ? mask_.row(y - 1) : nullptr;
    const BitWord* here = mask_.row(y);
    const BitWord* below = y + 1 < mask_.height ? mask_.row(y + 1) : nullptr;
    BitWord* out = deletions_[static_cast<std::size_t>(y & 1)].data();
    std::uint32_t result = 0;
    for (std::uint32_t left = candidates; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      out[i] = deleted(above, here, below, i, words_, second);
      if (out[i] != 0) result |= std::uint32_t{1} << i;
    }
    return result;
  }

  void apply(int y, std::uint32_t words) {
    for (std::uint32_t left = words; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      mask_.row(y)[i] &= ~deletions_[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(i)];
    }
  }

  BitView mask_;
  int words_;
  std::uint32_t all_words_;
  std::span<std::uint32_t> changed_;         // in the last pass
  std::span<std::uint32_t> changed_before_;  // in the pass before
  std::array<std::array<BitWord, max_words>, 2> deletions_;
};

}  // namespace

ThinningResult thin(BitView mask, std::span<ThinningScratch> scratch) {
  ThinningResult result;
  if (mask.width <= 0 || mask.height <= 0) return result;
  assert(mask.width <= max_thinning_width);
  assert(scratch.size() >= static_cast<std::size_t>(thinning_scratch_size(mask.height)));
  Pass pass(mask, scratch);
  const int bound = max_thinning_iterations(mask.width, mask.height);
  for (bool changed = true; changed;) {
    if (result.iterations == bound) {
      result.finished = false;
      return result;
    }
    ++result.iterations;
    const bool first = pass.run(false);
    const bool second = pass.run(true);
    changed = first || second;
  }
  return result;
}

}  // namespace touchline
