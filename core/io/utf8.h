#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace kingpin::io {

/// Where the first byte stands that makes the text no UTF-8 (RFC 3629: no overlong forms, no
/// surrogates, nothing above U+10FFFF), if there is one.
std::optional<std::size_t> FindInvalidUtf8(std::string_view text);

}  // namespace kingpin::io
