// SPDX-License-Identifier: Apache-2.0
// The robot's application on the simulator's devices, with a kidnap in the middle.
#include "platform/host/demo.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <ostream>
#include <vector>

#include <nlohmann/json.hpp>

#include "platform/host/canvas.h"
#include "platform/host/command_line.h"
#include "platform/host/contact_sheet.h"
#include "platform/host/field_map.h"
#include "platform/host/host_error.h"
#include "platform/host/pose_error.h"
#include "platform/host/sim/sim_devices.h"
#include "platform/host/stage_clock.h"
#include "platform/robot/robot_loop.h"
#include "vision/pipeline_storage.h"

namespace touchline::host {
namespace {

/// Passes a camera through and keeps a copy of the picture that was lent last: the application gives it back before
/// anybody could draw on it.
class KeepingCamera final : public Camera {
 public:
  explicit KeepingCamera(Camera& camera) : camera_(camera) {}
  [[nodiscard]] const RgbImage& picture() const { return picture_; }

 private:
  Status do_open() override { return camera_.open(); }
  void do_close() override { camera_.close(); }
  Result<CameraFrame> do_acquire(MonotonicNs deadline) override {
    const Result<CameraFrame> frame = camera_.acquire(deadline);
    if (frame.ok()) {
      const FrameView& view = frame.value().image;  // RGB24 without gaps: so the simulator is told
      picture_.width = view.width;
      picture_.height = view.height;
      picture_.rgb.assign(view.data, view.data + static_cast<std::ptrdiff_t>(view.stride_bytes) * view.height);
    }
    return frame;
  }
  Status do_release(const CameraFrame& frame) override { return camera_.release(frame); }
  [[nodiscard]] DeviceHealth do_health() const override { return camera_.health(); }

  Camera& camera_;
  RgbImage picture_;
};

/// What was true and what was believed, frame by frame.
struct Track {
  std::vector<JudgedFrame> judged;
  std::vector<Pose2> truth;
  std::vector<Pose2> estimate;
};

class Demo {
 public:
  Demo(const DemoCommand& command, std::ostream& out)
      : command_(command),
        out_(out),
        options_(scenario(command)),
        robot_(options_, command.seconds),
        camera_(robot_.camera()) {
    if (!robot_.ready()) throw HostError("the simulator refuses the demo's scene");
    std::error_code failed;
    std::filesystem::create_directories(command_.output, failed);
    if (failed)
      throw HostError(command_.output + ": cannot be made: " + failed.message() + "; choose another --output");
  }

  int run() {
    RobotLoop loop({&camera_, &robot_.imu(), &robot_.gait(), &robot_.panel(), &robot_.clock()}, storage_.memory(),
                   localizer_);
    const char* what = nullptr;
    const Status status = loop.configure(robot_config(), &what);
    if (status != Status::ok) {
      throw HostError(std::string("the demo's robot is refused: ") +
                      (what != nullptr ? what : touchline::to_string(status)));
    }
    RobotReport report;
    for (Status turn = Status::ok; turn != Status::end_of_data;) {
      turn = loop.turn(report, &clock_);
      if (turn == Status::ok && report.from_frame) use(report, loop.vision());
    }
    if (command_.live) out_ << "\n";
    write_field();
    return tell_result();
  }

 private:
  static sim::WalkScenarioOptions scenario(const DemoCommand& command) {
    const auto field = field_preset("acyut-5x3");
    const auto camera = sim::camera_model("fisheye-185");
    if (!field || !camera) throw HostError("the demo's field or camera is not known");
    sim::WalkScenarioOptions options = sim::acceptance_walk(*field, *camera, command.seed);
    options.kidnap_at_s = command.seconds / 2.0;
    return options;
  }

  [[nodiscard]] RobotConfig robot_config() const {
    RobotConfig config;
    config.vision.frame_width = options_.camera.width;
    config.vision.frame_height = options_.camera.height;
    tell_vision(options_.walk.field, config.vision);
    config.lens = options_.camera.lens;
    config.field = options_.walk.field;
    config.seed = command_.seed;
    const CameraPose& rest = options_.walk.camera;
    config.mount.x = rest.x;
    config.mount.y = rest.y;
    config.mount.height = rest.height;
    config.mount.yaw = rest.yaw;
    config.mount.pitch = rest.pitch;
    config.mount.roll = rest.roll;
    config.goal_yaw_known = true;
    config.goal_yaw = options_.imu.goal_yaw;
    return config;
  }

  void use(const RobotReport& step, const VisionResult& vision) {
    const sim::SimFrame& truth = robot_.truth();
    const PoseError error = judge(truth.truth, step.estimate);
    track_.judged.push_back({truth.time_s, truth.kidnapped, error});
    track_.truth.push_back(truth.truth);
    if (step.estimate.valid) track_.estimate.push_back(step.estimate.pose);
    tell(truth, step, error);
    const std::size_t seen = vision.features->junctions.size();
    if (step.estimate.settled && seen > most_seen_) {  // the sheet shows the frame with the most to see
      most_seen_ = seen;
      write_sheet(step, vision);
    }
  }

  void tell(const sim::SimFrame& truth, const RobotReport& step, const PoseError& error) {
    const bool whole_second =
        static_cast<int>(truth.time_s) != static_cast<int>(last_told_s_) || track_.judged.size() == 1;
    if (truth.kidnapped)
      out_ << (command_.live ? "\n" : "")
           << "         the robot is picked up and put down elsewhere; nobody tells it\n";
    if (!command_.live && !whole_second && !truth.kidnapped) return;
    last_told_s_ = truth.time_s;
    char text[200];
    const Pose2& t = truth.truth;
    const Pose2& e = step.estimate.pose;
    const auto number = [](float v) { return static_cast<double>(v); };
    int length = std::snprintf(text, sizeof text, "%5.1f s  truth %6.2f %6.2f m %6.1f deg   ", truth.time_s,
                               number(t.x), number(t.y), number(degrees(t.theta)));
    const auto rest = sizeof text - static_cast<std::size_t>(length);
    if (step.estimate.valid) {
      std::snprintf(text + length, rest, "estimate %6.2f %6.2f m %6.1f deg   off by %5.3f m %5.1f deg, confidence %.2f",
                    number(e.x), number(e.y), number(degrees(e.theta)), error.distance_m, error.angle_deg,
                    number(step.estimate.confidence));
    } else {
      std::snprintf(text + length, rest, "%-75s", "no pose");
    }
    out_ << (command_.live ? "\r" : "") << text << (command_.live ? "" : "\n") << std::flush;
  }

  std::vector<Pose2> particles() {
    std::vector<Pose2> out;
    const ParticleView view = localizer_.particles();
    out.reserve(static_cast<std::size_t>(view.count));
    for (int i = 0; i < view.count; ++i) out.push_back(view.pose(i));
    return out;
  }

  void write_sheet(const RobotReport& step, const VisionResult& vision) {
    const std::vector<Pose2> poses = particles();
    ContactSheetInput input;
    input.picture = &camera_.picture();
    input.vision = &vision;
    input.field = &localizer_.field();
    input.estimate = step.estimate;
    input.particles = poses;
    write_png(file("stages.png"), draw_contact_sheet(input));
  }

  void write_field() {
    Canvas canvas(1120, 740, colours::dark);
    FieldMap map(canvas, localizer_.field(), 10, 50, 1100, 680);
    map.landmarks(colours::yellow);
    map.particles(particles(), colours::orange);
    map.path(track_.truth, colours::cyan, 4);
    map.path(track_.estimate, colours::red, 2);
    if (!track_.truth.empty()) map.pose(track_.truth.back(), colours::cyan, 0.06F);
    if (!track_.estimate.empty()) map.pose(track_.estimate.back(), colours::red, 0.05F);
    canvas.text(12, 8, "truth", colours::cyan, 2);
    canvas.text(100, 8, "estimate", colours::red, 2);
    canvas.text(220, 8, "particles at the end", colours::orange, 2);
    canvas.text(480, 8, "landmarks", colours::yellow, 2);
    for (std::size_t i = 1; i < track_.judged.size(); ++i) {
      if (!track_.judged[i].kidnap) continue;
      const DrawPoint from = map.place({track_.truth[i - 1].x, track_.truth[i - 1].y});
      const DrawPoint to = map.place({track_.truth[i].x, track_.truth[i].y});
      canvas.arrow(from, to, colours::pink, 2);
      canvas.label(static_cast<int>((from.x + to.x) * 0.5F), static_cast<int>((from.y + to.y) * 0.5F), "kidnap",
                   colours::pink, 2);
    }
    write_png(file("field.png"), canvas.image());
  }

  int tell_result() {
    const SequenceScore score = judge_sequence(track_.judged);
    int wrong_half = 0;
    int outside = 0;
    for (const auto& frame : track_.judged) {
      wrong_half += frame.error.wrong_half ? 1 : 0;
      outside += frame.error.outside_3_sigma ? 1 : 0;
    }
    nlohmann::ordered_json back = nlohmann::ordered_json::array();
    bool is_back = true;
    for (const auto& seconds : score.back_s) {
      back.push_back(seconds ? nlohmann::ordered_json(*seconds) : nlohmann::ordered_json(nullptr));
      is_back = is_back && seconds.has_value();
    }
    nlohmann::ordered_json us = nlohmann::ordered_json::object();
    const StageTimes times = clock_.times();
    for (std::size_t i = 0; i < stage_count; ++i) us[touchline::to_string(static_cast<Stage>(i))] = times[i];
    const nlohmann::ordered_json summary = {{"seconds", command_.seconds},
                                            {"seed", command_.seed},
                                            {"field", "acyut-5x3"},
                                            {"frames", track_.judged.size()},
                                            {"rmse_m", score.rmse_m},
                                            {"rmse_deg", score.rmse_deg},
                                            {"frames_that_count", score.counted},
                                            {"frames_without_a_pose", score.without_pose},
                                            {"back_s", back},
                                            {"wrong_half", wrong_half},
                                            {"outside_3_sigma", outside},
                                            {"us_mean", us}};
    std::ofstream out(file("summary.json"));
    out << summary.dump(2) << "\n";
    if (!out.flush()) throw HostError(file("summary.json").string() + ": cannot be written; check the space left");
    char text[200];
    if (score.counted > score.without_pose) {
      std::snprintf(text, sizeof text, "RMSE %.3f m %.2f deg over %d frames; ", score.rmse_m, score.rmse_deg,
                    score.counted);
      out_ << text;
    } else {
      out_ << "no pose in the " << score.counted << " frames that count; ";
    }
    for (const auto& seconds : score.back_s) {
      std::snprintf(text, sizeof text, seconds ? "back %.2f s after the kidnap; " : "never back after the kidnap; ",
                    seconds.value_or(0.0));
      out_ << text;
    }
    out_ << "pictures in " << command_.output << "/\n";
    return is_back ? exit_ok : exit_missed;
  }

  [[nodiscard]] std::filesystem::path file(const char* name) const {
    return std::filesystem::path(command_.output) / name;
  }

  DemoCommand command_;
  std::ostream& out_;
  sim::WalkScenarioOptions options_;
  sim::SimRobot robot_;
  KeepingCamera camera_;
  PipelineStorage<> storage_;
  Localizer localizer_;
  StageClock clock_;
  Track track_;
  std::size_t most_seen_ = 0;
  double last_told_s_ = 0.0;
};

}  // namespace

int run_demo(const DemoCommand& command, std::ostream& out) {
  return std::make_unique<Demo>(command, out)->run();  // a mebibyte of state: not on the stack
}

}  // namespace touchline::host
