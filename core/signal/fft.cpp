#include "core/signal/fft.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace kingpin::signal {

namespace {

using Complex = std::complex<double>;
using Kernel = Eigen::internal::kissfft_impl<double>;

// A factor p costs n p operations in the mixed-radix transform; Bluestein's detour costs about as
// much as p = 60.
constexpr std::size_t kLargestDirectFactor = 60;

std::size_t CalcLargestPrimeFactor(std::size_t n) {
  std::size_t largest = 1;
  for (std::size_t p = 2; p * p <= n; ++p) {
    while (n % p == 0) {
      largest = p;
      n /= p;
    }
  }
  return n > 1 ? std::max(largest, n) : largest;
}

}  // namespace

class RealFft::Impl {
 public:
  explicit Impl(std::size_t size) : size_(size) {
    if (size == 0)
      throw std::invalid_argument("the length of a Fourier transform must be positive");
    if (CalcLargestPrimeFactor(size) > kLargestDirectFactor) {
      MakeChirp();
    } else if (size > 1) {
      // The kernel makes its plans and scratch buffers at the first call of each kind.
      std::vector<double> record(size);
      std::vector<Complex> spectrum(size / 2 + 1);
      kernel_.fwd(spectrum.data(), record.data(), static_cast<int>(size));
      kernel_.inv(record.data(), spectrum.data(), static_cast<int>(size));
    }
  }

  std::size_t size() const { return size_; }

  void UpdateSpectrum(std::span<const double> record, std::span<Complex> spectrum) {
    if (size_ == 1) {
      spectrum[0] = record[0];
    } else if (chirp_.empty()) {
      kernel_.fwd(spectrum.data(), record.data(), static_cast<int>(size_));
    } else {
      for (std::size_t i = 0; i < size_; ++i) padded_[i] = record[i] * chirp_[i];
      Convolve();
      for (std::size_t k = 0; k < spectrum.size(); ++k) spectrum[k] = convolved_[k] * chirp_[k];
    }
  }

  void UpdateRecord(std::span<const Complex> spectrum, std::span<double> record) {
    const double scale = 1.0 / static_cast<double>(size_);
    if (size_ == 1) {
      record[0] = spectrum[0].real();
    } else if (chirp_.empty()) {
      kernel_.inv(record.data(), spectrum.data(), static_cast<int>(size_));
      for (double& x : record) x *= scale;
    } else {
      // x = conj(DFT(conj X))/n with the full, conjugate-symmetric X.
      padded_[0] = spectrum[0].real();
      for (std::size_t k = 1; k < spectrum.size(); ++k) {
        const bool middle = 2 * k == size_;
        padded_[k] = middle ? Complex(spectrum[k].real()) : std::conj(spectrum[k]);
        padded_[size_ - k] = std::conj(padded_[k]);
      }
      for (std::size_t i = 0; i < size_; ++i) padded_[i] *= chirp_[i];
      Convolve();
      for (std::size_t i = 0; i < size_; ++i) {
        record[i] = scale * (convolved_[i] * chirp_[i]).real();
      }
    }
  }

 private:
  // Bluestein: i k = (i² + k² − (k − i)²)/2 turns the transform into a convolution with the chirp
  // e^{j π i²/n}, done by transforms of a convenient length.
  void MakeChirp() {
    padded_size_ = CalcFastLength(2 * size_ - 1);
    chirp_.resize(size_);
    for (std::size_t i = 0; i < size_; ++i) {
      // i² modulo 2 n keeps the phase exact for long records.
      const auto phase = static_cast<double>((i * i) % (2 * size_));
      chirp_[i] = std::polar(1.0, -std::numbers::pi * phase / static_cast<double>(size_));
    }
    padded_.assign(padded_size_, 0.0);
    transformed_.resize(padded_size_);
    convolved_.resize(padded_size_);
    chirp_spectrum_.resize(padded_size_);
    padded_[0] = std::conj(chirp_[0]);
    for (std::size_t i = 1; i < size_; ++i) {
      padded_[i] = padded_[padded_size_ - i] = std::conj(chirp_[i]);
    }
    kernel_.fwd(chirp_spectrum_.data(), padded_.data(), static_cast<int>(padded_size_));
    for (Complex& c : chirp_spectrum_) c /= static_cast<double>(padded_size_);
    kernel_.inv(convolved_.data(), chirp_spectrum_.data(), static_cast<int>(padded_size_));
  }

  void Convolve() {
    std::fill(padded_.begin() + static_cast<std::ptrdiff_t>(size_), padded_.end(), Complex{});
    kernel_.fwd(transformed_.data(), padded_.data(), static_cast<int>(padded_size_));
    for (std::size_t k = 0; k < padded_size_; ++k) transformed_[k] *= chirp_spectrum_[k];
    kernel_.inv(convolved_.data(), transformed_.data(), static_cast<int>(padded_size_));
  }

  std::size_t size_;
  Kernel kernel_;
  std::size_t padded_size_ = 0;
  std::vector<Complex> chirp_;  // empty when the direct transform is used
  std::vector<Complex> chirp_spectrum_, padded_, transformed_, convolved_;
};

RealFft::RealFft(std::size_t size) : impl_(std::make_unique<Impl>(size)) {}
RealFft::~RealFft() = default;
RealFft::RealFft(RealFft&&) noexcept = default;
RealFft& RealFft::operator=(RealFft&&) noexcept = default;

std::size_t RealFft::size() const { return impl_->size(); }
std::size_t RealFft::spectrum_size() const { return impl_->size() / 2 + 1; }

void RealFft::UpdateSpectrum(std::span<const double> record, std::span<Complex> spectrum) {
  if (record.size() != size() || spectrum.size() != spectrum_size()) {
    throw std::invalid_argument("a record or spectrum does not have the transform's size");
  }
  impl_->UpdateSpectrum(record, spectrum);
}

void RealFft::UpdateRecord(std::span<const Complex> spectrum, std::span<double> record) {
  if (record.size() != size() || spectrum.size() != spectrum_size()) {
    throw std::invalid_argument("a record or spectrum does not have the transform's size");
  }
  impl_->UpdateRecord(spectrum, record);
}

std::size_t CalcFastLength(std::size_t size) {
  for (std::size_t n = std::max<std::size_t>(4, (size + 3) / 4 * 4);; n += 4) {
    if (CalcLargestPrimeFactor(n) <= 5) return n;
  }
}

}  // namespace kingpin::signal
