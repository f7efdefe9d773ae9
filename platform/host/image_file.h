// SPDX-License-Identifier: Apache-2.0
// Image files: PNG and JPEG to 8-bit RGB in memory, and back (libpng, libjpeg).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "platform/core/frame.h"

namespace touchline::host {

/// 8-bit RGB, rows without gaps.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  RgbImage() = default;
  RgbImage(int w, int h) : width(w), height(h), rgb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * 3U) {}
  /// First of the three samples of a pixel that lies inside.
  [[nodiscard]] std::uint8_t* at(int x, int y) {
    return rgb.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3U;
  }
  [[nodiscard]] const std::uint8_t* at(int x, int y) const {
    return rgb.data() +
           (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) * 3U;
  }
  [[nodiscard]] FrameView view() const { return {PixelFormat::rgb24, rgb.data(), width, height, width * 3}; }
};

/// Decodes a whole file held in memory; `name` is for the message. Throws HostError: neither PNG nor JPEG, damaged or
/// cut off, larger than max_frame_width x max_frame_height.
RgbImage decode_image(std::span<const std::uint8_t> file, const std::string& name);
/// Reads and decodes; also throws when the file is missing, empty, a device or a pipe. What is no PNG or JPEG is told
/// by its first bytes, before the rest is read. `remedy` ends the sentence about a file that is missing or no file.
RgbImage read_image(const std::filesystem::path& path, const std::string& remedy = "give a PNG or JPEG file");
/// Throws HostError when the file cannot be written.
void write_png(const std::filesystem::path& path, const RgbImage& image);
/// Likewise; `quality` 1..100. For recordings, where a PNG a frame would be ten times the size.
void write_jpeg(const std::filesystem::path& path, const RgbImage& image, int quality);

}  // namespace touchline::host
