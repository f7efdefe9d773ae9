// SPDX-License-Identifier: Apache-2.0
// A field for tests, by the name of its preset.
#pragma once

#include <doctest/doctest.h>

#include "loc/field.h"

namespace touchline::test {

inline Field field_of(std::string_view preset) {
  Field field;
  const auto dimensions = field_preset(preset);
  REQUIRE(dimensions.has_value());
  REQUIRE(Field::create(*dimensions, field) == Status::ok);
  return field;
}

}  // namespace touchline::test
