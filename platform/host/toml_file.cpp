// SPDX-License-Identifier: Apache-2.0
// Reads TOML by toml++ and turns the tree into a JSON value.
#include "platform/host/toml_file.h"

#include <sstream>

#include <toml++/toml.h>
#include <nlohmann/json.hpp>

#include "platform/host/host_error.h"

namespace touchline::host {
namespace {

// NOLINTNEXTLINE(misc-no-recursion): a tree, as deep as the file is nested; toml++ bounds that
nlohmann::json to_json(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    auto out = nlohmann::json::object();
    for (const auto& [key, value] : *table) out[std::string(key.str())] = to_json(value);
    return out;
  }
  if (const auto* array = node.as_array()) {
    auto out = nlohmann::json::array();
    for (const auto& value : *array) out.push_back(to_json(value));
    return out;
  }
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* truth = node.as_boolean()) return truth->get();
  std::ostringstream text;
  node.visit([&text](const auto& value) { text << value; });
  return text.str();
}

}  // namespace

nlohmann::json read_toml(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw HostError(path.string() +
                    ": no such file; a data set is a folder with dataset.toml, frames.jsonl and images");
  }
  try {
    return to_json(toml::parse_file(path.string()));
  } catch (const toml::parse_error& error) {
    throw HostError(path.string() + ": line " + std::to_string(error.source().begin.line) +
                    ": not valid TOML: " + std::string(error.description()) + "; correct that line");
  }
}

}  // namespace touchline::host
