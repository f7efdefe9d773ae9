// SPDX-License-Identifier: Apache-2.0
// The kept goal's yaw: written whole or not at all, and nothing on the disk does harm.
#include "platform/sbc/goal_yaw_file.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "platform/sbc/daemon.h"
#include "tests/host/temp_folder.h"
#include "tests/support/heap_guard.h"

namespace touchline::sbc {
namespace {

TEST_CASE("what was stored is there after a restart") {
  const host::TempFolder temp;
  GoalYawFile first(temp.path() / "goal_yaw", false);
  const GoalYawFile::Loaded nothing = first.load();
  CHECK_FALSE(nothing.found);
  CHECK(nothing.problem.empty());
  const test::HeapGuard guard;
  const bool saved = first.save(0.75F) && first.save(-3.1F);
  const std::uint64_t allocations = guard.allocations();
  CHECK(saved);
  CHECK(allocations == 0);
  const GoalYawFile::Loaded loaded = GoalYawFile(temp.path() / "goal_yaw", false).load();
  CHECK(loaded.found);
  CHECK(loaded.yaw == doctest::Approx(-3.1));
  CHECK_FALSE(std::filesystem::exists(temp.path() / "goal_yaw.new"));
}

TEST_CASE("every truncation and every changed byte is told and not used") {
  const host::TempFolder temp;
  GoalYawFile file(temp.path() / "goal_yaw", false);
  REQUIRE(file.save(1.25F));
  const std::string good = temp.read("goal_yaw");
  const auto refused = [&](const std::string& text) {
    temp.write("goal_yaw", text);
    const GoalYawFile::Loaded loaded = file.load();
    CHECK_FALSE(loaded.found);
    CHECK(loaded.problem.find("press the button again") != std::string::npos);
  };
  for (std::size_t size = 0; size < good.size(); ++size) refused(good.substr(0, size));
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 1);
    refused(bad);
  }
  refused(std::string(100000, 'x'));
  temp.write("goal_yaw", good);
  CHECK(file.load().found);
}

TEST_CASE("a file of another boot is used only where the IMU keeps its zero") {
  const host::TempFolder temp;
  REQUIRE(GoalYawFile(temp.path() / "goal_yaw", true).save(0.5F));
  const GoalYawFile::Loaded other = GoalYawFile(temp.path() / "goal_yaw", false).load();
  CHECK_FALSE(other.found);
  CHECK(other.problem.find("another boot") != std::string::npos);
  CHECK(GoalYawFile(temp.path() / "goal_yaw", true).load().found);
}

TEST_CASE("a full disk, and a folder that is not there, keep the old line and say so") {
  const host::TempFolder temp;
  GoalYawFile file(temp.path() / "goal_yaw", false);
  REQUIRE(file.save(0.5F));
  // No more bytes for this process, as on a full disk.
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  auto* handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit none{0, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &none) == 0);
  const bool saved = file.save(0.9F);
  const int error = errno;
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &before) == 0);
  ::signal(SIGXFSZ, handler);
  CHECK_FALSE(saved);
  CHECK(error == EFBIG);
  CHECK(file.load().yaw == doctest::Approx(0.5));
  CHECK_FALSE(std::filesystem::exists(temp.path() / "goal_yaw.new"));
  GoalYawFile nowhere(temp.path() / "no" / "goal_yaw", false);
  CHECK_FALSE(nowhere.save(0.5F));
  CHECK_FALSE(nowhere.load().found);
}

TEST_CASE("where the file is: as named, or in systemd's state directory, or nowhere") {
  ::unsetenv("STATE_DIRECTORY");
  CHECK(goal_yaw_path("", "/etc").empty());
  CHECK(goal_yaw_path("/run/yaw", "/etc") == "/run/yaw");
  CHECK(goal_yaw_path("yaw", "/etc") == "/etc/yaw");
  ::setenv("STATE_DIRECTORY", "/var/lib/touchline:/other", 1);
  CHECK(goal_yaw_path("", "/etc") == "/var/lib/touchline/goal_yaw");
  ::unsetenv("STATE_DIRECTORY");
}

TEST_CASE("the daemon starts with the kept yaw, or says why not") {
  const host::TempFolder temp;
  REQUIRE(GoalYawFile(temp.path() / "goal_yaw", false).save(1.5F));
  const auto path = temp.write("robot.toml", R"([camera]
device = "/dev/no-such-camera"
[imu]
backend = "hidapi"
device = "/dev/no-such-imu"
[panel]
backend = "gpiod"
chip = "/dev/no-such-chip"
button_line = 1
state_file = "goal_yaw"
)");
  const Daemon daemon(path, -1, -1);
  CHECK(daemon.file().robot.goal_yaw_known);
  CHECK(daemon.file().robot.goal_yaw == doctest::Approx(1.5));
  temp.write("goal_yaw", "nonsense\n");
  const Daemon other(path, -1, -1);
  CHECK_FALSE(other.file().robot.goal_yaw_known);
}

}  // namespace
}  // namespace touchline::sbc
