// SPDX-License-Identifier: Apache-2.0
// A row of blocks at a time, by a loop that vectorises (image/block_widths_loops.h).
#include "vision/line_width_table.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "vision/image/block_widths_loops.h"

namespace touchline {
namespace {

constexpr std::size_t max_blocks = RayRow::capacity - 1;
static_assert(ray_cell_px == 8, "the loop's factors");

}  // namespace

void make_line_width_table(const RayGridView& grid, const CameraPose& pose, float line_width_m,
                           ImageView<LineWidth> table, const Kernels& kernels) {
  assert(table.width + 1 == grid.columns && table.height + 1 == grid.rows);
  const auto measure = kernels.block_widths != nullptr ? kernels.block_widths : block_widths::measure;
  const Mat3 rotation = robot_from_camera(pose);
  std::array<RayRow, 2> rows;
  std::array<std::int32_t, max_blocks> ground{}, across_row{}, across_column{}, slanted{};
  BlockRow row{.blocks = table.width,
               .height = pose.height,
               .line_width_m = line_width_m,
               .ground = ground.data(),
               .across_row = across_row.data(),
               .across_column = across_column.data(),
               .slanted = slanted.data()};
  std::copy_n(&rotation.m[0][0], 9, &row.robot_from_camera[0][0]);
  read_row(grid, 0, rows[0]);
  for (int y = 0; y < table.height; ++y) {
    const RayRow& above = rows[static_cast<std::size_t>(y % 2)];
    RayRow& below = rows[static_cast<std::size_t>((y + 1) % 2)];
    read_row(grid, y + 1, below);
    const auto set = [](const RayRow& rays, const float*(&to)[3]) {
      to[0] = rays.x.data();
      to[1] = rays.y.data();
      to[2] = rays.z.data();
    };
    set(above, row.above);
    set(below, row.below);
    measure(row);
    LineWidth* out = table.row(y);
    for (std::size_t i = 0; i < static_cast<std::size_t>(table.width); ++i) {
      const LineWidth width{static_cast<std::uint16_t>(across_row[i]), static_cast<std::uint16_t>(across_column[i]),
                            static_cast<std::uint16_t>(slanted[i])};
      out[i] = ground[i] == 0 ? LineWidth{} : width;
    }
  }
}

}  // namespace touchline
