#pragma once

#include <span>

#include "core/mechanism/cut_tree.h"
#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// Fills in what follows from the links and closures alone: parents of coordinates, supports of
/// rows. Enough for kinematics, residuals and assembly.
void CompileTopology(Model& model);

/// Chooses the order of elimination and finds the redundant rows. After CompileTopology. Deep trees
/// are cut. Takes time in proportion to the number of links, and to the cube of the number of
/// coordinates that loops share.
///
/// @param q an assembled position: redundancy is a property of the mechanism where it can be, not
/// of a position that
///     breaks its loops. States around it, on the constraints, are sampled from a fixed seed.
/// @throws std::invalid_argument if the mass matrix is singular in q; the message names the link
void CompileElimination(Model& model, std::span<const double> q, const CutRule& rule = {});

}  // namespace kingpin::mechanism
