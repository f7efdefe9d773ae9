// SPDX-License-Identifier: Apache-2.0
// Checked access to the keys of one table: every error names the file (and line), the key and the remedy. Keys that
// nobody asked for are collected, so that a typing error does not pass unseen.
#pragma once

#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace touchline::host {

/// The entry of `known` that is nearest to `word` by edit distance; empty when nothing is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// What a number may be: a closed range, and the advice that ends the error's text.
struct NumberRange {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  const char* remedy = "give a finite number";
};

struct UnknownKey {
  std::string key;   // with its table
  std::string text;  // "field.penalty_mrk: unknown key, not used; did you mean penalty_mark?"
};

class KeyReader {
 public:
  /// `table` must outlive the reader. `where` is the file, with the line where there is one; `prefix` is the table's
  /// name and a dot, or nothing at the top.
  KeyReader(const nlohmann::json& table, std::string where, std::string prefix);

  bool has(const char* key);
  /// Throws HostError when the key is missing and there is no fallback, is no number, is NaN or out of range.
  double number(const char* key, const NumberRange& range, std::optional<double> fallback = std::nullopt);
  int integer(const char* key, int low, int high, const char* remedy);
  std::string text(const char* key, std::optional<std::string> fallback = std::nullopt, const char* remedy = "add it");
  bool flag(const char* key, bool fallback);
  std::vector<double> numbers(const char* key, std::size_t max_count);
  /// An empty table when the key is missing.
  const nlohmann::json& table(const char* key);
  /// Throws when it is missing.
  const nlohmann::json& required_table(const char* key, const std::string& remedy);
  const nlohmann::json* find(const char* key);

  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;
  /// Tells all keys that may be asked for, so that unknown_keys() can be called before they are.
  void expect(std::initializer_list<const char*> keys);
  /// Each key that nobody asks for, with the nearest right one.
  [[nodiscard]] std::vector<UnknownKey> unknown_keys() const;
  [[nodiscard]] std::string prefix() const { return prefix_; }
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  const nlohmann::json& table_;
  std::string where_;
  std::string prefix_;
  std::vector<std::string> asked_;
};

}  // namespace touchline::host
