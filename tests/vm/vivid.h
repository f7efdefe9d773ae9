// SPDX-License-Identifier: Apache-2.0
// The kernel's virtual camera: finding its nodes, its controls by name, and its output, whose pictures the capture side
// then takes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace touchline::vm {

/// Path of the first vivid node that captures (or outputs); empty when there is none.
std::string vivid_node(bool output);
/// False when there is no such control, or it is refused.
bool set_control(const std::string& node, const std::string& name, int value);

/// Both ends at 640x480p60, YUYV, and the output looped to the capture's HDMI input (number 1).
class VividOutput {
 public:
  ~VividOutput();
  bool open();
  /// Shows a picture of 640x480 YUYV until the next; waits for a buffer for at most `timeout_ms`.
  bool show(const std::uint8_t* yuyv, int timeout_ms);

 private:
  struct Buffer {
    void* memory = nullptr;
    std::size_t size = 0;
  };
  bool set_timings(const std::string& node, bool input);

  int file_ = -1;
  std::vector<Buffer> buffers_;
  std::size_t queued_ = 0;
  bool streaming_ = false;
};

}  // namespace touchline::vm
