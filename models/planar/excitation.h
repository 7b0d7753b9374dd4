#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

/// The road force history F_T(t) [N], positive against the direction of travel.
namespace kingpin::planar {

enum class PulseKind {
  kHalfSine,   ///< A sin(π u)
  kVersine,    ///< A (1 − cos 2π u)/2
  kTrapezoid,  ///< linear up over `rise` of the duration, constant, linear down over `fall` of it
  kDouble,  ///< half sine A, then after `gap` seconds a half sine −`rebound`·A of the same duration
  kRingDown,  ///< A exp(−ζ ω τ) sin(ω τ), τ = t − start, ω = 2π `frequency`; goes on to the end
  kCubedParabola,  ///< A max(0, 4u(1 − u))³, the pulse of the identified paper sets
};

std::string_view ToString(PulseKind kind);

/// One pulse; u = (t − start)/duration in [0, 1], zero outside.
struct Pulse {
  PulseKind kind = PulseKind::kHalfSine;
  double amplitude = 0;  ///< A [N]
  double start = 0;      ///< [s]
  double duration = 0;   ///< [s]; unused by kRingDown
  double rise = 0.25;    ///< kTrapezoid: fraction of the duration, > 0
  double fall = 0.25;    ///< kTrapezoid: fraction of the duration, > 0, rise + fall <= 1
  double rebound = 0.5;  ///< kDouble: amplitude of the second half sine over −A
  double gap = 0;        ///< kDouble: pause between the two [s]
  double frequency = 0;  ///< kRingDown: f [Hz]
  double damping = 0;    ///< kRingDown: ζ
};

/// A sum of pulses and, if given, a tabulated history (monotone C1 cubic between samples, so
/// without overshoot; constant beyond its ends). Immutable.
class Excitation {
 public:
  Excitation();
  /// Throws io::InputError (keys `pulses[i].NAME`) for numbers that are not finite or out of range.
  explicit Excitation(std::vector<Pulse> pulses);
  /// Throws io::InputError when there are fewer than two samples, time does not increase, or a
  /// number is not finite.
  Excitation(std::vector<Pulse> pulses, std::vector<double> time, std::vector<double> value);

  /// F_T(t) [N].
  double CalcForce(double t) const;

  /// Where a derivative of F_T jumps, increasing, within (0, end). Integrators end a step there.
  std::vector<double> MakeKinks(double end) const;

  /// The kinks that a multistep method must start anew at: jumps of a derivative below the third,
  /// except at those nodes of a tabulated history that lie closer than 2.5 ms to a neighbour (there
  /// the jumps are as small as the history is smooth between its samples).
  std::vector<double> MakeStrongKinks(double end) const;

  /// F_T is zero before this time [s]; infinite when it always is.
  double start() const { return start_; }

  /// Tells histories apart: different for every history that was constructed, the same for copies.
  std::uint64_t id() const { return id_; }

  const std::vector<Pulse>& pulses() const { return pulses_; }

  /// The same history with all forces multiplied.
  Excitation MakeScaled(double factor) const;

 private:
  std::vector<double> MakeKinks(double end, bool strong) const;

  std::vector<Pulse> pulses_;
  std::vector<double> time_, value_, slope_;
  double start_ = 1e300;
  std::uint64_t id_;
};

}  // namespace kingpin::planar
