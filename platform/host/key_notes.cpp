// SPDX-License-Identifier: Apache-2.0
// Unknown keys of a data set, each told once.
#include "platform/host/key_notes.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchline::host {
namespace {

constexpr std::size_t most_sentences = 20;  // a file with more is of another kind

}  // namespace

void KeyNotes::take(const KeyReader& keys, const UnknownKey& remark, const char* end) {
  const std::string key = keys.name() + "." + remark.key;
  const auto same = [&](const Note& note) { return note.key == key && note.text == remark.text; };
  const auto found = std::find_if(notes_.begin(), notes_.end(), same);
  if (found != notes_.end()) {
    ++found->repeats;
  } else {
    notes_.push_back({key, remark.place, remark.text, 0, end});
  }
}

void KeyNotes::add(const KeyReader& keys, const nlohmann::json* own) {
  for (const auto& unknown : keys.unknown_keys()) {
    if (own == nullptr || own->contains(unknown.key)) take(keys, unknown, "not used");
  }
}

void KeyNotes::say(const KeyReader& keys, const std::string& key, const std::string& what, const nlohmann::json* own) {
  if (own == nullptr || own->contains(key)) take(keys, keys.remark(key, what), "");
}

std::vector<std::string> KeyNotes::sentences() const {
  std::vector<std::string> out;
  for (const auto& note : notes_) {
    if (out.size() == most_sentences) break;
    std::string end = note.end;
    if (note.repeats > 0) {
      end.append(end.empty() ? "" : "; ").append(std::to_string(note.repeats)).append(" more lines have it");
    }
    out.push_back(note.place + note.text + (end.empty() ? "" : " (" + end + ")"));
  }
  return out;
}

void KeyNotes::fail(const HostError& error) const {
  std::string text = error.what();
  for (const auto& sentence : sentences()) {
    if (text.find("did you mean it by") != std::string::npos) break;  // it was said
    if (sentence.find("did you mean") != std::string::npos) text.append("; note: ").append(sentence);
  }
  throw HostError(text);
}

}  // namespace touchline::host
