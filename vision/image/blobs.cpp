// SPDX-License-Identifier: Apache-2.0
// Blobs by runs. Only the runs of two rows and the blobs that reach the current row are kept; a blob that does not go
// on is handed out.
#include "vision/image/blobs.h"

#include <algorithm>
#include <bit>

#include "vision/image/bit_ops.h"
#include "vision/image/grow.h"

namespace touchline {
namespace {

bool before(GridPoint a, GridPoint b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

/// Runs of set pixels of one row, from the left.
int find_runs(const BitWord* row, int width, std::span<BlobRun> runs) {
  const int words = words_for(width);
  int count = 0;
  bool open = false;
  for (int i = 0; i < words; ++i) {
    // A set bit where a pixel differs from its left neighbour: starts and ends in turn.
    BitWord changes = row[i] ^ ((row[i] << 1) | (open ? 1U : 0U));
    for (; changes != 0; changes &= changes - 1) {
      const int x = i * bits_per_word + std::countr_zero(changes);
      if (open) {
        runs[static_cast<std::size_t>(count++)].last = static_cast<std::int16_t>(x - 1);
      } else {
        runs[static_cast<std::size_t>(count)].first = static_cast<std::int16_t>(x);
      }
      open = !open;
    }
  }
  if (open) runs[static_cast<std::size_t>(count++)].last = static_cast<std::int16_t>(width - 1);
  return count;
}

void merge(Blob& into, const Blob& other) {
  if (before(other.first, into.first)) into.first = other.first;
  into.left = std::min(into.left, other.left);
  into.right = std::max(into.right, other.right);
  into.bottom = std::max(into.bottom, other.bottom);
}

/// The result list: when full, the smallest gives way to a larger one.
class Results {
 public:
  explicit Results(std::span<Blob> blobs) : blobs_(blobs) {}
  void add(const Blob& blob) {
    if (static_cast<std::size_t>(count_.found) < blobs_.size()) {
      blobs_[static_cast<std::size_t>(count_.found++)] = blob;
      if (static_cast<std::size_t>(count_.found) == blobs_.size()) find_smallest();
      return;
    }
    ++count_.dropped;
    if (blobs_.empty() || blob.area <= blobs_[smallest_].area) return;
    blobs_[smallest_] = blob;
    find_smallest();
  }
  [[nodiscard]] BlobCount count() const { return count_; }

 private:
  void find_smallest() {
    const auto least =
        std::min_element(blobs_.begin(), blobs_.end(), [](const Blob& a, const Blob& b) { return a.area < b.area; });
    smallest_ = static_cast<std::size_t>(least - blobs_.begin());
  }
  std::span<Blob> blobs_;
  std::size_t smallest_ = 0;
  BlobCount count_;
};

/// Joins runs of this row with the runs above that they touch, corners included.
void join_rows(std::span<const BlobRun> above, std::span<const BlobRun> here, DisjointSet& sets) {
  std::size_t i = 0;
  for (const BlobRun& run : here) {
    while (i < above.size() && above[i].last < run.first - 1) ++i;
    for (std::size_t j = i; j < above.size() && above[j].first <= run.last + 1; ++j) {
      sets.unite(above[j].label, run.label);
    }
  }
}

/// The blobs that reach the current row.
class Labelling {
 public:
  Labelling(const BlobMemory& memory, Results& results)
      : memory_(memory), results_(results), sets_(memory.parents, memory.areas) {}

  /// Gives the runs of row y, and with them the blobs that go on, their labels: 0, 1, ... Blobs that end are handed
  /// out.
  void add_row(std::span<const BlobRun> above, std::span<BlobRun> here, int y) {
    if (go_on(above, here)) {
      for (std::size_t i = 0; i < here.size(); ++i) add_run(here[i], above[i].label, y);
      return;
    }
    // Elements of the sets: the open blobs, then the runs of this row.
    sets_.clear();
    for (std::size_t i = 0; i < open_count_; ++i) sets_.add(memory_.open[i].area);
    const auto row = static_cast<std::int16_t>(y);
    for (BlobRun& run : here) {
      run.label = sets_.add(run.last - run.first + 1);
      memory_.open[run.label] = {{run.first, row}, run.first, run.last, row, 0};
    }
    join_rows(above, here, sets_);
    renumber(here);
  }

  void finish() {
    for (std::size_t i = 0; i < open_count_; ++i) results_.add(memory_.open[i]);
  }

 private:
  /// The usual row: each run touches one of the row above, and no two the same one.
  static bool go_on(std::span<const BlobRun> above, std::span<const BlobRun> here) {
    if (above.size() != here.size()) return false;
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (above[i].last < here[i].first - 1 || above[i].first > here[i].last + 1) return false;
      if (i > 0 && (above[i - 1].last >= here[i].first - 1 || above[i].first <= here[i - 1].last + 1)) return false;
    }
    return true;
  }
  void add_run(BlobRun& run, SetId label, int y) {
    run.label = label;
    Blob& blob = memory_.open[label];
    blob.left = std::min(blob.left, run.first);
    blob.right = std::max(blob.right, run.last);
    blob.bottom = static_cast<std::int16_t>(y);
    blob.area += run.last - run.first + 1;
  }

  void renumber(std::span<BlobRun> here) {
    constexpr SetId ended = 0;
    constexpr SetId goes_on = 1;
    const std::size_t elements = sets_.size();
    for (std::size_t i = 0; i < elements; ++i) {
      const SetId root = sets_.find(static_cast<SetId>(i));
      if (root != i) merge(memory_.open[root], memory_.open[i]);
      memory_.labels[i] = ended;
    }
    for (const BlobRun& run : here) memory_.labels[sets_.find(run.label)] = goes_on;
    std::size_t kept = 0;  // never overtakes i, so blobs move to their new place without a second buffer
    for (std::size_t i = 0; i < elements; ++i) {
      if (!sets_.is_root(static_cast<SetId>(i))) continue;
      Blob blob = memory_.open[i];
      blob.area = sets_.weight(static_cast<SetId>(i));
      if (memory_.labels[i] == ended) {
        results_.add(blob);
        continue;
      }
      memory_.labels[i] = static_cast<SetId>(kept);
      memory_.open[kept++] = blob;
    }
    for (BlobRun& run : here) run.label = memory_.labels[sets_.find(run.label)];
    open_count_ = kept;
  }

  BlobMemory memory_;
  Results& results_;
  DisjointSet sets_;
  std::size_t open_count_ = 0;
};

int rows_of(const Blob& blob) { return blob.bottom - blob.first.y + 1; }

/// The rows of a mask that a blob lies in.
template <typename Word>
BasicBitView<Word> rows_under(const BasicBitView<Word>& mask, const Blob& blob) {
  return {mask.row(blob.first.y), mask.width, rows_of(blob), mask.stride};
}

}  // namespace

BlobCount find_blobs(ConstBitView mask, BlobMemory memory, std::span<Blob> blobs) {
  const auto half = static_cast<std::size_t>(max_runs(mask.width));
  assert(memory.runs.size() >= 2 * half && memory.open.size() >= 2 * half && memory.labels.size() >= 2 * half);
  Results results(blobs);
  Labelling labelling(memory, results);
  std::span<BlobRun> above = memory.runs.first(half);
  std::span<BlobRun> here = memory.runs.subspan(half);
  std::size_t above_count = 0;
  for (int y = 0; y < mask.height; ++y) {
    const auto here_count = static_cast<std::size_t>(find_runs(mask.row(y), mask.width, here));
    labelling.add_row(above.first(above_count), here.first(here_count), y);
    std::swap(above, here);
    above_count = here_count;
  }
  labelling.finish();
  return results.count();
}

void cut_out(ConstBitView mask, std::span<const Blob> blobs, std::size_t kept, bool all, BitView field,
             BitView scratch) {
  int rows_of_others = 0;
  for (std::size_t i = 0; i < blobs.size(); ++i) rows_of_others += i == kept ? 0 : rows_of(blobs[i]);
  const int rows_to_grow = 2 * mask.height;  // down and up, at the least
  if (!all || rows_of_others > rows_to_grow) {
    clear(field);
    field.set(blobs[kept].first.x, blobs[kept].first.y, true);
    grow_inside(field, mask);
    return;
  }
  copy(mask, field);
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (i == kept) continue;
    const Blob& other = blobs[i];
    const BitView seeds = rows_under(scratch, other);
    seeds.set(other.first.x, 0, true);
    grow_inside(seeds, rows_under(mask, other));
    and_not_with(rows_under(field, other), seeds);
    clear(seeds);
  }
}

int largest_blob(std::span<const Blob> blobs) {
  int best = -1;
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (best >= 0) {
      const Blob& leader = blobs[static_cast<std::size_t>(best)];
      if (blobs[i].area < leader.area) continue;
      if (blobs[i].area == leader.area && !before(blobs[i].first, leader.first)) continue;
    }
    best = static_cast<int>(i);
  }
  return best;
}

}  // namespace touchline
