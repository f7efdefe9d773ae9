// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/commands.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ostream>
#include <vector>

#include "hal/linux/device_list.h"
#include "hal/linux/gpio_lines.h"
#include "platform/host/host_error.h"
#include "platform/sbc/daemon.h"
#include "platform/sbc/goal_yaw_file.h"
#include "platform/sbc/service.h"
#include "platform/sbc/udp_address.h"

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

/// What may well be right on the robot, where this is checked on another machine.
void add_notes_of_this_machine(const RobotFile& file, std::vector<std::string>& notes) {
  const long cores = ::sysconf(_SC_NPROCESSORS_CONF);
  if (cores > 0 && file.realtime.cpu >= cores) {
    notes.push_back("[realtime] cpu = " + std::to_string(file.realtime.cpu) + ": this machine has the cores 0 to " +
                    std::to_string(cores - 1));
  }
  for (const std::string& text : file.output.udp) {
    UdpAddress address;
    if (!parse_udp_address(text, address).empty() || address.find_interface()) continue;
    notes.push_back("[output] udp \"" + text + "\": this machine has no network interface " + address.interface());
  }
  if (file.panel_backend == PanelBackend::none) return;
  const std::string problem = GoalYawFile(file.goal_yaw_file, file.imu_keeps_zero).folder_problem();
  if (!problem.empty()) notes.push_back("[panel] state_file: " + problem);
}

void section(std::ostream& out, const char* title, const std::string& text) {
  out << title << "\n" << (text.empty() ? "  none found\n" : text);
}

}  // namespace

int run_robot(const RunCommand& command, std::ostream& err) {
  const Signals signals;
  Daemon daemon(command.file, STDOUT_FILENO, STDERR_FILENO);
  for (const std::string& sentence : daemon.file().notes) {
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
  std::vector<std::string> notes = file.notes;
  add_notes_of_this_machine(file, notes);
  out << path << (notes.empty() ? " is good.\n" : " has no mistake, but see the notes:\n");
  for (const std::string& sentence : notes) out << "  note: " << sentence << "\n";
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
