#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kingpin::io {

/// SHA-256 (FIPS 180-4) as 64 hexadecimal digits: names the inputs of a run. Not for secrets.
std::string CalcSha256(std::string_view bytes);

/// Of a file's content. Throws InputError as ReadTextFile does.
std::string CalcFileSha256(const std::filesystem::path& path);

}  // namespace kingpin::io
