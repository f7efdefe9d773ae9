// SPDX-License-Identifier: Apache-2.0
// Lens, mount and field, key by key.
#include "platform/host/chain_tables.h"

#include <nlohmann/json.hpp>

#include "platform/core/angle.h"
#include "platform/host/field_words.h"

namespace touchline::host {
namespace {

const std::vector<std::string> model_names{"equidistant",    "equisolid", "rectilinear",
                                           "kannala_brandt", "barrel",    "polynomial"};  // in the order of LensModel
const std::vector<std::string> field_names{"acyut-5x3", "kidsize-9x6", "small-2026", "middle-2026"};
constexpr double longest_m = 1000.0;  // a field is 14 m; more is a slip of units

float as_float(double value) { return static_cast<float>(value); }
float as_radians(double degrees) { return static_cast<float>(degrees * 3.14159265358979323846 / 180.0); }

template <std::size_t N>
void read_coefficients(KeyReader& keys, const char* key, bool used, std::array<float, N>& out) {
  const auto values = keys.numbers(key, 1, N);
  if (!used || values.empty()) return;
  out.fill(0.0F);
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = as_float(values[i]);
}

void read_model_coefficients(KeyReader& keys, bool given, LensParameters& lens) {
  const auto needed = [given](float value) { return given ? std::optional(static_cast<double>(value)) : std::nullopt; };
  const bool barrel = lens.model == LensModel::barrel;
  const NumberRange alpha{-1.0, 1.0, "give alpha of the barrel model in 1/px^2"};
  const double read_alpha = keys.number("alpha", alpha, barrel ? needed(lens.alpha) : std::optional(0.0));
  if (barrel) lens.alpha = as_float(read_alpha);
  const bool polynomial = lens.model == LensModel::polynomial;
  if (polynomial && !given && !keys.has("a")) {
    keys.fail("a", "is missing; give a list of numbers, lowest power first");
  }
  read_coefficients(keys, "a", polynomial, lens.a);
  read_coefficients(keys, "b", polynomial, lens.b);
  static constexpr const char* k_names[] = {"k1", "k2", "k3", "k4"};
  const bool kannala_brandt = lens.model == LensModel::kannala_brandt;
  for (std::size_t i = 0; i < 4; ++i) {  // checked in any case: a frame may switch to a model without them
    const bool first = i == 0;           // of a model that is new here; those that are left out are 0
    const std::optional<double> left_out = given ? static_cast<double>(lens.k[i]) : 0.0;
    const double k = keys.number(k_names[i], {-1e3, 1e3, "give the model's coefficients, k1 to k4"},
                                 kannala_brandt && first ? needed(lens.k[i])
                                 : kannala_brandt        ? left_out
                                                         : 0.0);
    if (kannala_brandt) lens.k[i] = as_float(k);
  }
}

struct FieldKey {
  const char* name;
  const char* with_unit;
  float FieldDimensions::*member;
  bool required;
};
constexpr FieldKey field_keys[] = {
    {"length", "length_m", &FieldDimensions::length, true},
    {"width", "width_m", &FieldDimensions::width, true},
    {"line_width", "line_width_m", &FieldDimensions::line_width, true},
    {"circle_radius", "circle_radius_m", &FieldDimensions::circle_radius, true},
    {"goal_area_depth", "goal_area_depth_m", &FieldDimensions::goal_area_depth, false},
    {"goal_area_width", "goal_area_width_m", &FieldDimensions::goal_area_width, false},
    {"penalty_area_depth", "penalty_area_depth_m", &FieldDimensions::penalty_area_depth, false},
    {"penalty_area_width", "penalty_area_width_m", &FieldDimensions::penalty_area_width, false},
    {"penalty_mark", "penalty_mark_m", &FieldDimensions::penalty_mark, false},
    {"goal_width", "goal_width_m", &FieldDimensions::goal_width, true},
    {"goal_height", "goal_height_m", &FieldDimensions::goal_height, true},
    {"post_diameter", "post_diameter_m", &FieldDimensions::post_diameter, true},
    {"border", "border_m", &FieldDimensions::border, true},
};

NamedField preset(const KeyReader& keys, const char* key, const std::string& name) {
  const auto dimensions = field_preset(name);
  if (!dimensions) keys.fail(key, unknown_word(name, field_names));
  return {name, *dimensions};
}

const FieldKey& field_key(std::string_view name) {
  for (const auto& key : field_keys) {
    if (name == key.name) return key;
  }
  return field_keys[0];
}

void check_field(const FieldDimensions& dimensions, const KeyReader& keys, const nlohmann::json& table) {
  const char* what = nullptr;
  Field checked;
  if (Field::create(dimensions, checked, &what) == Status::ok) return;
  const FieldKey& key = field_key(what != nullptr ? what : "");
  const bool given = table.contains(key.name) || table.contains(key.with_unit);
  const char* const name = table.contains(key.with_unit) ? key.with_unit : key.name;
  keys.fail(name, "does not fit the rest of the field: it is " + in_words(dimensions.*key.member) +
                      (given                      ? ""
                       : table.contains("preset") ? " in the preset"
                                                  : " by default") +
                      ", but must be " + field_limit(dimensions, key.name) + "; check it against the rule book");
}

}  // namespace

void expect_lens_keys(KeyReader& keys) {
  keys.expect(
      {"model", "focal_px", "cx", "cy", "cx_px", "cy_px", "max_theta_deg", "alpha", "a", "b", "k1", "k2", "k3", "k4"});
}

void read_lens(KeyReader& keys, bool complete, LensParameters& lens) {
  const auto fallback = [complete](float value) {
    return complete ? std::optional(static_cast<double>(value)) : std::nullopt;
  };
  const auto before = static_cast<std::size_t>(lens.model);
  const std::size_t model = keys.choice("model", model_names, complete ? std::optional(before) : std::nullopt,
                                        "give the lens model, e.g. model = \"equidistant\"");
  lens.model = static_cast<LensModel>(model);
  lens.focal_px =
      as_float(keys.number("focal_px", {1.0, 1e5, "give the focal length in camera pixels"}, fallback(lens.focal_px)));
  const NumberRange centre{-1e4, 1e4, "give the principal point in camera pixels"};
  lens.cx = as_float(keys.number(keys.either("cx_px", "cx"), centre, static_cast<double>(lens.cx)));
  lens.cy = as_float(keys.number(keys.either("cy_px", "cy"), centre, static_cast<double>(lens.cy)));
  const NumberRange view{1.0, 180.0, "give the angle from the optical axis that the lens sees, in degrees"};
  const double max_theta_deg = keys.number("max_theta_deg", view, fallback(0.0F));
  if (max_theta_deg > 0.0) lens.max_theta = as_radians(max_theta_deg);
  read_model_coefficients(keys, complete && model == before, lens);
  const char* what = nullptr;
  Lens checked;
  if (Lens::create(lens, checked, &what) != Status::ok) {
    keys.fail("model", std::string("these lens parameters do not fit together: ") +
                           (what != nullptr ? what : "refused") + "; check them against the lens's calibration");
  }
}

void expect_mount_keys(KeyReader& keys) { keys.expect({"x_m", "y_m", "height_m", "yaw_deg", "pitch_deg", "roll_deg"}); }

void read_mount(KeyReader& keys, bool height_given, CameraPose& mount) {
  const NumberRange offset{-10.0, 10.0, "give the camera's place in the robot in metres"};
  const NumberRange height{0.01, 10.0, "give the camera's height above the carpet in metres, > 0"};
  mount.x = as_float(keys.number("x_m", offset, static_cast<double>(mount.x)));
  mount.y = as_float(keys.number("y_m", offset, static_cast<double>(mount.y)));
  mount.height = as_float(
      keys.number("height_m", height, height_given ? std::optional(static_cast<double>(mount.height)) : std::nullopt));
  const auto angle = [&keys](const char* key, float& value) {
    const NumberRange turn{-360.0, 360.0, "give the camera's angle in degrees"};
    if (keys.has(key)) value = as_radians(keys.number(key, turn));
  };
  angle("yaw_deg", mount.yaw);
  angle("pitch_deg", mount.pitch);
  angle("roll_deg", mount.roll);
}

NamedField read_field(KeyReader& top, const std::optional<NamedField>& fallback, KeyNotes* notes) {
  const nlohmann::json* value = top.find("field");
  if (value != nullptr && value->is_string()) return preset(top, "field", value->get<std::string>());
  if (value == nullptr && !fallback) {
    top.fail("field", "is missing; name a preset, e.g. field = \"small-2026\", or give a [field] table");
  }
  if (value != nullptr && !value->is_object()) {
    top.fail("field", "is " + value->dump() + "; name a preset in quotes or give a [field] table");
  }
  KeyReader keys = top.inner("field");
  keys.expect({"preset"});
  for (const auto& key : field_keys) {
    keys.expect({key.with_unit});  // without notes, in the robot's file, the names that its example has are told alone
    if (notes != nullptr) keys.expect({key.name});
  }
  if (notes != nullptr) notes->add(keys);
  std::optional<NamedField> base = fallback;
  const std::string name = keys.text("preset", "");
  if (!name.empty()) base = preset(keys, "preset", name);
  NamedField field = base.value_or(NamedField{"free", {}});
  const NumberRange metres{0.0, longest_m, "give the length in metres, between the centres of lines"};
  for (const auto& key : field_keys) {
    float& length = field.dimensions.*key.member;
    const bool optional = base || !key.required;
    const double read = keys.number(keys.either(key.with_unit, key.name), metres,
                                    optional ? std::optional(base ? static_cast<double>(length) : 0.0) : std::nullopt);
    if (as_float(read) != length) field.name = "free";
    length = as_float(read);
  }
  check_field(field.dimensions, keys, top.table("field"));
  if (notes == nullptr) keys.finish();
  return field;
}

}  // namespace touchline::host
