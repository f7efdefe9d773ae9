// SPDX-License-Identifier: Apache-2.0
// A HID device that this program plays by /dev/uhid: the kernel takes it for a real one, with hidraw node and drivers.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace touchline::vm {

class UhidDevice {
 public:
  using Bytes = std::vector<std::uint8_t>;
  /// Answers to GET_REPORT (report id first), and what is done at SET_REPORT. Called from the device's own thread.
  std::function<Bytes(std::uint8_t)> on_get = [](std::uint8_t) { return Bytes{}; };
  std::function<void(const Bytes&)> on_set = [](const Bytes&) {};

  UhidDevice(std::string name, std::uint16_t vendor, std::uint16_t product, Bytes descriptor);
  ~UhidDevice() { unplug(); }
  UhidDevice(const UhidDevice&) = delete;
  UhidDevice& operator=(const UhidDevice&) = delete;

  bool plug_in();
  void unplug();
  /// True once somebody has opened it.
  [[nodiscard]] bool is_open() const { return open_; }
  void send(const Bytes& report);

 private:
  void serve();

  std::string name_;
  std::uint16_t vendor_, product_;
  Bytes descriptor_;
  int file_ = -1;
  std::atomic<bool> open_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The vendor report's IMU, 1209:0001.
class UhidImu {
 public:
  UhidImu();
  bool plug_in() { return device_.plug_in(); }
  void unplug() { device_.unplug(); }
  /// `garbled`: with a wrong checksum.
  void send(float yaw, bool garbled = false);

 private:
  UhidDevice device_;
  std::uint8_t sequence_ = 0;
};

/// A Silicon Labs CP2112 as far as its GPIO goes: eight lines behind the kernel's own driver.
class UhidGpio {
 public:
  UhidGpio();
  bool plug_in() { return device_.plug_in(); }
  void unplug() { device_.unplug(); }
  void set_line(unsigned line, bool high);
  /// What the driver has set last.
  [[nodiscard]] bool line(unsigned number) const { return ((levels_ >> number) & 1) != 0; }

 private:
  std::atomic<unsigned> levels_{0xFF};
  std::atomic<unsigned> outputs_{0};
  UhidDevice device_;
};

}  // namespace touchline::vm
