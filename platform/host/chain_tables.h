// SPDX-License-Identifier: Apache-2.0
// Lens, mount and field as files give them: the same keys and the same checks in dataset.toml, in the lines of
// frames.jsonl and in the robot's file.
#pragma once

#include <optional>
#include <string>

#include "loc/field.h"
#include "platform/host/key_notes.h"
#include "platform/host/key_reader.h"
#include "vision/lens/camera_pose.h"
#include "vision/lens/lens.h"

namespace touchline::host {

/// The lens's coefficients that belong to one model alone.
struct LensKeyOwner {
  const char* key;
  LensModel model;
  const char* name;
};
inline constexpr LensKeyOwner lens_key_owners[] = {{"k1", LensModel::kannala_brandt, "kannala_brandt"},
                                                   {"k2", LensModel::kannala_brandt, "kannala_brandt"},
                                                   {"k3", LensModel::kannala_brandt, "kannala_brandt"},
                                                   {"k4", LensModel::kannala_brandt, "kannala_brandt"},
                                                   {"alpha", LensModel::barrel, "barrel"},
                                                   {"a", LensModel::polynomial, "polynomial"},
                                                   {"b", LensModel::polynomial, "polynomial"}};

void expect_lens_keys(KeyReader& keys);
/// `lens` comes in with the defaults: with `complete` of all keys, else of cx and cy alone. Of the coefficients those
/// of the model are read; they have defaults when the model is the default one.
void read_lens(KeyReader& keys, bool complete, LensParameters& lens);

void expect_mount_keys(KeyReader& keys);
/// `mount` comes in with the defaults; without `height_given` height_m has none.
void read_mount(KeyReader& keys, bool height_given, CameraPose& mount);

struct NamedField {
  std::string name;  // of the preset, or "free"
  FieldDimensions dimensions;
};
/// The key `field` of `top`: a preset's name, or a table with a preset, single keys, or both. `fallback` is taken where
/// the key is missing or names no preset; nothing: then it is an error. Unknown keys go to `notes`; null: they are
/// errors.
NamedField read_field(KeyReader& top, const std::optional<NamedField>& fallback, KeyNotes* notes);

}  // namespace touchline::host
