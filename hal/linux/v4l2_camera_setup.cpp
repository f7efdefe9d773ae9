// SPDX-License-Identifier: Apache-2.0
// Opening of V4l2Camera: the device by path or name, its format, rate and controls, the mapped buffers.
#include <fcntl.h>
#include <libv4l2.h>
#include <linux/videodev2.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cmath>

#include "hal/linux/v4l2_camera.h"

namespace touchline {
namespace {

constexpr int max_video_nodes = 64;  // /dev/video0 to 63: more than any board has

std::uint32_t fourcc(PixelFormat format) {
  switch (format) {
    case PixelFormat::rgb24: return V4L2_PIX_FMT_RGB24;
    case PixelFormat::bgr24: return V4L2_PIX_FMT_BGR24;
    case PixelFormat::rgb565: return V4L2_PIX_FMT_RGB565;
    case PixelFormat::yuyv: return V4L2_PIX_FMT_YUYV;
  }
  return 0;
}

/// libv4l2 marks the formats that it makes itself.
bool is_native(int descriptor, std::uint32_t format) {
  for (std::uint32_t index = 0; index < 64; ++index) {
    v4l2_fmtdesc entry{};
    entry.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    entry.index = index;
    if (v4l2_ioctl(descriptor, VIDIOC_ENUM_FMT, &entry) != 0) return false;
    if (entry.pixelformat == format) return (entry.flags & V4L2_FMT_FLAG_EMULATED) == 0;
  }
  return false;
}

/// A path that leads to a thing that is no video device: libv4l2 would complain of it on standard error, at each try.
bool is_something_else(const char* path) {
  constexpr unsigned video_major = 81;  // linux/major.h, VIDEO_MAJOR
  struct stat what {};
  return ::stat(path, &what) == 0 && !(S_ISCHR(what.st_mode) && major(what.st_rdev) == video_major);
}

bool has_name(int descriptor, const std::string& name) {
  v4l2_capability capability{};
  if (v4l2_ioctl(descriptor, VIDIOC_QUERYCAP, &capability) != 0) return false;
  const std::uint32_t caps =
      (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps : capability.capabilities;
  if ((caps & V4L2_CAP_VIDEO_CAPTURE) == 0) return false;  // UVC cameras have a second node, for metadata
  return name == reinterpret_cast<const char*>(capability.card);
}

}  // namespace

Status V4l2Camera::do_open() {
  if (descriptor_ >= 0) return Status::ok;
  problem_.clear();
  Status status = open_device();
  if (status == Status::ok) status = check_capabilities();
  if (status == Status::ok) status = set_format();
  if (status == Status::ok) {
    set_rate();
    set_controls();
    status = map_buffers();
  }
  if (status == Status::ok) status = start_streaming();
  if (status != Status::ok) return status;
  health_.open = true;
  ++health_.opened;
  return Status::ok;
}

Status V4l2Camera::open_device() {
  path_[0] = '\0';
  const std::string& device = config_.device;
  if (device.starts_with('/')) {
    errno = ENODEV;
    if (is_something_else(device.c_str())) return fail(Status::disconnected, "no video device at");
    std::snprintf(path_.data(), path_.size(), "%s", device.c_str());
    descriptor_ = v4l2_open(path_.data(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return descriptor_ >= 0 ? Status::ok : fail(Status::disconnected, "open");
  }
  for (int node = 0; node < max_video_nodes; ++node) {
    std::snprintf(path_.data(), path_.size(), "/dev/video%d", node);
    const int descriptor = v4l2_open(path_.data(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    if (has_name(descriptor, device)) {
      descriptor_ = descriptor;
      return Status::ok;
    }
    v4l2_close(descriptor);
  }
  path_[0] = '\0';
  errno = ENODEV;
  return fail(Status::disconnected, "no camera has the name");
}

Status V4l2Camera::check_capabilities() {
  v4l2_capability capability{};
  if (v4l2_ioctl(descriptor_, VIDIOC_QUERYCAP, &capability) != 0) return fail(Status::device_error, "VIDIOC_QUERYCAP");
  const std::uint32_t caps =
      (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps : capability.capabilities;
  errno = ENOTSUP;
  if ((caps & V4L2_CAP_VIDEO_CAPTURE) == 0) return fail(Status::unsupported, "no capture on");
  if ((caps & V4L2_CAP_STREAMING) == 0) return fail(Status::unsupported, "no streaming on");
  if (config_.input < 0) return Status::ok;
  int input = config_.input;
  return v4l2_ioctl(descriptor_, VIDIOC_S_INPUT, &input) == 0 ? Status::ok
                                                              : fail(Status::unsupported, "VIDIOC_S_INPUT");
}

Status V4l2Camera::set_format() {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(config_.width);
  format.fmt.pix.height = static_cast<std::uint32_t>(config_.height);
  format.fmt.pix.pixelformat = fourcc(config_.format);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  if (v4l2_ioctl(descriptor_, VIDIOC_S_FMT, &format) != 0) return fail(Status::device_error, "VIDIOC_S_FMT");
  const v4l2_pix_format& got = format.fmt.pix;
  const bool as_asked = got.width == static_cast<std::uint32_t>(config_.width) &&
                        got.height == static_cast<std::uint32_t>(config_.height) &&
                        got.pixelformat == fourcc(config_.format);
  if (!as_asked) {
    problem_.set("%s: %dx%d is not offered in this format; the camera answers %ux%u (see `touchline devices`)",
                 path_.data(), config_.width, config_.height, got.width, got.height);
    health_.last_error = Status::unsupported;
    stop();
    return Status::unsupported;
  }
  const int row = config_.width * bytes_per_pixel(config_.format);
  stride_ = got.bytesperline >= static_cast<std::uint32_t>(row) ? static_cast<int>(got.bytesperline) : row;
  native_ = is_native(descriptor_, fourcc(config_.format));
  return Status::ok;
}

/// Not fatal: many cameras have one rate only. The frames' time stamps tell what they do.
void V4l2Camera::set_rate() {
  if (config_.rate_hz <= 0.0) return;
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe.numerator = 1000;
  parameters.parm.capture.timeperframe.denominator = static_cast<std::uint32_t>(std::lround(config_.rate_hz * 1000.0));
  if (v4l2_ioctl(descriptor_, VIDIOC_S_PARM, &parameters) != 0)
    problem_.set_errno("the frame rate cannot be set on", path_.data());
}

void V4l2Camera::set_control(const char* name, std::uint32_t id, std::int32_t value) {
  v4l2_control control{};
  control.id = id;
  control.value = value;
  if (v4l2_ioctl(descriptor_, VIDIOC_S_CTRL, &control) == 0) return;
  problem_.set("%s: %s cannot be set to %d: %s", path_.data(), name, value, std::strerror(errno));
}

/// Not fatal either; problem() says what the camera has not.
void V4l2Camera::set_controls() {
  using Mode = CameraControl::Mode;
  if (config_.exposure.mode == Mode::automatic) {
    set_control("automatic exposure", V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY);
  } else if (config_.exposure.mode == Mode::fixed) {
    set_control("manual exposure", V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
    set_control("exposure", V4L2_CID_EXPOSURE_ABSOLUTE, config_.exposure.value);
  }
  if (config_.gain.mode != Mode::leave) {
    set_control("automatic gain", V4L2_CID_AUTOGAIN, config_.gain.mode == Mode::automatic ? 1 : 0);
  }
  if (config_.gain.mode == Mode::fixed) set_control("gain", V4L2_CID_GAIN, config_.gain.value);
  if (config_.white_balance.mode != Mode::leave) {
    set_control("automatic white balance", V4L2_CID_AUTO_WHITE_BALANCE,
                config_.white_balance.mode == Mode::automatic ? 1 : 0);
  }
  if (config_.white_balance.mode == Mode::fixed) {
    set_control("white balance", V4L2_CID_WHITE_BALANCE_TEMPERATURE, config_.white_balance.value);
  }
}

Status V4l2Camera::map_buffers() {
  v4l2_requestbuffers request{};
  request.count = max_buffers - 1;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (v4l2_ioctl(descriptor_, VIDIOC_REQBUFS, &request) != 0) return fail(Status::device_error, "VIDIOC_REQBUFS");
  errno = ENOMEM;
  if (request.count < 2 || request.count > max_buffers)
    return fail(Status::device_error, "a useless number of buffers on");
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer{};
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    buffer.index = i;
    if (v4l2_ioctl(descriptor_, VIDIOC_QUERYBUF, &buffer) != 0) return fail(Status::device_error, "VIDIOC_QUERYBUF");
    void* memory = v4l2_mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, buffer.m.offset);
    if (memory == MAP_FAILED) return fail(Status::device_error, "mmap");
    buffers_[i] = {memory, buffer.length, false};
    buffer_count_ = i + 1;
  }
  return Status::ok;
}

Status V4l2Camera::start_streaming() {
  for (std::size_t i = 0; i < buffer_count_; ++i) {
    if (enqueue(static_cast<std::uint32_t>(i)) != 0) return fail(Status::device_error, "VIDIOC_QBUF");
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (v4l2_ioctl(descriptor_, VIDIOC_STREAMON, &type) != 0) return fail(Status::device_error, "VIDIOC_STREAMON");
  streaming_ = true;
  return Status::ok;
}

}  // namespace touchline
