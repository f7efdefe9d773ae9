// SPDX-License-Identifier: Apache-2.0
// Area weighting against the integral over each working pixel in double precision, and the colours against BT.601.
#include "vision/image/subsample.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "tests/support/ascii_image.h"
#include "vision/image/colour_matrix.h"

using namespace touchline;
using namespace touchline::test;

namespace {

using Storage = SubsampleStorage<max_frame_width, 640>;

struct Frame {
  PixelFormat format;
  int width, height, stride;
  std::vector<std::uint8_t> bytes;
  Frame(PixelFormat f, int w, int h, int padding = 5)
      : format(f),
        width(w),
        height(h),
        stride(w * bytes_per_pixel(f) + padding),
        bytes(static_cast<std::size_t>(stride) * static_cast<std::size_t>(h), 77) {}
  [[nodiscard]] FrameView view() const { return {format, bytes.data(), width, height, stride}; }
  std::uint8_t& byte(int y, int i) { return bytes[static_cast<std::size_t>(y * stride + i)]; }
};

struct Picture {
  Gray y, cb, cr;
  Picture(int w, int h) : y(w, h, 99), cb((w + 1) / 2, (h + 1) / 2, 99), cr((w + 1) / 2, (h + 1) / 2, 99) {}
  Yuv420View view() { return {y.view(), cb.view(), cr.view()}; }
  bool operator==(const Picture&) const = default;
};

Picture subsample(const Frame& frame, int w, int h) {
  auto storage = std::make_unique<Storage>();
  Subsampler subsampler(storage->memory());
  REQUIRE(subsampler.configure(frame.width, frame.height, w, h) == Status::ok);
  Picture picture(w, h);
  REQUIRE(subsampler.run(frame.view(), picture.view()) == Status::ok);
  return picture;
}

struct Rgb {
  double r, g, b;
};

double luma(Rgb c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; }
double blue_difference(Rgb c) { return 128 + (c.b - luma(c)) / 1.772; }
double red_difference(Rgb c) { return 128 + (c.r - luma(c)) / 1.402; }

/// Mean of an RGB24 frame over the rectangle of a working pixel (or of several).
Rgb mean(Frame& frame, double x0, double y0, double x1, double y1) {
  Rgb sum = {0, 0, 0};
  double area = 0;
  for (int y = static_cast<int>(y0); y < y1; ++y) {
    for (int x = static_cast<int>(x0); x < x1; ++x) {
      const double w =
          (std::min(x1, x + 1.0) - std::max(x0, x + 0.0)) * (std::min(y1, y + 1.0) - std::max(y0, y + 0.0));
      if (w <= 0) continue;
      sum = {sum.r + w * frame.byte(y, 3 * x), sum.g + w * frame.byte(y, 3 * x + 1),
             sum.b + w * frame.byte(y, 3 * x + 2)};
      area += w;
    }
  }
  return {sum.r / area, sum.g / area, sum.b / area};
}

void fill_random(Frame& frame, unsigned seed) {
  std::mt19937 random(seed);
  for (std::uint8_t& byte : frame.bytes) byte = static_cast<std::uint8_t>(random());
}

}  // namespace

TEST_CASE("every working pixel is the mean over its area") {
  struct Sizes {
    int fw, fh, w, h;
    double tolerance;
  };
  // Exact weights: half a step of rounding and 1/64 of the sums. Rounded weights (the last two): up to 1/512 of a
  // working pixel at each of the four sides, where neighbours differ by up to 255.
  for (const Sizes s : {Sizes{752, 480, 320, 240, 0.52},
                        {640, 480, 320, 240, 0.52},
                        {1280, 1024, 320, 240, 0.52},
                        {320, 240, 320, 240, 0.52},
                        {94, 60, 40, 30, 0.52},
                        {30, 20, 13, 20, 0.52},
                        {752, 480, 640, 480, 0.52},
                        {333, 257, 320, 240, 2.6},
                        {1279, 1023, 319, 239, 2.6}}) {
    CAPTURE(s.fw);
    CAPTURE(s.w);
    Frame frame(PixelFormat::rgb24, s.fw, s.fh);
    fill_random(frame, 3);
    const Picture small = subsample(frame, s.w, s.h);
    const double sx = static_cast<double>(s.fw) / s.w, sy = static_cast<double>(s.fh) / s.h;
    double worst = 0;
    for (int y = 0; y < s.h; ++y) {
      for (int x = 0; x < s.w; ++x) {
        const double expected = luma(mean(frame, x * sx, y * sy, (x + 1) * sx, (y + 1) * sy));
        worst = std::max(worst, std::abs(small.y.view().at(x, y) - expected));
      }
    }
    for (int y = 0; y < s.h / 2; ++y) {
      for (int x = 0; x < s.w / 2; ++x) {
        const Rgb colour = mean(frame, 2 * x * sx, 2 * y * sy, 2 * (x + 1) * sx, 2 * (y + 1) * sy);
        worst = std::max(worst, std::abs(small.cb.view().at(x, y) - blue_difference(colour)));
        worst = std::max(worst, std::abs(small.cr.view().at(x, y) - red_difference(colour)));
      }
    }
    CHECK(worst < s.tolerance);
  }
}

TEST_CASE("a frame of one colour gives that colour's formula everywhere, at any size") {
  std::mt19937 random(4);
  for (const auto& [fw, fh, w, h] : {std::array{752, 480, 320, 240},
                                     {1280, 1024, 320, 240},
                                     {333, 257, 320, 240},
                                     {5, 3, 1, 1},
                                     {2, 2, 2, 2},
                                     {9, 7, 3, 5},
                                     {640, 480, 320, 240}}) {
    for (int round = 0; round < 8; ++round) {
      const std::uint8_t low = round == 0 ? 255 : 0;
      const int c[3] = {static_cast<std::uint8_t>(random()) | low, static_cast<std::uint8_t>(random()) | low,
                        static_cast<std::uint8_t>(random()) | low};
      Frame frame(PixelFormat::rgb24, fw, fh);
      for (int y = 0; y < fh; ++y) {
        for (int i = 0; i < 3 * fw; ++i) frame.byte(y, i) = static_cast<std::uint8_t>(c[i % 3]);
      }
      Picture expected(w, h);
      const auto set = [&](Gray& image, int value) {
        std::fill(image.samples.begin(), image.samples.end(), static_cast<std::uint8_t>(std::clamp(value, 0, 255)));
      };
      set(expected.y, (4899 * c[0] + 9617 * c[1] + 1868 * c[2] + 8192) >> 14);
      set(expected.cb, 128 + ((-2765 * c[0] - 5427 * c[1] + 8192 * c[2] + 8192) >> 14));
      set(expected.cr, 128 + ((8192 * c[0] - 6860 * c[1] - 1332 * c[2] + 8192) >> 14));
      CHECK(subsample(frame, w, h) == expected);
    }
  }
}

TEST_CASE("the same colours in another format give the same picture") {
  Frame rgb(PixelFormat::rgb24, 94, 60), bgr(PixelFormat::bgr24, 94, 60, 0), packed(PixelFormat::rgb565, 94, 60);
  std::mt19937 random(5);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 94; ++x) {
      const unsigned r = random() % 32, g = random() % 64, b = random() % 32;
      const unsigned word = r << 11 | g << 5 | b;
      packed.byte(y, 2 * x) = static_cast<std::uint8_t>(word);
      packed.byte(y, 2 * x + 1) = static_cast<std::uint8_t>(word >> 8);
      const unsigned wide[3] = {r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2};
      for (int c = 0; c < 3; ++c) {
        rgb.byte(y, 3 * x + c) = static_cast<std::uint8_t>(wide[c]);
        bgr.byte(y, 3 * x + 2 - c) = static_cast<std::uint8_t>(wide[c]);
      }
    }
  }
  const Picture expected = subsample(rgb, 40, 30);
  CHECK(subsample(bgr, 40, 30) == expected);
  CHECK(subsample(packed, 40, 30) == expected);
}

TEST_CASE("limited range YUYV is stretched to full range") {
  Frame frame(PixelFormat::yuyv, 4, 2);
  const std::uint8_t pair[4][4] = {{16, 128, 16, 128}, {235, 128, 235, 128}, {16, 16, 235, 240}, {255, 255, 0, 0}};
  for (int i = 0; i < 4; ++i) {
    for (int b = 0; b < 4; ++b) frame.byte(i / 2, i % 2 * 4 + b) = pair[i][b];
  }
  const Picture picture = subsample(frame, 4, 2);
  CHECK(picture.y.samples == std::vector<std::uint8_t>{0, 0, 255, 255, 0, 255, 255, 0});
  CHECK(picture.cb.samples == std::vector<std::uint8_t>{64, 200});
  CHECK(picture.cr.samples == std::vector<std::uint8_t>{192, 55});
}

TEST_CASE("YUYV of the working size gives what the general way gives of every pixel four times") {
  constexpr int width = 38, height = 26;
  Frame small(PixelFormat::yuyv, width, height);
  fill_random(small, 11);
  Frame large(PixelFormat::yuyv, 2 * width, 2 * height);
  for (int y = 0; y < 2 * height; ++y) {
    for (int x = 0; x < 2 * width; ++x) {
      // A pixel becomes a pair with the chroma of the pair it is from.
      const int pair = x / 4 * 4;
      const int from[2] = {x / 2 * 2, pair + (x % 2 == 0 ? 1 : 3)};
      large.byte(y, 2 * x) = small.byte(y / 2, from[0]);
      large.byte(y, 2 * x + 1) = small.byte(y / 2, from[1]);
    }
  }
  const Picture direct = subsample(small, width, height);
  const Picture general = subsample(large, width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      CHECK(direct.y.view().at(x, y) == general.y.view().at(x, y));
      CHECK(direct.cb.view().at(x / 2, y / 2) == general.cb.view().at(x / 2, y / 2));
      CHECK(direct.cr.view().at(x / 2, y / 2) == general.cr.view().at(x / 2, y / 2));
    }
  }
}

TEST_CASE("other formats of the working size, too") {
  constexpr int width = 78, height = 26;
  for (const PixelFormat format : {PixelFormat::rgb24, PixelFormat::bgr24, PixelFormat::rgb565}) {
    CAPTURE(static_cast<int>(format));
    const int bytes = bytes_per_pixel(format);
    Frame small(format, width, height);
    fill_random(small, 12);
    Frame large(format, 2 * width, 2 * height);
    for (int y = 0; y < 2 * height; ++y) {
      for (int i = 0; i < 2 * width * bytes; ++i) {
        const int pixel = i / bytes;
        large.byte(y, i) = small.byte(y / 2, pixel / 2 * bytes + i % bytes);
      }
    }
    CHECK(subsample(small, width, height) == subsample(large, width, height));
  }
}

TEST_CASE("the usual cameras take the kernel that halves rows") {
  static int calls = 0;
  Kernels kernels = portable_kernels();
  kernels.halve_frame = [](const HalvedFrame&) { ++calls; };
  const int height = 480;
  for (const int width : {752, 640, 1280}) {
    CAPTURE(width);
    const auto storage = std::make_unique<Storage>();
    Subsampler subsampler(storage->memory());
    REQUIRE(subsampler.configure(width, height, 320, 240, kernels) == Status::ok);
    const Frame frame(PixelFormat::rgb24, width, height);
    Picture out(320, 240);
    calls = 0;
    CHECK(subsampler.run(frame.view(), out.view()) == Status::ok);
    CHECK(calls == 1);
  }
}

TEST_CASE("bytes beyond the row are never looked at") {
  Frame tight(PixelFormat::rgb24, 33, 21, 0), padded(PixelFormat::rgb24, 33, 21, 40);
  fill_random(tight, 6);
  for (int y = 0; y < 21; ++y) {
    for (int i = 0; i < 99; ++i) padded.byte(y, i) = tight.byte(y, i);
  }
  CHECK(subsample(tight, 20, 11) == subsample(padded, 20, 11));
}

TEST_CASE("every small size works and stays inside its memory") {
  for (int w = 1; w <= 9; ++w) {
    for (int h = 1; h <= 5; ++h) {
      for (const auto& [fw, fh] : {std::pair{w, h}, {w + 1, h + 2}, {10 * w + 3, 9 * h}, {1280, 7 * h}}) {
        Frame frame(PixelFormat::bgr24, fw, fh, 0);
        std::fill(frame.bytes.begin(), frame.bytes.end(), std::uint8_t{200});
        const Picture picture = subsample(frame, w, h);
        CHECK(std::all_of(picture.y.samples.begin(), picture.y.samples.end(), [](int v) { return v == 200; }));
        CHECK(std::all_of(picture.cr.samples.begin(), picture.cr.samples.end(), [](int v) { return v == 128; }));
      }
    }
  }
}

TEST_CASE("what is wrong is refused and leaves the picture alone") {
  auto storage = std::make_unique<SubsampleStorage<100, 40>>();
  Subsampler subsampler(storage->memory());
  Frame frame(PixelFormat::rgb24, 94, 60);
  Picture picture(40, 30);
  const Picture untouched = picture;
  CHECK(subsampler.run(frame.view(), picture.view()) == Status::not_ready);
  CHECK(subsampler.configure(94, 60, 0, 30) == Status::invalid_argument);
  CHECK(subsampler.configure(39, 60, 40, 30) == Status::invalid_argument);
  CHECK(subsampler.configure(94, 29, 40, 30) == Status::invalid_argument);
  CHECK(subsampler.configure(1281, 60, 40, 30) == Status::invalid_argument);
  CHECK(subsampler.configure(94, 1025, 40, 30) == Status::invalid_argument);
  CHECK(subsampler.configure(101, 60, 40, 30) == Status::capacity);
  CHECK(subsampler.configure(94, 60, 41, 30) == Status::capacity);
  CHECK(subsampler.configure(94, 60, 40, 30) == Status::ok);
  CHECK(subsampler.configure(101, 60, 40, 30) == Status::capacity);
  CHECK(subsampler.run(Frame(PixelFormat::rgb24, 95, 60).view(), picture.view()) == Status::wrong_size);
  CHECK(subsampler.run(Frame(PixelFormat::rgb24, 94, 61).view(), picture.view()) == Status::wrong_size);
  Picture other(40, 32);
  CHECK(subsampler.run(frame.view(), other.view()) == Status::wrong_size);
  FrameView broken = frame.view();
  broken.stride_bytes = 94 * 3 - 1;
  CHECK(subsampler.run(broken, picture.view()) == Status::invalid_argument);
  broken = frame.view();
  broken.format = static_cast<PixelFormat>(9);
  CHECK(subsampler.run(broken, picture.view()) == Status::invalid_argument);
  broken = frame.view();
  broken.data = nullptr;
  CHECK(subsampler.run(broken, picture.view()) == Status::invalid_argument);
  CHECK(picture == untouched);
  CHECK(subsampler.run(frame.view(), picture.view()) == Status::ok);
  CHECK(subsampler.configure(95, 60, 40, 30) == Status::ok);
  CHECK(subsampler.run(Frame(PixelFormat::yuyv, 95, 60).view(), picture.view()) == Status::invalid_argument);
}
