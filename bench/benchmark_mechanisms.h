#pragma once

#include "core/mechanism/model.h"

namespace kingpin::mechanism {

/// A vehicle of 39 degrees of freedom and 24 loop rows: free chassis, rack, and four corners of a
/// double wishbone, a knuckle, a tie rod (to the rack in front, to the chassis behind) and a wheel.
/// Assembled at q.
Model MakeBenchmarkVehicle(std::vector<double>& q);

/// A serial chain of `count` spatial four-bars (revolute, universal, spherical cut, revolute), each
/// mounted on the rocker of the one before: 4 coordinates and 3 rows per loop.
Model MakeSpatialFourBars(int count, std::vector<double>& q);

/// The same with planar four-bars closed by a revolute cut in the plane and one redundant row: 3
/// coordinates and 3 rows per loop.
Model MakePlanarFourBars(int count, std::vector<double>& q);

/// A chain of bodies on revolute joints with axes z, y, x in turn, along a coil; with `loops`,
/// every tenth body is held at a point to the tenth before it (the first to the world): 10
/// coordinates and 3 rows per loop.
Model MakeChain(int bodies, bool loops, std::vector<double>& q);

/// Free base and 30 revolute joints, branched like a walking robot.
Model MakeHumanoid(std::vector<double>& q);

}  // namespace kingpin::mechanism
