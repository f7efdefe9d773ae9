// SPDX-License-Identifier: Apache-2.0
#include "tests/support/fake_v4l2.h"

#include <libv4l2.h>
#include <linux/videodev2.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>

namespace touchline::fake {
namespace {

V4l2 the_fake;

int query_capability(V4l2& fake, v4l2_capability& capability) {
  std::string card;
  for (const auto& [path, name] : fake.devices) card = name;
  std::strncpy(reinterpret_cast<char*>(capability.card), card.c_str(), sizeof capability.card - 1);
  capability.capabilities = fake.capabilities;
  return 0;
}

int set_format(V4l2& fake, v4l2_format& format) {
  v4l2_pix_format& pix = format.fmt.pix;
  if (fake.offered_width != 0) pix.width = fake.offered_width;
  if (fake.offered_format != 0) pix.pixelformat = fake.offered_format;
  pix.bytesperline = pix.width * (pix.pixelformat == V4L2_PIX_FMT_YUYV ? 2 : 3);
  pix.sizeimage = pix.bytesperline * pix.height;
  fake.image_bytes = pix.sizeimage;
  return 0;
}

int request_buffers(V4l2& fake, v4l2_requestbuffers& request) {
  if (fake.granted_buffers != 0) request.count = fake.granted_buffers;
  fake.driver_buffers.reserve(64);  // so that the fake itself leaves the heap alone while streaming
  fake.memory.assign(request.count, std::vector<std::uint8_t>(fake.image_bytes));
  return 0;
}

int query_buffer(V4l2& fake, v4l2_buffer& buffer) {
  buffer.length = fake.image_bytes;
  buffer.m.offset = buffer.index;
  return 0;
}

int dequeue(V4l2& fake, v4l2_buffer& buffer) {
  if (!fake.present) return errno = ENODEV, -1;
  if (fake.frames.empty() || fake.driver_buffers.empty()) return errno = EAGAIN, -1;
  const V4l2Frame frame = fake.frames.front();
  fake.frames.pop_front();
  char byte = 0;
  if (read(fake.descriptor, &byte, 1) != 1) return errno = EIO, -1;
  buffer.index = fake.driver_buffers.front();
  fake.driver_buffers.erase(fake.driver_buffers.begin());
  --fake.queued;
  auto& memory = fake.memory[buffer.index];
  std::fill(memory.begin(), memory.end(), frame.fill);
  buffer.sequence = frame.sequence;
  buffer.flags = frame.flags;
  buffer.bytesused = frame.bytes_used != 0 ? frame.bytes_used : fake.image_bytes;
  buffer.timestamp.tv_sec = static_cast<decltype(buffer.timestamp.tv_sec)>(frame.time_ns / 1'000'000'000);
  buffer.timestamp.tv_usec = static_cast<decltype(buffer.timestamp.tv_usec)>(frame.time_ns % 1'000'000'000 / 1000);
  return 0;
}

int enumerate_format(V4l2& fake, v4l2_fmtdesc& entry) {
  if (entry.index > 1) return errno = EINVAL, -1;
  entry.pixelformat = entry.index == 0 ? V4L2_PIX_FMT_YUYV : V4L2_PIX_FMT_RGB24;
  entry.flags = fake.emulated ? V4L2_FMT_FLAG_EMULATED : 0U;
  std::strcpy(reinterpret_cast<char*>(entry.description), "fake");
  return 0;
}

int dispatch(V4l2& fake, unsigned long request, void* argument) {
  switch (request) {
    case VIDIOC_QUERYCAP: return query_capability(fake, *static_cast<v4l2_capability*>(argument));
    case VIDIOC_ENUM_FMT: return enumerate_format(fake, *static_cast<v4l2_fmtdesc*>(argument));
    case VIDIOC_S_FMT: return set_format(fake, *static_cast<v4l2_format*>(argument));
    case VIDIOC_REQBUFS: return request_buffers(fake, *static_cast<v4l2_requestbuffers*>(argument));
    case VIDIOC_QUERYBUF: return query_buffer(fake, *static_cast<v4l2_buffer*>(argument));
    case VIDIOC_DQBUF: return dequeue(fake, *static_cast<v4l2_buffer*>(argument));
    case VIDIOC_QBUF:
      if (!fake.present) return errno = ENODEV, -1;
      fake.driver_buffers.push_back(static_cast<v4l2_buffer*>(argument)->index);
      ++fake.queued;
      return 0;
    case VIDIOC_STREAMON: return ++fake.streams_started, 0;
    case VIDIOC_STREAMOFF: return --fake.streams_started, 0;
    case VIDIOC_S_CTRL: {
      const auto& control = *static_cast<v4l2_control*>(argument);
      fake.controls[control.id] = control.value;
      return 0;
    }
    case VIDIOC_S_PARM:
    case VIDIOC_S_INPUT: return 0;
    default: return errno = ENOTTY, -1;
  }
}

}  // namespace

V4l2& v4l2() { return the_fake; }

void reset_v4l2() {
  if (the_fake.descriptor >= 0) close(the_fake.descriptor);
  if (the_fake.peer >= 0) close(the_fake.peer);
  the_fake = V4l2();
}

void V4l2::push(const V4l2Frame& frame) {
  frames.push_back(frame);
  if (write(peer, "f", 1) != 1) std::abort();
}

void V4l2::unplug() {
  present = false;
  if (peer >= 0) close(peer);
  peer = -1;
}

}  // namespace touchline::fake

using touchline::fake::v4l2;

extern "C" {

int v4l2_open(const char* file, int, ...) {
  auto& fake = v4l2();
  if (fake.fail_open != 0) return errno = fake.fail_open, -1;
  if (!fake.present || !fake.devices.contains(file)) return errno = ENOENT, -1;
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends) != 0) return -1;
  fake.descriptor = ends[0];
  fake.peer = ends[1];
  fake.frames.clear();
  fake.driver_buffers.clear();
  fake.queued = 0;
  ++fake.open_handles;
  if (fake.spurious_ready && write(fake.peer, "x", 1) != 1) return -1;
  return fake.descriptor;
}

int v4l2_close(int descriptor) {
  auto& fake = v4l2();
  if (descriptor != fake.descriptor) return errno = EBADF, -1;
  close(fake.descriptor);
  if (fake.peer >= 0) close(fake.peer);
  fake.descriptor = fake.peer = -1;
  --fake.open_handles;
  return 0;
}

int v4l2_ioctl(int descriptor, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  auto& fake = v4l2();
  if (descriptor != fake.descriptor) return errno = EBADF, -1;
  const auto failure = fake.failing.find(request);
  if (failure != fake.failing.end()) return errno = failure->second, -1;
  return touchline::fake::dispatch(fake, request, argument);
}

void* v4l2_mmap(void*, size_t, int, int, int, int64_t offset) {
  auto& fake = v4l2();
  if (fake.fail_mmap) return errno = ENOMEM, MAP_FAILED;
  ++fake.mapped;
  return fake.memory[static_cast<std::size_t>(offset)].data();
}

int v4l2_munmap(void*, size_t) {
  --v4l2().mapped;
  return 0;
}
}
