#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

/// JSON as this program writes it: keys in the order given, two blanks of indentation, numbers that
/// read back as the same double (at most 17 significant digits), and no NaN or infinity, which JSON
/// cannot hold: they become null.
namespace kingpin::io {

std::string FormatJson(const nlohmann::ordered_json& json);

/// A number as JSON has it; `null` when it is not finite.
std::string FormatJsonNumber(double value);

/// A text in quotes, with what JSON demands escaped; bytes that are not UTF-8 become U+FFFD.
std::string FormatJsonText(std::string_view text);

}  // namespace kingpin::io
