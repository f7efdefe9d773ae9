// SPDX-License-Identifier: Apache-2.0
// The frames that the benchmark rotates through: more bytes than any cache holds, so that each frame comes from memory,
// as it does from a camera.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "loc/field.h"
#include "platform/core/frame.h"
#include "vision/lens/camera_pose.h"
#include "vision/lens/lens.h"

namespace touchline::bench {

inline constexpr int shots_per_view = 4;  // the FIFO's depth: the last shot of a view has a full mean
inline constexpr std::size_t pool_bytes = std::size_t{64} << 20U;

/// One place and attitude of the camera, seen in several shots.
struct View {
  CameraPose mount;
  bool has_yaw = false;
  float yaw = 0.0F;
  Pose2 truth;
  std::vector<std::vector<std::uint8_t>> shots;  // RGB24
};

struct FramePool {
  FieldDimensions field;
  LensParameters lens;
  int width = 0;
  int height = 0;
  std::string origin;  // for people
  std::vector<View> views;

  [[nodiscard]] FrameView frame(const View& view, int shot) const {
    return {PixelFormat::rgb24, view.shots[static_cast<std::size_t>(shot)].data(), width, height, width * 3};
  }
};

/// `views` views of the simulator, 752x480, the paper's lens; 0: as many as fill 64 MB.
FramePool simulated_frames(int views = 0);
/// The pictures of a data set, repeated until 64 MB are full. Throws HostError.
FramePool recorded_frames(const std::string& folder);

enum class WorstKind : std::uint8_t {
  white_noise,
  checkerboard,
  turned_checkerboard,  // its squares are as high as the other's are wide
  blocks,               // squares of carpet and white by chance: each edge is a line, each corner a junction
  noise_in_green,
  all_white,
  all_green
};
inline constexpr WorstKind worst_kinds[] = {
    WorstKind::white_noise, WorstKind::checkerboard,   WorstKind::turned_checkerboard,
    WorstKind::blocks,      WorstKind::noise_in_green, WorstKind::all_white,
    WorstKind::all_green};
const char* to_string(WorstKind kind);
/// RGB24 of the given size.
std::vector<std::uint8_t> worst_frame(WorstKind kind, int width, int height, std::uint64_t seed);

}  // namespace touchline::bench
