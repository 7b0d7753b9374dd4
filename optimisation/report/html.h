#pragma once

#include <set>
#include <string>
#include <string_view>

namespace kingpin::report {

/// Text as HTML or SVG content or attribute value: & < > " ' become entities, control characters
/// that HTML forbids become U+FFFD.
std::string EscapeHtml(std::string_view text);

/// Text with its symbols set: `r_L` as r<sub>L</sub>, base in italics; escaped. A symbol is a word
/// of one or two characters, an underscore and up to four letters or digits; anything longer (keys,
/// paths) stays as it is.
std::string SymbolHtml(std::string_view text);

/// The same for SVG text, with shifted tspans.
std::string SymbolSvg(std::string_view text);

/// `N*m/rad` as N·m/rad, `mm/s^2` as mm/s²; not escaped.
std::string PrettyUnit(std::string_view unit);

/// `name [unit]`, or the name alone; escaped.
std::string WithUnit(std::string_view name, std::string_view unit);

/// Gives every element of a document an id of its own.
class IdPool {
 public:
  /// Lower-case letters, digits and hyphens made from the text; numbered when taken.
  std::string MakeId(std::string_view text);

 private:
  std::set<std::string> taken_;
};

}  // namespace kingpin::report
