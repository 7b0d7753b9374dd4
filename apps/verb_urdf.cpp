#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/common_options.h"
#include "apps/run_support.h"
#include "apps/urdf_states.h"
#include "core/io/error.h"
#include "core/io/json_text.h"
#include "core/io/output_file.h"
#include "joints/tree_evaluation.h"
#include "joints/urdf.h"

namespace kingpin::apps {
namespace {

struct UrdfOptions {
  std::string file;
  std::string states;
  bool floating_base = false;
};

/// JSON numbers with 17 digits. A state far beyond what is physical may overflow; its results would
/// not be JSON.
class Writer {
 public:
  explicit Writer(std::size_t state) : state_(state) {}

  void Add(std::string_view text) { text_ += text; }
  void Add(double value) {
    if (!std::isfinite(value)) {
      throw io::RunError(fmt::format("states[{}]: the result is not finite", state_));
    }
    fmt::format_to(std::back_inserter(text_), "{:.17g}", value);
  }
  template <class List>
  void AddList(const List& list) {
    text_ += '[';
    bool first = true;
    for (double value : list) {
      if (!first) text_ += ", ";
      first = false;
      Add(value);
    }
    text_ += ']';
  }
  void Add(const math::Vector3<double>& a) {
    AddList(std::initializer_list<double>{a.x, a.y, a.z});
  }
  const std::string& text() const { return text_; }

 private:
  std::size_t state_;
  std::string text_;
};

void AddRows(const Eigen::MatrixXd& M, Writer& writer) {
  writer.Add("[");
  for (Eigen::Index i = 0; i < M.rows(); ++i) {
    writer.Add(i > 0 ? ",\n       " : "");
    writer.AddList(std::span<const double>(M.col(i).data(), M.rows()));  // M is symmetric
  }
  writer.Add("]");
}

std::string FormatState(std::size_t index, const joints::TreeEvaluation& e,
                        const std::vector<std::string>& links) {
  Writer writer(index);
  writer.Add("{\"M\": ");
  AddRows(e.M, writer);
  const auto add_list = [&](const char* key, const Eigen::VectorXd& values) {
    writer.Add(fmt::format(",\n     \"{}\": ", key));
    writer.AddList(std::span<const double>(values.data(), values.size()));
  };
  add_list("bias_nle", e.bias);
  add_list("qdd_forward_dynamics", e.qdd);
  add_list("tau_inverse_dynamics", e.tau);
  writer.Add(",\n     \"kinetic_energy\": ");
  writer.Add(e.kinetic);
  writer.Add(",\n     \"potential_energy\": ");
  writer.Add(e.potential);
  writer.Add(",\n     \"com\": ");
  if (e.mass > 0) {
    writer.Add(e.centre);
  } else {
    writer.Add("null");
  }
  writer.Add(",\n     \"links\": {");
  for (std::size_t l = 0; l < links.size(); ++l) {
    const joints::FrameMotion& motion = e.frames[l];
    writer.Add(
        fmt::format("{}\n      {}: {{\"p\": ", l > 0 ? "," : "", io::FormatJsonText(links[l])));
    writer.Add(motion.X_WF.p);
    writer.Add(", \"R\": [");
    const math::Rotation<double> rows = motion.X_WF.R.Transpose();
    writer.Add(rows.x);
    writer.Add(", ");
    writer.Add(rows.y);
    writer.Add(", ");
    writer.Add(rows.z);
    writer.Add("], \"v\": ");
    writer.Add(motion.v);
    writer.Add(", \"w\": ");
    writer.Add(motion.w);
    writer.Add(", \"acc\": ");
    writer.Add(motion.acc);
    writer.Add(", \"alpha\": ");
    writer.Add(motion.alpha);
    writer.Add("}");
  }
  writer.Add("}}");
  return writer.text();
}

std::string Evaluate(const joints::Urdf& urdf, joints::Mechanism& mechanism,
                     const UrdfOptions& options) {
  const UrdfStates states = ReadUrdfStates(options.states, mechanism, options.floating_base);
  mechanism.system.model.gravity = states.gravity;
  std::vector<std::string> links;
  std::vector<mechanism::Frame> frames;
  for (const auto& [link, body] : urdf.bodies) {
    links.push_back(link);
    frames.push_back(mechanism.GetBody(body));
  }
  std::string text = "{\"velocity_layout\": [";
  for (const auto& place : mechanism.joints) {
    text += fmt::format("{}\n   {{\"joint\": {}, \"first\": {}, \"size\": {}}}",
                        &place == &mechanism.joints.front() ? "" : ",",
                        io::FormatJsonText(place.name), place.v, place.velocities);
  }
  text += "],\n \"states\": [";
  for (std::size_t k = 0; k < states.states.size(); ++k) {
    const UrdfStates::State& state = states.states[k];
    text += k > 0 ? ",\n    " : "\n    ";
    text += FormatState(
        k, joints::CalcTreeEvaluation(mechanism, state.q, state.v, state.tau, state.a, frames),
        links);
  }
  return text + "]}\n";
}

std::string FormatJoint(const joints::UrdfJoint& joint) {
  std::string text =
      fmt::format("  {}: {}, {} -> {}", joint.name, joint.type, joint.parent, joint.child);
  const bool turns = joint.type == "revolute" || joint.type == "continuous";
  if (joint.limit && joint.type != "fixed" && joint.type != "floating") {
    if (joint.type != "continuous") {
      text += fmt::format(", from {:g} to {:g} {}", joint.limit->lower, joint.limit->upper,
                          turns ? "rad" : "m");
    }
    text += fmt::format(", at most {:g} {} and {:g} {}", joint.limit->effort, turns ? "N m" : "N",
                        joint.limit->velocity, turns ? "rad/s" : "m/s");
  }
  if (joint.damping != 0) {
    text += fmt::format(", damping {:g} {}", joint.damping, turns ? "N m s/rad" : "N s/m");
  }
  if (joint.friction != 0) {
    text += fmt::format(", friction {:g} {}", joint.friction, turns ? "N m" : "N");
  }
  if (joint.mimic) {
    text += fmt::format(", mimics {} times {:g} plus {:g}", joint.mimic->joint,
                        joint.mimic->multiplier, joint.mimic->offset);
  }
  return text + '\n';
}

std::string Describe(const joints::Urdf& urdf, const joints::Mechanism& mechanism) {
  double mass = 0;
  for (const mechanism::Link& link : mechanism.system.model.links) mass += link.mass;
  std::string text = fmt::format(
      "robot '{}': {} links, {} joints, {} degrees of freedom, {:g} kg that move; root '{}'\n",
      urdf.name, urdf.bodies.size(), urdf.joints.size(), mechanism.system.model.velocities, mass,
      urdf.root);
  text += "joints:\n";
  for (const joints::UrdfJoint& joint : urdf.joints) text += FormatJoint(joint);
  text += "velocity coordinates:\n";
  for (const auto& place : mechanism.joints) {
    text += fmt::format("  {}: {}", place.name, place.v);
    text += place.velocities > 1 ? fmt::format(" to {}\n", place.v + place.velocities - 1) : "\n";
  }
  return text;
}

void RunUrdfVerb(const UrdfOptions& options, const CommonOptions& common) {
  CheckOutputFile(common, {options.file, options.states});
  joints::Urdf urdf = joints::ReadUrdf(
      options.file, options.floating_base ? joints::UrdfBase::kFloating : joints::UrdfBase::kFixed);
  // the tree by itself: every joint a coordinate of its own
  urdf.description.couplings.clear();
  joints::Mechanism mechanism = joints::MakeMechanism(urdf.description);
  const std::string text =
      options.states.empty() ? Describe(urdf, mechanism) : Evaluate(urdf, mechanism, options);
  if (!common.output.empty()) {
    io::WriteFileAtomically(common.output, text);
  } else {
    io::WriteStandardOutput(text);
  }
}

}  // namespace

void AddVerbUrdf(CLI::App& app, CommonOptions& common) {
  CLI::App* verb = app.add_subcommand(
      "urdf", "Reads a URDF mechanism and says what it is; --evaluate gives its dynamics as JSON");
  const auto options = std::make_shared<UrdfOptions>();
  verb->add_option("FILE", options->file, "A URDF file")->required();
  verb->add_option("--evaluate", options->states,
                   "States for which to write mass matrix, bias, forward and inverse dynamics, "
                   "energies and link motions")
      ->type_name("STATES.json");
  verb->add_flag("--floating-base", options->floating_base,
                 "The root link moves freely instead of being welded to the world");
  AddOutputOption(*verb, common, "File instead of standard output");
  verb->callback([options, &common] { RunUrdfVerb(*options, common); });
}

}  // namespace kingpin::apps
