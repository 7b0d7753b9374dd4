#pragma once

#include <span>

#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// Fills in the derived arrays of a model whose links, closures and names are set: supports, slots,
/// the elimination order and the redundant rows.
///
/// @param q an assembled position: redundancy is a property of the mechanism where it can be, not
/// of a position that
///     breaks its loops. States around it, on the constraints, are sampled from a fixed seed.
/// @throws std::invalid_argument if the mass matrix is singular in q; the message names the
/// coordinate
void Compile(Model& model, std::span<const double> q);

}  // namespace kingpin::mechanism
