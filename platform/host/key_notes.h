// SPDX-License-Identifier: Apache-2.0
// Unknown keys of a data set, each told once, however many lines of frames.jsonl have it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "platform/host/host_error.h"
#include "platform/host/key_reader.h"

namespace touchline::host {

class KeyNotes {
 public:
  /// Of a table that was laid over another, `own` alone counts.
  void add(const KeyReader& keys, const nlohmann::json* own = nullptr);
  /// Something else to say about a key of the table, likewise told once.
  void say(const KeyReader& keys, const std::string& key, const std::string& what, const nlohmann::json* own = nullptr);
  /// "file:3: [mount] pich_deg: unknown key; did you mean pitch_deg? (not used; 99 more lines have it)"
  [[nodiscard]] std::vector<std::string> sentences() const;
  /// The error may come from a key that was misspelt: what is known about such keys is told with it.
  [[noreturn]] void fail(const HostError& error) const;

 private:
  void take(const KeyReader& keys, const UnknownKey& remark, const char* end);

  struct Note {
    std::string key;    // with its table
    std::string place;  // first seen
    std::string text;
    int repeats;
    const char* end;  // of the sentence: "not used"
  };
  std::vector<Note> notes_;
};

}  // namespace touchline::host
