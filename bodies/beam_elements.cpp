#include "bodies/beam_elements.h"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace kingpin::bodies {

namespace {

// Gauss-Legendre, 8 points on [-1, 1]: exact for the mass and inertia of any taper here, and far
// below what n elements leave for its compliance.
constexpr double kNode[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                             0.9602898564975363};
constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                               0.1012285362903763};

void CheckNotNegative(size_t segment, const char* what, double value, bool zero_is_fine) {
  if (std::isfinite(value) && value >= 0 && (zero_is_fine || value > 0)) return;
  throw std::invalid_argument(fmt::format("segment {}: {} of {:g}, expected a number {}",
                                          segment + 1, what, value,
                                          zero_is_fine ? "that is not negative" : "above zero"));
}

// Cuts [0, length] for n springs.
BeamElements Divide(double length, int n) {
  if (n < 0) throw std::invalid_argument(fmt::format("{} elements, expected 0 or more", n));
  if (!(std::isfinite(length) && length > 0)) {
    throw std::invalid_argument(fmt::format("length of {:g} m, expected one above zero", length));
  }
  BeamElements beam;
  beam.length = length;
  beam.springs.resize(n);
  beam.elements.resize(n + 1);
  for (int k = 0; k < n; ++k) beam.springs[k].position = length * (k + 0.5) / n;
  for (int k = 0; k <= n; ++k) {
    beam.elements[k].start = k == 0 ? 0 : beam.springs[k - 1].position;
    beam.elements[k].end = k == n ? length : beam.springs[k].position;
  }
  return beam;
}

class Integrator {
 public:
  explicit Integrator(const std::vector<BeamSegment>& segments) : segments_(segments) {
    if (segments.empty()) throw std::invalid_argument("a beam without segments");
    begin_.push_back(0);
    for (size_t s = 0; s < segments.size(); ++s) {
      const BeamSegment& segment = segments[s];
      CheckNotNegative(s, "length", segment.length, false);
      CheckNotNegative(s, "Young's modulus", segment.material.E, false);
      CheckNotNegative(s, "shear modulus", segment.material.G, false);
      CheckNotNegative(s, "density", segment.material.density, false);
      CheckNotNegative(s, "normal damping", segment.material.eta_normal, true);
      CheckNotNegative(s, "shear damping", segment.material.eta_shear, true);
      try {
        CalcSection(segment.section);
        if (segment.end) {
          CalcSection(*segment.end);
          CalcSection(Interpolate(segment.section, *segment.end, 0.5));
        }
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(fmt::format("segment {}: {}", s + 1, error.what()));
      }
      begin_.push_back(begin_.back() + segment.length);
    }
  }

  double length() const { return begin_.back(); }

  // f(x, weight, section, material) over all Gauss points of [from, to]
  template <class F>
  void Visit(double from, double to, const F& f) const {
    for (size_t s = 0; s < segments_.size(); ++s) {
      const BeamSegment& segment = segments_[s];
      // the last segment ends where the beam ends, whatever the sums round to
      const double a = std::max(from, begin_[s]), b = std::min(to, begin_[s + 1]);
      if (!(b > a)) continue;
      const GivenSection uniform = CalcSection(segment.section);
      for (int i = 0; i < 8; ++i) {
        const double node = i < 4 ? kNode[i] : -kNode[i - 4];
        const double x = 0.5 * (a + b) + 0.5 * (b - a) * node;
        const double weight = 0.5 * (b - a) * kWeight[i % 4];
        f(x, weight,
          segment.end ? CalcSection(Interpolate(segment.section, *segment.end,
                                                (x - begin_[s]) / segment.length))
                      : uniform,
          segment.material);
      }
    }
  }

 private:
  const std::vector<BeamSegment>& segments_;
  std::vector<double> begin_;
};

RigidInertia CalcElementInertia(const Integrator& integrator, double from, double to) {
  double mass = 0, moment = 0, second = 0, about_y = 0, about_z = 0;
  integrator.Visit(
      from, to,
      [&](double x, double weight, const GivenSection& section, const BeamMaterial& material) {
        const double dm = weight * material.density * section.area, r = x - from;
        mass += dm;
        moment += dm * r;
        second += dm * r * r;
        about_y += weight * material.density * section.Iy;
        about_z += weight * material.density * section.Iz;
      });
  const double centre = moment / mass;
  const double along = second - mass * centre * centre;
  return {mass, {centre, 0, 0}, {about_y + about_z, about_y + along, about_z + along, 0, 0, 0}};
}

void SetSpring(const Integrator& integrator, double from, double to, BeamElements::Spring& spring) {
  std::array<double, 6> compliance{}, loss{};
  integrator.Visit(
      from, to,
      [&](double, double weight, const GivenSection& section, const BeamMaterial& material) {
        const double A = section.area;
        const double size[6] = {
            A,          A / section.shear_y, A / section.shear_z, section.torsion_constant,
            section.Iy, section.Iz};
        for (int i = 0; i < 6; ++i) {
          const bool normal = i == 0 || i > 3;
          const double modulus = normal ? material.E : material.G;
          const double eta = normal ? material.eta_normal : material.eta_shear;
          compliance[i] += weight / (modulus * size[i]);
          loss[i] += weight * eta / (modulus * modulus * size[i]);
        }
      });
  for (int i = 0; i < 6; ++i) {
    spring.stiffness[i] = 1 / compliance[i];
    spring.damping[i] = loss[i] / (compliance[i] * compliance[i]);
  }
}

}  // namespace

BeamElements MakeBeamElements(const std::vector<BeamSegment>& segments, int n) {
  const Integrator integrator(segments);
  BeamElements beam = Divide(integrator.length(), n);
  for (int k = 0; k < n; ++k) {
    SetSpring(integrator, beam.length * k / n, beam.length * (k + 1) / n, beam.springs[k]);
  }
  for (BeamElements::Element& element : beam.elements) {
    element.inertia = CalcElementInertia(integrator, element.start, element.end);
  }
  return beam;
}

BeamElements MakeBeamElements(const UniformBeam& uniform, int n) {
  BeamElements beam = Divide(uniform.length, n);
  for (double value : {uniform.mass, uniform.axial_inertia}) {
    if (!(std::isfinite(value) && value > 0)) {
      throw std::invalid_argument(
          fmt::format("mass or axial inertia of {:g}, expected a number above zero", value));
    }
  }
  for (int i = 0; i < 6; ++i) {
    for (double value : {uniform.stiffness[i], uniform.damping[i]}) {
      if (!(std::isfinite(value) && value >= 0)) {
        throw std::invalid_argument(fmt::format(
            "stiffness or damping of {:g}, expected a number that is not negative", value));
      }
    }
  }
  for (BeamElements::Spring& spring : beam.springs) {
    for (int i = 0; i < 6; ++i) {
      spring.stiffness[i] = n * uniform.stiffness[i];
      spring.damping[i] = n * uniform.damping[i];
    }
  }
  for (BeamElements::Element& element : beam.elements) {
    const double part = element.end - element.start, share = part / uniform.length;
    const double axial = share * uniform.axial_inertia, mass = share * uniform.mass;
    const double transverse = 0.5 * axial + mass * part * part / 12;
    element.inertia = {mass, {0.5 * part, 0, 0}, {axial, transverse, transverse, 0, 0, 0}};
  }
  return beam;
}

}  // namespace kingpin::bodies
