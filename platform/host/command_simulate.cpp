// SPDX-License-Identifier: Apache-2.0
#include "platform/host/command_simulate.h"

#include <memory>
#include <ostream>

#include "platform/host/host_error.h"
#include "platform/host/sim/data_set_writer.h"

namespace touchline::host {
namespace {

sim::DataSetHead make_head(const SimulateCommand& command) {
  sim::DataSetHead head;
  const auto field = field_preset(command.field);
  if (!field) {
    throw HostError("--field " + command.field +
                    ": no such preset; use acyut-5x3, kidsize-9x6, small-2026 or middle-2026");
  }
  const auto camera = sim::camera_model(command.camera);
  if (!camera) {
    throw HostError("--camera " + command.camera +
                    ": no such camera; use fisheye-185, fisheye-185-qvga, fisheye-140 or fisheye-140-kb");
  }
  head.name = "sim-" + command.kind + "-" + command.field + "-" + std::to_string(command.seed);
  head.field_name = command.field;
  head.field = *field;
  head.camera = *camera;
  head.jpeg_quality = command.jpeg_quality;
  return head;
}

int write_walk(const SimulateCommand& command, sim::DataSetHead head) {
  if (!(command.seconds >= 0.0 && command.seconds <= 3600.0)) throw HostError("--seconds: give 0 to 3600");
  if (!(command.frames_per_second >= 5.0 && command.frames_per_second <= 100.0))
    throw HostError("--fps: give 5 to 100");
  sim::WalkScenarioOptions options = sim::acceptance_walk(head.field, head.camera, command.seed);
  options.frames_per_second = static_cast<float>(command.frames_per_second);
  options.yaw = command.yaw;
  options.kidnap_at_s = command.kidnap_at_s;
  const auto walk = std::make_unique<sim::WalkScenario>(options);
  head.protocol = Protocol::sequence;
  head.mount = options.walk.camera;
  sim::DataSetWriter writer(command.out, head);
  const int frames = static_cast<int>(command.seconds * command.frames_per_second) + 1;
  for (int i = 0; i < frames; ++i) writer.add(walk->next(), walk->scene(), walk->lens());
  return writer.frames();
}

int write_poses(const SimulateCommand& command, sim::DataSetHead head) {
  if (command.count < 1 || command.count > 100000) throw HostError("--count: give 1 to 100000");
  sim::PoseScenarioOptions options;
  options.field = head.field;
  options.camera = head.camera;
  options.seed = command.seed;
  options.yaw = command.yaw;
  const auto poses = std::make_unique<sim::PoseScenario>(options);
  head.mount.height = 0.58F;
  head.mount.pitch = radians(30.0F);
  sim::DataSetWriter writer(command.out, head);
  for (int i = 0; i < command.count; ++i) writer.add(poses->frame(i), poses->scene(), poses->lens());
  return writer.frames();
}

}  // namespace

int run_simulate(const SimulateCommand& command, std::ostream& out) {
  if (command.kind != "walk" && command.kind != "poses")
    throw HostError("--kind " + command.kind + ": use walk or poses");
  if (command.jpeg_quality < 0 || command.jpeg_quality > 100) throw HostError("--jpeg: give 1 to 100, or 0 for PNG");
  const sim::DataSetHead head = make_head(command);
  const int frames = command.kind == "walk" ? write_walk(command, head) : write_poses(command, head);
  out << command.out << ": " << frames << " frames, " << head.field_name << ", " << command.camera << ", seed "
      << command.seed << "\n";
  return 0;
}

}  // namespace touchline::host
