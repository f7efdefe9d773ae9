// SPDX-License-Identifier: Apache-2.0
// The table against lines that are projected into the image one by one.
#include "vision/line_width_table.h"
#include "tests/support/kernel_tables.h"
#include "tests/support/paper_lens.h"

#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <memory>

using namespace touchline;

namespace {

constexpr int frame_width = 752, frame_height = 480, work_width = 320, work_height = 240;
using Table = Image<LineWidth, work_width / width_block_px, work_height / width_block_px>;

template <int W, int H>
void fill_table(const GroundProjection& projection, float line_width_m, ImageView<LineWidth> table,
                const Kernels& kernels = portable_kernels()) {
  std::array<Vec3, static_cast<std::size_t>(ray_columns(W) * ray_rows(H))> rays{};
  const RayGridView grid{rays, ray_columns(W), ray_rows(H)};
  make_ray_grid(projection.lens(), frame_width, frame_height, W, H, grid);
  make_line_width_table(grid, projection.pose(), line_width_m, table, kernels);
}
std::unique_ptr<Table> make_table(const GroundProjection& projection, float line_width_m) {
  auto table = std::make_unique<Table>();
  fill_table<work_width, work_height>(projection, line_width_m, table->view());
  return table;
}

PixelPoint camera_pixel(float u, float v) { return {u * 2.35F, v * 2.0F}; }

/// Extent along (du, dv), in working pixels, of a line that runs along (eu, ev) in the picture: by halving the stretch
/// until its ends are the line's width apart, measured across the line on the ground.
float measured_extent(const GroundProjection& projection, float u, float v, float du, float dv, float eu, float ev,
                      float width) {
  GroundPoint from, to;
  if (!projection.ground(camera_pixel(u - eu * 0.1F, v - ev * 0.1F), from)) return 0.0F;
  if (!projection.ground(camera_pixel(u + eu * 0.1F, v + ev * 0.1F), to)) return 0.0F;
  const float length = math::hypot(to.x - from.x, to.y - from.y);
  const float tx = (to.x - from.x) / length, ty = (to.y - from.y) / length;
  float low = 0.0F, high = 60.0F;
  for (int i = 0; i < 40; ++i) {
    const float half = 0.25F * (low + high);
    GroundPoint a, b;
    const bool seen = projection.ground(camera_pixel(u - du * half, v - dv * half), a) &&
                      projection.ground(camera_pixel(u + du * half, v + dv * half), b);
    (!seen || math::abs((b.x - a.x) * ty - (b.y - a.y) * tx) > width ? high : low) = 2.0F * half;
  }
  return low;
}

}  // namespace

TEST_CASE("widths agree with projected lines wherever a line is a pixel wide and the picture does not end") {
  for (const float roll : {0.0F, 0.3F}) {
    const GroundProjection projection(test::paper_lens(), {0.0F, 0.0F, 0.58F, 0.1F, radians(30.0F), roll});
    const auto table = make_table(projection, 0.05F);
    int compared = 0;
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) {
        const float u = static_cast<float>(x * 8 + 4);
        const float v = static_cast<float>(y * 8 + 4);
        const PixelPoint centre = camera_pixel(u, v);
        GroundPoint g;
        // A line that the image circle cuts has no width to measure.
        if (math::hypot(centre.u - 376.0F, centre.v - 240.0F) > 340.0F) continue;
        if (!projection.ground(centre, g) || math::hypot(g.x, g.y) > 4.0F) continue;
        const LineWidth width = table->view().at(x, y);
        const float row = measured_extent(projection, u, v, 1.0F, 0.0F, 0.0F, 1.0F, 0.05F);
        const float column = measured_extent(projection, u, v, 0.0F, 1.0F, 1.0F, 0.0F, 0.05F);
        const float slanted = math::max(measured_extent(projection, u, v, 1.0F, 0.0F, 1.0F, 1.0F, 0.05F),
                                        measured_extent(projection, u, v, 1.0F, 0.0F, 1.0F, -1.0F, 0.05F));
        if (row < 1.0F || row > 40.0F || column < 1.0F || column > 40.0F || slanted > 40.0F) continue;
        CAPTURE(x);
        CAPTURE(y);
        CHECK(math::abs(static_cast<float>(width.across_row) / 16.0F - row) < 0.05F * row + 0.1F);
        CHECK(math::abs(static_cast<float>(width.across_column) / 16.0F - column) < 0.05F * column + 0.1F);
        CHECK(math::abs(static_cast<float>(width.slanted) / 16.0F - slanted) < 0.05F * slanted + 0.1F);
        ++compared;
      }
    }
    CHECK(compared > 300);
  }
}

TEST_CASE("no ground, no width: above the horizon and outside the lens") {
  LensParameters p = test::paper_lens().parameters();
  p.max_theta = radians(40.0F);  // image circle of 163 camera pixels
  Lens narrow;
  REQUIRE(Lens::create(p, narrow) == Status::ok);
  const GroundProjection projection(narrow, {0.0F, 0.0F, 0.58F, 0.0F, radians(20.0F), 0.0F});
  const auto table = make_table(projection, 0.05F);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      const PixelPoint centre = camera_pixel(static_cast<float>(x * 8 + 4), static_cast<float>(y * 8 + 4));
      GroundPoint g;
      const bool sees_ground = projection.ground(centre, g);
      const LineWidth width = table->view().at(x, y);
      if (!sees_ground && math::hypot(centre.u - 376.0F, centre.v - 240.0F) > 250.0F) {
        CHECK(width.across_row == 0);
        CHECK(width.across_column == 0);
      } else if (sees_ground && math::hypot(g.x, g.y) < 3.0F &&
                 math::hypot(centre.u - 376.0F, centre.v - 240.0F) < 155.0F) {
        CHECK(width.across_row > 0);
        CHECK(width.across_column > 0);
      }
    }
  }
}

TEST_CASE("twice the line, twice the width") {
  const GroundProjection projection(test::paper_lens(), {0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F});
  const auto thin = make_table(projection, 0.05F);
  const auto wide = make_table(projection, 0.10F);
  for (std::size_t i = 0; i < thin->samples.size(); ++i) {
    if (thin->samples[i].across_row == 0) continue;
    CHECK(std::abs(wide->samples[i].across_row - 2 * thin->samples[i].across_row) <= 1);
  }
}

TEST_CASE("a table whose size is no multiple of the block still covers the picture") {
  const GroundProjection projection(test::paper_lens(), {0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F});
  Image<LineWidth, 13, 8> table;
  fill_table<100, 60>(projection, 0.05F, table.view());
  CHECK(table.view().at(6, 7).across_row > 0);
  CHECK(table.view().at(11, 4).across_column > 0);
}

TEST_CASE("the table is the same with every table of kernels") {
  for (const float pitch : {-20.0F, 3.0F, 30.0F, 80.0F}) {
    for (const float roll : {0.0F, 0.4F, 3.0F}) {
      const GroundProjection projection(test::paper_lens(), {0.0F, 0.0F, 0.58F, 0.1F, radians(pitch), roll});
      const auto expected = make_table(projection, 0.05F);
      for (const Kernels& kernels : test::all_tables()) {
        CAPTURE(kernels.name);
        CAPTURE(pitch);
        auto table = std::make_unique<Table>();
        fill_table<work_width, work_height>(projection, 0.05F, table->view(), kernels);
        CHECK(std::memcmp(table->samples.data(), expected->samples.data(), sizeof(LineWidth) * table->samples.size()) ==
              0);
      }
    }
  }
}
