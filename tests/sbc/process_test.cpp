// SPDX-License-Identifier: Apache-2.0
// `touchline run` as a process of its own: signals are obeyed in time. Waits end at the event; the deadlines are those
// that the service promises (SIGTERM), or only there so that a failure does not hang.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "tests/host/temp_folder.h"
#include "tests/support/child_process.h"

namespace touchline::sbc {
namespace {

constexpr int promised_end_ms = 1000;
constexpr int patience_ms = 30000;

const std::string program = TOUCHLINE_PROGRAM;
/// A robot whose camera is not there: it runs by the real clock and says so ten times a second.
const std::string no_camera = "[camera]\ndevice = \"/dev/no-such-camera\"\n[realtime]\nlock_memory = false\n";

TEST_CASE("SIGTERM and SIGINT end the daemon within a second, with status 0") {
  for (const int signal : {SIGTERM, SIGINT}) {
    const host::TempFolder temp;
    test::ChildProcess daemon({program, "run", temp.write("robot.toml", no_camera).string()});
    REQUIRE(daemon.wait_for_lines(1, patience_ms));
    CHECK_FALSE(daemon.wait_for_end(0).has_value());
    daemon.send(signal);
    CHECK(daemon.wait_for_end(promised_end_ms) == 0);
  }
}

TEST_CASE("SIGTERM ends a daemon that is busy with frames, and one whose reader is asleep") {
  const host::TempFolder temp;
  const std::string fixtures = std::string(TOUCHLINE_SOURCE_DIR) + "/fixtures";
  const auto path = temp.write("robot.toml", "[camera]\nbackend = \"replay\"\nreplay_folder = \"" + fixtures +
                                                 "/sim-walk\"\nreplay_loops = 1000000\n");
  test::ChildProcess daemon({program, "run", path.string()});
  REQUIRE(daemon.wait_for_lines(3, patience_ms));
  daemon.send(SIGTERM);
  CHECK(daemon.wait_for_end(promised_end_ms) == 0);
}

TEST_CASE("SIGHUP reads the thresholds again; a broken file changes nothing and is told with its line") {
  const host::TempFolder temp;
  const auto path = temp.write("robot.toml", no_camera);
  test::ChildProcess daemon({program, "run", path.string()});
  REQUIRE(daemon.wait_for_lines(1, patience_ms));
  temp.write("robot.toml", no_camera + "[localization]\nparticles = 300\n");
  daemon.send(SIGHUP);
  CHECK(daemon.wait_for_log("thresholds read again from " + path.string(), patience_ms));
  temp.write("robot.toml", no_camera + "[localization]\nparticles = \n");
  daemon.send(SIGHUP);
  CHECK(daemon.wait_for_log("thresholds stay: " + path.string() + ":6: ", patience_ms));
  const std::size_t before = daemon.output().size();
  CHECK(daemon.wait_for_lines(5, patience_ms));
  CHECK(daemon.output().size() > before);
  daemon.send(SIGTERM);
  CHECK(daemon.wait_for_end(promised_end_ms) == 0);
}

TEST_CASE("with the standard descriptors closed at start, nothing that is printed reaches a device") {
  const host::TempFolder temp;
  const int controller = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  REQUIRE(controller >= 0);
  REQUIRE(::grantpt(controller) == 0);
  REQUIRE(::unlockpt(controller) == 0);
  const auto path = temp.write(
      "robot.toml", no_camera + "[gait]\nbackend = \"serial\"\ndevice = \"" + ::ptsname(controller) + "\"\n");
  for (const std::string closed : {">&-", "<&- >&-", "<&- 2>&-"}) {
    INFO(doctest::String(closed.c_str()));
    test::ChildProcess daemon({"/bin/sh", "-c", "exec \"$0\" run \"$1\" " + closed, program, path.string()});
    const bool has_log = closed.find("2>&-") == std::string::npos;
    if (has_log) {
      CHECK(daemon.wait_for_log("fault: output: standard output: Bad file descriptor", patience_ms));
    } else {
      CHECK(daemon.wait_for_lines(3, patience_ms));
    }
    pollfd ready{controller, POLLIN, 0};
    CHECK(::poll(&ready, 1, 0) >= 0);
    CHECK((ready.revents & POLLIN) == 0);
    daemon.send(SIGTERM);
    CHECK(daemon.wait_for_end(promised_end_ms) == 0);
  }
  ::close(controller);
}

TEST_CASE("a path that is no camera is told in our words, once") {
  const host::TempFolder temp;
  test::ChildProcess daemon({program, "run", temp.write("robot.toml", "[camera]\ndevice = \"/dev/null\"\n").string()});
  CHECK(daemon.wait_for_lines(12, patience_ms));  // more than a second: three tries to open it
  daemon.send(SIGTERM);
  CHECK(daemon.wait_for_end(promised_end_ms) == 0);
  CHECK(daemon.log().find("apabilit") == std::string::npos);  // of libv4l2's complaints
  CHECK(daemon.log().find("fault: camera_missing: no video device at /dev/null") != std::string::npos);
}

TEST_CASE("a run that ends by itself says when its lines did not get through, with status 2") {
  const std::string replay = std::string(TOUCHLINE_SOURCE_DIR) + "/fixtures/robot-replay.toml";
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  REQUIRE(full >= 0);
  test::ChildProcess run({program, "run", replay, "--frames", "3"}, full);
  CHECK(run.wait_for_end(patience_ms) == 2);
  CHECK(run.wait_for_log("touchline: standard output: 3 lines did not get through: No space left on device",
                         patience_ms));
  ::close(full);
}

TEST_CASE("a file as long as the shell lets it be ends no daemon") {
  const host::TempFolder temp;
  const std::string command = "ulimit -f 1; exec \"$0\" run \"$1\" >\"$2\"";
  test::ChildProcess daemon({"/bin/sh", "-c", command, program, temp.write("robot.toml", no_camera).string(),
                             (temp.path() / "lines").string()});
  CHECK(daemon.wait_for_log("fault: output: standard output: File too large", patience_ms));
  daemon.send(SIGTERM);
  CHECK(daemon.wait_for_end(promised_end_ms) == 0);
}

TEST_CASE("a file that is wrong at start is no daemon but a message and status 2") {
  const host::TempFolder temp;
  test::ChildProcess daemon({program, "run", temp.write("robot.toml", "[camera]\nwidht_px = 3\n").string()});
  CHECK(daemon.wait_for_end(patience_ms) == 2);
  CHECK(daemon.wait_for_log("did you mean width_px?", patience_ms));
}

}  // namespace
}  // namespace touchline::sbc
