// SPDX-License-Identifier: Apache-2.0
#include "vision/ground_mask.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "platform/core/elementary.h"
#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"

namespace touchline {
namespace {

constexpr float steepness_scale = 16384.0F;  // 2^14: a sine fits int16 with room
constexpr std::int16_t no_ray = -32768;

using CornerRow = std::array<std::int16_t, RayRow::capacity>;

/// How steeply the rays of one grid row look down: minus the sine of their elevation, in 2^-14.
void steepness_of_row(const RayGridView& grid, int row, const Vec3& up, CornerRow& out) {
  RayRow rays;
  read_row(grid, row, rays);
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (std::size_t i = 0; i < columns; ++i) {
    const float x = rays.x[i];
    const float y = rays.y[i];
    const float z = rays.z[i];
    const std::int32_t any = x * x + y * y + z * z > 0.0F ? -1 : 0;
    const auto steepness = static_cast<std::int32_t>(-(x * up.x + y * up.y + z * up.z) * steepness_scale);
    out[i] = static_cast<std::int16_t>((steepness & any) | (no_ray & ~any));
  }
}

/// A row of cells.
struct Cells {
  static constexpr std::size_t capacity = static_cast<std::size_t>(words_for(max_mask_width)) * sizeof(BitWord);
  std::array<std::uint8_t, capacity> whole;     // 255: steep at all corners; as a row of the mask, too
  std::array<std::uint8_t, capacity> border{};  // 255: steep at some, and a ray at each
};

// By value: of references the compiler makes no vectors.
std::int16_t least(std::int16_t a, std::int16_t b) { return a < b ? a : b; }
std::int16_t most(std::int16_t a, std::int16_t b) { return a > b ? a : b; }

void classify(const CornerRow& above, const CornerRow& below, std::size_t cells, std::int16_t limit, Cells& out) {
  for (std::size_t i = 0; i < cells; ++i) {
    const std::int16_t lower_end = least(least(above[i], above[i + 1]), least(below[i], below[i + 1]));
    const std::int16_t upper_end = most(most(above[i], above[i + 1]), most(below[i], below[i + 1]));
    const std::int16_t whole = lower_end > limit ? 255 : 0;
    const std::int16_t some = upper_end > limit ? 255 : 0;
    const std::int16_t rays = lower_end > no_ray ? 255 : 0;
    out.whole[i] = static_cast<std::uint8_t>(whole);
    out.border[i] = static_cast<std::uint8_t>(some & rays & ~whole);
  }
}

/// The cell right of corner `i`, a byte for each of its rows: by how much its pixels are steeper than the limit changes
/// by the same amount from row to row.
void draw_border(const CornerRow& above, const CornerRow& below, std::size_t i, std::int32_t limit,
                 std::array<std::uint8_t, ray_cell_px>& bytes) {
  constexpr int half_px = 2 * ray_cell_px;  // a cell has 16 half pixels; the first centre is at the first
  const std::int32_t left = above[i] * (half_px - 1) + below[i];
  const std::int32_t right = above[i + 1] * (half_px - 1) + below[i + 1];
  std::int32_t excess[ray_cell_px];
  std::int32_t step[ray_cell_px];
  for (int k = 0; k < ray_cell_px; ++k) {
    const std::int32_t across = 2 * k + 1;
    excess[k] = left * (half_px - across) + right * across - limit * (half_px * half_px);
    step[k] = 2 * ((below[i] - above[i]) * (half_px - across) + (below[i + 1] - above[i + 1]) * across);
  }
  for (std::uint8_t& byte : bytes) {
    std::int32_t bits = 0;
    for (int k = 0; k < ray_cell_px; ++k) bits += excess[k] > 0 ? 1 << k : 0;
    for (int k = 0; k < ray_cell_px; ++k) excess[k] += step[k];
    byte = static_cast<std::uint8_t>(bits);
  }
}

/// Calls visit(cell), eight cells at a time, of which most are none.
template <typename Visit>
void for_each_border(const Cells& row, std::size_t words, Visit visit) {
  constexpr BitWord tops = 0x8080808080808080U;
  for (std::size_t i = 0; i < words; ++i) {
    BitWord eight = 0;
    std::memcpy(&eight, row.border.data() + i * sizeof eight, sizeof eight);
    for_each_bit(eight & tops, [&](int bit) { visit(i * sizeof eight + static_cast<std::size_t>(bit) / 8); });
  }
}

}  // namespace

/// Not inlined: its memory is not to lie below that of the steps that follow.
[[gnu::noinline]] void make_ground_mask(const RayGridView& grid, const CameraPose& pose, float max_range_m,
                                        ConstBitView seen, BitView ground) {
  const Mat3 rotation = robot_from_camera(pose);
  const Vec3 up{rotation.m[2][0], rotation.m[2][1], rotation.m[2][2]};
  const auto limit = static_cast<std::int16_t>(pose.height / math::hypot(pose.height, max_range_m) * steepness_scale);
  const auto cells = static_cast<std::size_t>(grid.columns - 1);
  const auto words = static_cast<std::size_t>(words_for(ground.width));
  std::array<CornerRow, 2> corners;
  Cells row;
  row.whole.fill(0);
  steepness_of_row(grid, 0, up, corners[0]);
  for (int y0 = 0; y0 < ground.height; y0 += ray_cell_px) {
    const int j = y0 / ray_cell_px;
    const CornerRow& above = corners[static_cast<std::size_t>(j % 2)];
    CornerRow& below = corners[static_cast<std::size_t>((j + 1) % 2)];
    steepness_of_row(grid, j + 1, up, below);
    classify(above, below, cells, limit, row);
    const int end = std::min(y0 + ray_cell_px, ground.height);
    std::array<BitWord, words_for(max_mask_width)> whole;
    std::memcpy(whole.data(), row.whole.data(), words * sizeof(BitWord));
    for (int y = y0; y < end; ++y) {
      for (std::size_t i = 0; i < words; ++i) ground.row(y)[i] = whole[i] & seen.row(y)[i];
    }
    for_each_border(row, words, [&](std::size_t i) {
      std::array<std::uint8_t, ray_cell_px> bytes;
      draw_border(above, below, i, limit, bytes);
      for (int y = y0; y < end; ++y) {
        const auto inside = reinterpret_cast<const std::uint8_t*>(seen.row(y))[i];
        const auto byte = bytes[static_cast<std::size_t>(y - y0)];
        reinterpret_cast<std::uint8_t*>(ground.row(y))[i] = byte & inside;
      }
    });
  }
}

}  // namespace touchline
