#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "core/signal/spectrum.h"
#include "models/planar/curve_spline.h"
#include "optimisation/study/report_parts.h"

namespace kingpin::study {
namespace {

using planar::Parameters;

constexpr double kDegree = 180.0 / std::numbers::pi;

report::Curve MakeCurve(const planar::Curve<double>& curve) {
  const auto spline = planar::MakeSpline(curve);
  report::Curve sampled;
  constexpr int kPoints = 121;
  const double first = curve.x[0], last = curve.x[curve.count - 1];
  for (int i = 0; i < kPoints; ++i) {
    const double x = first + (last - first) * i / (kPoints - 1);
    sampled.x.push_back(x);
    sampled.y.push_back(spline(x));
  }
  return sampled;
}

report::CharacteristicCurve MakeCharacteristic(const planar::Curve<double>& curve) {
  report::CharacteristicCurve shown;
  if (curve.count < 2) return shown;
  shown.curve = MakeCurve(curve);
  shown.nodes.x.assign(curve.x.begin(), curve.x.begin() + curve.count);
  shown.nodes.y.assign(curve.f.begin(), curve.f.begin() + curve.count);
  return shown;
}

report::CornerGeometry MakeGeometry(const Parameters<double>& p, const Case& c) {
  report::CornerGeometry g;
  g.name = "front left";
  g.centre_of_mass = {0.0, 0.0};
  g.force_point = {p.force_x, p.force_y};
  g.rod_outer = {p.design_origin_x + p.outer_joint_x, p.design_origin_y + p.outer_joint_y};
  g.rod_inner = {p.design_origin_x + p.rack_position, p.rack_half_length - p.half_track};
  g.rack_half_length = p.rack_half_length;
  g.lateral_support = {p.lateral_x, p.lateral_y};
  g.lateral_direction = p.lateral_angle;
  g.longitudinal_support = {p.longitudinal_x, p.longitudinal_y};
  g.longitudinal_direction = p.longitudinal_angle;
  if (c.model.car) {
    g.kingpin = {p.design_origin_x, p.design_origin_y};
    if (c.model.options.road_force_at == planar::CarModeOptions::RoadForceAt::kWheelCentre) {
      g.wheel_centre = g.force_point;
      g.wheel_radius = c.model.car->tyres.free_radius;
      // The parameter set has no tyre width; the outline only needs the proportions of a wheel.
      constexpr double kDrawnWidthOverRadius = 0.6;
      g.wheel_width = kDrawnWidthOverRadius * g.wheel_radius;
    }
  }
  return g;
}

report::CornerMotion MakeMotion(const planar::History& h) {
  return {h.time, h.q[0], h.q[1], h.q[2], h.q[3], h.q[4], h.road_force};
}

std::vector<report::Mode> MakeModes(const planar::Modes& modes) {
  std::vector<report::Mode> rows;
  for (const planar::Mode& mode : modes.modes) {
    rows.push_back({mode.frequency, mode.damping_ratio, mode.summary});
  }
  return rows;
}

}  // namespace

const std::vector<report::Channel>& GetChannels() {
  static const std::vector<report::Channel> channels{
      {"Rim acceleration", "A_tan", {"m/s^2"}, false},
      {"Torsion torque", "M_sw", {"N*m"}, false},
      {"Force of the tie rod on the rack", "", {"kN", 1e-3}, false},
      {"Tie-rod force", "F_R", {"kN", 1e-3}, false},
      {"Steering wheel angle", "φ", {"deg", kDegree}, false},
      {"Rack travel", "y", {"mm", 1e3}, false},
      {"Road force", "F_T", {"kN", 1e-3}, true}};
  return channels;
}

report::Design MakeReportDesign(const DesignResult& design, const DesignDetails& details,
                                const Case& c, const std::vector<DesignVariable>& variables,
                                double sample_interval) {
  report::Design data;
  data.name = design.name;
  data.measures = MakeMeasureValues(design, details);
  for (const DesignVariable& v : variables) {
    data.variables.push_back(GetVariable(design.parameters, v));
    if (!design.space) continue;
    const auto& own = design.space->variables();
    const auto found =
        std::find_if(own.begin(), own.end(), [&](const auto& o) { return o.name == v.name; });
    data.lower.push_back(found == own.end() ? report::kMissing : found->lower);
    data.upper.push_back(found == own.end() ? report::kMissing : found->upper);
  }
  data.objective = design.sum_of_ratios;
  const planar::History& h = details.histories.front();
  data.time = h.time;
  data.histories = {h.rim_acceleration, h.torsion_torque, h.rack_force,
                    h.tie_rod_force,    h.q[4],           h.q[3],
                    h.road_force};
  const signal::Spectrum spectrum =
      signal::MakeAmplitudeSpectrum(h.rim_acceleration, sample_interval);
  data.spectrum = {spectrum.frequency, spectrum.value};
  data.response_frequency = details.response.frequency;
  for (const char* output : {"tie_rod.force", "steering.wheel.angle"}) {
    const auto& outputs = details.response.outputs;
    const auto found = std::find(outputs.begin(), outputs.end(), output);
    data.frequency_responses.push_back(details.response.value[found - outputs.begin()][0]);
  }
  data.modes = MakeModes(details.modes);
  data.characteristics = {MakeCharacteristic(design.parameters.assist_force),
                          MakeCharacteristic(design.parameters.longitudinal_force)};
  data.geometry = MakeGeometry(design.parameters, c);
  data.motion = MakeMotion(h);
  data.note = design.relative_to == design.name
                  ? std::string("The reference of all ratios.")
                  : fmt::format("Sum of ratios {:.4g}, relative to {}.", design.sum_of_ratios,
                                design.relative_to);
  return data;
}

}  // namespace kingpin::study
