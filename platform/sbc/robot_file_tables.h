// SPDX-License-Identifier: Apache-2.0
// One function per table of the robot's file.
#pragma once

#include "platform/host/key_reader.h"
#include "platform/sbc/robot_file.h"

namespace touchline::sbc {

using host::KeyReader;

void read_field(KeyReader& top, RobotFile& file);
void read_camera(KeyReader table, RobotFile& file, const std::filesystem::path& folder);
void read_lens(KeyReader table, RobotFile& file);
void read_mount(KeyReader table, RobotFile& file);
void read_imu(KeyReader table, RobotFile& file);
void read_gait(KeyReader table, RobotFile& file);
void read_panel(KeyReader table, RobotFile& file, const std::filesystem::path& folder);
void read_vision(KeyReader table, RobotFile& file);
void read_localization(KeyReader table, RobotFile& file);
void read_output(KeyReader table, RobotFile& file);
void read_realtime(KeyReader table, RobotFile& file);

}  // namespace touchline::sbc
