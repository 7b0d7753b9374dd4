#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <span>

namespace kingpin::signal {

/// Discrete Fourier transform of real records of one fixed length n >= 1:
///
///     X_k = Σ_{i=0}^{n-1} x_i e^{-j 2π i k / n},   k = 0 .. n/2 (rounded down),
///
/// and its inverse. Unscaled forward, 1/n backward, as in NumPy and MATLAB.
///
/// The constructor prepares everything; the two transforms allocate nothing. The object holds
/// scratch memory, so each thread needs its own. Lengths with a large prime factor go through
/// Bluestein's chirp transform, so that the cost is O(n log n) for every n.
///
/// @throws std::invalid_argument for n = 0 and for spans of a wrong size.
class RealFft {
 public:
  explicit RealFft(std::size_t size);
  ~RealFft();
  RealFft(RealFft&&) noexcept;
  RealFft& operator=(RealFft&&) noexcept;

  std::size_t size() const;           ///< n
  std::size_t spectrum_size() const;  ///< n/2 + 1

  /// X from x.
  void UpdateSpectrum(std::span<const double> record, std::span<std::complex<double>> spectrum);

  /// x from X; the parts of X that no real record has (imaginary part at 0 and at n/2) are ignored.
  void UpdateRecord(std::span<const std::complex<double>> spectrum, std::span<double> record);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The smallest length >= `size` whose prime factors are 2, 3 and 5 and which 4 divides: the
/// lengths the transform is fastest for.
std::size_t CalcFastLength(std::size_t size);

}  // namespace kingpin::signal
