// SPDX-License-Identifier: Apache-2.0
// A camera on libv4l2: memory-mapped streaming, frames read in the driver's own buffers. YUYV and the other formats
// that the device has itself cost no copy; what it has not is converted by libv4l2, which copies and may allocate.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/linux/problem.h"

struct v4l2_buffer;  // of <linux/videodev2.h>, which stays out of headers

namespace touchline {

/// A control that the camera either runs by itself or holds at a value.
struct CameraControl {
  enum class Mode : std::uint8_t { leave, automatic, fixed };
  Mode mode = Mode::leave;
  std::int32_t value = 0;  // of Mode::fixed
};

struct V4l2CameraConfig {
  std::string device = "/dev/video0";  // a path, or the card's name as `touchline devices` prints it
  int input = -1;                      // of a device with several; -1: leave
  int width = 640;
  int height = 480;
  PixelFormat format = PixelFormat::yuyv;
  double rate_hz = 30.0;        // 0: leave
  CameraControl exposure;       // 100 microseconds
  CameraControl gain;           // the driver's units
  CameraControl white_balance;  // kelvin
};

class V4l2Camera final : public Camera {
 public:
  V4l2Camera(const V4l2CameraConfig& config, Clock& clock) : config_(config), clock_(clock) {}
  ~V4l2Camera() override { stop(); }
  V4l2Camera(const V4l2Camera&) = delete;
  V4l2Camera& operator=(const V4l2Camera&) = delete;

  /// What went wrong last, for the log; also what is no failure, like a control that the camera has not.
  [[nodiscard]] const char* problem() const { return problem_.text(); }
  /// The device converts nothing: frames come in the driver's format. Known once open.
  [[nodiscard]] bool native() const { return native_; }
  /// Path of the device in use.
  [[nodiscard]] const char* path() const { return path_.data(); }

 private:
  /// Four in the driver while one is read; more only makes old frames.
  static constexpr std::size_t max_buffers = 6;
  struct Buffer {
    void* memory = nullptr;
    std::size_t size = 0;
    bool lent = false;
  };

  Status do_open() override;
  void do_close() override;
  Result<CameraFrame> do_acquire(MonotonicNs deadline) override;
  Status do_release(const CameraFrame& frame) override;
  DeviceHealth do_health() const override { return health_; }

  Status open_device();
  Status check_capabilities();
  Status set_format();
  void set_rate();
  void set_controls();
  void set_control(const char* name, std::uint32_t id, std::int32_t value);
  Status map_buffers();
  Status start_streaming();
  Status wait_for_frame(MonotonicNs deadline);
  Result<CameraFrame> take_newest();
  int dequeue(v4l2_buffer& buffer);
  int enqueue(std::uint32_t index);
  CameraFrame describe(const v4l2_buffer& buffer);
  Status fail(Status status, const char* what);
  Status gone(const char* what);
  void stop();

  V4l2CameraConfig config_;
  Clock& clock_;
  Problem problem_;
  DeviceHealth health_;
  std::array<char, 64> path_{};
  int descriptor_ = -1;
  bool streaming_ = false;
  bool native_ = false;
  int stride_ = 0;
  std::array<Buffer, max_buffers> buffers_{};
  std::size_t buffer_count_ = 0;
  bool has_sequence_ = false;
  std::uint32_t last_sequence_ = 0;
};

}  // namespace touchline
