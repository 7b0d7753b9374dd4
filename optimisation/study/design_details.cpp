#include "optimisation/study/design_details.h"

namespace kingpin::study {

DesignDetails CalcDetails(const planar::Parameters<double>& design,
                          const std::vector<WeightedLoad>& loads, const measures::GammaPlan& plan,
                          double duration, double sample_interval) {
  DesignDetails details;
  planar::SimulationOptions options;
  options.duration = duration;
  options.sample_interval = sample_interval;
  measures::GammaWorkspace workspace(plan);
  measures::CompanionOptions companion_options;
  companion_options.weighting = plan.conventions().weighting;
  companion_options.decay_level = plan.conventions().decay_level;
  for (const WeightedLoad& load : loads) {
    planar::History history = planar::Simulate(design, load.excitation, options);
    details.gammas.push_back(workspace.Update(history.rim_acceleration));
    details.companions.push_back(
        measures::CalcCompanions({history.rim_acceleration, history.torsion_torque,
                                  history.rack_force, history.tie_rod_force},
                                 sample_interval, companion_options));
    details.histories.push_back(std::move(history));
  }
  const planar::LinearModel linear = planar::MakeLinearModel(design);
  details.modes = planar::CalcModes(linear);
  details.response = planar::CalcFrequencyResponse(
      linear, planar::MakeFrequencyGrid(details.modes, 0.5, 500.0, 60));
  return details;
}

io::Signals MakeSignals(const planar::History& h) {
  io::Signals signals;
  signals.time = h.time;
  const auto add = [&](const char* name, const char* unit, const std::vector<double>& values) {
    signals.channels.push_back({name, unit, unit, values});
  };
  add("steering.wheel.rim_acceleration", "m/s^2", h.rim_acceleration);
  add("steering.wheel.angle", "rad", h.q[4]);
  add("steering.wheel.angular_velocity", "rad/s", h.v[4]);
  add("steering.wheel.angular_acceleration", "rad/s^2", h.a[4]);
  add("steering.column.torsion_torque", "N m", h.torsion_torque);
  add("steering.rack.travel", "m", h.q[3]);
  add("steering.rack.velocity", "m/s", h.v[3]);
  add("steering.rack.acceleration", "m/s^2", h.a[3]);
  add("steering.rack.tie_rod_force", "N", h.rack_force);
  add("steering.rack.friction_force", "N", h.friction_force);
  add("steering.rack.assist_force", "N", h.assist_force);
  add("front.left.tie_rod.force", "N", h.tie_rod_force);
  add("front.left.carrier.x", "m", h.q[0]);
  add("front.left.carrier.y", "m", h.q[1]);
  add("front.left.carrier.yaw", "rad", h.q[2]);
  add("front.left.carrier.acceleration_x", "m/s^2", h.a[0]);
  add("front.left.carrier.acceleration_y", "m/s^2", h.a[1]);
  add("front.left.carrier.yaw_acceleration", "rad/s^2", h.a[2]);
  // F_T is positive rearwards, the signal forwards (ISO 8855).
  std::vector<double> road_force_x = h.road_force;
  for (double& force : road_force_x) force = -force;
  add("front.left.road.force_x", "N", road_force_x);
  add("energy.kinetic", "J", h.kinetic_energy);
  add("energy.potential", "J", h.potential_energy);
  add("energy.dissipated", "J", h.dissipated_energy);
  add("energy.supplied", "J", h.supplied_energy);
  return signals;
}

}  // namespace kingpin::study
