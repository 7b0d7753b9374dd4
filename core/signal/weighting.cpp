#include "core/signal/weighting.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/io/csv.h"
#include "core/io/error.h"
#include "core/io/units.h"
#include "core/signal/fft.h"

namespace kingpin::signal {

struct Weighting::IsoRow {
  std::string_view name;
  std::string_view use;
  TransferFunction function;
};

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kHandCorner = 100.0 / (2.0 * std::numbers::pi);            // 100 rad/s
constexpr double kBuildingCorner = 1.0 / (0.028 * 2.0 * std::numbers::pi);  // 28 ms

constexpr std::array<std::string_view, 13> kNames = {"Wb", "Wc", "Wd", "We", "Wf",    "Wg",  "Wh",
                                                     "Wj", "Wk", "Wm", "Ws", "paper", "none"};

/// `W_h`, `wh` and `Wh` are the same name.
std::string Normalise(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c != '_') plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return plain;
}

/// (1 + s/(q w) + (s/w)²) at s = j r w, r = f/f_corner.
std::complex<double> CalcQuadratic(double ratio, double q) {
  return {1.0 - ratio * ratio, ratio / q};
}

}  // namespace

// f1 f2 | f3 f4 Q4 | f5 Q5 f6 Q6 | K, ISO 8041-1:2017 table 3.
const Weighting::IsoRow Weighting::kIsoRows[] = {
    {"Wb",
     "whole body, z, rail and BS 6841",
     {0.4, 100.0, 16.0, 16.0, 0.55, 2.5, 0.90, 4.0, 0.95, 1.024}},
    {"Wc", "seat back, x", {0.4, 100.0, 8.0, 8.0, 0.63, kInf, 1.0, kInf, 1.0, 1.0}},
    {"Wd", "whole body, x and y", {0.4, 100.0, 2.0, 2.0, 0.63, kInf, 1.0, kInf, 1.0, 1.0}},
    {"We", "rotation of the seat", {0.4, 100.0, 1.0, 1.0, 0.63, kInf, 1.0, kInf, 1.0, 1.0}},
    {"Wf", "motion sickness", {0.08, 0.63, kInf, 0.25, 0.86, 0.0625, 0.80, 0.10, 0.80, 1.0}},
    {"Wg", "whole body, z, BS 6841 only", {0.8, 100.0, 1.5, 5.3, 0.68, kInf, 1.0, kInf, 1.0, 0.42}},
    {"Wh",
     "hand and arm, all directions, ISO 5349-1",
     {std::pow(10.0, 0.8), std::pow(10.0, 3.1), kHandCorner, kHandCorner, 0.64, kInf, 1.0, kInf,
      1.0, 1.0}},
    {"Wj", "recumbent head", {0.4, 100.0, kInf, kInf, 1.0, 3.75, 0.91, 5.32, 0.91, 1.0}},
    {"Wk",
     "whole body, z, ISO 2631-1",
     {0.4, 100.0, 12.5, 12.5, 0.63, 2.37, 0.91, 3.35, 0.91, 1.0}},
    {"Wm",
     "buildings",
     {std::pow(10.0, -0.1), 100.0, kBuildingCorner, kBuildingCorner, 0.5, kInf, 1.0, kInf, 1.0,
      1.0}},
};

std::span<const std::string_view> Weighting::names() { return kNames; }

Weighting Weighting::Named(std::string_view name) {
  const std::string wanted = Normalise(name);
  Weighting weighting;
  for (const IsoRow& row : kIsoRows) {
    if (Normalise(row.name) != wanted) continue;
    weighting.kind_ = Kind::kTransferFunction;
    weighting.name_ = row.name;
    weighting.description_ =
        fmt::format("{}: {}; transfer function of {}", row.name, row.use,
                    row.name == "Wg" ? "BS 6841 (corner values not checked against the standard)"
                                     : "ISO 8041-1:2017");
    weighting.function_ = row.function;
    return weighting;
  }
  if (wanted == "none") {
    weighting.name_ = "none";
    weighting.description_ = "none: factor 1 at every frequency";
    return weighting;
  }
  const double ln10 = std::numbers::ln10;
  if (wanted == "ws") {
    weighting.kind_ = Kind::kTable;
    weighting.name_ = "Ws";
    weighting.description_ =
        "Ws: rotation of the steering wheel (Giacomin et al. 2004), 1 up to 6.3 Hz, slope -1 to 50 "
        "Hz, "
        "level to 160 Hz, slope -5/3 beyond";
    weighting.log_frequency_ = {0.8 * ln10, 1.7 * ln10, 2.2 * ln10};
    weighting.log_factor_ = {0.0, -0.9 * ln10, -0.9 * ln10};
    weighting.slope_above_ = -5.0 / 3.0;
    return weighting;
  }
  if (wanted == "paper") {
    weighting.kind_ = Kind::kTable;
    weighting.name_ = "paper";
    weighting.description_ =
        "paper: shape of the identified paper sets, f/8 below 8 Hz, 1 to 16 Hz, 16/f above";
    weighting.log_frequency_ = {std::log(8.0), std::log(16.0)};
    weighting.log_factor_ = {0.0, 0.0};
    weighting.slope_below_ = 1.0;
    weighting.slope_above_ = -1.0;
    return weighting;
  }
  throw io::InputError(
      {.file = {},
       .line = 0,
       .key = "weighting",
       .found = fmt::format("'{}'", name),
       .expected = fmt::format("one of {}, or a CSV file with frequency and factor",
                               fmt::join(kNames, ", ")),
       .suggestion = {}});
}

Weighting Weighting::FromFile(const std::filesystem::path& path) {
  const io::CsvTable table = io::ReadCsv(path);
  const auto reject = [&](int line, std::string found, std::string expected,
                          std::string suggestion) {
    throw io::InputError({.file = table.file,
                          .line = line,
                          .key = "weighting",
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .suggestion = std::move(suggestion)});
  };
  if (table.columns.size() != 2) {
    reject(table.lines.front(), fmt::format("{} columns", table.columns.size()),
           "two: frequency [Hz], factor [-]", {});
  }
  const io::CsvColumn& frequencies = table.columns[0];
  const io::CsvColumn& factors = table.columns[1];
  const io::Unit hertz = io::ParseUnit(frequencies.unit.empty() ? "Hz" : frequencies.unit);
  if (!io::IsUsableAs(hertz.dimension, io::ParseUnit("Hz").dimension)) {
    reject(0, fmt::format("unit '{}' of the frequency", frequencies.unit), "'Hz'", {});
  }
  const io::Unit one = io::ParseUnit(factors.unit);
  if (one.dimension != io::Dimension{}) {
    reject(0, fmt::format("unit '{}' of the factor", factors.unit), "'-'", {});
  }
  Weighting weighting;
  weighting.kind_ = Kind::kTable;
  weighting.name_ = table.file;
  for (std::size_t i = 0; i < table.lines.size(); ++i) {
    const double frequency = hertz.ToSi(frequencies.values[i]);
    const double factor = one.ToSi(factors.values[i]);
    if (frequency <= 0.0 || factor <= 0.0) {
      reject(table.lines[i], fmt::format("{:g} Hz, factor {:g}", frequency, factor),
             "a positive frequency and a positive factor", "interpolation is in logarithmic axes");
    }
    if (i > 0 && std::log(frequency) <= weighting.log_frequency_.back()) {
      reject(table.lines[i],
             fmt::format("frequency {:g} Hz after {:g} Hz", frequency,
                         hertz.ToSi(frequencies.values[i - 1])),
             "increasing frequencies", {});
    }
    weighting.log_frequency_.push_back(std::log(frequency));
    weighting.log_factor_.push_back(std::log(factor));
  }
  weighting.description_ = fmt::format(
      "table from {}: {} points from {:g} to {:g} Hz, straight lines in log-log axes, "
      "constant outside",
      table.file, weighting.log_frequency_.size(), std::exp(weighting.log_frequency_.front()),
      std::exp(weighting.log_frequency_.back()));
  return weighting;
}

std::complex<double> Weighting::CalcResponse(double frequency) const {
  switch (kind_) {
    case Kind::kUnity:
      return 1.0;
    case Kind::kTable: {
      const auto& x = log_frequency_;
      const auto& y = log_factor_;
      const double at = std::log(frequency);  // −∞ at 0 Hz: the slope below decides
      if (at <= x.front()) {
        return slope_below_ == 0.0 ? std::exp(y.front())
                                   : std::exp(y.front() + slope_below_ * (at - x.front()));
      }
      if (at >= x.back()) return std::exp(y.back() + slope_above_ * (at - x.back()));
      const auto i =
          static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin()) - 1;
      return std::exp(y[i] + (y[i + 1] - y[i]) * (at - x[i]) / (x[i + 1] - x[i]));
    }
    case Kind::kTransferFunction:
      break;
  }
  const TransferFunction& p = function_;
  const double q = std::numbers::sqrt2 / 2.0;
  const double f = frequency;
  // H_h multiplied out, so that it is 0 and not 1/∞ at 0 Hz.
  const double high = f / p.f1;
  std::complex<double> h = -high * high / CalcQuadratic(high, q);
  h /= CalcQuadratic(f / p.f2, q);
  h *= p.gain * std::complex<double>(1.0, f / p.f3) / CalcQuadratic(f / p.f4, p.q4);
  if (std::isfinite(p.f5)) {
    const double step = p.f5 / p.f6;
    h *= step * step * CalcQuadratic(f / p.f5, p.q5) / CalcQuadratic(f / p.f6, p.q6);
  }
  return h;
}

double Weighting::CalcMagnitude(double frequency) const {
  return std::abs(CalcResponse(frequency));
}

std::vector<double> MakeWeighted(const Weighting& weighting, std::span<const double> record,
                                 double time_step) {
  const std::size_t padded_size = CalcFastLength(2 * record.size());
  std::vector<double> padded(padded_size, 0.0);
  std::copy(record.begin(), record.end(), padded.begin());
  RealFft fft(padded_size);
  std::vector<std::complex<double>> spectrum(fft.spectrum_size());
  fft.UpdateSpectrum(padded, spectrum);
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    spectrum[k] *= weighting.CalcResponse(static_cast<double>(k) /
                                          (static_cast<double>(padded_size) * time_step));
  }
  fft.UpdateRecord(spectrum, padded);
  padded.resize(record.size());
  return padded;
}

}  // namespace kingpin::signal
