#pragma once

#include <complex>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kingpin::signal {

/// A frequency weighting W(f): how much people mind a vibration of frequency f.
///
/// Transfer functions of ISO 8041-1:2017 (s = j 2π f; a corner at infinity gives the factor 1):
///
///     H   = H_h H_l H_t H_s
///     H_h = 1/(1 + ω1/(Q1 s) + (ω1/s)²)          high pass, Q1 = 1/√2
///     H_l = 1/(1 + s/(Q2 ω2) + (s/ω2)²)          low pass, Q2 = 1/√2
///     H_t = K (1 + s/ω3)/(1 + s/(Q4 ω4) + (s/ω4)²)
///     H_s = (1 + s/(Q5 ω5) + (s/ω5)²)/(1 + s/(Q6 ω6) + (s/ω6)²) (ω5/ω6)²
///
/// | name | for | source |
/// | Wb | vertical, rail and BS 6841 | ISO 8041-1 |
/// | Wc | seat back, x | ISO 8041-1 |
/// | Wd | seat, x and y | ISO 8041-1 |
/// | We | rotation of the seat | ISO 8041-1 |
/// | Wf | motion sickness | ISO 8041-1 |
/// | Wg | whole body, z (its row is from general knowledge, not from the standard) | BS 6841 |
/// | Wh | hand and arm, all directions | ISO 8041-1, ISO 5349-1 |
/// | Wj | recumbent head | ISO 8041-1 |
/// | Wk | seat, z | ISO 8041-1, ISO 2631-1 |
/// | Wm | buildings | ISO 8041-1 |
/// | Ws | rotation of the steering wheel | Giacomin et al., Int. J. Ind. Ergonomics 33 (2004) |
/// | paper | shape used with the identified paper sets: f/8, 1 from 8 to 16 Hz, 16/f | |
/// | none | 1 | |
///
/// Ws is a broken line in log-log axes: 1 up to 10^0.8 Hz, slope −1 to 10^1.7 Hz, level to
/// 10^2.2 Hz, slope −5/3 beyond (the published −6 dB/oct and −10 dB/oct between the third-octave
/// bands 6.3, 50, 160 and 315 Hz; it is continued beyond 315 Hz). A table from a file is
/// interpolated linearly in log-log axes and held constant outside its range. These three have a
/// magnitude only: their response is real, a filter without phase.
class Weighting {
 public:
  /// @throws io::InputError for a name that is not in the table above (case and `_` do not matter).
  static Weighting Named(std::string_view name);

  /// Reads a table of two columns, frequency [Hz] and factor [-], both positive, frequency
  /// increasing (core/io/csv.h says how it is written).
  /// @throws io::InputError with file and line
  static Weighting FromFile(const std::filesystem::path& path);

  /// The names that Named() knows.
  static std::span<const std::string_view> names();

  const std::string& name() const { return name_; }

  /// One sentence, for reports: `Wh: hand and arm, ISO 8041-1 ...`.
  const std::string& description() const { return description_; }

  /// |H(f)| for f >= 0 [Hz].
  double CalcMagnitude(double frequency) const;

  /// H(f) for f >= 0 [Hz].
  std::complex<double> CalcResponse(double frequency) const;

 private:
  enum class Kind { kUnity, kTransferFunction, kTable };
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct TransferFunction {
    double f1 = 0.0, f2 = kInfinity;                            // band limits [Hz]
    double f3 = kInfinity, f4 = kInfinity, q4 = 1.0;            // transition
    double f5 = kInfinity, q5 = 1.0, f6 = kInfinity, q6 = 1.0;  // upward step
    double gain = 1.0;                                          // K
  };
  struct IsoRow;
  static const IsoRow kIsoRows[];

  Weighting() = default;

  Kind kind_ = Kind::kUnity;
  std::string name_;
  std::string description_;
  TransferFunction function_;
  // Broken line in log-log axes; slopes beyond the ends.
  std::vector<double> log_frequency_, log_factor_;
  double slope_below_ = 0.0, slope_above_ = 0.0;
};

/// The record passed through the weighting: multiplied by H(f) in the frequency domain. The record
/// is taken as zero outside its span and padded to at least twice its length, so that the response
/// to its end does not wrap around to its start.
std::vector<double> MakeWeighted(const Weighting& weighting, std::span<const double> record,
                                 double time_step);

}  // namespace kingpin::signal
