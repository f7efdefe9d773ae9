// SPDX-License-Identifier: Apache-2.0
// The 8-connected blobs of a mask: area, extent and first pixel of each (paper section IV-B), in one pass over the
// rows' runs (the classic two-row labelling of Rosenfeld and Pfaltz 1966, with a disjoint set). Memory follows the
// width, not the area.
#pragma once

#include <array>
#include <span>

#include "vision/image/bit_image.h"
#include "vision/image/disjoint_set.h"
#include "vision/image/grid_point.h"

namespace touchline {

struct Blob {
  GridPoint first;        // its first pixel in raster order: a contour starts there
  std::int16_t left = 0;  // extent, both ends included; the top is first.y
  std::int16_t right = 0;
  std::int16_t bottom = 0;
  std::int32_t area = 0;  // pixels
};

struct BlobRun {
  std::int16_t first = 0;
  std::int16_t last = 0;
  SetId label = 0;
};

/// Runs of a row: at most every other pixel starts one.
constexpr int max_runs(int width) { return (width + 1) / 2; }

/// What find_blobs() works in; each span has two entries for each run that a row may have. Nothing has to stay.
struct BlobMemory {
  std::span<BlobRun> runs;
  std::span<Blob> open;
  std::span<SetId> parents;
  std::span<std::int32_t> areas;
  std::span<SetId> labels;
};
template <int W>
struct BlobStorage {
  static constexpr std::size_t size = 2 * static_cast<std::size_t>(max_runs(W));
  std::array<BlobRun, size> runs{};
  std::array<Blob, size> open{};
  std::array<SetId, size> parents{};
  std::array<std::int32_t, size> areas{};
  std::array<SetId, size> labels{};
  [[nodiscard]] BlobMemory memory() { return {runs, open, parents, areas, labels}; }
};

struct BlobCount {
  int found = 0;    // entries of `blobs` that are valid
  int dropped = 0;  // smaller ones that found no room: when full, the smallest gives way
};

/// Finds all blobs, in the order in which they end; the largest ones when there are more than `blobs` holds, so noise
/// never costs the large blob its place. blobs.size() >= 1.
BlobCount find_blobs(ConstBitView mask, BlobMemory memory, std::span<Blob> blobs);

/// field = the pixels of blobs[kept] alone. `all`: no other blob of the mask is missing in `blobs`; then the others,
/// which are few and small, are taken off; without, the blob is grown from its first pixel. `scratch` is clear, and is
/// again afterwards.
void cut_out(ConstBitView mask, std::span<const Blob> blobs, std::size_t kept, bool all, BitView field,
             BitView scratch);

/// Index of the largest blob, of equals the one that comes first in raster order; -1 when there is none.
[[nodiscard]] int largest_blob(std::span<const Blob> blobs);

}  // namespace touchline
