// SPDX-License-Identifier: Apache-2.0
// One function per table of the robot's file.
#pragma once

#include "platform/sbc/robot_file.h"
#include "platform/sbc/toml_table.h"

namespace touchline::sbc {

void read_field(TomlTable top, RobotFile& file);
void read_camera(TomlTable table, RobotFile& file, const std::filesystem::path& folder);
void read_lens(TomlTable table, RobotFile& file);
void read_mount(TomlTable table, RobotFile& file);
void read_imu(TomlTable table, RobotFile& file);
void read_gait(TomlTable table, RobotFile& file);
void read_panel(TomlTable table, RobotFile& file, const std::filesystem::path& folder);
void read_vision(TomlTable table, RobotFile& file);
void read_localization(TomlTable table, RobotFile& file);
void read_output(TomlTable table, RobotFile& file);
void read_realtime(TomlTable table, RobotFile& file);

}  // namespace touchline::sbc
