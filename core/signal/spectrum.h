#pragma once

#include <span>
#include <vector>

namespace kingpin::signal {

/// A one-sided spectrum: values at f_k = k/(n dt), k = 0 .. n/2.
struct Spectrum {
  std::vector<double> frequency;  ///< [Hz]
  std::vector<double> value;
};

/// Amplitude spectrum 2|X_k|/n (|X_k|/n at 0 Hz and, for even n, at the Nyquist frequency): a sine
/// of amplitude a with a whole number of periods in the record gives a line of height a. Unit of
/// the record.
Spectrum MakeAmplitudeSpectrum(std::span<const double> record, double time_step);

/// One-sided energy spectral density 2|dt X_k|² (once at 0 Hz and at the Nyquist frequency). Unit
/// of the record squared, times s/Hz. Parseval: Σ_k value_k / (n dt) = dt Σ_i x_i².
Spectrum MakeEnergySpectrum(std::span<const double> record, double time_step);

}  // namespace kingpin::signal
