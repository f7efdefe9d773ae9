// SPDX-License-Identifier: Apache-2.0
// The options of the command line, checked in one place: a number is finite, whole where it counts something, and
// within its range; a text is not empty; a word is one of the known ones. Whatever is wrong becomes a HostError that
// names command, option, value and remedy. For the files that declare options; it brings CLI11 along.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace touchline::host {

/// The range is closed. The help says range and default.
void add_number(CLI::App& app, const std::string& name, double& to, double low, double high, const std::string& help);
void add_number(CLI::App& app, const std::string& name, std::optional<double>& to, double low, double high,
                const std::string& help);
void add_whole(CLI::App& app, const std::string& name, int& to, int low, int high, const std::string& help);
/// Any from 0 on.
void add_whole(CLI::App& app, const std::string& name, std::uint64_t& to, const std::string& help);

/// File and folder names, names of presets.
CLI::Option* add_text(CLI::App& app, const std::string& name, std::string& to, const std::string& help);
/// Positional, at least one.
void add_texts(CLI::App& app, const std::string& name, std::vector<std::string>& to, const std::string& help);

/// `take` is told the place of the word in `known`; known[initial] is the default.
void add_choice(CLI::App& app, const std::string& name, const std::vector<std::string>& known, std::size_t initial,
                const std::function<void(std::size_t)>& take, const std::string& help);
void add_choice(CLI::App& app, const std::string& name, std::string& to, const std::vector<std::string>& known,
                const std::string& help);

/// Throws when the option was given: beside the others it has no meaning.
void refuse_option(const CLI::App& app, const std::string& name, const std::string& why);

/// What CLI11 found wrong with the arguments, in this program's words: one line without the program's name.
std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace touchline::host
