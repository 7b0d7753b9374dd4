#pragma once

#include <string>

#include "joints/mechanism_run.h"

namespace kingpin::apps {

/// What a run of a mechanism file was, as one self-contained HTML page: a table of the books,
/// coordinates, rates, energies, residuals of the constraints, reactions, and when dry friction
/// switched. At most twelve charts of coordinates and of reactions each; the text says what is
/// left out.
std::string MakeMechanismReport(const joints::MechanismRun& run);

/// Modes as a table and frequency responses as Bode plots.
std::string MakeModesReport(const joints::MechanismModes& modes);

}  // namespace kingpin::apps
