// SPDX-License-Identifier: Apache-2.0
// Checked access to the keys of one table.
#include "platform/host/key_reader.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "platform/core/angle.h"
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
  if (value.is_binary()) return {value.get_binary().begin(), value.get_binary().end()};  // a date or a time
  if (value.is_number_float() && std::isinf(value.get<double>())) {
    return value.get<double>() < 0.0 ? "-infinity" : "infinity";
  }
  const std::string text = value.dump();
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

std::string in_words(double value) {
  std::string text = nlohmann::json(value).dump();
  if (text.size() > 2 && text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

std::vector<std::string> without_repeats(const std::vector<std::string>& words) {
  std::vector<std::string> out;
  for (const auto& word : words) {
    if (std::find(out.begin(), out.end(), word) == out.end()) out.push_back(word);
  }
  return out;
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  const std::string* begun = nullptr;  // the only one that begins so
  int beginnings = 0;
  for (const auto& candidate : known) {
    if (word.size() < 3 || !candidate.starts_with(word)) continue;
    beginnings += begun == nullptr || candidate != *begun ? 1 : 0;
    begun = &candidate;
  }
  if (beginnings == 1) return *begun;
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

std::string unknown_word(const std::string& word, const std::vector<std::string>& known) {
  std::string text = "\"" + word + "\" is not known; known are";
  for (const auto& k : known) text.append(&k == &known.front() ? " " : ", ").append(k.empty() ? "\"\"" : k);
  const std::string near = nearest_word(word, known);
  return near.empty() ? text : text + "; did you mean " + near + "?";
}

KeyReader::KeyReader(const nlohmann::json& table, Place place, std::string name, KeyLog* log)
    : table_(&table), place_(std::move(place)), name_(std::move(name)), log_(log) {
  if (table.is_object()) return;
  throw HostError(place_of("") + (name_.empty() ? "" : "[" + name_ + "]: ") + "expected keys and values here, found " +
                  shown(table));
}

std::string KeyReader::place_of(const std::string& key) const {
  int line = place_.line;
  if (place_.lines != nullptr) {
    auto found = place_.lines->find(path_of(key));
    if (found == place_.lines->end()) found = place_.lines->find(name_);
    if (found != place_.lines->end()) line = found->second;
  }
  return place_.file + (line > 0 ? ":" + std::to_string(line) : std::string()) + ": ";
}

void KeyReader::fail(const std::string& key, const std::string& problem) const {
  throw HostError(place_of(key) + in_table(key) + ": " + problem);
}

/// A key that nobody asks for may be the missing one, misspelt.
void KeyReader::fail_missing(const std::string& key, const std::string& remedy) const {
  std::string text = "is missing; " + remedy;
  for (const auto& [word, value] : table_->items()) {
    if (std::find(asked_.begin(), asked_.end(), word) != asked_.end() || nearest_word(word, {key}).empty()) continue;
    text += "; did you mean it by " + word + "?";
    break;
  }
  fail(key, text);
}

const nlohmann::json* KeyReader::find(const char* key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
  if (log_ != nullptr) log_->push_back(path_of(key));
  const auto found = table_->find(key);
  return found == table_->end() ? nullptr : &*found;
}

bool KeyReader::has(const char* key) { return find(key) != nullptr; }

const char* KeyReader::either(const char* with_unit, const char* plain) {
  if (!table_->contains(plain)) return with_unit;
  if (has(with_unit)) fail(with_unit, std::string("says the same as ") + plain + "; give one of them");
  return plain;
}

double KeyReader::checked(const char* key, const nlohmann::json& value, const NumberRange& range) const {
  const std::string limits = in_words(range.low) + " to " + in_words(range.high);
  const std::string remedy = range.remedy != nullptr ? range.remedy : "write a number from " + limits;
  if (!value.is_number()) fail(key, "is " + shown(value) + ", not a number; " + remedy);
  const auto number = value.get<double>();
  if (!std::isfinite(number)) fail(key, "is " + shown(value) + "; " + remedy);
  if (number < range.low || number > range.high) {
    fail(key, "is " + in_words(number) + ", outside " + limits + "; " + remedy);
  }
  return number;
}

double KeyReader::number(const char* key, const NumberRange& range, std::optional<double> fallback) {
  const auto* value = find(key);
  if (value != nullptr) return checked(key, *value, range);
  if (fallback) return *fallback;
  fail_missing(key, range.remedy != nullptr ? range.remedy : "add it");
}

double KeyReader::number(const char* key, double low, double high, double fallback) {
  return number(key, NumberRange{low, high}, fallback);
}

float KeyReader::real(const char* key, double low, double high, float fallback) {
  const auto* value = find(key);
  return value == nullptr ? fallback : static_cast<float>(checked(key, *value, {low, high}));
}

float KeyReader::angle(const char* key, double low_deg, double high_deg, float fallback) {
  const auto* value = find(key);
  return value == nullptr ? fallback : radians(static_cast<float>(checked(key, *value, {low_deg, high_deg})));
}

std::int64_t KeyReader::milliseconds(const char* key, double low, double high, std::int64_t fallback) {
  const auto* value = find(key);
  return value == nullptr ? fallback : std::llround(checked(key, *value, {low, high}) * 1e6);
}

int KeyReader::integer(const char* key, int low, int high, const char* remedy) {
  const NumberRange range{static_cast<double>(low), static_cast<double>(high), remedy};
  const auto* value = find(key);
  if (value != nullptr && value->is_number_float()) {
    NumberRange any;
    any.remedy = remedy;
    const double number = checked(key, *value, any);
    if (number != std::floor(number)) fail(key, "is " + in_words(number) + ", not a whole number; " + remedy);
  }
  return static_cast<int>(number(key, range));
}

int KeyReader::integer(const char* key, int low, int high, int fallback) {
  const auto* value = find(key);
  if (value == nullptr) return fallback;
  if (value->is_number_float()) {
    fail(key,
         "is " + shown(*value) + "; write a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return static_cast<int>(checked(key, *value, {static_cast<double>(low), static_cast<double>(high)}));
}

/// The system ends a name at its first NUL: another file would be opened than the one that is told.
std::string KeyReader::without_nul(const char* key, const nlohmann::json& value) const {
  auto text = value.get<std::string>();
  if (text.find('\0') != std::string::npos) fail(key, "is " + shown(value) + ", with a NUL in it; take that out");
  return text;
}

std::string KeyReader::text(const char* key, std::optional<std::string> fallback, const char* remedy) {
  const auto* value = find(key);
  if (value == nullptr) {
    if (fallback) return *fallback;
    fail_missing(key, remedy);
  }
  if (!value->is_string()) fail(key, "is " + shown(*value) + ", not a text in quotes; write it as one");
  return without_nul(key, *value);
}

std::size_t KeyReader::choice(const char* key, const std::vector<std::string>& choices,
                              std::optional<std::size_t> fallback, const char* remedy) {
  const std::string value = text(key, fallback ? std::optional(choices[*fallback]) : std::nullopt, remedy);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] == value) return i;
  }
  fail(key, unknown_word(value, choices));
}

bool KeyReader::flag(const char* key, bool fallback) {
  const auto* value = find(key);
  if (value == nullptr) return fallback;
  if (!value->is_boolean()) fail(key, "is " + shown(*value) + "; write true or false");
  return value->get<bool>();
}

std::vector<double> KeyReader::numbers(const char* key, std::size_t min_count, std::size_t max_count) {
  std::vector<double> out;
  const auto* value = find(key);
  if (value == nullptr) return out;
  const std::string count =
      std::to_string(min_count) + (max_count > min_count ? " to " + std::to_string(max_count) : "") + " numbers";
  if (!value->is_array()) fail(key, "is " + shown(*value) + "; write a list of " + count);
  if (value->size() < min_count || value->size() > max_count) {
    fail(key, "has " + std::to_string(value->size()) + " entries; write " + count);
  }
  for (const auto& element : *value) {
    if (!element.is_number() || !std::isfinite(element.get<double>())) {
      fail(key, "holds " + shown(element) + "; write finite numbers");
    }
    out.push_back(element.get<double>());
  }
  return out;
}

std::vector<std::string> KeyReader::texts(const char* key) {
  std::vector<std::string> out;
  const auto* value = find(key);
  if (value == nullptr) return out;
  if (!value->is_array()) fail(key, "is " + shown(*value) + "; write a list of texts");
  for (const auto& element : *value) {
    if (!element.is_string()) fail(key, "holds " + shown(element) + "; write texts in quotes");
    out.push_back(without_nul(key, element));
  }
  return out;
}

std::vector<std::vector<double>> KeyReader::lists(const char* key, double most) {
  std::vector<std::vector<double>> out;
  const auto* value = find(key);
  if (value == nullptr) return out;
  if (!value->is_array()) fail(key, "is " + shown(*value) + "; write a list of lists of numbers");
  for (const auto& entry : *value) {
    if (!entry.is_array()) fail(key, "holds " + shown(entry) + "; write a list of lists of numbers");
    out.emplace_back();
    for (const auto& element : entry) out.back().push_back(checked(key, element, {-most, most}));
  }
  return out;
}

const nlohmann::json& KeyReader::table(const char* key) {
  static const nlohmann::json empty = nlohmann::json::object();
  const auto* value = find(key);
  if (value == nullptr) return empty;
  if (!value->is_object()) fail(key, "is " + shown(*value) + "; write a table, [" + path_of(key) + "]");
  return *value;
}

KeyReader KeyReader::inner(const char* key) { return {table(key), place_, path_of(key), log_}; }

/// The other tables of the file that have a key of this name: "[imu], [gait]".
std::string KeyReader::homes_of(const std::string& key) const {
  std::vector<std::string> homes;
  std::string text;
  if (place_.everything == nullptr) return text;
  for (const auto& path : *place_.everything) {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string::npos || path.substr(dot + 1) != key || path.substr(0, dot) == name_) continue;
    const std::string home = std::string("[").append(path, 0, dot).append("]");
    if (std::find(homes.begin(), homes.end(), home) != homes.end()) continue;
    homes.push_back(home);
    text.append(text.empty() ? "" : ", ").append(home);
  }
  return text;
}

void KeyReader::expect(std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
  }
}

std::vector<UnknownKey> KeyReader::unknown_keys() const {
  std::vector<UnknownKey> unknown;
  for (const auto& [key, value] : table_->items()) {
    if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) continue;
    std::string text = in_table(key);
    text.append(value.is_object() ? ": unknown table" : ": unknown key");
    const std::string near = nearest_word(key, asked_);
    const std::string homes = homes_of(key);
    if (!homes.empty()) {
      text.append("; it belongs to ").append(homes);
      if (!near.empty()) text.append("; or did you mean ").append(near).append("?");
    } else if (!near.empty()) {
      text.append("; did you mean ").append(near).append("?");
    } else {
      text.append("; known are");
      const auto known = without_repeats(asked_);
      for (const auto& word : known) text.append(&word == &known.front() ? " " : ", ").append(word);
    }
    unknown.push_back({key, place_of(key), text});
  }
  return unknown;
}

UnknownKey KeyReader::remark(const std::string& key, const std::string& what) const {
  return {key, place_of(key), in_table(key) + ": " + what};
}

void KeyReader::finish() const {
  std::string text;
  for (const auto& unknown : unknown_keys()) text += (text.empty() ? "" : "\n") + unknown.place + unknown.text;
  if (!text.empty()) throw HostError(text);
}

}  // namespace touchline::host
