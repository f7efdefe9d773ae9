// SPDX-License-Identifier: Apache-2.0
// What libv4l2's conversion costs, for a camera that has not the format that is asked for: libv4lconvert, which does
// that work inside libv4l2, is given a camera of our own making. Prints, per format of the camera, time and allocations
// per frame of 640x480 as RGB24.   conversion_cost [FRAMES]
#include <fcntl.h>
#include <libv4l-plugin.h>
#include <libv4lconvert.h>
#include <linux/videodev2.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <jpeglib.h>

#include "tests/support/heap_guard.h"

namespace touchline::test {
namespace {

constexpr unsigned width = 640, height = 480;
constexpr int warm_up = 5;

struct Source {
  const char* name;
  std::uint32_t fourcc;
  unsigned row_bytes;  // 0: compressed
  std::vector<std::uint8_t> frame;
};

v4l2_format format_of(std::uint32_t fourcc, unsigned row_bytes, std::size_t bytes) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = width;
  format.fmt.pix.height = height;
  format.fmt.pix.pixelformat = fourcc;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = row_bytes;
  format.fmt.pix.sizeimage = static_cast<std::uint32_t>(bytes);
  return format;
}

/// A camera that offers the source's format and nothing else.
int answer(void* camera, int, unsigned long request, void* argument) {
  const auto& source = *static_cast<const Source*>(camera);
  if (request == VIDIOC_QUERYCAP) {
    auto& caps = *static_cast<v4l2_capability*>(argument);
    caps = {};
    caps.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    return 0;
  }
  if (request == VIDIOC_ENUM_FMT && static_cast<v4l2_fmtdesc*>(argument)->index == 0) {
    static_cast<v4l2_fmtdesc*>(argument)->pixelformat = source.fourcc;
    return 0;
  }
  if (request == VIDIOC_TRY_FMT || request == VIDIOC_S_FMT || request == VIDIOC_G_FMT) {
    *static_cast<v4l2_format*>(argument) = format_of(source.fourcc, source.row_bytes, source.frame.size());
    return 0;
  }
  errno = EINVAL;
  return -1;
}

/// Something between a field and noise: an encoder and a decoder have work with it.
std::uint8_t texture(std::size_t i) { return static_cast<std::uint8_t>((i / 7 % 200) + (i * 2654435761U >> 29)); }

std::vector<std::uint8_t> raw(std::size_t bytes) {
  std::vector<std::uint8_t> frame(bytes);
  for (std::size_t i = 0; i < bytes; ++i) frame[i] = texture(i);
  return frame;
}

std::vector<std::uint8_t> jpeg() {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &bytes, &size);
  encoder.image_width = width;
  encoder.image_height = height;
  encoder.input_components = 3;
  encoder.in_color_space = JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, 85, TRUE);
  jpeg_start_compress(&encoder, TRUE);
  const std::vector<std::uint8_t> picture = raw(std::size_t{width} * height * 3);
  while (encoder.next_scanline < height) {
    std::vector<std::uint8_t> line(picture.begin() + encoder.next_scanline * width * 3,
                                   picture.begin() + (encoder.next_scanline + 1) * width * 3);
    JSAMPROW rows[] = {line.data()};
    jpeg_write_scanlines(&encoder, rows, 1);
  }
  jpeg_finish_compress(&encoder);
  std::vector<std::uint8_t> frame(bytes, bytes + size);
  std::free(bytes);
  jpeg_destroy_compress(&encoder);
  return frame;
}

bool measure(Source source, int frames) {
  libv4l_dev_ops operations{};
  operations.ioctl = answer;
  const int file = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  v4lconvert_data* converter = v4lconvert_create_with_dev_ops(file, &source, &operations);
  if (converter == nullptr) return false;
  v4l2_format from = format_of(source.fourcc, source.row_bytes, source.frame.size());
  v4l2_format to = format_of(V4L2_PIX_FMT_RGB24, width * 3, std::size_t{width} * height * 3);
  std::vector<std::uint8_t> picture(std::size_t{width} * height * 3);
  std::vector<std::uint8_t> input;
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(frames));
  std::uint64_t first = 0, later = 0;
  bool good = v4lconvert_needs_conversion(converter, &from, &to) != 0;
  for (int i = 0; good && i < frames + warm_up; ++i) {
    input = source.frame;
    const HeapGuard guard;
    const auto begin = std::chrono::steady_clock::now();
    good = v4lconvert_convert(converter, &from, &to, input.data(), static_cast<int>(input.size()), picture.data(),
                              static_cast<int>(picture.size())) == static_cast<int>(picture.size());
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    if (i == 0) first = guard.allocations();
    if (i < warm_up) continue;
    later += guard.allocations();
    times.push_back(took.count());
  }
  if (!good) std::printf("%-8s failed: %s\n", source.name, v4lconvert_get_error_message(converter));
  v4lconvert_destroy(converter);
  ::close(file);
  if (!good) return false;
  std::sort(times.begin(), times.end());
  std::printf("%-8s %9zu %9.2f %9.2f %9llu %9.2f\n", source.name, source.frame.size(), times[times.size() / 2],
              times[times.size() * 9 / 10], static_cast<unsigned long long>(first),
              static_cast<double>(later) / frames);
  return true;
}

}  // namespace
}  // namespace touchline::test

int main(int argc, char** argv) {
  using namespace touchline::test;
  const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 200;
  std::printf("to RGB24, %ux%u, %d frames\n%-8s %9s %9s %9s %9s %9s\n", width, height, frames, "camera", "bytes",
              "median ms", "90 % ms", "1st alloc", "allocs");
  bool good = true;
  const std::size_t pixels = std::size_t{width} * height;
  good = measure({"YUYV", V4L2_PIX_FMT_YUYV, width * 2, raw(pixels * 2)}, frames) && good;
  good = measure({"UYVY", V4L2_PIX_FMT_UYVY, width * 2, raw(pixels * 2)}, frames) && good;
  good = measure({"NV12", V4L2_PIX_FMT_NV12, width, raw(pixels * 3 / 2)}, frames) && good;
  good = measure({"Bayer 8", V4L2_PIX_FMT_SBGGR8, width, raw(pixels)}, frames) && good;
  good = measure({"MJPEG", V4L2_PIX_FMT_MJPEG, 0, jpeg()}, frames) && good;
  return good ? 0 : 1;
}
