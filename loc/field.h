// SPDX-License-Identifier: Apache-2.0
// The field's dimensions, its lines, and the landmarks that follow from them. All in metres, between centres of lines.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>

#include "platform/core/geometry.h"
#include "platform/core/static_vector.h"
#include "platform/core/status.h"
#include "vision/features.h"
#include "vision/vision_config.h"

namespace touchline {

struct FieldDimensions {
  float length = 9.0F, width = 6.0F;
  float line_width = 0.05F;
  float circle_radius = 0.75F;                                 // 0: none
  float goal_area_depth = 1.0F, goal_area_width = 3.0F;        // 0, 0: none
  float penalty_area_depth = 2.0F, penalty_area_width = 4.0F;  // 0, 0: none
  float penalty_mark = 1.5F;                                   // from the goal line; 0: none
  float goal_width = 1.8F;                                     // between the centres of posts
  float goal_height = 1.2F;
  float post_diameter = 0.10F;
  float border = 1.0F;  // carpet beyond the line's centre
};

/// "acyut-5x3", "kidsize-9x6" (2017), "small-2026", "middle-2026"; nothing for another name.
std::optional<FieldDimensions> field_preset(std::string_view name);

/// What vision has to know of a field: width of lines, radius of the circle, diameter of posts.
void tell_vision(const FieldDimensions& field, VisionConfig& vision);

struct FieldLine {
  FieldPoint a, b;
};
/// The same line by its axis: from low to high along it, at `across` on the other one.
struct AxisLine {
  float low = 0.0F, high = 0.0F, across = 0.0F;
  int index = 0;  // in Field::lines()
};
struct FieldLandmark {
  JunctionType type = JunctionType::l;
  FieldPoint at;
  /// Branch directions in the field frame, ordered as in Junction::direction.
  int branches = 0;
  float direction[4] = {};
};

inline constexpr std::size_t max_field_lines = 17;      // 4 border, half line, 2 x 3 goal area, 2 x 3 penalty area
inline constexpr std::size_t max_field_landmarks = 32;  // 2 X, 2 + 8 T, 4 + 8 L = 24 at the most
inline constexpr float max_field_length = 14.0F, max_field_width = 9.0F, max_field_border = 1.5F;

/// A field whose dimensions were checked, with all that follows from them. Lines: the two touch lines, the two goal
/// lines, the half line, then those of the goal areas and of the penalty areas. The centre circle is no segment and
/// stands apart. Landmarks come in pairs: the one at 2 i + 1 is the one at 2 i, turned by half a turn about the centre
/// mark.
class Field {
 public:
  /// invalid_argument: not finite, out of range, or areas that do not fit; `what` names the key, when not null.
  static Status create(const FieldDimensions& dimensions, Field& out, const char** what = nullptr);

  [[nodiscard]] const FieldDimensions& dimensions() const { return dimensions_; }
  [[nodiscard]] std::span<const FieldLine> lines() const& { return lines_.span(); }
  /// Those along x, those along y, each in the order of lines().
  [[nodiscard]] std::span<const AxisLine> lines_along_x() const& { return {by_axis_.data(), along_x_}; }
  [[nodiscard]] std::span<const AxisLine> lines_along_y() const& {
    return {by_axis_.data() + along_x_, lines_.size() - along_x_};
  }
  [[nodiscard]] std::span<const FieldLandmark> landmarks() const& { return landmarks_.span(); }
  [[nodiscard]] std::span<const FieldPoint> posts() const& { return posts_.span(); }  // own two, then opponent's two
  /// None, or own and opponent's.
  [[nodiscard]] std::span<const FieldPoint> penalty_marks() const& { return penalty_marks_.span(); }
  // The spans refer into the field: a temporary would leave them dangling.
  std::span<const FieldLine> lines() const&& = delete;
  std::span<const AxisLine> lines_along_x() const&& = delete;
  std::span<const AxisLine> lines_along_y() const&& = delete;
  std::span<const FieldLandmark> landmarks() const&& = delete;
  std::span<const FieldPoint> posts() const&& = delete;
  std::span<const FieldPoint> penalty_marks() const&& = delete;
  /// Half of length (width) plus border: the carpet's edge.
  [[nodiscard]] float half_carpet_length() const { return dimensions_.length * 0.5F + dimensions_.border; }
  [[nodiscard]] float half_carpet_width() const { return dimensions_.width * 0.5F + dimensions_.border; }

 private:
  FieldDimensions dimensions_{};
  StaticVector<FieldLine, max_field_lines> lines_;
  std::array<AxisLine, max_field_lines> by_axis_{};  // along x, then along y
  std::size_t along_x_ = 0;                          // how many of them run along x
  StaticVector<FieldLandmark, max_field_landmarks> landmarks_;
  StaticVector<FieldPoint, 4> posts_;
  StaticVector<FieldPoint, 2> penalty_marks_;

  void add_lines();
  void sort_by_axis();
  void add_landmarks();
  void add_pair(JunctionType type, const FieldPoint& at, std::initializer_list<float> directions);
  void add_area(float depth, float width);
};

}  // namespace touchline
