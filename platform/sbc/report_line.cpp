// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/report_line.h"

#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace touchline::sbc {
namespace {

const char* name_of(LedPattern led) {
  switch (led) {
    case LedPattern::off: return "off";
    case LedPattern::no_camera: return "no_camera";
    case LedPattern::searching: return "searching";
    case LedPattern::sure: return "sure";
    case LedPattern::fault: return "fault";
  }
  return "off";
}

const char* yes_no(bool value) { return value ? "true" : "false"; }

}  // namespace

void ReportLine::add(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int written = std::vsnprintf(text_.data() + size_, capacity - size_, format, arguments);
  va_end(arguments);
  if (written > 0)
    size_ =
        size_ + static_cast<std::size_t>(written) < capacity ? size_ + static_cast<std::size_t>(written) : capacity - 1;
}

/// JSON knows neither NaN nor infinity.
void ReportLine::add_number(double value, int digits) {
  if (std::isfinite(value)) {
    add("%.*f", digits, value);
  } else {
    add("null");
  }
}

void ReportLine::add_pose(const Pose2& pose) {
  add("{\"x_m\":");
  add_number(static_cast<double>(pose.x), 4);
  add(",\"y_m\":");
  add_number(static_cast<double>(pose.y), 4);
  add(",\"theta_deg\":");
  add_number(static_cast<double>(degrees(pose.theta)), 3);
  add("}");
}

void ReportLine::add_estimate(const PoseEstimate& estimate) {
  if (!estimate.valid) {
    add(",\"pose\":null,\"covariance\":null,\"confidence\":0,\"mirror\":null");
    return;
  }
  add(",\"pose\":");
  add_pose(estimate.pose);
  const PoseCovariance& p = estimate.covariance;
  add(",\"covariance\":[");
  const float entries[] = {p.xx, p.xy, p.yy, p.xt, p.yt, p.tt};
  for (int i = 0; i < 6; ++i) {
    if (i > 0) add(",");
    add_number(static_cast<double>(entries[i]), 8);
  }
  add("],\"confidence\":");
  add_number(static_cast<double>(estimate.confidence), 3);
  if (!estimate.has_mirror) {
    add(",\"mirror\":null");
    return;
  }
  add(",\"mirror\":{\"pose\":");
  add_pose(estimate.mirror);
  add(",\"confidence\":");
  add_number(static_cast<double>(estimate.mirror_confidence), 3);
  add("}");
}

void ReportLine::add_faults(const FaultSet& faults) {
  add(",\"faults\":[");
  bool first = true;
  for (unsigned i = 0; i < static_cast<unsigned>(Fault::count); ++i) {
    const auto fault = static_cast<Fault>(i);
    if (!faults.has(fault)) continue;
    add("%s\"%s\"", first ? "" : ",", to_string(fault));
    first = false;
  }
  add("]");
}

void ReportLine::add_health(const char* name, const DeviceHealth& h, MonotonicNs now) {
  add("\"%s\":{\"open\":%s,\"opened\":%u,\"received\":%u,\"lost\":%u,\"skipped\":%u,\"corrupt\":%u,\"stale\":%u,"
      "\"restarts\":%u,\"last_error\":\"%s\",\"age_ms\":",
      name, yes_no(h.open), h.opened, h.received, h.lost, h.skipped, h.corrupt, h.stale, h.restarts,
      touchline::to_string(h.last_error));
  if (h.last_datum > 0 && now >= h.last_datum) {
    add_number(to_seconds(now - h.last_datum) * 1e3, 1);
  } else {
    add("null");
  }
  add("}");
}

std::string_view ReportLine::format(const RobotReport& r) {
  size_ = 0;
  add("{\"schema\":%d,\"sequence\":%llu,\"t_ns\":%lld,\"from_frame\":%s", report_schema_version,
      static_cast<unsigned long long>(r.sequence), static_cast<long long>(r.time), yes_no(r.from_frame));
  add_estimate(r.estimate);
  add(",\"yaw_used\":%s,\"odometry_used\":%s,\"led\":\"%s\"", yes_no(r.yaw_used), yes_no(r.odometry_used),
      name_of(r.led));
  add(",\"counts\":{\"frames\":%llu,\"junctions\":%d,\"posts\":%d,\"line_points\":%d,\"dropped\":%d,\"yaw_jumps\":%u,"
      "\"odometry_jumps\":%u}",
      static_cast<unsigned long long>(r.frames), r.junctions, r.posts, r.line_points, r.dropped, r.yaw_jumps,
      r.odometry_jumps);
  add(",\"latency_ms\":{\"frame_to_pose\":");
  add_number(to_seconds(r.frame_to_pose) * 1e3, 2);
  add(",\"processing\":");
  add_number(to_seconds(r.processing) * 1e3, 2);
  add("},\"camera\":{\"source\":\"%s\",\"height_m\":", touchline::to_string(r.attitude_source));
  add_number(static_cast<double>(r.camera.height), 4);
  add(",\"pitch_deg\":");
  add_number(static_cast<double>(degrees(r.camera.pitch)), 3);
  add(",\"roll_deg\":");
  add_number(static_cast<double>(degrees(r.camera.roll)), 3);
  add(",\"yaw_deg\":");
  add_number(static_cast<double>(degrees(r.camera.yaw)), 3);
  add("}");
  add_faults(r.faults);
  add(",\"health\":{");
  const MonotonicNs now = r.time + r.frame_to_pose;
  add_health("camera", r.camera_health, now);
  add(",");
  add_health("imu", r.imu_health, now);
  add(",");
  add_health("gait", r.gait_health, now);
  add(",");
  add_health("panel", r.panel_health, now);
  add("}}\n");
  return {text_.data(), size_};
}

}  // namespace touchline::sbc
