// SPDX-License-Identifier: Apache-2.0
// Checked access to the keys of one table of dataset.toml, of a line of frames.jsonl, or of the robot's file. Every
// error reads "file:line: [table] key: what is wrong; remedy". Keys that nobody asked for are found, so that a typing
// error does not pass unseen.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace touchline::host {

/// The entry of `known` that begins with `word`, where there is one, else the nearest by edit distance; empty when
/// nothing is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);
/// "\"x\" is not known; known are a, b; did you mean a?"
std::string unknown_word(const std::string& word, const std::vector<std::string>& known);

/// What a number may be: a closed range, and the advice that ends the error's text.
struct NumberRange {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  const char* remedy = nullptr;  // null: the range says it
};

/// Every key that was asked for, as "table.key".
using KeyLog = std::vector<std::string>;

/// Where a table stands.
struct Place {
  std::string file;
  int line = 0;                                       // of all of it, as in frames.jsonl; 0: see `lines`
  const std::map<std::string, int>* lines = nullptr;  // by "table.key", of a TOML file; outlives the reader
  const KeyLog* everything = nullptr;  // that the file may have, to tell where a key belongs; outlives it
};

/// A key that nobody asked for, or about which there is something else to say.
struct UnknownKey {
  std::string key;    // without its table
  std::string place;  // "file:line: "
  std::string text;   // "[field] penalty_mrk: unknown key; did you mean penalty_mark?"
};

class KeyReader {
 public:
  /// `table` must outlive the reader. `name` is the table's, "imu.yaw", or nothing at the top. `log` may be null.
  KeyReader(const nlohmann::json& table, Place place, std::string name, KeyLog* log = nullptr);

  bool has(const char* key);
  /// Of two names for one value, `plain` where the table has it, else `with_unit`; an error where it has both.
  const char* either(const char* with_unit, const char* plain);
  /// All below throw HostError for another type, a number that is not finite or out of range; and for a missing key
  /// where there is no fallback.
  double number(const char* key, const NumberRange& range, std::optional<double> fallback = std::nullopt);
  double number(const char* key, double low, double high, double fallback);
  float real(const char* key, double low, double high, float fallback);
  /// In degrees; returned in radians. `fallback` is in radians.
  float angle(const char* key, double low_deg, double high_deg, float fallback);
  /// In milliseconds; returned in nanoseconds. `fallback` is in nanoseconds.
  std::int64_t milliseconds(const char* key, double low, double high, std::int64_t fallback);
  int integer(const char* key, int low, int high, const char* remedy);
  int integer(const char* key, int low, int high, int fallback);
  std::string text(const char* key, std::optional<std::string> fallback = std::nullopt, const char* remedy = "add it");
  /// The place of the word in `choices`.
  std::size_t choice(const char* key, const std::vector<std::string>& choices, std::optional<std::size_t> fallback,
                     const char* remedy = "add it");
  bool flag(const char* key, bool fallback);
  /// Empty when the key is missing; else as many as said.
  std::vector<double> numbers(const char* key, std::size_t min_count, std::size_t max_count);
  std::vector<std::string> texts(const char* key);
  /// One list of numbers per entry, each from -`most` to `most`.
  std::vector<std::vector<double>> lists(const char* key, double most);
  /// An empty table when the key is missing.
  const nlohmann::json& table(const char* key);
  KeyReader inner(const char* key);
  const nlohmann::json* find(const char* key);

  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;
  /// Tells all keys that may be asked for, so that unknown_keys() can be called before they are.
  void expect(std::initializer_list<const char*> keys);
  /// Each key that nobody asks for, with the nearest right one.
  [[nodiscard]] std::vector<UnknownKey> unknown_keys() const;
  /// A sentence about a key, with its place.
  [[nodiscard]] UnknownKey remark(const std::string& key, const std::string& what) const;
  /// Throws for unknown keys, a line for each. Call it last.
  void finish() const;
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Place& place() const { return place_; }

 private:
  [[nodiscard]] std::string path_of(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }
  [[nodiscard]] std::string in_table(const std::string& key) const {
    return name_.empty() ? key : "[" + name_ + "] " + key;
  }
  [[nodiscard]] std::string homes_of(const std::string& key) const;
  [[nodiscard]] std::string place_of(const std::string& key) const;
  [[noreturn]] void fail_missing(const std::string& key, const std::string& remedy) const;
  [[nodiscard]] std::string without_nul(const char* key, const nlohmann::json& value) const;
  double checked(const char* key, const nlohmann::json& value, const NumberRange& range) const;

  const nlohmann::json* table_;
  Place place_;
  std::string name_;
  KeyLog* log_;
  std::vector<std::string> asked_;
};

}  // namespace touchline::host
