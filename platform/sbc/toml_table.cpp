// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/toml_table.h"

#include <cmath>
#include <sstream>

#include "platform/core/angle.h"
#include "platform/host/host_error.h"
#include "platform/host/key_reader.h"

namespace touchline::sbc {
namespace {

const char* type_name(const toml::node& node) {
  if (node.is_string()) return "a text";
  if (node.is_number()) return "a number";
  if (node.is_boolean()) return "true or false";
  if (node.is_array()) return "a list";
  if (node.is_table()) return "a table";
  return "a date";
}

std::string in_words(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

}  // namespace

std::string TomlTable::place(const toml::node* node) const {
  if (node == nullptr && table_ != nullptr) node = table_;
  return node != nullptr && node->source().begin.line > 0 ? file_ + ":" + std::to_string(node->source().begin.line)
                                                          : file_;
}

void TomlTable::fail(const char* key, const std::string& problem) const {
  const toml::node* node = table_ != nullptr ? table_->get(key) : nullptr;
  throw host::HostError(place(node) + ": " + (name_.empty() ? "" : name_ + ".") + key + " " + problem);
}

const toml::node* TomlTable::find(const char* key) {
  asked_.emplace_back(key);
  if (log_ != nullptr) log_->push_back((name_.empty() ? "" : name_ + ".") + key);
  return table_ != nullptr ? table_->get(key) : nullptr;
}

double TomlTable::checked(const char* key, const toml::node& node, double low, double high) const {
  if (!node.is_number()) fail(key, std::string("is ") + type_name(node) + "; write a number");
  const double value = *node.value<double>();
  if (!(value >= low && value <= high)) {
    fail(key, "is " + in_words(value) + "; write a number from " + in_words(low) + " to " + in_words(high));
  }
  return value;
}

double TomlTable::number(const char* key, double low, double high, double fallback) {
  const toml::node* node = find(key);
  return node == nullptr ? fallback : checked(key, *node, low, high);
}

float TomlTable::real(const char* key, double low, double high, float fallback) {
  const toml::node* node = find(key);
  return node == nullptr ? fallback : static_cast<float>(checked(key, *node, low, high));
}

float TomlTable::angle(const char* key, double low_deg, double high_deg, float fallback) {
  const toml::node* node = find(key);
  return node == nullptr ? fallback : radians(static_cast<float>(checked(key, *node, low_deg, high_deg)));
}

std::int64_t TomlTable::milliseconds(const char* key, double low, double high, std::int64_t fallback) {
  const toml::node* node = find(key);
  return node == nullptr ? fallback : std::llround(checked(key, *node, low, high) * 1e6);
}

int TomlTable::integer(const char* key, int low, int high, int fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (node->is_floating_point()) fail(key, "is a number with a point; write a whole number");
  return static_cast<int>(checked(key, *node, low, high));
}

bool TomlTable::flag(const char* key, bool fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) fail(key, std::string("is ") + type_name(*node) + "; write true or false");
  return *node->value<bool>();
}

std::string TomlTable::text(const char* key, const std::string& fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_string()) fail(key, std::string("is ") + type_name(*node) + "; write a text in quotation marks");
  return *node->value<std::string>();
}

std::size_t TomlTable::choice(const char* key, const std::vector<std::string>& choices, std::size_t fallback) {
  const std::string value = text(key, choices[fallback]);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] == value) return i;
  }
  std::string all;
  for (const std::string& choice : choices) all += (all.empty() ? "\"" : ", \"") + choice + "\"";
  const std::string nearest = host::nearest_word(value, choices);
  fail(key,
       "is \"" + value + "\"; write one of " + all + (nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)"));
}

std::vector<double> TomlTable::numbers(const char* key, std::size_t min_count, std::size_t max_count) {
  std::vector<double> values;
  const toml::node* node = find(key);
  if (node == nullptr) return values;
  const toml::array* list = node->as_array();
  if (list == nullptr) fail(key, std::string("is ") + type_name(*node) + "; write a list of numbers");
  for (const toml::node& item : *list) values.push_back(checked(key, item, -1e12, 1e12));
  if (values.size() < min_count || values.size() > max_count) {
    fail(key, "has " + std::to_string(values.size()) + " numbers; write " + std::to_string(min_count) +
                  (max_count > min_count ? " to " + std::to_string(max_count) : ""));
  }
  return values;
}

std::vector<std::string> TomlTable::texts(const char* key) {
  std::vector<std::string> values;
  const toml::node* node = find(key);
  if (node == nullptr) return values;
  const toml::array* list = node->as_array();
  if (list == nullptr) fail(key, std::string("is ") + type_name(*node) + "; write a list of texts");
  for (const toml::node& item : *list) {
    if (!item.is_string()) fail(key, std::string("holds ") + type_name(item) + "; write texts in quotation marks");
    values.push_back(*item.value<std::string>());
  }
  return values;
}

std::vector<std::vector<double>> TomlTable::lists(const char* key) {
  std::vector<std::vector<double>> values;
  const toml::node* node = find(key);
  if (node == nullptr) return values;
  const toml::array* outer = node->as_array();
  if (outer == nullptr) fail(key, std::string("is ") + type_name(*node) + "; write a list of lists of numbers");
  for (const toml::node& entry : *outer) {
    const toml::array* inner = entry.as_array();
    if (inner == nullptr) fail(key, std::string("holds ") + type_name(entry) + "; write a list of lists of numbers");
    values.emplace_back();
    for (const toml::node& item : *inner) values.back().push_back(checked(key, item, -1e12, 1e12));
  }
  return values;
}

TomlTable TomlTable::table(const char* key) {
  const toml::node* node = find(key);
  const std::string name = (name_.empty() ? "" : name_ + ".") + key;
  if (node == nullptr) return {nullptr, file_, name, log_};
  if (!node->is_table()) fail(key, std::string("is ") + type_name(*node) + "; write a table, [" + name + "]");
  return {node->as_table(), file_, name, log_};
}

void TomlTable::finish() const {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    bool known = false;
    for (const std::string& asked : asked_) known = known || asked == name;
    if (known) continue;
    const std::string nearest = host::nearest_word(name, asked_);
    std::string all;
    for (const std::string& asked : asked_) all += (all.empty() ? "" : ", ") + asked;
    throw host::HostError(place(&node) + ": " + (name_.empty() ? "" : name_ + ".") + name +
                          " is no key of this program" +
                          (nearest.empty() ? "; here are known: " + all : "; did you mean " + nearest + "?"));
  }
}

}  // namespace touchline::sbc
