#include "core/signal/spectrum.h"

#include <complex>
#include <cstddef>

#include "core/signal/fft.h"

namespace kingpin::signal {

namespace {

template <class Function>
Spectrum MakeSpectrum(std::span<const double> record, double time_step, Function value) {
  RealFft fft(record.size());
  std::vector<std::complex<double>> lines(fft.spectrum_size());
  fft.UpdateSpectrum(record, lines);
  Spectrum spectrum;
  const double duration = static_cast<double>(record.size()) * time_step;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const bool single = k == 0 || 2 * k == record.size();
    spectrum.frequency.push_back(static_cast<double>(k) / duration);
    spectrum.value.push_back((single ? 1.0 : 2.0) * value(lines[k]));
  }
  return spectrum;
}

}  // namespace

Spectrum MakeAmplitudeSpectrum(std::span<const double> record, double time_step) {
  const auto n = static_cast<double>(record.size());
  return MakeSpectrum(record, time_step, [n](auto line) { return std::abs(line) / n; });
}

Spectrum MakeEnergySpectrum(std::span<const double> record, double time_step) {
  return MakeSpectrum(record, time_step,
                      [=](auto line) { return time_step * time_step * std::norm(line); });
}

}  // namespace kingpin::signal
