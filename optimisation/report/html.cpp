#include "optimisation/report/html.h"

#include <algorithm>

#include <fmt/format.h>

namespace kingpin::report {
namespace {

bool IsSubscript(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool Contains(std::string_view set, char c) { return set.find(c) != std::string_view::npos; }

/// Calls `plain` and `symbol` for the pieces of a text. A symbol is one or two characters, an
/// underscore and up to four letters or digits (`r_L`, `Γ_1`, `F_A,1`), standing alone as a word;
/// so paths and keys (`rack_mass`, `x_1.yaml`) are left as they are.
template <typename Plain, typename Symbol>
void SplitSymbols(std::string_view text, const Plain& plain, const Symbol& symbol) {
  size_t done = 0;
  for (size_t at = text.find('_'); at != std::string_view::npos; at = text.find('_', at + 1)) {
    size_t begin = at;
    int characters = 0;
    while (begin > done && !Contains(" \t\n([{/|=", text[begin - 1])) {
      --begin;
      characters += (static_cast<unsigned char>(text[begin]) & 0xC0) != 0x80 ? 1 : 0;
    }
    size_t end = at + 1;
    while (end < text.size() &&
           (IsSubscript(text[end]) || (text[end] == ',' && end > at + 1 && end + 1 < text.size() &&
                                       IsSubscript(text[end + 1])))) {
      ++end;
    }
    const bool stands_alone =
        end == text.size() || Contains(" \t\n)]},;:", text[end]) ||
        (text[end] == '.' && (end + 1 == text.size() || text[end + 1] == ' ')) ||
        static_cast<unsigned char>(text[end]) >= 0x80;
    if (characters < 1 || characters > 2 || end == at + 1 || end > at + 5 || !stands_alone) {
      continue;
    }
    plain(text.substr(done, begin - done));
    symbol(text.substr(begin, at - begin), text.substr(at + 1, end - at - 1));
    done = end;
  }
  plain(text.substr(done));
}

}  // namespace

std::string EscapeHtml(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) {
          out += "\xEF\xBF\xBD";
        } else {
          out += c;
        }
    }
  }
  return out;
}

std::string SymbolHtml(std::string_view text) {
  std::string out;
  SplitSymbols(
      text, [&](std::string_view plain) { out += EscapeHtml(plain); },
      [&](std::string_view base, std::string_view subscript) {
        out += fmt::format("<i>{}</i><sub>{}</sub>", EscapeHtml(base), EscapeHtml(subscript));
      });
  return out;
}

std::string SymbolSvg(std::string_view text) {
  std::string out;
  SplitSymbols(
      text, [&](std::string_view plain) { out += EscapeHtml(plain); },
      [&](std::string_view base, std::string_view subscript) {
        // The zero-width space carries the shift back to the line.
        out += fmt::format(
            "<tspan font-style=\"italic\">{}</tspan><tspan dy=\"0.25em\" "
            "font-size=\"80%\">{}</tspan>"
            "<tspan dy=\"-0.2em\">\u200b</tspan>",
            EscapeHtml(base), EscapeHtml(subscript));
      });
  return out;
}

std::string PrettyUnit(std::string_view unit) {
  std::string out;
  for (size_t i = 0; i < unit.size(); ++i) {
    const char c = unit[i];
    if (c == '*') {
      out += "·";
    } else if (c == '^' && i + 1 < unit.size()) {
      size_t j = i + 1;
      std::string power;
      if (unit[j] == '-') {
        power += "⁻";
        ++j;
      }
      static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
      const size_t first = j;
      for (; j < unit.size() && ((unit[j] >= '0' && unit[j] <= '9') || unit[j] == '.'); ++j) {
        power += unit[j] == '.' ? "\u02d9" : kDigits[unit[j] - '0'];
      }
      if (j == first) {  // not a number: as written
        out += c;
      } else {
        out += power;
        i = j - 1;
      }
    } else {
      out += c;
    }
  }
  return out;
}

std::string WithUnit(std::string_view name, std::string_view unit) {
  if (unit.empty()) return EscapeHtml(name);
  return fmt::format("{} [{}]", EscapeHtml(name), EscapeHtml(PrettyUnit(unit)));
}

std::string IdPool::MakeId(std::string_view text) {
  std::string base;
  for (const char c : text) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) {
      base += c;
    } else if (c >= 'A' && c <= 'Z') {
      base += static_cast<char>(c - 'A' + 'a');
    } else if (!base.empty() && base.back() != '-') {
      base += '-';
    }
  }
  while (!base.empty() && base.back() == '-') base.pop_back();
  if (base.empty() || (base[0] >= '0' && base[0] <= '9')) base = "s-" + base;
  std::string id = base;
  for (int n = 2; !taken_.insert(id).second; ++n) id = fmt::format("{}-{}", base, n);
  return id;
}

}  // namespace kingpin::report
