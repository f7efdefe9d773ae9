// SPDX-License-Identifier: Apache-2.0
// The robot's one configuration file: which devices, which lens and mount, which field, what goes out. Every key has a
// default; the installed example, robot.toml, explains each of them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "hal/button.h"
#include "hal/linux/gpio_lines.h"
#include "hal/linux/hid_imu.h"
#include "hal/linux/serial_gait_link.h"
#include "hal/linux/v4l2_camera.h"
#include "platform/robot/robot_config.h"

namespace touchline::sbc {

enum class CameraBackend { v4l2, replay };
enum class ImuBackend { none, hidapi, replay };
enum class GaitBackend { none, serial, replay };
enum class PanelBackend { none, gpiod };

struct OutputConfig {
  bool standard_output = true;
  std::vector<std::string> udp;  // "192.168.0.5:7777", "[fe80::1%wlan0]:7777"; none: nothing leaves the robot
};

struct RealtimeConfig {
  bool lock_memory = true;
  int priority = 0;  // of SCHED_FIFO, 1 to 99; 0: the usual scheduler
  int cpu = -1;      // to stay on; -1: any
};

struct RobotFile {
  RobotConfig robot;
  CameraBackend camera_backend = CameraBackend::v4l2;
  V4l2CameraConfig camera;
  std::filesystem::path replay_folder;
  int replay_loops = 1;
  ImuBackend imu_backend = ImuBackend::none;
  HidImuConfig imu;
  GaitBackend gait_backend = GaitBackend::none;
  SerialGaitLinkConfig gait;
  PanelBackend panel_backend = PanelBackend::none;
  GpioLinesConfig panel;
  std::filesystem::path goal_yaw_file;  // where the goal's yaw is kept; empty: nowhere
  bool imu_keeps_zero = false;
  ButtonTiming button;
  OutputConfig output;
  RealtimeConfig realtime;
  std::vector<std::string> notes;  // what is no mistake, but hardly meant: lens, mount and field that are the defaults
  std::map<std::string, std::string> fixed_parts;  // the text of "[camera]" and so on: what SIGHUP does not read again
};

/// Reads and checks the whole file. Throws host::HostError: it names file, line, key and remedy. `keys`, when not null,
/// gets every key that the file may have.
RobotFile read_robot_file(const std::filesystem::path& path, std::vector<std::string>* keys = nullptr);

}  // namespace touchline::sbc
