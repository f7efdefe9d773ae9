// SPDX-License-Identifier: Apache-2.0
#include "vision/vision_config.h"

#include "vision/image/frame_fifo.h"

namespace touchline {
namespace {

Status refuse(const char** what, const char* key) {
  if (what != nullptr) *what = key;
  return Status::invalid_argument;
}

bool odd_kernel(int side) { return side >= 1 && side <= 31 && side % 2 == 1; }

bool weight(int value) { return value >= 0 && value <= 32767; }

bool is_range(const HsvRange& r) {
  return r.hue_low <= 179 && r.hue_high <= 179 && r.saturation_low <= r.saturation_high && r.value_low <= r.value_high;
}

/// NaN fails every comparison.
bool in_reach(const MaskPolygon& polygon) {
  for (const PixelPoint& p : polygon) {
    if (!(p.u >= -max_mask_coordinate_px && p.u <= max_mask_coordinate_px && p.v >= -max_mask_coordinate_px &&
          p.v <= max_mask_coordinate_px)) {
      return false;
    }
  }
  return true;
}

/// All that every table has.
bool is_whole(const Kernels& k) {
  const bool frame = k.change_rows != nullptr && k.subsample.add_row != nullptr &&
                     k.subsample.reduce_columns != nullptr && k.subsample.change_colour != nullptr &&
                     k.subsample.halve != nullptr;
  const bool colour = k.hsv_rows != nullptr && k.white_rows != nullptr && k.carpet.count_colours != nullptr &&
                      k.carpet.sum_chroma != nullptr && k.carpet.count_ratios != nullptr;
  const bool points =
      k.probes.axes != nullptr && k.probes.edges != nullptr && k.probes.widths != nullptr && k.probes.places != nullptr;
  return frame && colour && points && k.find_ridges != nullptr;
}

}  // namespace

Status check_config(const VisionConfig& c, const char** what) {
  if (!is_whole(c.kernels)) return refuse(what, "kernels");
  if (c.fifo_depth < 1 || c.fifo_depth > max_fifo_depth) return refuse(what, "fifo_depth");
  if (!odd_kernel(c.green_erode_px)) return refuse(what, "green_erode_px");
  if (!odd_kernel(c.green_dilate_px)) return refuse(what, "green_dilate_px");
  if (!odd_kernel(c.line_dilate_px)) return refuse(what, "line_dilate_px");
  if (!odd_kernel(c.line_erode_px)) return refuse(what, "line_erode_px");
  if (!(c.line_width_m > 0.005F && c.line_width_m < 1.0F)) return refuse(what, "line_width_m");
  if (!(c.max_range_m > 0.1F && c.max_range_m < 100.0F)) return refuse(what, "max_range_m");
  if (!is_range(c.green) || c.green.hue_low > c.green.hue_high) return refuse(what, "green");
  if (!is_range(c.yellow_post)) return refuse(what, "yellow_post");
  if (!is_range(c.white_post)) return refuse(what, "white_post");
  if (c.digestion_radius_px < 1 || c.digestion_radius_px > 64) return refuse(what, "digestion_radius_px");
  if (!weight(c.low_weight)) return refuse(what, "low_weight");
  if (!weight(c.medium_weight)) return refuse(what, "medium_weight");
  if (!weight(c.high_weight)) return refuse(what, "high_weight");
  if (c.spur_px < 0 || c.spur_px > 64) return refuse(what, "spur_px");
  if (!(c.circle_radius_m >= 0.0F && c.circle_radius_m < 10.0F)) return refuse(what, "circle_radius_m");
  if (!(c.post_diameter_m > 0.005F && c.post_diameter_m < 1.0F)) return refuse(what, "post_diameter_m");
  for (const MaskPolygon& polygon : c.body_mask) {
    if (!in_reach(polygon)) return refuse(what, "body_mask");
  }
  return Status::ok;
}

}  // namespace touchline
