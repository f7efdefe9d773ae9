// SPDX-License-Identifier: Apache-2.0
// Zhang-Suen thinning: which blocks each pass looks at. The rule is in thinning_loops.h.
#include "vision/image/thinning.h"

#include <cassert>

#include "vision/image/thinning_loops.h"

namespace touchline {
namespace {

/// The mask column by column, and a mark for every block of it.
class Thinning {
 public:
  Thinning(BitView mask, const ThinningMemory& memory, ThinningKernel kernel)
      : mask_(mask),
        columns_(memory.columns.data()),
        words_(words_for(mask.width)),
        height_(thinning_height(mask.height)),
        marks_(thinning_marks(mask.height)),
        size_(static_cast<std::size_t>(words_ * marks_)),
        kernel_(kernel),
        deleted_(memory.deleted.data()),
        filled_(memory.marks.subspan(0, size_)),
        active_(memory.marks.subspan(size_, size_)),
        changed_(memory.marks.subspan(2 * size_, size_)),
        changed_before_(memory.marks.subspan(3 * size_, size_)) {
    for (BitWord& word : memory.columns.first(thinning_columns_size(mask.width, mask.height))) word = 0;
    for (BitWord& word : memory.marks.first(4 * size_)) word = 0;
    for (int y = 0; y < mask.height; ++y) {
      const BitWord* row = mask.row(y);
      const int block = y / thinning_block_rows;
      for (int i = 0; i < words_; ++i) {
        *at(i, y) = row[i];
        filled_[mark(i, block / bits_per_word)] |= BitWord{row[i] != 0} << (block % bits_per_word);
      }
    }
    for (std::size_t i = 0; i < size_; ++i) changed_[i] = filled_[i];  // everything is new
  }

  /// True when a pixel was deleted.
  bool run(bool second) {
    for (int i = 0; i < words_; ++i) choose_active(i);
    std::swap(changed_, changed_before_);
    for (BitWord& word : changed_) word = 0;
    return kernel_({columns_, deleted_, active_.data(), changed_.data(), words_, height_, marks_, second});
  }

  void write_back() const {
    for (int y = 0; y < mask_.height; ++y) {
      BitWord* row = mask_.row(y);
      for (int i = 0; i < words_; ++i) row[i] = *at(i, y);
    }
  }

 private:
  [[nodiscard]] BitWord* at(int i, int y) const { return columns_ + (i + 1) * thinning_stride(height_) + 1 + y; }
  [[nodiscard]] std::size_t mark(int i, int word) const { return static_cast<std::size_t>(i * marks_ + word); }
  [[nodiscard]] BitWord recently_changed(int i, int word) const {
    if (i < 0 || i >= words_ || word < 0 || word >= marks_) return 0;
    return changed_[mark(i, word)] | changed_before_[mark(i, word)];
  }
  /// Of column i, the blocks near a change of the last two passes.
  void choose_active(int i) {
    const auto near = [&](int word) {
      return recently_changed(i - 1, word) | recently_changed(i, word) | recently_changed(i + 1, word);
    };
    BitWord before = 0;
    BitWord here = near(0);
    for (int word = 0; word < marks_; ++word) {
      const BitWord after = near(word + 1);
      const BitWord spread =
          here | here << 1 | here >> 1 | before >> (bits_per_word - 1) | after << (bits_per_word - 1);
      active_[mark(i, word)] = spread & filled_[mark(i, word)];
      before = here;
      here = after;
    }
  }

  BitView mask_;
  BitWord* columns_;
  int words_;
  int height_;
  int marks_;  // words of marks a column
  std::size_t size_;
  ThinningKernel kernel_;
  BitWord* deleted_;
  std::span<BitWord> filled_;  // blocks that are not empty at first
  std::span<BitWord> active_;
  std::span<BitWord> changed_;         // in the last pass
  std::span<BitWord> changed_before_;  // in the pass before
};

}  // namespace

ThinningKernel portable_thinning() { return thinning::run; }

ThinningResult thin(BitView mask, const ThinningMemory& memory, ThinningKernel kernel) {
  ThinningResult result;
  if (mask.width <= 0 || mask.height <= 0) return result;
  assert(memory.columns.size() >= thinning_columns_size(mask.width, mask.height));
  assert(memory.deleted.size() >= thinning_deleted_size(mask.width, mask.height));
  assert(memory.marks.size() >= thinning_marks_size(mask.width, mask.height));
  Thinning thinning(mask, memory, kernel != nullptr ? kernel : portable_thinning());
  const int bound = max_thinning_iterations(mask.width, mask.height);
  for (bool changed = true; changed;) {
    if (result.iterations == bound) {
      result.finished = false;
      break;
    }
    ++result.iterations;
    const bool first = thinning.run(false);
    const bool second = thinning.run(true);
    changed = first || second;
  }
  thinning.write_back();
  return result;
}

}  // namespace touchline
