// SPDX-License-Identifier: Apache-2.0
// Checked access to the keys of one table.
#include "platform/host/key_reader.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "platform/host/host_error.h"

namespace touchline::host {
namespace {

/// Levenshtein distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0U : 1U);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string shown(const nlohmann::json& value) {
  if (value.is_number_float() && std::isnan(value.get<double>())) return "NaN";
  const std::string text = value.is_number_float() && std::isinf(value.get<double>()) ? "infinity" : value.dump();
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

std::string in_words(double value) {
  std::string text = nlohmann::json(value).dump();
  if (text.size() > 2 && text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const auto& candidate : known) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

KeyReader::KeyReader(const nlohmann::json& table, std::string where, std::string prefix)
    : table_(table), where_(std::move(where)), prefix_(std::move(prefix)) {
  if (!table_.is_object()) throw HostError(where_ + ": expected keys and values here, found " + shown(table_));
}

void KeyReader::fail(const std::string& key, const std::string& problem) const {
  throw HostError(where_ + ": " + prefix_ + key + ": " + problem);
}

const nlohmann::json* KeyReader::find(const char* key) {
  asked_.emplace_back(key);
  const auto found = table_.find(key);
  return found == table_.end() ? nullptr : &*found;
}

bool KeyReader::has(const char* key) { return find(key) != nullptr; }

double KeyReader::number(const char* key, const NumberRange& range, std::optional<double> fallback) {
  const auto* value = find(key);
  if (value == nullptr) {
    if (fallback) return *fallback;
    fail(key, std::string("is missing; ") + range.remedy);
  }
  if (!value->is_number()) fail(key, "is " + shown(*value) + ", not a number; " + range.remedy);
  const auto number = value->get<double>();
  if (!std::isfinite(number)) fail(key, "is " + shown(*value) + "; " + range.remedy);
  if (number < range.low || number > range.high) {
    fail(key, "is " + in_words(number) + ", outside " + in_words(range.low) + " to " + in_words(range.high) + "; " +
                  range.remedy);
  }
  return number;
}

int KeyReader::integer(const char* key, int low, int high, const char* remedy) {
  const double value = number(key, {static_cast<double>(low), static_cast<double>(high), remedy});
  if (value != std::floor(value)) fail(key, "is " + in_words(value) + ", not a whole number; " + remedy);
  return static_cast<int>(value);
}

std::string KeyReader::text(const char* key, std::optional<std::string> fallback, const char* remedy) {
  const auto* value = find(key);
  if (value == nullptr) {
    if (fallback) return *fallback;
    fail(key, std::string("is missing; ") + remedy);
  }
  if (!value->is_string()) fail(key, "is " + shown(*value) + ", not a text in quotes; " + remedy);
  return value->get<std::string>();
}

bool KeyReader::flag(const char* key, bool fallback) {
  const auto* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_boolean()) fail(key, "is " + shown(*value) + "; give true or false");
  return value->get<bool>();
}

std::vector<double> KeyReader::numbers(const char* key, std::size_t max_count) {
  const auto* value = find(key);
  if (value == nullptr) fail(key, "is missing; give a list of numbers, lowest power first");
  std::vector<double> out;
  if (!value->is_array() || value->empty() || value->size() > max_count) {
    fail(key, "must be a list of 1 to " + std::to_string(max_count) + " numbers, lowest power first");
  }
  for (const auto& element : *value) {
    if (!element.is_number() || !std::isfinite(element.get<double>())) {
      fail(key, "holds " + shown(element) + "; give finite numbers");
    }
    out.push_back(element.get<double>());
  }
  return out;
}

const nlohmann::json& KeyReader::table(const char* key) {
  static const nlohmann::json empty = nlohmann::json::object();
  const auto* value = find(key);
  if (value == nullptr) return empty;
  if (!value->is_object()) fail(key, "is " + shown(*value) + ", not a table of keys and values");
  return *value;
}

const nlohmann::json& KeyReader::required_table(const char* key, const std::string& remedy) {
  if (!has(key)) fail(key, "the table is missing; " + remedy);
  return table(key);
}

void KeyReader::expect(std::initializer_list<const char*> keys) {
  asked_.insert(asked_.end(), keys.begin(), keys.end());
}

std::vector<UnknownKey> KeyReader::unknown_keys() const {
  std::vector<UnknownKey> unknown;
  for (const auto& [key, value] : table_.items()) {
    if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) continue;
    const std::string near = nearest_word(key, asked_);
    std::string name = prefix_;
    name.append(key);
    std::string text = name;
    text.append(value.is_object() ? ": unknown table, not used" : ": unknown key, not used");
    if (!near.empty()) text.append("; did you mean ").append(near).append("?");
    unknown.push_back({name, text});
  }
  return unknown;
}

}  // namespace touchline::host
