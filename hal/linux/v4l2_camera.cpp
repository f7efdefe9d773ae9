// SPDX-License-Identifier: Apache-2.0
// Streaming of V4l2Camera: waiting, lending, giving back. Opening and setting up is in v4l2_camera_setup.cpp.
#include "hal/linux/v4l2_camera.h"

#include <libv4l2.h>
#include <linux/videodev2.h>
#include <poll.h>

namespace touchline {
namespace {

/// Milliseconds for poll(), rounded up so that a wait does not spin at its end; never forever.
int poll_timeout(MonotonicNs remaining) {
  if (remaining <= 0) return 0;
  const MonotonicNs ms = (remaining + one_millisecond - 1) / one_millisecond;
  return ms > 60'000 ? 60'000 : static_cast<int>(ms);
}

v4l2_buffer capture_buffer() {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

bool another_waits(int descriptor) {
  pollfd ready{descriptor, POLLIN, 0};
  return poll(&ready, 1, 0) == 1 && (ready.revents & POLLIN) != 0;
}

}  // namespace

Result<CameraFrame> V4l2Camera::do_acquire(MonotonicNs deadline) {
  if (descriptor_ < 0) return Status::disconnected;
  std::size_t lent = 0;
  for (std::size_t i = 0; i < buffer_count_; ++i) lent += buffers_[i].lent ? 1U : 0U;
  if (lent == buffer_count_) return Status::capacity;
  // Bounded: a driver that says "ready" and then has nothing gets as many tries as it has buffers.
  for (std::size_t tries = 0; tries <= max_buffers; ++tries) {
    const Status waited = wait_for_frame(deadline);
    if (waited != Status::ok) return waited;
    const Result<CameraFrame> frame = take_newest();
    if (frame.status() != Status::not_ready) return frame;
  }
  return Status::timeout;
}

Status V4l2Camera::wait_for_frame(MonotonicNs deadline) {
  pollfd ready{descriptor_, POLLIN, 0};
  const int count = poll(&ready, 1, poll_timeout(deadline - clock_.now()));
  if (count < 0) return errno == EINTR ? Status::timeout : gone("poll");  // a signal: the caller decides what it means
  if (count == 0) return Status::timeout;
  if ((ready.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) {
    errno = ENODEV;
    return gone("poll");
  }
  return Status::ok;
}

int V4l2Camera::dequeue(v4l2_buffer& buffer) {
  buffer = capture_buffer();
  return v4l2_ioctl(descriptor_, VIDIOC_DQBUF, &buffer);
}

int V4l2Camera::enqueue(std::uint32_t index) {
  v4l2_buffer buffer = capture_buffer();
  buffer.index = index;
  return v4l2_ioctl(descriptor_, VIDIOC_QBUF, &buffer);
}

/// Takes all frames that wait, gives all but the newest back. not_ready: none waited.
Result<CameraFrame> V4l2Camera::take_newest() {
  CameraFrame newest;
  bool found = false;
  std::uint32_t passed_over = 0;
  std::uint32_t lost = 0;
  for (std::size_t i = 0; i < buffer_count_; ++i) {
    // Asked first, since libv4l2 writes a line to standard error for each try that finds nothing.
    if (found && !another_waits(descriptor_)) break;
    v4l2_buffer buffer{};
    if (dequeue(buffer) != 0) {
      if (errno == EAGAIN) break;
      return gone("VIDIOC_DQBUF");
    }
    errno = EINVAL;
    if (buffer.index >= buffer_count_) return fail(Status::device_error, "a buffer that was never mapped");
    if (found) {
      buffers_[newest.buffer].lent = false;
      ++passed_over;
      if (enqueue(newest.buffer) != 0) return gone("VIDIOC_QBUF");
    }
    newest = describe(buffer);
    lost += newest.lost;
    found = true;
    buffers_[buffer.index].lent = true;
    if (!native_) break;  // each further frame would be converted only to be passed over
  }
  if (!found) return Status::not_ready;
  newest.skipped = passed_over;
  newest.lost = lost;
  health_.skipped += passed_over;
  health_.lost += lost;
  health_.last_datum = newest.time;
  ++(newest.error ? health_.corrupt : health_.received);
  return newest;
}

CameraFrame V4l2Camera::describe(const v4l2_buffer& buffer) {
  CameraFrame frame;
  const Buffer& memory = buffers_[buffer.index];
  frame.image = {config_.format, static_cast<const std::uint8_t*>(memory.memory), config_.width, config_.height,
                 stride_};
  const bool monotonic = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const MonotonicNs stamp =
      MonotonicNs{buffer.timestamp.tv_sec} * one_second + MonotonicNs{buffer.timestamp.tv_usec} * 1000;
  const MonotonicNs now = clock_.now();
  frame.time = monotonic && stamp <= now && stamp > 0 ? stamp : now;
  frame.sequence = buffer.sequence;
  frame.lost = has_sequence_ && buffer.sequence > last_sequence_ ? buffer.sequence - last_sequence_ - 1 : 0;
  has_sequence_ = true;
  last_sequence_ = buffer.sequence;
  const std::size_t needed = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(config_.height);
  frame.error = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 || buffer.bytesused < needed || memory.size < needed;
  frame.buffer = buffer.index;
  return frame;
}

Status V4l2Camera::do_release(const CameraFrame& frame) {
  if (descriptor_ < 0) return Status::disconnected;
  if (frame.buffer >= buffer_count_ || !buffers_[frame.buffer].lent) return Status::invalid_argument;
  buffers_[frame.buffer].lent = false;
  return enqueue(frame.buffer) == 0 ? Status::ok : gone("VIDIOC_QBUF");
}

Status V4l2Camera::fail(Status status, const char* what) {
  problem_.set_errno(what, path_[0] != '\0' ? path_.data() : config_.device.c_str());
  health_.last_error = status;
  stop();
  return status;
}

Status V4l2Camera::gone(const char* what) { return fail(Status::disconnected, what); }

void V4l2Camera::do_close() { stop(); }

void V4l2Camera::stop() {
  if (streaming_) {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    v4l2_ioctl(descriptor_, VIDIOC_STREAMOFF, &type);  // of a device that is gone it fails, and nothing is to be done
  }
  for (Buffer& buffer : buffers_) {
    if (buffer.memory != nullptr) v4l2_munmap(buffer.memory, buffer.size);
    buffer = {};
  }
  if (descriptor_ >= 0) v4l2_close(descriptor_);
  buffer_count_ = 0;
  streaming_ = false;
  has_sequence_ = false;
  descriptor_ = -1;
  health_.open = false;
}

}  // namespace touchline
