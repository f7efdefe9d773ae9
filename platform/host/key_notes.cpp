// SPDX-License-Identifier: Apache-2.0
// Unknown keys of a data set, each told once.
#include "platform/host/key_notes.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace touchline::host {
namespace {

constexpr std::size_t most_sentences = 20;  // a file with more is of another kind

}  // namespace

void KeyNotes::add(const KeyReader& keys, const nlohmann::json* own) {
  for (const auto& unknown : keys.unknown_keys()) {
    if (own != nullptr && !own->contains(unknown.key)) continue;
    const std::string key = keys.name() + "." + unknown.key;
    const auto same = [&](const Note& note) { return note.key == key; };
    const auto found = std::find_if(notes_.begin(), notes_.end(), same);
    if (found != notes_.end()) {
      ++found->repeats;
    } else {
      notes_.push_back({key, unknown.place, unknown.text, 0});
    }
  }
}

std::vector<std::string> KeyNotes::sentences() const {
  std::vector<std::string> out;
  for (const auto& note : notes_) {
    if (out.size() == most_sentences) break;
    std::string sentence = note.place;
    sentence.append(note.text).append(" (not used");
    if (note.repeats > 0) sentence.append("; ").append(std::to_string(note.repeats)).append(" more lines have it");
    out.push_back(sentence.append(")"));
  }
  return out;
}

void KeyNotes::fail(const HostError& error) const {
  std::string text = error.what();
  for (const auto& sentence : sentences()) {
    if (sentence.find("did you mean") != std::string::npos) text.append("; note: ").append(sentence);
  }
  throw HostError(text);
}

}  // namespace touchline::host
