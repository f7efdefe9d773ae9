// SPDX-License-Identifier: Apache-2.0
// The goal's yaw that the button has stored, kept in a small file, so that a restart of the program in the middle of a
// match asks for no new press. One line of text: a name, the machine's boot, the yaw, a CRC-32.
#pragma once

#include <filesystem>
#include <string>

namespace touchline::sbc {

/// Where the file is: `named` if given (relative: to `folder`), else `goal_yaw` in systemd's state directory, else
/// nowhere (empty).
std::filesystem::path goal_yaw_path(const std::string& named, const std::filesystem::path& folder);

class GoalYawFile {
 public:
  struct Loaded {
    bool found = false;
    float yaw = 0.0F;     // radians, as the device reads it
    std::string problem;  // why a file that is there is not used; empty when there is none
  };

  /// An empty path: nothing is kept. `keeps_zero`: the IMU's zero is the same after the machine was off; else a file of
  /// another boot is not used.
  GoalYawFile(const std::filesystem::path& path, bool keeps_zero);

  [[nodiscard]] bool used() const { return !path_.empty(); }
  [[nodiscard]] const char* path() const { return path_.c_str(); }
  /// Why a press could not be kept: its folder is missing, or may not be written. Empty when there is no reason.
  [[nodiscard]] std::string folder_problem() const;
  /// Never throws for what is on the disk.
  [[nodiscard]] Loaded load() const;
  /// Writes beside the file and renames, so that a reader sees the old line or the new one. Waits for no disk and
  /// allocates nothing. False: errno says why, and the old line is still there.
  bool save(float yaw);

 private:
  std::string path_;
  std::string new_path_;
  std::string boot_;
};

}  // namespace touchline::sbc
