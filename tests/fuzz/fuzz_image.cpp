// SPDX-License-Identifier: Apache-2.0
// Any bytes as an image file: a picture within the limits, or a HostError; nothing else.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "platform/host/host_error.h"
#include "platform/host/image_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace touchline;
  try {
    const host::RgbImage image = host::decode_image({data, size}, "fuzz");
    const auto bytes = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3U;
    if (image.width > max_frame_width || image.height > max_frame_height || image.rgb.size() != bytes) std::abort();
  } catch (const host::HostError&) {
  }
  return 0;
}
