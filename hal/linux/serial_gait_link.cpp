// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/serial_gait_link.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

namespace touchline {
namespace {

struct Baud {
  int rate;
  speed_t code;
};
constexpr Baud bauds[] = {{9600, B9600},       {19200, B19200},     {38400, B38400},     {57600, B57600},
                          {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},
                          {576000, B576000},   {921600, B921600},   {1000000, B1000000}, {1500000, B1500000},
                          {2000000, B2000000}, {3000000, B3000000}, {4000000, B4000000}};

const Baud* find_baud(int rate) {
  for (const Baud& baud : bauds) {
    if (baud.rate == rate) return &baud;
  }
  return nullptr;
}

}  // namespace

bool is_known_baud(int baud) { return find_baud(baud) != nullptr; }

Status SerialGaitLink::fail(Status status, const char* what) {
  problem_.set_errno(what, config_.device.c_str());
  last_error_ = status;
  do_close();
  return status;
}

Status SerialGaitLink::do_open() {
  if (descriptor_ >= 0) return Status::ok;
  problem_.clear();
  descriptor_ = ::open(config_.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) return fail(Status::disconnected, "open");
  const Status status = configure_port();
  if (status != Status::ok) return status;
  stream_.line_reset();
  arrival_ = framed_ = clock_.now();
  ++opened_;
  return Status::ok;
}

/// Raw bytes, 8N1, no flow control, no modem lines; nobody else may open the port meanwhile.
Status SerialGaitLink::configure_port() {
  const Baud* baud = find_baud(config_.baud);
  errno = EINVAL;
  if (baud == nullptr) return fail(Status::invalid_argument, "a baud rate that is not offered for");
  termios settings{};
  if (tcgetattr(descriptor_, &settings) != 0) return fail(Status::device_error, "not a serial port:");
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CRTSCTS);
  settings.c_cc[VMIN] = 1;  // then 0 bytes mean that the line was hung up, and nothing else
  settings.c_cc[VTIME] = 0;
  if (cfsetspeed(&settings, baud->code) != 0) return fail(Status::device_error, "cfsetspeed");
  if (tcsetattr(descriptor_, TCSANOW, &settings) != 0) return fail(Status::device_error, "tcsetattr");
  if (ioctl(descriptor_, TIOCEXCL) != 0) return fail(Status::device_error, "TIOCEXCL");
  tcflush(descriptor_, TCIFLUSH);  // what waited from before would come with a false time
  return Status::ok;
}

void SerialGaitLink::do_close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  size_ = 0;
  next_ = 0;
}

/// ok: there are bytes. not_ready: none wait.
Status SerialGaitLink::refill() {
  const ssize_t count = ::read(descriptor_, bytes_.data(), bytes_.size());
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return Status::not_ready;
  if (count == 0) errno = EIO;
  if (count <= 0) return fail(Status::disconnected, "the line is gone:");
  size_ = static_cast<std::size_t>(count);
  next_ = 0;
  arrival_ = clock_.now();
  return Status::ok;
}

Result<GaitSample> SerialGaitLink::do_read() {
  if (descriptor_ < 0) return Status::disconnected;
  for (int i = 0; i < max_chunks; ++i) {
    while (next_ < size_) {
      const Result<GaitSample> sample = stream_.push(bytes_[next_++], arrival_);
      if (!sample.ok() && sample.status() != Status::stale) continue;
      framed_ = arrival_;
      if (sample.ok()) return sample;
    }
    const Status status = refill();
    if (status != Status::ok) return status;
  }
  return Status::not_ready;
}

const char* SerialGaitLink::silence() const {
  if (descriptor_ < 0 || arrival_ == framed_) return "no bytes arrive";
  return "bytes arrive, but no frame: compare gait.baud with the controller's, and what it sends with touchline_gait.h";
}

DeviceHealth SerialGaitLink::do_health() const {
  DeviceHealth health = stream_.counts();
  health.open = descriptor_ >= 0;
  health.opened = opened_;
  if (last_error_ != Status::ok) health.last_error = last_error_;
  return health;
}

}  // namespace touchline
