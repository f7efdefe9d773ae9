// SPDX-License-Identifier: Apache-2.0
// The limits of Field::create(), in words (loc/field.cpp).
#include "platform/host/field_words.h"

#include <cstdio>

namespace touchline::host {
namespace {

std::string from_to(float low, float high) { return "from " + in_words(low) + " to " + in_words(high); }

std::string below(float limit, const std::string& reason) { return "below " + in_words(limit) + " (" + reason + ")"; }

std::string area_limit(const FieldDimensions& f, bool penalty, bool depth) {
  const std::string name = penalty ? "penalty_area_" : "goal_area_";
  const std::string other = name + (depth ? "width" : "depth");
  const float other_value =
      penalty ? (depth ? f.penalty_area_width : f.penalty_area_depth) : (depth ? f.goal_area_width : f.goal_area_depth);
  const float inner = !penalty ? 0.0F : depth ? f.goal_area_depth : f.goal_area_width;
  std::string text = "above " + in_words(inner);
  if (inner > 0.0F) text += std::string(" (goal_area_") + (depth ? "depth)" : "width)");
  text += " and " + (depth ? below(0.5F * f.length - f.circle_radius, "half of length, less circle_radius")
                           : below(f.width, "width"));
  return text + ", or 0 together with " + other + (other_value > 0.0F ? ", which is " + in_words(other_value) : "");
}

}  // namespace

std::string in_words(float metres) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", static_cast<double>(metres));
  return text;
}

std::string field_limit(const FieldDimensions& field, std::string_view key) {
  if (key == "length") return from_to(1.0F, max_field_length);
  if (key == "width") return from_to(1.0F, max_field_width);
  if (key == "line_width") return from_to(0.01F, 0.3F);
  if (key == "circle_radius") {
    return below(0.5F * (field.width < field.length ? field.width : field.length), "half of the field's shorter side");
  }
  if (key == "goal_area_depth") return area_limit(field, false, true);
  if (key == "goal_area_width") return area_limit(field, false, false);
  if (key == "penalty_area_depth") return area_limit(field, true, true);
  if (key == "penalty_area_width") return area_limit(field, true, false);
  if (key == "penalty_mark") return below(0.5F * field.length, "half of length");
  if (key == "goal_width") return "above 0 and " + below(field.width, "width");
  if (key == "goal_height") return from_to(0.1F, 5.0F);
  if (key == "post_diameter") return from_to(0.01F, 0.5F);
  if (key == "border") return from_to(0.0F, max_field_border);
  return "another length";
}

}  // namespace touchline::host
