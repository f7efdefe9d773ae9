// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/vivid.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace touchline::vm {
namespace {

constexpr std::uint32_t width = 640, height = 480;

bool done(int file, unsigned long request, void* argument, const char* name) {
  if (::ioctl(file, request, argument) == 0) return true;
  std::fprintf(stderr, "vivid: %s: %s\n", name, std::strerror(errno));
  return false;
}

}  // namespace

std::string vivid_node(bool output) {
  for (int node = 0; node < 16; ++node) {
    const std::string path = "/dev/video" + std::to_string(node);
    const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) continue;
    v4l2_capability capability{};
    const bool asked = ::ioctl(file, VIDIOC_QUERYCAP, &capability) == 0;
    ::close(file);
    const std::uint32_t wanted = output ? V4L2_CAP_VIDEO_OUTPUT : V4L2_CAP_VIDEO_CAPTURE;
    const bool vivid = std::strcmp(reinterpret_cast<const char*>(capability.driver), "vivid") == 0;
    if (asked && vivid && (capability.device_caps & wanted) != 0) return path;
  }
  return {};
}

bool set_control(const std::string& node, const std::string& name, int value) {
  const int file = ::open(node.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return false;
  v4l2_queryctrl query{};
  bool found = false;
  query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (::ioctl(file, VIDIOC_QUERYCTRL, &query) == 0) {
    if (name == reinterpret_cast<const char*>(query.name)) {
      v4l2_control control{};
      control.id = query.id;
      control.value = value;
      found = done(file, VIDIOC_S_CTRL, &control, name.c_str());
      break;
    }
    query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  ::close(file);
  return found;
}

bool VividOutput::set_timings(const std::string& node, bool input) {
  const int file = ::open(node.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return false;
  int number = input ? 1 : 0;
  bool good = done(file, input ? VIDIOC_S_INPUT : VIDIOC_S_OUTPUT, &number, "S_INPUT");
  bool set = false;
  for (std::uint32_t index = 0; good && !set && index < 100; ++index) {
    v4l2_enum_dv_timings entry{};
    entry.index = index;
    if (::ioctl(file, VIDIOC_ENUM_DV_TIMINGS, &entry) != 0) break;
    if (entry.timings.bt.width != width || entry.timings.bt.height != height) continue;
    set = done(file, VIDIOC_S_DV_TIMINGS, &entry.timings, "S_DV_TIMINGS");
  }
  ::close(file);
  return good && set;
}

bool VividOutput::open() {
  const std::string capture = vivid_node(false);
  const std::string output = vivid_node(true);
  if (capture.empty() || output.empty()) return false;
  if (!set_timings(capture, true) || !set_timings(output, false)) return false;
  if (!set_control(capture, "Loop Video", 1) && !set_control(output, "Loop Video", 1)) return false;
  if (!set_control(capture, "OSD Text Mode", 2)) return false;
  file_ = ::open(output.c_str(), O_RDWR | O_CLOEXEC);
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  format.fmt.pix.width = width;
  format.fmt.pix.height = height;
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (!done(file_, VIDIOC_S_FMT, &format, "S_FMT")) return false;
  if (format.fmt.pix.width != width || format.fmt.pix.height != height) return false;
  v4l2_requestbuffers request{};
  request.count = 3;
  request.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  request.memory = V4L2_MEMORY_MMAP;
  if (!done(file_, VIDIOC_REQBUFS, &request, "REQBUFS")) return false;
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer{};
    buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = i;
    if (!done(file_, VIDIOC_QUERYBUF, &buffer, "QUERYBUF")) return false;
    void* memory = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, file_, buffer.m.offset);
    if (memory == MAP_FAILED) return false;
    buffers_.push_back({memory, buffer.length});
  }
  return true;
}

bool VividOutput::show(const std::uint8_t* yuyv, int timeout_ms) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  buffer.memory = V4L2_MEMORY_MMAP;
  if (queued_ < buffers_.size()) {
    buffer.index = static_cast<std::uint32_t>(queued_++);
  } else {
    pollfd ready{file_, POLLOUT, 0};
    if (::poll(&ready, 1, timeout_ms) <= 0 || ::ioctl(file_, VIDIOC_DQBUF, &buffer) != 0) return false;
  }
  std::memcpy(buffers_[buffer.index].memory, yuyv, width * height * 2);
  buffer.bytesused = width * height * 2;
  buffer.field = V4L2_FIELD_NONE;
  if (!done(file_, VIDIOC_QBUF, &buffer, "QBUF")) return false;
  if (streaming_) return true;
  int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  streaming_ = done(file_, VIDIOC_STREAMON, &type, "STREAMON");
  return streaming_;
}

VividOutput::~VividOutput() {
  for (const Buffer& buffer : buffers_) ::munmap(buffer.memory, buffer.size);
  if (file_ >= 0) ::close(file_);
}

}  // namespace touchline::vm
