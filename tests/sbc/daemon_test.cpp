// SPDX-License-Identifier: Apache-2.0
// The daemon on replayed devices: poses come, nothing is allocated after the start, files are read again, a missing
// camera is no reason to end.
#include "platform/sbc/daemon.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "platform/host/host_error.h"
#include "platform/sbc/commands.h"
#include "platform/sbc/service.h"
#include "tests/host/temp_folder.h"
#include "tests/support/heap_guard.h"

namespace touchline::sbc {
namespace {

const std::string fixtures = std::string(TOUCHLINE_SOURCE_DIR) + "/fixtures";

struct Output {
  Output()
      : file(::open((temp.path() / "out").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600)),
        log(::open((temp.path() / "log").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600)) {}
  ~Output() {
    ::close(file);
    ::close(log);
  }
  host::TempFolder temp;
  int file;
  int log;
};

std::string replay_file(int loops, const std::string& more = "") {
  return "[camera]\nbackend = \"replay\"\nreplay_folder = \"" + fixtures +
         "/sim-walk\"\nreplay_loops = " + std::to_string(loops) + "\n" + more;
}

TEST_CASE("the fixtures give poses, line by line") {
  Output output;
  Daemon daemon(fixtures + "/robot-replay.toml", output.file, output.log);
  while (daemon.turn()) {
  }
  CHECK(daemon.report().frames == 80);
  std::istringstream lines(output.temp.read("out"));
  std::string line;
  int count = 0;
  int with_pose = 0;
  while (std::getline(lines, line)) {
    const auto json = nlohmann::json::parse(line);
    CHECK(json["sequence"] == count);
    with_pose += json["pose"].is_null() ? 0 : 1;
    ++count;
  }
  CHECK(count == static_cast<int>(daemon.published()));
  CHECK(with_pose > 60);
}

TEST_CASE("1,000 frames allocate nothing after the start") {
  Output output;
  const auto path = output.temp.write("robot.toml", replay_file(126));
  Daemon daemon(path, output.file, output.log);
  for (int i = 0; i < 20; ++i) REQUIRE(daemon.turn());
  const std::uint64_t before = daemon.report().frames;
  const test::HeapGuard guard;
  while (daemon.report().frames < before + 1000) {
    if (!daemon.turn()) break;
  }
  const std::uint64_t allocations = guard.allocations();
  CHECK(allocations == 0);
  CHECK(daemon.report().frames == before + 1000);
}

TEST_CASE("a robot without its devices goes on and says so") {
  Output output;
  const auto path = output.temp.write("robot.toml", R"([camera]
device = "/dev/no-such-camera"
[imu]
backend = "hidapi"
device = "/dev/no-such-imu"
[gait]
backend = "serial"
device = "/dev/no-such-port"
[panel]
backend = "gpiod"
chip = "/dev/no-such-chip"
button_line = 1
)");
  Daemon daemon(path, output.file, output.log);
  while (daemon.published() == 0) REQUIRE(daemon.turn());
  for (const Fault fault : {Fault::camera_missing, Fault::imu_missing, Fault::gait_missing, Fault::panel_missing}) {
    CHECK(daemon.report().faults.has(fault));
  }
  const std::string log = output.temp.read("log");
  CHECK(log.find("camera_missing: open /dev/no-such-camera: No such file") != std::string::npos);
  CHECK(log.find("gait_missing: open /dev/no-such-port") != std::string::npos);
}

TEST_CASE("a full disk is shown as a fault, and the poses go on") {
  host::TempFolder temp;
  const auto path = temp.write("robot.toml", replay_file(2));
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  Daemon daemon(path, full, full);
  while (daemon.turn()) {
  }
  CHECK(daemon.report().faults.has(Fault::output));
  CHECK(daemon.report().frames == 16);
  ::close(full);
}

TEST_CASE("thresholds are read again; a wrong file changes nothing") {
  Output output;
  const auto path = output.temp.write("robot.toml", replay_file(3));
  Daemon daemon(path, output.file, output.log);
  for (int i = 0; i < 10; ++i) REQUIRE(daemon.turn());
  output.temp.write("robot.toml", replay_file(3, "[localization]\nparticles = 300\n[vision]\nspur_px = 8\n"));
  daemon.reload();
  CHECK(daemon.file().robot.localizer.particles == 300);
  CHECK(daemon.file().robot.vision.spur_px == 8);
  output.temp.write("robot.toml", replay_file(3, "[localization]\nparticles = 0\n"));
  daemon.reload();
  CHECK(daemon.file().robot.localizer.particles == 300);
  const std::uint64_t before = daemon.report().frames;
  while (daemon.report().frames < before + 12) REQUIRE(daemon.turn());
  CHECK(daemon.report().estimate.valid);
  const std::string log = output.temp.read("log");
  CHECK(log.find("thresholds read again") != std::string::npos);
  CHECK(log.find("thresholds stay: ") != std::string::npos);
}

TEST_CASE("SIGTERM and SIGHUP are heard") {
  const Signals signals;
  CHECK_FALSE(Signals::end_asked());
  CHECK(std::raise(SIGHUP) == 0);
  CHECK(Signals::reload_asked());
  CHECK_FALSE(Signals::reload_asked());
  CHECK(std::raise(SIGPIPE) == 0);
  CHECK(std::raise(SIGTERM) == 0);
  CHECK(Signals::end_asked());
}

TEST_CASE("systemd hears that the service is ready, alive and stopping") {
  const host::TempFolder temp;
  const std::string path = (temp.path() / "notify").string();
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  REQUIRE(path.size() < sizeof address.sun_path);
  path.copy(address.sun_path, path.size());
  REQUIRE(::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  ::setenv("WATCHDOG_USEC", "3000000", 1);
  const auto heard = [&]() -> std::string {
    char text[64];
    const ssize_t size = ::recv(socket, text, sizeof text, MSG_DONTWAIT);
    return size > 0 ? std::string(text, static_cast<std::size_t>(size)) : "";
  };
  ServiceNotifier notifier;
  ::unsetenv("NOTIFY_SOCKET");
  ::unsetenv("WATCHDOG_USEC");
  notifier.ready();
  CHECK(heard() == "READY=1\n");
  notifier.alive(10 * one_second);
  CHECK(heard() == "WATCHDOG=1\n");
  notifier.alive(10 * one_second + 500 * one_millisecond);
  CHECK(heard().empty());
  notifier.alive(11 * one_second);
  CHECK(heard() == "WATCHDOG=1\n");
  notifier.stopping();
  CHECK(heard() == "STOPPING=1\n");
  ::close(socket);
  ServiceNotifier silent;
  silent.ready();
}

TEST_CASE("real-time settings that the system refuses are told, with a remedy") {
  RealtimeConfig config;
  config.lock_memory = false;
  config.cpu = 1023;
  CHECK(apply_realtime(config).find("touchline: the core cannot be chosen: ") == 0);
  CHECK(apply_realtime(config).find("realtime.cpu") != std::string::npos);
}

TEST_CASE("check says what the robot would do, or what is wrong") {
  std::ostringstream out;
  CHECK(check_robot(fixtures + "/robot-replay.toml", out) == 0);
  CHECK(out.str().find("is good") != std::string::npos);
  CHECK(out.str().find("note:") == std::string::npos);
  const host::TempFolder folder;
  std::ostringstream empty;
  CHECK(check_robot(folder.write("robot.toml", "").string(), empty) == 0);
  CHECK(empty.str().find("is good") == std::string::npos);
  CHECK(empty.str().find("note: [lens] is the default") != std::string::npos);
  const host::TempFolder temp;
  const auto path = temp.write("robot.toml", "[output]\nudp = [\"nowhere\"]\n");
  CHECK_THROWS_AS(check_robot(path.string(), out), host::HostError);
  std::ostringstream elsewhere;
  CHECK(check_robot(temp.write("robot.toml", R"([output]
udp = ["[fe80::1%nope0]:5"]
[realtime]
cpu = 1000
[panel]
backend = "gpiod"
led_line = 1
state_file = "no/such/folder/yaw"
)")
                        .string(),
                    elsewhere) == 0);
  CHECK(elsewhere.str().find("has no network interface nope0") != std::string::npos);
  CHECK(elsewhere.str().find("[realtime] cpu = 1000: this machine has the cores 0 to ") != std::string::npos);
  CHECK(elsewhere.str().find("[panel] state_file: the goal's yaw cannot be kept in ") != std::string::npos);
}

TEST_CASE("a goal's yaw that cannot be kept is told at the start, not at the first press") {
  Output output;
  const auto path = output.temp.write("robot.toml", replay_file(1, R"([panel]
backend = "gpiod"
led_line = 1
state_file = "no/such/folder/yaw"
)"));
  const Daemon daemon(path, output.file, output.log);
  CHECK(output.temp.read("log").find("no/such/folder: No such file or directory; make the folder") !=
        std::string::npos);
}

TEST_CASE("reading again says which changes take a restart; a pipe is not read again") {
  Output output;
  const auto path = output.temp.write("robot.toml", replay_file(3));
  Daemon daemon(path, output.file, output.log);
  daemon.reload();
  CHECK(output.temp.read("log").find("restart") == std::string::npos);
  output.temp.write("robot.toml",
                    replay_file(4, "[vision]\nspur_px = 8\n[mount]\nheight_m = 0.6\n[localization]\nseed = 9\n"));
  daemon.reload();
  CHECK(daemon.file().robot.vision.spur_px == 8);
  CHECK(output.temp.read("log").find(
            "robot.toml: [camera], [localization] seed, [mount] changed too, which takes a restart") !=
        std::string::npos);
  std::filesystem::remove(path);
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  daemon.reload();
  CHECK(output.temp.read("log").find("is a device or a pipe") != std::string::npos);
}

}  // namespace
}  // namespace touchline::sbc
