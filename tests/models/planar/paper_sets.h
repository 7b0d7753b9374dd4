#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/planar/excitation.h"
#include "models/planar/paper_set.h"
#include "models/planar/parameters.h"

/// The three identified parameter sets of the paper with the initial design of case 2, for tests.
namespace kingpin::planar::sets {

inline PaperSet ReadSet(const std::string& name) {
  PaperSet set = ReadPaperSet(KINGPIN_SOURCE_DIR "/examples/paper/set_" + name + ".json");
  set.parameters = set.designs.at("case2_initial").parameters;
  return set;
}

inline PaperSet SetA() { return ReadSet("A"); }
inline PaperSet SetB() { return ReadSet("B"); }
inline PaperSet SetC() { return ReadSet("C"); }
inline std::vector<PaperSet> AllSets() { return {SetA(), SetB(), SetC()}; }

inline Curve<double> MakeCurve(std::array<double, 7> x, std::array<double, 7> f) {
  Curve<double> curve;
  curve.count = 7;
  for (std::size_t i = 0; i < 7; ++i) {
    curve.x[i] = x[i];
    curve.f[i] = f[i];
  }
  return curve;
}

}  // namespace kingpin::planar::sets
