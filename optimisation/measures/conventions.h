#pragma once

#include <array>
#include <string>

#include "core/signal/running_integral.h"
#include "core/signal/weighting.h"

namespace kingpin::measures {

/// What the moving window of Γ_2 and Γ_4 does where it reaches beyond the record.
enum class WindowEnds {
  kTruncated,   ///< the record is zero outside its span
  kNormalised,  ///< the energy found is scaled up by window/overlap; raises Γ_2 by 4 to 11 %
};

/// What Γ_4 counts when the window energy crosses its level more than twice.
enum class DecayTime {
  kFirstToLastCrossing,  ///< last crossing minus first; an end of the record counts as a crossing
  kMeasureOfSet,         ///< the time spent at or above the level
};

/// How Γ_3 makes a number of the Fourier transform X of the record.
enum class SpectrumScaling {
  /// A(f_k) = dt X_k approximates ∫ a e^{−j2πft} dt; Γ_3² = ∫_{f1}^{f2} |A W|² df, one-sided and
  /// not
  /// doubled. Each line stands for the band of width 1/T about it, clipped to [f1, f2].
  kFourierIntegral,
  /// 2|X_k|/N is the amplitude of line k; Γ_3² = Σ (2|X_k|/N)² W(f_k)² over the lines in [f1, f2].
  kAmplitudeLines,
};

/// How a record of n samples, both ends included, becomes one period of N = n − 1 samples.
enum class EndSample {
  kFolded,   ///< x_0 becomes (x_0 + x_{n−1})/2: the trapezoidal rule of the Fourier integral
  kDropped,  ///< the last sample is left out
};

/// Every choice that the five measures depend on. Γ_k are evaluated on the acceleration of the
/// steering wheel's rim, a = r_sw φ̈ [m/s²], over the whole record given (T2 − T1 = its duration T).
///
/// Source: Szczotka 2011, (3.10) to (3.14). What the paper leaves open is decided here; the reasons
/// stand in docs/theory/measures.md.
struct Conventions {
  /// Γ_1: replace the largest and the smallest sample by the vertex of the parabola through it and
  /// its two neighbours.
  bool refine_peaks = true;

  /// Γ_2, Γ_4, Γ_5: how a² is integrated.
  signal::Quadrature quadrature = signal::Quadrature::kCubic;

  double window = 0.6;  ///< Δt_w [s], centred
  WindowEnds window_ends = WindowEnds::kTruncated;

  double decay_level = 0.25;  ///< κ_DS, in (0, 1)
  DecayTime decay_time = DecayTime::kFirstToLastCrossing;

  double f1 = 1.0;    ///< [Hz]
  double f2 = 500.0;  ///< [Hz]; the Nyquist frequency where that is lower
  signal::Weighting weighting = signal::Weighting::Named("Wh");
  SpectrumScaling spectrum_scaling = SpectrumScaling::kFourierIntegral;
  EndSample end_sample = EndSample::kFolded;
  double gamma_3_scale = 1.0;  ///< c_3, multiplies Γ_3² (before the root)
  bool gamma_3_root = true;    ///< false: Γ_3² itself, what the paper evidently printed
};

/// The project's conventions: the defaults above.
Conventions MakeDefaultConventions();

/// The conventions of the identified paper sets: amplitude lines at 1 to 100 Hz weighted with the
/// `paper` shape, no root, last sample dropped, scaled by the set's c_3.
Conventions MakePaperSetConventions(double gamma_3_scale);

/// @throws io::InputError when a number is out of its range.
void CheckConventions(const Conventions& conventions);

/// Units of Γ_1 .. Γ_5: mm/s^2, mm/s (= mm/s^2 s), by convention, s, mm/s^2.
std::array<std::string, 5> DescribeUnits(const Conventions& conventions);

/// One sentence per measure that says with numbers how it is computed.
std::array<std::string, 5> DescribeMeasures(const Conventions& conventions);

}  // namespace kingpin::measures
