// SPDX-License-Identifier: Apache-2.0
// A robot that stands still before one picture, inside the virtual machine: its devices can be made to fail one by one,
// and the unchanged daemon beside it is listened to. Everything is played from one thread, tick by tick.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hal/linux/monotonic_clock.h"
#include "tests/support/child_process.h"
#include "tests/vm/uhid_device.h"
#include "tests/vm/vivid.h"

namespace touchline::vm {

/// A line of the daemon, as far as the tests look at it.
struct Seen {
  std::set<std::string> faults;
  bool pose = false, from_frame = false, yaw_used = false, odometry_used = false;
  double sigma_m = 0.0;  // of x and y together
  int camera_lost = 0;
  [[nodiscard]] bool has(const std::string& fault) const { return faults.count(fault) > 0; }
};

class FaultStage {
 public:
  enum class Imu { good, silent, garbage };
  enum class Gait { good, silent, corrupt, doubled };

  /// `share` has the daemon and the walk whose first picture and reading are shown.
  explicit FaultStage(std::string share);

  // What is played; to be changed by the tests.
  UhidImu imu;
  UhidGpio panel;
  Imu imu_mode = Imu::good;
  Gait gait_mode = Gait::good;
  float yaw = 0.0F;
  std::uint8_t gait_flags = 0;
  std::uint32_t boot_id = 1;
  float walked_x = 0.0F;
  bool black = false;

  [[nodiscard]] bool ready() const { return ready_; }
  [[nodiscard]] float true_yaw() const { return true_yaw_; }
  /// The camera as the daemon sees it is a link that is there while vivid is loaded and ready.
  bool plug_in_camera();
  bool unplug_camera();
  bool control_camera(const std::string& name, int value) { return set_control(camera_, name, value); }

  /// A daemon on this robot; `more` is added to its file, `out` as in ChildProcess.
  void start_daemon(const std::string& more, int out = -1);
  [[nodiscard]] test::ChildProcess& daemon() { return *daemon_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  void write_file(const std::string& more) const;

  /// Plays on until a line fulfils the condition: seconds that took, or nothing after `seconds`.
  std::optional<double> until(double seconds, const std::function<bool(const Seen&)>& condition);
  /// Plays on until the daemon's log has this text.
  bool until_logged(double seconds, const std::string& text);
  /// Plays on for so long; the number of lines that came.
  int play(double seconds);
  [[nodiscard]] const Seen& newest() const { return newest_; }

 private:
  void tick();
  void send_gait();
  /// Every line that has come, oldest first; true at the first that fulfils the condition.
  bool listen(const std::function<bool(const Seen&)>& condition);

  MonotonicClock clock_;
  std::string share_, file_, base_, camera_;
  std::unique_ptr<VividOutput> output_;
  std::unique_ptr<test::ChildProcess> daemon_;
  std::vector<std::uint8_t> picture_, black_picture_;
  float true_yaw_ = 0.0F, height_ = 0.0F, pitch_ = 0.0F, roll_ = 0.0F;
  int serial_ = -1;
  std::uint32_t sequence_ = 0;
  MonotonicNs start_ = 0, next_tick_ = 0, next_picture_ = 0;
  Seen newest_;
  int lines_ = 0;
  bool ready_ = false;
};

}  // namespace touchline::vm
