// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/commands.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ostream>

#include "hal/linux/device_list.h"
#include "hal/linux/gpio_lines.h"
#include "platform/host/host_error.h"
#include "platform/sbc/daemon.h"
#include "platform/sbc/service.h"

namespace touchline::sbc {
namespace {

const char* name_of(ImuBackend backend) {
  return backend == ImuBackend::none ? "none" : backend == ImuBackend::hidapi ? "hidapi" : "replay";
}
const char* name_of(GaitBackend backend) {
  return backend == GaitBackend::none ? "none" : backend == GaitBackend::serial ? "serial" : "replay";
}

/// A run that ends by itself has an outcome: its lines. A reader that went away had enough.
void check_all_written(const Publisher& publisher) {
  if (publisher.lines_lost() == 0 || publisher.line_error() == EPIPE) return;
  throw host::HostError(
      "standard output: " + std::to_string(publisher.lines_lost()) + " lines did not get through: " +
      (publisher.line_error() == EAGAIN ? "the reader was too slow" : std::strerror(publisher.line_error())));
}

void section(std::ostream& out, const char* title, const std::string& text) {
  out << title << "\n" << (text.empty() ? "  none found\n" : text);
}

}  // namespace

int run_robot(const RunCommand& command, std::ostream& err) {
  const Signals signals;
  Daemon daemon(command.file, STDOUT_FILENO, STDERR_FILENO);
  for (const std::string& sentence : daemon.file().assumed) {
    err << "touchline: note: " << command.file << ": " << sentence << "\n" << std::flush;
  }
  const std::string problems = apply_realtime(daemon.file().realtime);
  if (!problems.empty()) err << problems << std::flush;
  ServiceNotifier notifier;
  notifier.ready();
  bool asked = false;
  while (!(asked = Signals::end_asked()) && daemon.turn()) {
    if (Signals::reload_asked()) daemon.reload();
    notifier.alive(daemon.now());
    if (command.frames > 0 && daemon.report().frames >= command.frames) break;
  }
  notifier.stopping();
  if (!asked) check_all_written(daemon.publisher());
  return 0;
}

int check_robot(const std::string& path, std::ostream& out) {
  const RobotFile file = read_robot_file(path);
  const bool replayed = file.camera_backend == CameraBackend::replay;
  out << path << (file.assumed.empty() ? " is good.\n" : " has no mistake, but is not all about your robot:\n");
  for (const std::string& sentence : file.assumed) out << "  note: " << sentence << "\n";
  out << "  camera  " << (replayed ? "replay of " + file.replay_folder.string() : file.camera.device) << ", "
      << file.camera.width << "x" << file.camera.height << "\n  imu     " << name_of(file.imu_backend) << "\n  gait    "
      << name_of(file.gait_backend) << "\n  panel   " << (file.panel_backend == PanelBackend::gpiod ? "gpiod" : "none")
      << "\n  field   " << file.robot.field.length << " x " << file.robot.field.width << " m\n  output  "
      << (file.output.standard_output ? "standard output" : "none") << ", " << file.output.udp.size()
      << " UDP addresses\n";
  return 0;
}

int list_devices(std::ostream& out) {
  section(out, "Cameras (camera.device: path or name)", list_cameras());
  section(out, "HID devices (imu.device: vendor:product:serial or path)", list_hid_devices());
  section(out, "Serial ports (gait.device)", list_serial_ports());
  section(out, "GPIO chips (panel.chip: path or label)", list_gpio_chips());
  return 0;
}

}  // namespace touchline::sbc
