// SPDX-License-Identifier: Apache-2.0
// Reports as JSON lines, and where they go: pipes that nobody reads, full disks, addresses that nobody has.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "platform/host/host_error.h"
#include "platform/sbc/fault_log.h"
#include "platform/sbc/publisher.h"
#include "platform/sbc/report_line.h"
#include "platform/sbc/udp_address.h"
#include "tests/host/temp_folder.h"

namespace touchline::sbc {
namespace {

RobotReport example() {
  RobotReport report;
  report.sequence = 7;
  report.time = 123456789;
  report.from_frame = true;
  report.estimate.valid = true;
  report.estimate.pose = {1.5F, -0.25F, math::half_pi};
  report.estimate.covariance = {0.01F, 0.001F, 0.02F, 0.0F, 0.0F, 0.003F};
  report.estimate.confidence = 0.9F;
  report.faults.set(Fault::imu_missing);
  report.faults.set(Fault::fallen);
  report.camera_health.open = true;
  report.camera_health.received = 42;
  report.camera_health.last_datum = 123456789;
  report.frame_to_pose = 12 * one_millisecond;
  return report;
}

TEST_CASE("a report is one line of JSON") {
  ReportLine line;
  const std::string text(line.format(example()));
  CHECK(text.back() == '\n');
  CHECK(text.find('\n') == text.size() - 1);
  const auto json = nlohmann::json::parse(text);
  CHECK(json["schema"] == 1);
  CHECK(json["sequence"] == 7);
  CHECK(json["t_ns"] == 123456789);
  CHECK(json["pose"]["x_m"] == 1.5);
  CHECK(json["pose"]["theta_deg"] == doctest::Approx(90.0));
  CHECK(json["covariance"].size() == 6);
  CHECK(json["covariance"][2] == doctest::Approx(0.02));
  CHECK(json["mirror"].is_null());
  CHECK(json["faults"] == nlohmann::json::array({"imu_missing", "fallen"}));
  CHECK(json["latency_ms"]["frame_to_pose"] == 12.0);
  CHECK(json["health"]["camera"]["received"] == 42);
  CHECK(json["health"]["camera"]["age_ms"] == 12.0);
  CHECK(json["health"]["imu"]["age_ms"].is_null());
}

TEST_CASE("no pose is null, and numbers that JSON has not are null") {
  RobotReport report = example();
  report.estimate.pose.x = std::numeric_limits<float>::quiet_NaN();
  report.estimate.has_mirror = true;
  ReportLine line;
  auto json = nlohmann::json::parse(line.format(report));
  CHECK(json["pose"]["x_m"].is_null());
  CHECK(json["mirror"]["pose"]["x_m"] == 0.0);
  report.estimate = {};
  json = nlohmann::json::parse(line.format(report));
  CHECK(json["pose"].is_null());
  CHECK(json["confidence"] == 0);
}

TEST_CASE("the longest report fits into 4096 bytes") {
  RobotReport report;
  report.estimate.valid = report.estimate.has_mirror = true;
  const float big = -3.4e38F;
  report.estimate.pose = report.estimate.mirror = {-1000.0F, -1000.0F, -3.0F};
  report.estimate.covariance = {-1e6F, -1e6F, -1e6F, -1e6F, -1e6F, -1e6F};
  report.camera.height = big;
  report.sequence = report.frames = std::numeric_limits<std::uint64_t>::max();
  report.time = std::numeric_limits<MonotonicNs>::max() / 2;
  report.junctions = report.posts = report.line_points = report.dropped = std::numeric_limits<int>::min();
  for (unsigned i = 0; i < static_cast<unsigned>(Fault::count); ++i) report.faults.set(static_cast<Fault>(i));
  DeviceHealth health;
  health.last_error = Status::invalid_argument;
  health.opened = health.received = health.lost = health.skipped = health.corrupt = health.stale = health.restarts =
      std::numeric_limits<std::uint32_t>::max();
  health.last_datum = 1;
  report.camera_health = report.imu_health = report.gait_health = report.panel_health = health;
  ReportLine line;
  const std::string text(line.format(report));
  CHECK(text.size() < 4096);
  CHECK(nlohmann::json::parse(text, nullptr, false).is_object());
}

TEST_CASE("a pipe that nobody empties costs lines, not time") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  Publisher publisher(ends[1], {});
  const std::string line(1000, 'x');
  int written = 0;
  for (int i = 0; i < 200; ++i) written += publisher.publish(line) ? 1 : 0;
  CHECK(written > 10);
  CHECK(written < 200);
  CHECK(publisher.dropped() == static_cast<std::uint64_t>(200 - written));
  CHECK(publisher.last_error() == EAGAIN);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_CASE("a terminal that nobody reads costs lines, not time, and stays as the shell has it") {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  REQUIRE(terminal >= 0);
  REQUIRE(::grantpt(terminal) == 0);
  REQUIRE(::unlockpt(terminal) == 0);
  const int shared = ::open(::ptsname(terminal), O_RDWR | O_NOCTTY | O_CLOEXEC);
  REQUIRE(shared >= 0);
  {
    Publisher publisher(shared, {});
    const std::string line(1000, 'x');
    int written = 0;
    ::alarm(20);  // a write that waits ends the test, not the day
    for (int i = 0; i < 200; ++i) written += publisher.publish(line) ? 1 : 0;
    ::alarm(0);
    CHECK(written > 0);
    CHECK(written < 200);
    CHECK(publisher.last_error() == EAGAIN);
    CHECK(std::string(publisher.problem()) == "standard output: its reader is too slow");
    CHECK((::fcntl(shared, F_GETFL) & O_NONBLOCK) == 0);
  }
  CHECK((::fcntl(shared, F_GETFL) & O_NONBLOCK) == 0);
  ::close(shared);
  ::close(terminal);
}

TEST_CASE("a socket that nobody reads costs lines, not time") {
  int ends[2];
  REQUIRE(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0);
  Publisher publisher(ends[1], {});
  const std::string line(4000, 'x');
  int written = 0;
  ::alarm(20);
  for (int i = 0; i < 1000; ++i) written += publisher.publish(line) ? 1 : 0;
  ::alarm(0);
  CHECK(written > 0);
  CHECK(written < 1000);
  CHECK(publisher.last_error() == EAGAIN);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST_CASE("a line that a full file cuts is finished when there is room again") {
  const host::TempFolder temp;
  const int file = ::open((temp.path() / "out").c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  REQUIRE(file >= 0);
  auto* before = ::signal(SIGXFSZ, SIG_IGN);
  rlimit whole{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &whole) == 0);
  Publisher publisher(file, {});
  rlimit small = whole;
  small.rlim_cur = 25;
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  CHECK(publisher.publish("0123456789abcdefghi\n"));
  CHECK(publisher.publish("0123456789ABCDEFGHI\n"));  // its rest is kept
  CHECK_FALSE(publisher.publish("lost\n"));
  CHECK(publisher.last_error() == EFBIG);
  CHECK_FALSE(publisher.closed());
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &whole) == 0);
  CHECK(publisher.publish("again\n"));
  ::signal(SIGXFSZ, before);
  CHECK(temp.read("out") == "0123456789abcdefghi\n0123456789ABCDEFGHI\nagain\n");
  ::close(file);
}

TEST_CASE("a full disk, and a reader that has gone, stop nothing") {
  const int full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
  REQUIRE(full >= 0);
  Publisher disk(full, {});
  CHECK_FALSE(disk.publish("x\n"));
  CHECK(disk.last_error() == ENOSPC);
  CHECK_FALSE(disk.closed());
  ::close(full);

  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  ::close(ends[0]);
  auto* before = ::signal(SIGPIPE, SIG_IGN);
  Publisher gone(ends[1], {});
  CHECK_FALSE(gone.publish("x\n"));
  CHECK(gone.closed());
  CHECK_FALSE(gone.publish("x\n"));  // a fault that stays is not well again
  CHECK(gone.last_error() == EPIPE);
  CHECK(gone.lines_lost() == 2);
  ::signal(SIGPIPE, before);
  ::close(ends[1]);
}

TEST_CASE("UDP reaches its address, and one that nobody has stops nothing") {
  const int receiver = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  REQUIRE(::bind(receiver, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  socklen_t size = sizeof address;
  REQUIRE(::getsockname(receiver, reinterpret_cast<sockaddr*>(&address), &size) == 0);
  Publisher publisher(-1, {"127.0.0.1:" + std::to_string(ntohs(address.sin_port))});
  CHECK(publisher.publish("hello\n"));
  char text[16] = {};
  CHECK(::recv(receiver, text, sizeof text, MSG_DONTWAIT) == 6);
  CHECK(std::string(text) == "hello\n");
  ::close(receiver);
  for (int i = 0; i < 10; ++i) (void)publisher.publish("hello\n");  // refused now and then, never stopped
  CHECK(publisher.publish(std::string(70000, 'x')) == false);       // longer than any datagram
  CHECK(publisher.last_error() == EMSGSIZE);
}

TEST_CASE("what is no address is refused by name") {
  UdpAddress address;
  for (const char* good : {"127.0.0.1:7777", "[::1]:1", "192.168.0.255:65535", "[fe80::1%eth0]:5", "[ff02::1%2]:5"}) {
    INFO(doctest::String(good));
    CHECK(parse_udp_address(good, address).empty());
  }
  for (const char* bad :
       {"", "localhost:7", "127.0.0.1", "127.0.0.1:", "127.0.0.1:0", "127.0.0.1:65536", ":7", "1.2.3.4:x", "1.2.3:5",
        "1:5", "::1:5000", "[::1]", "[127.0.0.1]:5", "[fe80::1]:5", "[ff02::1]:5", "[fe80::1%]:5", "[::1"}) {
    INFO(doctest::String(bad));
    CHECK_FALSE(parse_udp_address(bad, address).empty());
    CHECK_THROWS_AS(Publisher(-1, {bad}), host::HostError);
  }
  CHECK(parse_udp_address("::1:5000", address).find("in brackets") != std::string::npos);
  CHECK(parse_udp_address("[fe80::1]:5", address).find("say which, like") != std::string::npos);
}

TEST_CASE("a network interface that is not there is a failure of the line, until it comes") {
  Publisher publisher(-1, {"[fe80::1%nope0]:5000"});
  CHECK_FALSE(publisher.publish("hello\n"));
  CHECK(publisher.last_error() == ENODEV);
  CHECK(std::string(publisher.problem()).find("udp [fe80::1%nope0]:5000: ") == 0);
  UdpAddress address;
  REQUIRE(parse_udp_address("[fe80::1%lo]:5000", address).empty());
  CHECK(address.find_interface());
  CHECK(reinterpret_cast<const sockaddr_in6*>(address.get())->sin6_scope_id == 1);
}

TEST_CASE("the log tells of a fault once when it comes and once when it has gone, and never floods") {
  const host::TempFolder temp;
  const std::string path = (temp.path() / "log").string();
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  REQUIRE(file >= 0);
  FaultLog log(file);
  FaultSet faults;
  const auto detail = [](Fault) { return "cable"; };
  MonotonicNs now = one_second;
  for (int i = 0; i < 100; ++i) {
    faults.set(Fault::camera_missing, i >= 10 && i < 50);
    log.update(faults, now += 10 * one_millisecond, detail);
  }
  CHECK(temp.read("log") == "touchline: fault: camera_missing: cable\ntouchline: well again: camera_missing\n");
  for (int i = 0; i < 1000; ++i) {
    faults.set(Fault::imu_stale, i % 2 == 0);
    log.update(faults, now += one_millisecond, detail);
  }
  log.say("later", "", "");
  const std::string text = temp.read("log");
  CHECK(std::count(text.begin(), text.end(), '\n') == 11);
  CHECK(text.find("later (992 lines left out)") != std::string::npos);
  ::close(file);
}

TEST_CASE(
    "the log answers the operator always, tells no recovery without its fault, and tells a state late, not never") {
  const host::TempFolder temp;
  const int file = ::open((temp.path() / "log").c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  REQUIRE(file >= 0);
  FaultLog log(file);
  FaultSet faults;
  const auto detail = [](Fault) { return ""; };
  MonotonicNs now = one_second;
  for (int i = 0; i < 10; ++i) {
    faults.set(Fault::imu_stale, i % 2 == 0);
    log.update(faults, now += one_millisecond, detail);
  }
  faults.set(Fault::camera_missing);
  faults.set(Fault::gait_missing);
  log.update(faults, now += one_millisecond, detail);
  CHECK(temp.read("log").find("_missing") == std::string::npos);  // ten lines are out
  log.say("thresholds read again", "", "");
  CHECK(temp.read("log").find("thresholds read again (2 lines left out)\n") != std::string::npos);
  faults.set(Fault::gait_missing, false);
  log.update(faults, now += 11 * one_second, detail);
  log.update(faults, now + one_second, detail);
  const std::string text = temp.read("log");
  CHECK(text.find("gait_missing") == std::string::npos);
  CHECK(text.find("touchline: fault: camera_missing\n") != std::string::npos);
  ::close(file);
}

}  // namespace
}  // namespace touchline::sbc
