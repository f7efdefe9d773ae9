// SPDX-License-Identifier: Apache-2.0
// What a dimension of the field may be beside the others, in words: Field::create() names the key, a person wants to
// know the limit and with what it collides.
#pragma once

#include <string>
#include <string_view>

#include "loc/field.h"

namespace touchline::host {

/// "12.5", as short as it can be.
std::string in_words(float metres);
/// "above 0 and below 4.5 (half of length), or 0 together with goal_area_width". `key` as Field::create() names it.
std::string field_limit(const FieldDimensions& field, std::string_view key);

}  // namespace touchline::host
