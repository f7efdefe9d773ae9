// SPDX-License-Identifier: Apache-2.0
// Runs inside the virtual machine: the rows of the daemon's table of faults that the kernel's devices can make, on the
// unchanged daemon.  vm_faults SHARE   Each must be named, with lines going on, and be over within 2 s of the device's
// return: pictures, yaw or odometry are used again, and the fault's name is gone where it is a state. (Faults that are
// events are shown 2 s on.) The exit status is the number of checks that failed.
#include <fcntl.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>

#include "tests/hal/gait_header.h"
#include "tests/vm/fault_stage.h"

namespace touchline::vm {
namespace {

constexpr double recovery_s = 2.0;
constexpr double naming_s = 5.0;
constexpr int promised_end_ms = 1000;

int failures = 0;

bool check(bool good, const std::string& what) {
  std::printf("%s %s\n", good ? "PASS" : "FAIL", what.c_str());
  std::fflush(stdout);
  failures += good ? 0 : 1;
  return good;
}

using Judge = bool (*)(const Seen&);
bool pictures_used(const Seen& s) { return s.from_frame && s.pose; }
bool frames_used(const Seen& s) { return s.from_frame; }
bool yaw_used(const Seen& s) { return s.from_frame && s.yaw_used; }
bool odometry_used(const Seen& s) { return s.odometry_used; }
bool all_well(const Seen& s) { return s.from_frame && s.pose && s.yaw_used && s.odometry_used; }

enum class Kind { state, event };

struct Row {
  const char* fault;
  const char* how;
  Kind kind;
  Judge used_again;
  std::function<void(FaultStage&)> break_it, mend_it;
};

void run(FaultStage& stage, const Row& row) {
  const std::string name = "fault " + std::string(row.fault) + " (" + row.how + ")";
  if (!stage.until(20.0, all_well)) {
    check(false, name + ": the robot is not well before it");
    return;
  }
  (void)stage.play(0.5);
  row.break_it(stage);
  const auto named = stage.until(naming_s, [&](const Seen& s) { return s.has(row.fault); });
  const double sigma = stage.newest().sigma_m;
  const int lines = stage.play(1.5);
  const bool blind = row.kind == Kind::state && row.used_again == pictures_used;
  const bool fades = !blind || !stage.newest().pose || stage.newest().sigma_m > sigma;
  row.mend_it(stage);
  const auto well = stage.until(4.0 * recovery_s, [&](const Seen& s) {
    return row.used_again(s) && (row.kind == Kind::event || !s.has(row.fault));
  });
  char text[200];
  std::snprintf(text, sizeof text, ": named after %.1f s, %d lines meanwhile, well %.1f s after the return",
                named.value_or(-1.0), lines, well.value_or(-1.0));
  const bool lives = !stage.daemon().wait_for_end(0).has_value();
  check(named && lines >= 3 && fades && lives && well && *well <= recovery_s,
        name + text + (fades ? "" : ", but the pose was as sure as before"));
}

void camera_rows(FaultStage& stage) {
  const std::string dropped = "Percentage of Dropped Buffers";
  const Row rows[] = {
      {"camera_stalled", "vivid drops every frame", Kind::state, pictures_used,
       [&](FaultStage& s) { s.control_camera(dropped, 100); }, [&](FaultStage& s) { s.control_camera(dropped, 0); }},
      {"camera_damaged", "a buffer with the error flag", Kind::event, pictures_used,
       [](FaultStage& s) {
         for (int i = 0; i < 30; ++i) {  // the daemon takes the newest of the frames that wait: not every one is seen
           s.control_camera("Inject V4L2_BUF_FLAG_ERROR", 1);
           (void)s.play(0.05);
         }
       },
       [](FaultStage&) {}},
      {"camera_black", "black pictures", Kind::state, pictures_used, [](FaultStage& s) { s.black = true; },
       [](FaultStage& s) { s.black = false; }},
      {"camera_missing", "disconnect, module taken out and loaded", Kind::state, pictures_used,
       [](FaultStage& s) { check(s.unplug_camera(), "camera: the module can be taken out under the daemon"); },
       [](FaultStage& s) { check(s.plug_in_camera(), "camera: the module is loaded again"); }},
  };
  for (const Row& row : rows) run(stage, row);
  (void)stage.until(20.0, all_well);
  const int lost = stage.newest().camera_lost;
  stage.control_camera(dropped, 50);
  (void)stage.play(3.0);
  stage.control_camera(dropped, 0);
  check(stage.until(recovery_s, [&](const Seen& s) { return s.camera_lost > lost && pictures_used(s); }).has_value(),
        "camera: dropped frames are counted as lost, and poses go on");
}

void imu_rows(FaultStage& stage) {
  using Imu = FaultStage::Imu;
  const Row rows[] = {
      {"imu_missing", "uhid unplugged", Kind::state, yaw_used, [](FaultStage& s) { s.imu.unplug(); },
       [](FaultStage& s) { check(s.imu.plug_in(), "imu: plugged in again"); }},
      {"imu_stale", "no reports", Kind::state, yaw_used, [](FaultStage& s) { s.imu_mode = Imu::silent; },
       [](FaultStage& s) { s.imu_mode = Imu::good; }},
      {"imu_garbage", "wrong checksums", Kind::event, yaw_used, [](FaultStage& s) { s.imu_mode = Imu::garbage; },
       [](FaultStage& s) { s.imu_mode = Imu::good; }},
      {"imu_jump", "half a turn at once, and back", Kind::event, yaw_used, [](FaultStage& s) { s.yaw += 3.0F; },
       [](FaultStage& s) { s.yaw = s.true_yaw(); }},
  };
  for (const Row& row : rows) run(stage, row);
}

void gait_rows(FaultStage& stage) {
  using Gait = FaultStage::Gait;
  const auto nothing = [](FaultStage&) {};
  const auto good = [](FaultStage& s) { s.gait_mode = Gait::good; };
  const auto stand = [](FaultStage& s) { s.gait_flags = 0; };
  const Row rows[] = {
      {"gait_silent", "nothing on the line", Kind::state, odometry_used,
       [](FaultStage& s) { s.gait_mode = Gait::silent; }, good},
      {"gait_corrupt", "a wrong bit in every frame", Kind::event, odometry_used,
       [](FaultStage& s) { s.gait_mode = Gait::corrupt; }, good},
      {"gait_corrupt", "every frame twice", Kind::event, odometry_used,
       [](FaultStage& s) { s.gait_mode = Gait::doubled; }, good},
      {"gait_restarted", "another boot, all sums from zero", Kind::event, odometry_used,
       [](FaultStage& s) { ++s.boot_id, s.walked_x = 0.0F; }, nothing},
      {"gait_jump", "5 m in one frame", Kind::event, odometry_used, [](FaultStage& s) { s.walked_x += 5.0F; }, nothing},
      {"fallen", "flag", Kind::state, frames_used, [](FaultStage& s) { s.gait_flags = TOUCHLINE_GAIT_FALLEN; }, stand},
      {"lifted", "flag", Kind::state, frames_used, [](FaultStage& s) { s.gait_flags = TOUCHLINE_GAIT_LIFTED; }, stand},
  };
  for (const Row& row : rows) run(stage, row);
}

void press_button(FaultStage& stage) {
  stage.panel.set_line(2, false);
  (void)stage.play(0.8);  // long enough for an emulated processor to see
  stage.panel.set_line(2, true);
}

/// Nothing is there at start; then all comes. The yaw is used once the button was pressed, looking at the goal.
void test_start(FaultStage& stage, const std::string& more) {
  using Gait = FaultStage::Gait;
  stage.gait_mode = Gait::silent;
  stage.start_daemon(more);
  check(stage
            .until(20.0,
                   [](const Seen& s) {
                     return s.has("camera_missing") && s.has("imu_missing") && s.has("gait_silent") &&
                            s.has("panel_missing");
                   })
            .has_value(),
        "start: without a camera, an IMU, a gait controller and a panel it runs and names them all");
  stage.gait_mode = Gait::good;
  const bool there = stage.plug_in_camera() && stage.imu.plug_in() && stage.panel.plug_in();
  const auto well = stage.until(10.0, [](const Seen& s) {
    return s.from_frame && s.odometry_used && !s.has("imu_missing") && !s.has("panel_missing");
  });
  check(there && well && *well <= recovery_s,
        "start: all are in use " + std::to_string(well.value_or(-1.0)) + " s after they came");
  press_button(stage);
  check(stage.until_logged(5.0, "the goal's yaw is kept in "), "button: the goal's yaw is stored and kept");
  stage.gait_flags = TOUCHLINE_GAIT_LIFTED;
  for (int i = 0; i < 50; ++i) {  // carried to its place
    stage.yaw = stage.true_yaw() * static_cast<float>(i) / 49.0F;
    (void)stage.play(0.02);
  }
  stage.gait_flags = 0;
}

void test_signals(FaultStage& stage, const std::string& more) {
  stage.write_file(more + "[localization]\nparticles = 300\n");
  stage.daemon().send(SIGHUP);
  check(stage.until_logged(5.0, "thresholds read again"), "SIGHUP: thresholds are read again");
  check(stage.until(recovery_s, pictures_used).has_value(), "SIGHUP: poses go on");
  stage.write_file(more + "[localization]\nparticles = none\n");
  stage.daemon().send(SIGHUP);
  check(stage.until_logged(5.0, "thresholds stay: "), "SIGHUP: a broken file changes nothing and is told");
  stage.daemon().send(SIGTERM);
  check(stage.daemon().wait_for_end(promised_end_ms) == 0, "SIGTERM: ended within a second, status 0");
}

/// The clock goes on while the daemon does not: as after a suspend.
void test_clock(FaultStage& stage) {
  run(stage, {"clock_jump", "stopped for 6 s", Kind::event, all_well,
              [](FaultStage& s) {
                s.daemon().send(SIGSTOP);
                (void)s.play(6.0);
                s.daemon().send(SIGCONT);
              },
              [](FaultStage&) {}});
}

void test_outputs(FaultStage& stage) {
  stage.start_daemon("[output]\nudp = [\"192.0.2.1:9\"]\n");
  check(stage.until(20.0, [](const Seen& s) { return s.has("output") && s.from_frame; }).has_value(),
        "fault output (no route to the address): named, and lines go on");
  stage.daemon().send(SIGTERM);
  check(stage.daemon().wait_for_end(promised_end_ms) == 0, "SIGTERM: ended within a second, status 0");
}

/// Lines and the goal's yaw go to a disk of 64 KiB that is full.
void test_full_disk(FaultStage& stage) {
  const std::string disk = "/tmp/small";
  ::mkdir(disk.c_str(), 0755);
  if (!check(::mount("none", disk.c_str(), "tmpfs", 0, "size=64k") == 0, "disk: a small one is there")) return;
  std::ofstream(disk + "/filler") << std::string(100000, 'x');
  const int out = ::open((disk + "/lines").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  stage.start_daemon("state_file = \"" + disk + "/goal_yaw\"\n", out);
  check(stage.until_logged(10.0, "fault: output: standard output: No space left on device"),
        "fault output (disk full): named in the log");
  press_button(stage);
  check(stage.until_logged(10.0, "the goal's yaw cannot be kept in " + disk),
        "disk full: the goal's yaw is used, and told not to be kept");
  ::unlink((disk + "/filler").c_str());
  check(stage.until_logged(10.0, "well again: output"), "fault output (disk full): well again when there is room");
  stage.daemon().send(SIGTERM);
  check(stage.daemon().wait_for_end(promised_end_ms) == 0, "SIGTERM: ended within a second, status 0");
  ::close(out);
}

void test_all(FaultStage& stage) {
  const std::string kept = "state_file = \"/tmp/goal_yaw\"\n";
  check(stage.unplug_camera(), "start: no camera");
  test_start(stage, kept);
  camera_rows(stage);
  imu_rows(stage);
  gait_rows(stage);
  run(stage, {"panel_missing", "uhid unplugged", Kind::state, frames_used, [](FaultStage& s) { s.panel.unplug(); },
              [](FaultStage& s) { check(s.panel.plug_in(), "panel: plugged in again"); }});
  test_clock(stage);
  test_signals(stage, kept);
  stage.start_daemon(kept);
  check(stage.until(20.0, yaw_used).has_value(), "restart: the kept yaw is used without a press");
  stage.daemon().send(SIGTERM);
  check(stage.daemon().wait_for_end(promised_end_ms) == 0, "SIGTERM: ended within a second, status 0");
  test_outputs(stage);
  test_full_disk(stage);
}

}  // namespace
}  // namespace touchline::vm

int main(int argc, char** argv) {
  using namespace touchline::vm;
  if (argc != 2) return 2;
  FaultStage stage(argv[1]);
  if (!check(stage.ready(), "faults: the stage is ready")) return 1;
  test_all(stage);
  return failures;
}
