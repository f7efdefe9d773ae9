// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/goal_yaw_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>

#include "hal/crc32.h"

namespace touchline::sbc {
namespace {

constexpr std::size_t max_line = 128;  // the name, 36 characters of a boot, a number and the check, with room
constexpr const char* any_boot = "any";

std::uint32_t check_of(const char* text, std::size_t size) {
  return crc32(std::span(reinterpret_cast<const std::uint8_t*>(text), size));
}

bool is_good(float yaw) { return std::isfinite(yaw) && std::fabs(yaw) <= 3.15F; }

}  // namespace

std::filesystem::path goal_yaw_path(const std::string& named, const std::filesystem::path& folder) {
  if (!named.empty()) return folder / named;  // an absolute path stays as it is
  const char* state = std::getenv("STATE_DIRECTORY");
  if (state == nullptr || *state == '\0') return {};
  const std::string first = std::string(state).substr(0, std::string(state).find(':'));
  return std::filesystem::path(first) / "goal_yaw";
}

GoalYawFile::GoalYawFile(const std::filesystem::path& path, bool keeps_zero) : path_(path.string()) {
  if (path_.empty()) return;
  new_path_ = path_ + ".new";
  if (!keeps_zero) std::ifstream("/proc/sys/kernel/random/boot_id") >> boot_;
  if (boot_.empty() || boot_.size() > 40) boot_ = any_boot;
}

std::string GoalYawFile::folder_problem() const {
  if (path_.empty()) return {};
  const std::filesystem::path parent = std::filesystem::path(path_).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  if (::access((folder + "/").c_str(), W_OK | X_OK) == 0) return {};
  return "the goal's yaw cannot be kept in " + folder + ": " + std::strerror(errno) +
         "; make the folder, or name another file";
}

GoalYawFile::Loaded GoalYawFile::load() const {
  Loaded loaded;
  const int file = path_.empty() ? -1 : ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    if (!path_.empty() && errno != ENOENT) loaded.problem = path_ + ": " + std::strerror(errno);
    return loaded;
  }
  std::array<char, max_line> text{};
  const ssize_t size = ::read(file, text.data(), text.size() - 1);
  ::close(file);
  std::array<char, 64> boot{};
  unsigned check = 0;
  int checked = 0;
  const bool whole =
      size > 0 && text[static_cast<std::size_t>(size) - 1] == '\n' &&
      std::sscanf(text.data(), "touchline-goal-yaw 1 %40s %f%n %8x", boot.data(), &loaded.yaw, &checked, &check) == 3 &&
      check == check_of(text.data(), static_cast<std::size_t>(checked)) && is_good(loaded.yaw);
  if (!whole) {
    loaded.problem = path_ + ": is damaged and not used; press the button again, looking at the goal";
  } else if (boot_ != boot.data()) {
    loaded.problem = path_ + ": is of another boot, the IMU may have a new zero; press the button again";
  } else {
    loaded.found = true;
  }
  return loaded;
}

bool GoalYawFile::save(float yaw) {
  std::array<char, max_line> text{};
  const int checked =
      std::snprintf(text.data(), text.size(), "touchline-goal-yaw 1 %s %.6f", boot_.c_str(), static_cast<double>(yaw));
  const auto used = static_cast<std::size_t>(checked);
  const int more = std::snprintf(text.data() + used, text.size() - used, " %08x\n", check_of(text.data(), used));
  const ssize_t size = checked + more;
  const int file = ::open(new_path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NONBLOCK, 0644);
  if (file < 0) return false;
  errno = ENOSPC;  // of a write that is cut short
  bool good = ::write(file, text.data(), static_cast<std::size_t>(size)) == size;
  int error = errno;
  if (::close(file) != 0 && good) {
    good = false;
    error = errno;
  }
  if (good && ::rename(new_path_.c_str(), path_.c_str()) == 0) return true;
  if (good) error = errno;
  ::unlink(new_path_.c_str());
  errno = error;
  return false;
}

}  // namespace touchline::sbc
