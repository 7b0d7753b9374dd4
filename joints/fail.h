#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "core/io/error.h"
#include "joints/mechanism_description.h"

namespace kingpin::joints {

/// Throws the io::InputError of something a user wrote at `source`.
[[noreturn]] inline void Fail(const Source& source, std::string key, std::string found,
                              std::string expected, std::string suggestion = {}) {
  throw io::InputError({.file = source.file,
                        .line = source.line,
                        .key = std::move(key),
                        .found = std::move(found),
                        .expected = std::move(expected),
                        .suggestion = std::move(suggestion)});
}

inline bool IsFinite(const Vector3<double>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

inline bool IsFinite(const Transform<double>& X) {
  return IsFinite(X.p) && IsFinite(X.R.x) && IsFinite(X.R.y) && IsFinite(X.R.z);
}

}  // namespace kingpin::joints
