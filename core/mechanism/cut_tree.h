#pragma once

#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// When a tree is cut into segments (segments.h).
struct CutRule {
  /// Trees with at most as many coordinates between root and leaf stay whole. Measured: from about
  /// here on the cut costs less than it saves.
  int depth = 24;
  int length = 8;  ///< coordinates of a segment from which on it ends, if its links allow
};

/// Chooses the cuts, after CompileTopology. A segment ends at the first link of its length that is
/// fit to be cut and lies within no loop, or at twice the length at any link fit to be cut. A link
/// is fit if its mass and its central inertia are regular: a chain of point masses stays whole.
void CutTree(Model& model, const CutRule& rule);

/// Leaves the tree whole.
void SetWholeTree(Model& model);

}  // namespace kingpin::mechanism
