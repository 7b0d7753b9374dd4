#include "core/io/units.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/io/error.h"
#include "core/io/nearest_name.h"

namespace kingpin::io {
namespace {

constexpr std::size_t kLongestUnit = 96;
constexpr int kDeepestParenthesis = 8;
constexpr double kLargestExponent = 8.0;

struct Symbol {
  const char* name;
  std::array<int, Dimension::kCount> exponents;  // m, kg, s, A, rad, cycle
  double numerator;
  double denominator;
  bool takes_prefix;
};

constexpr double kPi = std::numbers::pi;
constexpr double kPound = 0.45359237;  // exact by definition
constexpr double kInch = 0.0254;       // exact by definition

const Symbol kSymbols[] = {
    {"m", {1, 0, 0, 0, 0, 0}, 1, 1, true},
    {"g", {0, 1, 0, 0, 0, 0}, 1, 1000, true},
    {"s", {0, 0, 1, 0, 0, 0}, 1, 1, true},
    {"A", {0, 0, 0, 1, 0, 0}, 1, 1, true},
    {"rad", {0, 0, 0, 0, 1, 0}, 1, 1, true},
    {"N", {1, 1, -2, 0, 0, 0}, 1, 1, true},
    {"Nm", {2, 1, -2, 0, 0, 0}, 1, 1, true},
    {"Pa", {-1, 1, -2, 0, 0, 0}, 1, 1, true},
    {"J", {2, 1, -2, 0, 0, 0}, 1, 1, true},
    {"W", {2, 1, -3, 0, 0, 0}, 1, 1, true},
    {"Hz", {0, 0, -1, 0, 0, 1}, 1, 1, true},
    {"bar", {-1, 1, -2, 0, 0, 0}, 1e5, 1, true},
    {"l", {3, 0, 0, 0, 0, 0}, 1, 1000, true},
    {"L", {3, 0, 0, 0, 0, 0}, 1, 1000, true},
    {"V", {2, 1, -3, -1, 0, 0}, 1, 1, true},
    {"ohm", {2, 1, -3, -2, 0, 0}, 1, 1, true},
    {"t", {0, 1, 0, 0, 0, 0}, 1000, 1, false},
    {"min", {0, 0, 1, 0, 0, 0}, 60, 1, false},
    {"h", {0, 0, 1, 0, 0, 0}, 3600, 1, false},
    {"deg", {0, 0, 0, 0, 1, 0}, kPi, 180, false},
    {"rev", {0, 0, 0, 0, 1, 0}, 2 * kPi, 1, false},
    {"rpm", {0, 0, -1, 0, 1, 0}, kPi, 30, false},
    {"cycle", {0, 0, 0, 0, 0, 1}, 1, 1, false},
    {"kph", {1, 0, -1, 0, 0, 0}, 1000, 3600, false},
    {"mph", {1, 0, -1, 0, 0, 0}, 63360 * kInch, 3600, false},
    {"in", {1, 0, 0, 0, 0, 0}, kInch, 1, false},
    {"ft", {1, 0, 0, 0, 0, 0}, 12 * kInch, 1, false},
    {"lb", {0, 1, 0, 0, 0, 0}, kPound, 1, false},
    {"lbf", {1, 1, -2, 0, 0, 0}, kPound* kStandardGravity, 1, false},
    {"psi", {-1, 1, -2, 0, 0, 0}, kPound* kStandardGravity, kInch* kInch, false},
    {"%", {0, 0, 0, 0, 0, 0}, 1, 100, false},
    {"Nmm", {2, 1, -2, 0, 0, 0}, 1, 1000, false},
    {"Ns", {1, 1, -1, 0, 0, 0}, 1, 1, false},
    {"Nms", {2, 1, -1, 0, 0, 0}, 1, 1, false},
};

struct Prefix {
  char name;
  double numerator;
  double denominator;
};

constexpr Prefix kPrefixes[] = {{'u', 1, 1e6}, {'m', 1, 1e3}, {'c', 1, 1e2}, {'d', 1, 1e1},
                                {'k', 1e3, 1}, {'M', 1e6, 1}, {'G', 1e9, 1}};

// What stands in messages for well-known dimensions; the first that fits is used.
struct KnownQuantity {
  const char* unit;
  const char* name;
  const char* example;
};

constexpr KnownQuantity kKnownQuantities[] = {
    {"1", "a plain number", "0.08 or 8 %"},
    {"m", "a length", "0.35 m or 350 mm"},
    {"kg", "a mass", "35 kg"},
    {"s", "a time", "20 ms"},
    {"rad", "an angle", "3 deg or 0.05 rad"},
    {"m/s", "a speed", "35 km/h or 10 m/s"},
    {"m/s^2", "an acceleration", "9.81 m/s^2"},
    {"rad/s", "an angular speed", "2 rad/s or 60 rpm"},
    {"rad/s^2", "an angular acceleration", "5 rad/s^2"},
    {"Hz", "a frequency", "45 Hz"},
    {"1/s", "a rate", "3 1/s"},
    {"m^2", "an area", "2.2 m^2"},
    {"m^3", "a volume", "0.5 l"},
    {"m^3/s", "a volume flow", "8 l/min"},
    {"N", "a force", "3 kN"},
    {"N m", "a torque", "6 N m"},
    {"Pa", "a pressure", "2.4 bar"},
    {"W", "a power", "50 kW"},
    {"kg m^2", "a moment of inertia", "0.57 kg m^2"},
    {"N/m", "a stiffness", "25 N/mm or 2.5e4 N/m"},
    {"N s/m", "a damping", "1500 N s/m"},
    {"N m/rad", "a torsional stiffness", "60 N m/rad or 1.05 N m/deg"},
    {"N m s/rad", "a torsional damping", "0.05 N m s/rad"},
    {"rad/m", "a gear ratio", "125 rad/m"},
    {"m/rad", "a gear ratio", "50 mm/rev"},
    {"1/m", "a curvature", "0.02 1/m"},
    {"m/N", "a compliance", "1e-7 m/N"},
    {"A", "a current", "40 A"},
    {"V", "a voltage", "12 V"},
    {"ohm", "a resistance", "20 mohm"},
    {"N m/A", "a torque constant", "0.05 N m/A"},
    {"N/rad", "a stiffness per angle", "6e4 N/rad or 1 kN/deg"},
    {"kg/m^3", "a density", "7850 kg/m^3"},
    {"kg/m", "a mass per length", "1.2 kg/m"},
};

[[noreturn]] void Fail(std::string found, std::string expected, std::string suggestion = {}) {
  throw InputError(InputProblem{.found = std::move(found),
                                .expected = std::move(expected),
                                .suggestion = std::move(suggestion)});
}

std::string Quote(std::string_view text) {
  constexpr std::size_t kLongestQuote = 60;
  std::string shown(text.substr(0, kLongestQuote));
  // Do not cut a character of several bytes in two.
  if (text.size() > kLongestQuote) {
    while (!shown.empty() && (static_cast<unsigned char>(shown.back()) & 0xC0) == 0x80) {
      shown.pop_back();
    }
    if (!shown.empty() && static_cast<unsigned char>(shown.back()) >= 0xC0) shown.pop_back();
    shown += "...";
  }
  return fmt::format("'{}'", shown);
}

bool IsSpace(char c) { return c == ' ' || c == '\t'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsSpace(text.back())) text.remove_suffix(1);
  return text;
}

// Typographic characters become what the parser knows.
std::string ToAscii(std::string_view text) {
  static constexpr std::pair<std::string_view, std::string_view> kReplacements[] = {
      {"\u00b7", "*"},         {"\u22c5", "*"},         {"\u00d7", "*"},         {"\u00a0", " "},
      {"\u202f", " "},         {"\u2009", " "},         {"\u2212", "-"},         {"\u00b5", "u"},
      {"\u03bc", "u"},         {"\u03a9", "ohm"},       {"\u2126", "ohm"},       {"\u00b0", "deg"},
      {"\u207b\u00b9", "^-1"}, {"\u207b\u00b2", "^-2"}, {"\u207b\u00b3", "^-3"}, {"\u00b9", "^1"},
      {"\u00b2", "^2"},        {"\u00b3", "^3"},        {"\u2074", "^4"}};
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    bool replaced = false;
    if (static_cast<unsigned char>(text[i]) >= 0x80) {
      for (const auto& [from, to] : kReplacements) {
        if (text.substr(i, from.size()) == from) {
          result += to;
          i += from.size();
          replaced = true;
          break;
        }
      }
    }
    if (!replaced) result += text[i++];
  }
  return result;
}

double Power(double base, double exponent) {
  return base == 1.0 ? 1.0 : std::pow(base, exponent);  // exact for powers of ten in range
}

Unit Raise(const Unit& unit, double exponent) {
  Unit result;
  for (int i = 0; i < Dimension::kCount; ++i) {
    const double quarters = unit.dimension.quarters[i] * exponent;
    result.dimension.quarters[i] = static_cast<int>(std::lround(quarters));
  }
  const double size = std::abs(exponent);
  result.numerator = Power(unit.numerator, size);
  result.denominator = Power(unit.denominator, size);
  if (exponent < 0) std::swap(result.numerator, result.denominator);
  return result;
}

void MultiplyBy(const Unit& factor, Unit* product) {
  for (int i = 0; i < Dimension::kCount; ++i) {
    product->dimension.quarters[i] += factor.dimension.quarters[i];
  }
  product->numerator *= factor.numerator;
  product->denominator *= factor.denominator;
}

std::optional<Unit> FindSymbol(std::string_view name) {
  const auto make = [](const Symbol& symbol) {
    Unit unit;
    for (int i = 0; i < Dimension::kCount; ++i) {
      unit.dimension.quarters[i] = 4 * symbol.exponents[i];
    }
    unit.numerator = symbol.numerator;
    unit.denominator = symbol.denominator;
    return unit;
  };
  // The kilogram is the base unit: 1000 g / 1000 would be the same, but let it be exact by sight.
  if (name == "kg") {
    Unit unit = make(kSymbols[1]);
    unit.denominator = 1;
    return unit;
  }
  for (const Symbol& symbol : kSymbols) {
    if (name == symbol.name) return make(symbol);
  }
  for (const Prefix& prefix : kPrefixes) {
    if (name.size() < 2 || name.front() != prefix.name) continue;
    for (const Symbol& symbol : kSymbols) {
      if (!symbol.takes_prefix || name.substr(1) != symbol.name) continue;
      Unit unit = make(symbol);
      unit.numerator *= prefix.numerator;
      unit.denominator *= prefix.denominator;
      return unit;
    }
  }
  return std::nullopt;
}

// For suggestions; of two that are equally near, the first.
std::vector<std::string> MakeSymbolNames() {
  std::vector<std::string> names = {"kg", "km/h", "mm",  "cm",  "km",  "ms",  "us", "kN",
                                    "MN", "kNm",  "kPa", "MPa", "GPa", "kHz", "kW", "mrad"};
  for (const Symbol& symbol : kSymbols) names.emplace_back(symbol.name);
  return names;
}

class UnitParser {
 public:
  explicit UnitParser(std::string_view original)
      : original_(original), text_(ToAscii(Trim(original))) {}

  Unit Parse() {
    if (text_.size() > kLongestUnit) Fail("a unit of more than 96 characters", "a unit");
    Unit unit;
    if (!text_.empty() && text_ != "-") {
      unit = ParseProduct(0);
      if (at_ != text_.size()) FailHere("a unit");
    }
    unit.text = std::string(Trim(original_));
    return unit;
  }

 private:
  [[noreturn]] void FailHere(std::string expected, std::string suggestion = {}) const {
    Fail("unit " + Quote(original_), std::move(expected), std::move(suggestion));
  }

  void SkipSpaces() {
    while (at_ < text_.size() && IsSpace(text_[at_])) ++at_;
  }

  Unit ParseProduct(int depth) {
    Unit product = ParseFactor(depth);
    bool divided = false;
    while (true) {
      const std::size_t before = at_;
      SkipSpaces();
      if (at_ == text_.size() || text_[at_] == ')') return product;
      bool divide = false;
      if (text_[at_] == '/') {
        divide = true;
        ++at_;
      } else if (text_[at_] == '*') {
        ++at_;
        if (at_ < text_.size() && text_[at_] == '*') FailHere("a unit", "write a power as m^2");
      } else if (before == at_) {
        FailHere("a unit", "write a product as 'N m' or 'N*m' and a power as 'm^2'");
      }
      if (divided && !divide) {
        FailHere("a unit that can be read one way only",
                 "put what follows '/' in parentheses, as N/(m s), or before it, as N s/m");
      }
      divided = divided || divide;
      SkipSpaces();
      MultiplyBy(Raise(ParseFactor(depth), divide ? -1.0 : 1.0), &product);
    }
  }

  Unit ParseFactor(int depth) {
    if (at_ == text_.size()) FailHere("a unit after the sign");
    Unit factor;
    if (text_[at_] == '(') {
      if (depth == kDeepestParenthesis) FailHere("fewer parentheses");
      ++at_;
      SkipSpaces();
      factor = ParseProduct(depth + 1);
      SkipSpaces();
      if (at_ == text_.size() || text_[at_] != ')') FailHere("a unit with ')'");
      ++at_;
    } else if (text_[at_] == '1') {
      ++at_;
      return factor;
    } else {
      const std::size_t begin = at_;
      while (at_ < text_.size() &&
             (IsLetter(text_[at_]) || text_[at_] == '%' || text_[at_] == '_' ||
              static_cast<unsigned char>(text_[at_]) >= 0x80)) {
        ++at_;
      }
      const std::string_view name = std::string_view(text_).substr(begin, at_ - begin);
      if (name.empty()) FailHere("a unit");
      const std::optional<Unit> symbol = FindSymbol(name);
      if (!symbol) {
        Fail("unknown unit " + Quote(name), "a unit such as m, kg, s, N, N m, rad, deg, km/h",
             FindNearestName(name, MakeSymbolNames()).empty()
                 ? "the units accepted are listed in docs/formats.md"
                 : SuggestName(name, MakeSymbolNames(), "units"));
      }
      factor = *symbol;
    }
    const double exponent = ParseExponent();
    return exponent == 1.0 ? factor : Raise(factor, exponent);
  }

  double ParseExponent() {
    if (at_ == text_.size()) return 1.0;
    if (text_[at_] == '^') {
      ++at_;
    } else if (!IsDigit(text_[at_])) {
      return 1.0;
    }
    double exponent = 0.0;
    const char* begin = text_.data() + at_;
    const auto [end, status] =
        std::from_chars(begin, text_.data() + text_.size(), exponent, std::chars_format::fixed);
    if (status != std::errc{} || !(std::abs(exponent) <= kLargestExponent) ||
        exponent * 4 != std::round(exponent * 4)) {
      FailHere("an exponent that is a multiple of 1/4 and at most 8, as in m^2");
    }
    at_ += static_cast<std::size_t>(end - begin);
    return exponent;
  }

  std::string_view original_;
  std::string text_;
  std::size_t at_ = 0;
};

// Splits the number off the front of a quantity; `rest` is what follows.
double TakeNumber(std::string_view original, std::string_view text, std::string_view* rest) {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const std::string_view unsigned_part = digits.starts_with('-') ? digits.substr(1) : digits;
  // from_chars also reads 'nan' and 'inf', which no quantity is.
  if (unsigned_part.empty() || !(IsDigit(unsigned_part.front()) || unsigned_part.front() == '.')) {
    std::string word;
    for (char c : unsigned_part.substr(0, 8)) word += static_cast<char>(c | 0x20);
    if (word.starts_with("nan") || word.starts_with("inf")) {
      Fail(Quote(original), "a finite number");
    }
    Fail(original.empty() ? "nothing" : Quote(original), "a number");
  }
  if (unsigned_part.starts_with(".nan") || unsigned_part.starts_with(".NaN") ||
      unsigned_part.starts_with(".NAN") || unsigned_part.starts_with(".inf") ||
      unsigned_part.starts_with(".Inf") || unsigned_part.starts_with(".INF")) {
    Fail(Quote(original), "a finite number");
  }
  if (text.starts_with('+') && digits.starts_with('-')) Fail(Quote(original), "a number");
  double value = 0.0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (status == std::errc::result_out_of_range) {
    Fail(Quote(original), "a number between 1e-308 and 1e308 in size, or 0");
  }
  if (status != std::errc{}) Fail(Quote(original), "a number");
  *rest = digits.substr(static_cast<std::size_t>(end - digits.data()));
  if (rest->size() > 1 && rest->front() == ',' && IsDigit((*rest)[1])) {
    Fail(Quote(original), "a number with a decimal point", "write 1.5, not 1,5");
  }
  return value;
}

}  // namespace

Unit ParseUnit(std::string_view text) { return UnitParser(text).Parse(); }

bool IsUsableAs(const Dimension& found, const Dimension& expected) {
  for (int i = 0; i < Dimension::kCount; ++i) {
    const bool may_be_left_out = i == Dimension::kAngle || i == Dimension::kCycle;
    if (found.quarters[i] != expected.quarters[i] && !(may_be_left_out && found.quarters[i] == 0)) {
      return false;
    }
  }
  return true;
}

double ParseNumber(std::string_view text) {
  std::string_view rest;
  const std::string_view trimmed = Trim(text);
  const double value = TakeNumber(trimmed, trimmed, &rest);
  if (!Trim(rest).empty()) Fail(Quote(text), "a number without a unit");
  return value;
}

double ParseQuantity(std::string_view text, const Unit& expected) {
  constexpr std::size_t kLongestQuantity = 256;
  if (text.size() > kLongestQuantity) Fail(Quote(text), DescribeQuantity(expected));
  const std::string ascii = ToAscii(text);
  const std::string_view trimmed = Trim(text);
  std::string_view rest;
  double value = 0.0;
  try {
    value = TakeNumber(trimmed, Trim(ascii), &rest);
  } catch (const InputError& error) {
    InputProblem problem = error.problem();
    if (problem.expected == "a number") problem.expected = DescribeQuantity(expected);
    throw InputError(problem);
  }
  rest = Trim(rest);
  if (rest.empty()) return expected.ToSi(value);
  Unit unit;
  try {
    unit = ParseUnit(rest);
  } catch (const InputError& error) {
    InputProblem problem = error.problem();
    problem.found += " in " + Quote(trimmed);
    problem.expected = DescribeQuantity(expected);
    throw InputError(problem);
  }
  if (!IsUsableAs(unit.dimension, expected.dimension)) {
    std::string found = Quote(trimmed);
    for (const KnownQuantity& known : kKnownQuantities) {
      if (ParseUnit(known.unit).dimension == unit.dimension) {
        found += fmt::format(" ({})", known.name);
        break;
      }
    }
    std::string suggestion;
    const bool cycles = unit.dimension.quarters[Dimension::kCycle] != 0 &&
                        expected.dimension.quarters[Dimension::kAngle] != 0;
    if (cycles) suggestion = "1 Hz is 6.2832 rad/s";
    Fail(found, DescribeQuantity(expected), suggestion);
  }
  const double si = unit.ToSi(value);
  if (!std::isfinite(si)) Fail(Quote(trimmed), "a finite number");
  return si;
}

std::string DescribeQuantity(const Unit& unit) {
  for (const KnownQuantity& known : kKnownQuantities) {
    if (ParseUnit(known.unit).dimension != unit.dimension) continue;
    std::string example = known.example;
    std::string examples;
    for (std::size_t at = 0;;) {
      const std::size_t next = example.find(" or ", at);
      examples += fmt::format("'{}'", example.substr(at, next - at));
      if (next == std::string::npos) break;
      examples += " or ";
      at = next + 4;
    }
    if (unit.text.empty() || unit.text == "1" || unit.text == "-") {
      return fmt::format("{}, such as {}", known.name, examples);
    }
    return fmt::format("{} in {}, such as {}", known.name, unit.text, examples);
  }
  return fmt::format("a quantity in {}", unit.text);
}

std::string FormatNumber(double value) { return fmt::format("{}", value); }

std::string FormatQuantity(double value, std::string_view unit) {
  if (unit.empty() || unit == "1" || unit == "-") return FormatNumber(value);
  return fmt::format("{} {}", value, unit);
}

}  // namespace kingpin::io
