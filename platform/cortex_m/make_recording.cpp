// SPDX-License-Identifier: Apache-2.0
// Turns a data set into a source file and the pixels of its frames, for flash: the camera's PNGs become YUYV.
//   make_recording DATA_SET FOLDER [FRAMES]     writes FOLDER/recording.cpp and FOLDER/pixels.bin; 0 frames: all
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "platform/cortex_m/recording.h"
#include "platform/host/dataset.h"
#include "platform/host/host_error.h"
#include "platform/host/image_file.h"

namespace {

using namespace touchline;
namespace fs = std::filesystem;

/// BT.601, limited range, in 16 bits of fraction: the matrix rows sum to 219/255 and to zero.
struct Yuv {
  int y = 0, cb = 0, cr = 0;
};
Yuv to_yuv(const std::uint8_t* rgb) {
  const int r = rgb[0];
  const int g = rgb[1];
  const int b = rgb[2];
  constexpr int half = 1 << 15;
  return {16 + ((16829 * r + 33039 * g + 6416 * b + half) >> 16),
          128 + ((-9714 * r - 19070 * g + 28784 * b + half) >> 16),
          128 + ((28784 * r - 24103 * g - 4681 * b + half) >> 16)};
}

/// Two neighbours share the mean of their colours.
void append_yuyv(const host::RgbImage& image, std::vector<std::uint8_t>& pixels) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; x += 2) {
      const Yuv left = to_yuv(image.at(x, y));
      const Yuv right = to_yuv(image.at(x + 1, y));
      for (const int sample : {left.y, (left.cb + right.cb + 1) / 2, right.y, (left.cr + right.cr + 1) / 2}) {
        pixels.push_back(static_cast<std::uint8_t>(sample));
      }
    }
  }
}

/// All bits of the value.
std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", value);
  return text;
}
std::string exact(float value) { return exact(static_cast<double>(value)) + "F"; }

template <typename Container>
std::string list(const Container& values) {
  std::string text = "{";
  for (const float value : values) text += exact(value) + ", ";
  return text + "}";
}

std::string lens_text(const LensParameters& p) {
  return "{static_cast<LensModel>(" + std::to_string(static_cast<int>(p.model)) + "), " + exact(p.focal_px) + ", " +
         exact(p.cx) + ", " + exact(p.cy) + ", " + exact(p.max_theta) + ", " + list(p.k) + ", " + exact(p.alpha) +
         ", " + list(p.a) + ", " + list(p.b) + "}";
}

std::string frame_text(const host::DataFrame& frame) {
  const CameraPose& c = frame.camera.mount;
  return "    {" + exact(frame.time_s) + ", {" + exact(c.x) + ", " + exact(c.y) + ", " + exact(c.height) + ", " +
         exact(c.yaw) + ", " + exact(c.pitch) + ", " + exact(c.roll) + "}, {" + exact(frame.odometry.x) + ", " +
         exact(frame.odometry.y) + ", " + exact(frame.odometry.theta) + "}, " + (frame.has_yaw ? "true" : "false") +
         ", " + exact(frame.yaw) + "},\n";
}

std::string source_text(const host::DataSet& set) {
  std::ostringstream text;
  text << "// Made by make_recording from the data set " << set.name
       << ".\n#include \"platform/cortex_m/recording.h\"\n\n"
       << "asm(\".section .recording, \\\"a\\\"\\n\" \".balign 4\\n\" \".global recorded_pixels\\n\" "
          "\"recorded_pixels:\\n\"\n"
       << "    \".incbin \\\"\" TOUCHLINE_PIXELS \"\\\"\\n\" \".previous\\n\");\n"
       << "extern \"C\" const std::uint8_t recorded_pixels[];\n\nnamespace touchline::board {\n\n"
       << "static constexpr RecordedFrame frames[] = {\n";
  for (const host::DataFrame& frame : set.frames) text << frame_text(frame);
  text << "};\nconst Recording recording_in_flash = {\"" << set.name << "\", \"" << set.field_name << "\", "
       << lens_text(set.camera.lens) << ", frames, recorded_pixels};\n\n}  // namespace touchline::board\n";
  return text.str();
}

void write(const fs::path& path, const char* data, std::size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(data, static_cast<std::streamsize>(size));
  if (!file.flush())
    throw host::HostError(path.string() + ": cannot be written; is there room, and may you write there?");
}

void make_recording(const fs::path& data_set, const fs::path& folder, std::size_t frames) {
  host::DataSet set = host::read_dataset(data_set);
  if (set.camera.width != board::frame_width || set.camera.height != board::frame_height) {
    throw host::HostError(data_set.string() +
                          ": [camera] width and height have to be 320 and 240 for a board; simulate it with "
                          "--camera fisheye-185-qvga");
  }
  if (frames > set.frames.size()) {
    throw host::HostError(data_set.string() + ": has " + std::to_string(set.frames.size()) + " frames, " +
                          std::to_string(frames) + " are asked for");
  }
  if (frames != 0) set.frames.erase(set.frames.begin() + static_cast<std::ptrdiff_t>(frames), set.frames.end());
  std::vector<std::uint8_t> pixels;
  for (const host::DataFrame& frame : set.frames) append_yuyv(host::read_frame_image(frame), pixels);
  fs::create_directories(folder);
  const std::string source = source_text(set);
  write(folder / "recording.cpp", source.data(), source.size());
  write(folder / "pixels.bin", reinterpret_cast<const char*>(pixels.data()), pixels.size());
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t frames = 0;
  const std::string_view count = argc == 4 ? argv[3] : "0";
  const auto [end, wrong] = std::from_chars(count.data(), count.data() + count.size(), frames);
  if (argc < 3 || argc > 4 || wrong != std::errc{} || end != count.data() + count.size()) {
    std::fputs("usage: make_recording DATA_SET FOLDER [FRAMES]     FRAMES: a whole number, 0 for all\n", stderr);
    return 2;
  }
  try {
    make_recording(argv[1], argv[2], frames);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_recording: %s\n", error.what());
    return 2;
  }
}
