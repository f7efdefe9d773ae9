// SPDX-License-Identifier: Apache-2.0
// Checked access to the keys of one TOML table: every error names file, line, key and remedy, and a key that nobody
// asked for is an error with the nearest right one.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace touchline::sbc {

/// Every key that was asked for, as "table.key": the installed example must mention them all.
using KeyLog = std::vector<std::string>;

class TomlTable {
 public:
  /// `table` may be null: then every key has its default. `log` may be null.
  TomlTable(const toml::table* table, std::string file, std::string name, KeyLog* log)
      : table_(table), file_(std::move(file)), name_(std::move(name)), log_(log) {}

  [[nodiscard]] bool has(const char* key) const { return table_ != nullptr && table_->contains(key); }
  /// All throw host::HostError for another type, NaN, or a value outside the closed range.
  double number(const char* key, double low, double high, double fallback);
  float real(const char* key, double low, double high, float fallback);
  /// In degrees; returned in radians. `fallback` is in radians.
  float angle(const char* key, double low_deg, double high_deg, float fallback);
  /// In milliseconds; returned in nanoseconds. `fallback` is in nanoseconds.
  std::int64_t milliseconds(const char* key, double low, double high, std::int64_t fallback);
  int integer(const char* key, int low, int high, int fallback);
  bool flag(const char* key, bool fallback);
  std::string text(const char* key, const std::string& fallback);
  /// The position of the value in `choices`.
  std::size_t choice(const char* key, const std::vector<std::string>& choices, std::size_t fallback);
  std::vector<double> numbers(const char* key, std::size_t min_count, std::size_t max_count);
  std::vector<std::string> texts(const char* key);
  /// One list of numbers per entry.
  std::vector<std::vector<double>> lists(const char* key);
  TomlTable table(const char* key);

  /// Throws for a key that nobody asked for. Call it last.
  void finish() const;
  [[noreturn]] void fail(const char* key, const std::string& problem) const;

 private:
  const toml::node* find(const char* key);
  [[nodiscard]] std::string place(const toml::node* node) const;
  double checked(const char* key, const toml::node& node, double low, double high) const;

  const toml::table* table_;
  std::string file_;
  std::string name_;  // "camera", or empty at the top
  KeyLog* log_;
  std::vector<std::string> asked_;
};

}  // namespace touchline::sbc
