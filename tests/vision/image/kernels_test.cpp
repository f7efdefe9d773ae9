// SPDX-License-Identifier: Apache-2.0
// Every table of kernels that this processor runs gives what the portable code gives, byte for byte.
#include "vision/image/kernels.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <vector>

#include "platform/core/rng.h"
#include "tests/support/ascii_image.h"
#include "tests/support/kernel_tables.h"
#include "vision/image/bit_ops.h"
#include "vision/image/frame_fifo.h"
#include "vision/image/hsv.h"
#include "vision/image/subsample.h"

namespace touchline {
namespace {

std::vector<std::uint8_t> noise(std::size_t bytes, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<std::uint8_t> out(bytes);
  for (std::uint8_t& byte : out) {
    const std::uint32_t bits = rng.next_u32();
    byte = (bits & 0x300U) == 0 ? 255 : (bits & 0x300U) == 0x100U ? 0 : static_cast<std::uint8_t>(bits);
  }
  return out;
}

struct Result {
  std::vector<std::uint8_t> y, cb, cr;
  bool operator==(const Result&) const = default;
};

Result subsampled(const FrameView& frame, int width, int height, const Kernels& kernels) {
  auto storage = std::make_unique<SubsampleStorage<1280, 640>>();
  Subsampler subsampler(storage->memory());
  REQUIRE(subsampler.configure(frame.width, frame.height, width, height, kernels) == Status::ok);
  const auto luma = static_cast<std::size_t>(width * height);
  Result r{std::vector<std::uint8_t>(luma), std::vector<std::uint8_t>(luma / 4), std::vector<std::uint8_t>(luma / 4)};
  const Yuv420View view{{r.y.data(), width, height, width},
                        {r.cb.data(), width / 2, height / 2, width / 2},
                        {r.cr.data(), width / 2, height / 2, width / 2}};
  REQUIRE(subsampler.run(frame, view) == Status::ok);
  return r;
}

TEST_CASE("kernels subsample as the portable code does") {
  if (test::runnable_tables().size() == 1) {
    MESSAGE("skipped: this processor runs the portable code alone");
    return;
  }
  struct Size {
    int width, height, work_width, work_height;
  };
  for (const Size& s : {Size{752, 480, 320, 240},
                        {640, 480, 320, 240},
                        {320, 480, 320, 240},
                        {376, 480, 160, 240},
                        {1280, 480, 320, 240},
                        {1128, 960, 480, 480},
                        {640, 480, 200, 240},
                        {1280, 960, 640, 480},
                        {320, 240, 320, 240},
                        {86, 16, 86, 16},
                        {94, 60, 46, 30},  // no pairs of columns: too many taps, no small fraction, too few columns
                        {900, 60, 100, 30},
                        {752, 480, 452, 340},
                        {13, 8, 6, 4},
                        {1280, 720, 226, 170},
                        {1280, 960, 86, 64}}) {
    for (const PixelFormat format : {PixelFormat::rgb24, PixelFormat::bgr24, PixelFormat::yuyv, PixelFormat::rgb565}) {
      if (format == PixelFormat::yuyv && s.width % 2 != 0) continue;
      const auto pixels = noise(static_cast<std::size_t>(s.width * s.height * 3), 4);
      const FrameView frame{format, pixels.data(), s.width, s.height, s.width * 3};
      CAPTURE(s.width);
      CAPTURE(s.work_width);
      const Result portable = subsampled(frame, s.work_width, s.work_height, portable_kernels());
      for (const Kernels& kernels : test::runnable_tables()) {
        CAPTURE(kernels.name);
        CHECK(subsampled(frame, s.work_width, s.work_height, kernels) == portable);
      }
    }
  }
}

/// About the columns' middle.
Moments moments_one_by_one(ConstBitView mask, GridPoint at, WindowColumns columns, int radius) {
  Moments m;
  const int middle = at.x + columns.middle();
  for (int y = at.y - radius; y <= at.y + radius; ++y) {
    for (int x = at.x + columns.first; x < at.x + columns.first + columns.count; ++x) {
      if (!mask.get(x, y)) continue;
      const int dx = x - middle, dy = y - at.y;
      m = {m.n + 1, m.x + dx, m.y + dy, m.xx + dx * dx, m.xy + dx * dy, m.yy + dy * dy};
    }
  }
  return m;
}

TEST_CASE("moments of a window are those of its pixels, one by one") {
  constexpr int width = 130, height = 40;
  for (const Kernels& kernels : test::runnable_tables()) {
    for (const int radius : {3, 5, 7, 10, 11, 14, 15}) {
      Rng rng(7);
      test::Bits mask(width, height);
      for (int i = 0; i < width * height / 4; ++i) {
        mask.view().set(static_cast<int>(rng.below(width)), static_cast<int>(rng.below(height)), true);
      }
      for (int i = 0; i < 300; ++i) {
        const int cx = static_cast<int>(rng.below(width));
        const int cy = static_cast<int>(rng.below(height));
        const GridPoint at{static_cast<std::int16_t>(cx), static_cast<std::int16_t>(cy)};
        const Moments want = moments_one_by_one(mask.view(), at, {-radius, 2 * radius + 1}, radius);
        CAPTURE(kernels.name);
        CAPTURE(radius);
        CAPTURE(cx);
        CAPTURE(cy);
        REQUIRE(moments_around(mask.view(), at, radius, kernels) == want);
      }
    }
  }
}

TEST_CASE("moments of sixteen windows are those of each, and of those that are not asked nothing is changed") {
  Rng rng(9);
  for (int turn = 0; turn < 40; ++turn) {
    const int width = 40 + static_cast<int>(rng.below(100));
    const auto density = static_cast<std::uint32_t>(turn % 4);  // of pixels that are left out
    test::Bits mask(width, 50);
    for (int y = 0; y < mask.height; ++y) {
      for (int x = 0; x < width; ++x) mask.view().set(x, y, rng.below(4) >= density);
    }
    const int radius = 1 + static_cast<int>(rng.below(max_moments_radius));
    const WindowParts parts = parts_of(radius);
    const WindowColumns& columns = parts.part[rng.below(static_cast<std::uint32_t>(parts.count))];
    ProbeWindows windows{reinterpret_cast<const std::uint8_t*>(mask.words.data()), words_for(width) * 8, columns.count,
                         radius};
    Moments want[probe_lanes];
    for (int i = 0; i < probe_lanes; ++i) {
      const GridPoint at{static_cast<std::int16_t>(rng.below(static_cast<std::uint32_t>(width))),
                         static_cast<std::int16_t>(rng.below(50))};
      MomentWindow window;
      if (!make_window(mask.view(), at, columns, radius, window)) continue;
      windows.asked |= 1U << i;
      windows.offset[i] = static_cast<std::int32_t>(window.bytes - windows.bytes);
      windows.shift[i] = window.shift;
      want[i] = moments_one_by_one(mask.view(), at, columns, radius);
    }
    for (const Kernels& kernels : test::runnable_tables()) {
      if (kernels.probes.moments == nullptr) continue;
      ProbeMoments m;
      std::fill_n(m.n, probe_lanes, -7);
      kernels.probes.moments(windows, m);
      for (int i = 0; i < probe_lanes; ++i) {
        if ((windows.asked >> i & 1U) == 0) {
          CHECK(m.n[i] == -7);
        } else {
          CHECK(Moments{m.n[i], m.x[i], m.y[i], m.xx[i], m.xy[i], m.yy[i]} == want[i]);
        }
      }
    }
  }
}

/// An image of few grey levels and colours, so that many pixels are as bright as their margin, with masks and widths to
/// search it for ridges.
struct RidgeScene {
  int width, height;
  std::vector<std::uint8_t> luma, cb, cr;
  test::Bits roi, green, strong, weak;
  std::vector<LineWidth> widths;
  RidgeSearch search;

  RidgeScene(int w, int h, std::uint64_t seed) : width(w), height(h), roi(w, h), green(w, h), strong(w, h), weak(w, h) {
    Rng rng(seed);
    const int chroma_width = (w + 1) / 2, chroma_height = (h + 1) / 2;
    luma.resize(static_cast<std::size_t>(w * h));
    for (std::uint8_t& v : luma)
      v = static_cast<std::uint8_t>(rng.below(4) == 0 ? 90 + rng.below(80) : 60 + rng.below(9));
    cb.resize(static_cast<std::size_t>(chroma_width * chroma_height));
    cr.resize(cb.size());
    for (std::uint8_t& v : cb) v = static_cast<std::uint8_t>(100 + rng.below(20));
    for (std::uint8_t& v : cr) v = static_cast<std::uint8_t>(100 + rng.below(20));
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        roi.view().set(x, y, rng.below(16) != 0);
        green.view().set(x, y, rng.below(8) != 0);
        strong.view().set(x, y, rng.below(32) == 0);
      }
    }
    copy(strong.view(), weak.view());
    const int columns = (w + 7) / 8, rows = (h + 7) / 8;
    for (int i = 0; i < columns * rows; ++i) {
      const auto any = [&] { return static_cast<std::uint16_t>(rng.below(16) == 0 ? 65535 : rng.below(150)); };
      widths.push_back(rng.below(16) == 0 ? LineWidth{} : LineWidth{any(), any(), any()});
    }
    search.image = {{luma.data(), w, h, w},
                    {cb.data(), chroma_width, chroma_height, chroma_width},
                    {cr.data(), chroma_width, chroma_height, chroma_width}};
    search.roi = roi.view();
    search.green = green.view();
    search.widths = {widths.data(), columns, rows, columns};
    search.axis_cb = -256;
    search.axis_cr = -200;
    search.weak_margin = 20;
    search.strong_margin = 90;
    search.strong = strong.view();
    search.weak = weak.view();
  }

  [[nodiscard]] int sum(int x, int y, bool along_row) const {
    const auto at = [&](int px, int py) { return int{search.image.y.at(px, py)}; };
    return along_row ? at(x, y - 1) + 2 * at(x, y) + at(x, y + 1) : at(x - 1, y) + 2 * at(x, y) + at(x + 1, y);
  }
  [[nodiscard]] bool is_whiter(int x, int y, int side_x, int side_y) const {
    const auto greenness = [&](int px, int py) {
      return (search.image.cb.at(px / 2, py / 2) - 128) * search.axis_cb +
             (search.image.cr.at(px / 2, py / 2) - 128) * search.axis_cr;
    };
    const auto chroma = [&](int px, int py) {
      return std::abs(search.image.cb.at(px / 2, py / 2) - 128) + std::abs(search.image.cr.at(px / 2, py / 2) - 128);
    };
    const int here = search.image.y.at(x, y), side = search.image.y.at(side_x, side_y);
    return greenness(x, y) * side * 8 < greenness(side_x, side_y) * here * 7 &&
           chroma(x, y) * side < chroma(side_x, side_y) * here;
  }
  /// Whether a pixel is a ridge by that margin, by the definition.
  [[nodiscard]] bool is_ridge(int x, int y, int margin) const {
    const LineWidth& w = search.widths.at(x / 8, y / 8);
    if (w.slanted == 0) return false;
    for (const bool along_row : {true, false}) {
      const int narrow = std::min(along_row ? w.across_row : w.across_column, w.slanted);
      for (const int reach :
           {(narrow * 19 / 16 + 32) / 16, ((narrow + w.slanted) / 2 + 32) / 16, (w.slanted + 32) / 16}) {
        if (reach > max_ridge_reach_px) break;
        const int dx = along_row ? reach : 0, dy = along_row ? 0 : reach;
        // With a neighbour across the look for each of the three sums.
        const int beside_x = along_row ? 0 : 1, beside_y = 1;
        if (x - std::max(dx, 1) < 0 || x + std::max(dx, 1) >= width) continue;
        if (y - dy - beside_y < 0 || y + dy + beside_y >= height || x - beside_x < 0) continue;
        if (!search.green.get(x - dx, y - dy) || !search.green.get(x + dx, y + dy)) continue;
        const int side = std::max(sum(x - dx, y - dy, along_row), sum(x + dx, y + dy, along_row));
        if (sum(x, y, along_row) <= side + side / 16 + margin) continue;
        if (is_whiter(x, y, x - dx, y - dy) && is_whiter(x, y, x + dx, y + dy)) return true;
      }
    }
    return false;
  }
};

void check_ridges(const Kernels& kernels, int width, int height) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    RidgeScene scene(width, height, seed);
    const RidgeScene before(width, height, seed);
    kernels.find_ridges(scene.search);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        CAPTURE(x);
        CAPTURE(y);
        const bool was = before.search.strong.get(x, y);
        const bool wanted = before.search.roi.get(x, y) && !was;
        REQUIRE(scene.search.weak.get(x, y) == (was || (wanted && before.is_ridge(x, y, 20))));
        REQUIRE(scene.search.strong.get(x, y) == (was || (wanted && before.is_ridge(x, y, 90))));
      }
    }
  }
}

TEST_CASE("ridges are those of the definition, with every table of kernels") {
  for (const Kernels& kernels : test::all_tables()) {
    CAPTURE(kernels.name);
    check_ridges(kernels, 128, 48);
    check_ridges(kernels, 160, 120);
    check_ridges(kernels, 70, 46);
    check_ridges(kernels, 24, 16);
    check_ridges(kernels, 8, 50);
  }
}

/// White of one row by its definition.
bool is_white(const CarpetLimits& limits, int luma, int cb, int cr) {
  const int along = std::max((cb * limits.axis_cb + cr * limits.axis_cr) / 256, 0);
  const int by_chroma = (std::abs(cb) + std::abs(cr)) * limits.per_chroma / 256;
  return luma >= std::min(std::max({limits.shadow_luma, along * limits.per_green / 256, by_chroma}), 255);
}

void check_white(const Kernels& kernels, int width) {
  const auto samples = static_cast<std::size_t>(width);
  const auto luma = noise(2 * samples, 11);
  auto chroma = noise(2 * samples, 12);
  for (std::uint8_t& c : chroma) c = static_cast<std::uint8_t>(118 + c % 24);
  std::vector<std::uint64_t> region((samples + 63) / 64, ~std::uint64_t{0});
  if (width % 64 != 0) region.back() >>= 64 - width % 64;
  std::vector<std::uint64_t> upper(region.size()), lower(region.size());
  const CarpetLimits limits = {-200, -256, 500, 700, 40};
  BandMemo memo;
  memo.clear();
  kernels.white_rows(limits, {chroma.data(),
                              chroma.data() + samples,
                              {luma.data(), luma.data() + samples},
                              {region.data(), region.data()},
                              {upper.data(), lower.data()},
                              width,
                              &memo});
  for (int x = 0; x < width; ++x) {
    const auto at = static_cast<std::size_t>(x);
    const int cb = chroma[at / 2] - 128;
    const int cr = chroma[samples + at / 2] - 128;
    REQUIRE(((upper[at / 64] >> (at % 64)) & 1U) == (is_white(limits, luma[at], cb, cr) ? 1 : 0));
    REQUIRE(((lower[at / 64] >> (at % 64)) & 1U) == (is_white(limits, luma[samples + at], cb, cr) ? 1 : 0));
  }
}

TEST_CASE("white is that of the definition, with every table of kernels") {
  for (const int width : {1, 63, 64, 65, 95, 320}) {
    CAPTURE(width);
    for (const Kernels& kernels : test::all_tables()) {
      CAPTURE(kernels.name);
      check_white(kernels, width);
    }
  }
}

/// What the carpet's colour is made of, by its definition.
struct CarpetOfRow {
  CarpetColours colours;
  ChromaSums sums;
  CarpetRatios ratios;
};
CarpetOfRow carpet_by_definition(const CarpetRow& row, const HsvRange& gate, const ChromaAxis& axis) {
  const auto is_set = [](const std::uint64_t* bits, int x) { return ((bits[x / 64] >> (x % 64)) & 1U) != 0; };
  CarpetOfRow out;
  for (int x = 2; x < row.width; x += 4) {
    if (!is_set(row.mask, x)) continue;
    const int luma = row.y[x];
    const Hsv hsv = hsv_from_ycbcr(row.y[x], row.cb[x / 2], row.cr[x / 2]);
    if (in_range(hsv, gate)) {
      ++out.colours.samples;
      ++out.colours.hues[hsv.hue];
      ++out.colours.saturations[hsv.saturation];
    }
    const int cb = row.cb[x / 2] - 128;
    const int cr = row.cr[x / 2] - 128;
    ++out.sums.samples;
    out.sums.cb += cb;
    out.sums.cr += cr;
    const int divisor = std::max(luma, 1);
    ++out.ratios.greenness[std::clamp((cb * axis.cb + cr * axis.cr) / divisor, 0, 255)];
    ++out.ratios.chroma[std::min((std::abs(cb) + std::abs(cr)) * 256 / divisor, 255)];
    ++out.ratios.lumas[luma];
    if (x + 1 < row.width && is_set(row.around, x - 1) && is_set(row.around, x + 1)) {
      out.ratios.roughness += std::min(std::abs(2 * luma - row.y[x - 1] - row.y[x + 1]), 32);
      ++out.ratios.rough_samples;
    }
  }
  return out;
}

bool same(const Histogram& a, const Histogram& b) { return std::equal(a, a + 256, b); }

void check_carpet(const CarpetKernels& kernels, int width, const HsvRange& gate, std::uint64_t seed) {
  const auto samples = static_cast<std::size_t>(width);
  const auto luma = noise(samples, seed);
  const auto chroma = noise(samples + 1, seed + 1);
  Rng rng(seed + 2);
  std::vector<std::uint64_t> mask((samples + 63) / 64), around(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    around[i] = rng.next_u32() | std::uint64_t{rng.next_u32()} << 32U | 0xFFF00U;
    mask[i] = around[i] & (rng.next_u32() | std::uint64_t{rng.next_u32()} << 32U);
  }
  const std::uint64_t inside = width % 64 == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << (width % 64)) - 1;
  mask.back() &= inside;
  around.back() &= inside;
  const std::vector<std::uint8_t> cb(chroma.begin(), chroma.begin() + (width + 1) / 2);
  const std::vector<std::uint8_t> cr(chroma.end() - (width + 1) / 2, chroma.end());
  const CarpetRow row{luma.data(), cb.data(), cr.data(), mask.data(), around.data(), width};
  const ChromaAxis axis{-180, -256};
  const CarpetOfRow expected = carpet_by_definition(row, gate, axis);
  CarpetOfRow found;
  kernels.count_colours(row, gate, found.colours);
  kernels.sum_chroma(row, found.sums);
  kernels.count_ratios(row, axis, found.ratios);
  REQUIRE(found.colours.samples == expected.colours.samples);
  REQUIRE(same(found.colours.hues, expected.colours.hues));
  REQUIRE(same(found.colours.saturations, expected.colours.saturations));
  REQUIRE(found.sums.samples == expected.sums.samples);
  REQUIRE(found.sums.cb == expected.sums.cb);
  REQUIRE(found.sums.cr == expected.sums.cr);
  REQUIRE(same(found.ratios.greenness, expected.ratios.greenness));
  REQUIRE(same(found.ratios.chroma, expected.ratios.chroma));
  REQUIRE(same(found.ratios.lumas, expected.ratios.lumas));
  REQUIRE(found.ratios.roughness == expected.ratios.roughness);
  REQUIRE(found.ratios.rough_samples == expected.ratios.rough_samples);
}

TEST_CASE("the carpet's colours are counted as their definition says, with every table of kernels") {
  for (const int width : {3, 63, 64, 66, 95, 320, 1280}) {
    for (const HsvRange& gate : {HsvRange{}, HsvRange{28, 95, 40, 255, 12, 255}, HsvRange{170, 20, 3, 200, 0, 180}}) {
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        CAPTURE(width);
        CAPTURE(seed);
        for (const Kernels& kernels : test::all_tables()) {
          CAPTURE(kernels.name);
          check_carpet(kernels.carpet, width, gate, seed);
        }
      }
    }
  }
}

TEST_CASE("the mean of four rows is rounded once, with every table of kernels that has it") {
  for (const int width : {1, 31, 160, 333}) {
    const auto samples = static_cast<std::size_t>(width);
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      auto four = noise(4 * samples, seed);
      for (std::size_t i = 0; i < samples; i += 3) {  // neighbouring values, where rounding matters
        for (std::size_t k = 1; k < 4; ++k) four[k * samples + i] = static_cast<std::uint8_t>(four[i] ^ (seed + k) % 4);
      }
      const std::uint8_t* const rows[4] = {four.data(), &four[samples], &four[2 * samples], &four[3 * samples]};
      for (const Kernels& kernels : test::runnable_tables()) {
        if (kernels.mean_of_four == nullptr) continue;
        std::vector<std::uint8_t> mean(samples);
        kernels.mean_of_four(rows, width, mean.data());
        for (std::size_t i = 0; i < samples; ++i) {
          REQUIRE(mean[i] == (rows[0][i] + rows[1][i] + rows[2][i] + rows[3][i] + 2) / 4);
        }
      }
    }
  }
}

}  // namespace
}  // namespace touchline
