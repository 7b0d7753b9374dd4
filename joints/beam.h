#pragma once

#include <string>
#include <vector>

#include "bodies/beam_elements.h"
#include "joints/force_description.h"

namespace kingpin::joints {

/// A beam or shaft of rigid finite elements, as bodies, joints and forces.
struct BeamDescription {
  enum class Flexibility {
    kTorsion,            ///< one revolute coordinate per spring
    kTorsionAndBending,  ///< spherical joints; large deflections
    kAll,                ///< with shear and tension as chosen below
  };
  std::string name;
  FrameDescription at;  ///< where it begins; the beam lies along x of this frame
  bodies::BeamElements elements;
  Flexibility flexibility = Flexibility::kTorsionAndBending;
  bool shear = true, tension = true;  ///< of kAll
  /// How the first element hangs on `at`: fixed (clamped), revolute (about x), spherical, free.
  JointType root = JointType::kFixed;
  Source source;
};

/// What AppendBeam has made.
struct BeamParts {
  std::vector<std::string> bodies;  ///< "NAME.0" ... "NAME.n", the rigid elements
  std::vector<std::string> joints;  ///< "NAME.root", then "NAME.joint1" ... "NAME.jointn"
  FrameDescription end;             ///< at the far end, axes of the last element
};

/// Appends bodies NAME.k, joints NAME.jointk and forces NAME.springk. Springs of rotations and of
/// all six directions are bushings: their rotation vector has no preferred order of axes and no
/// singular position.
///
/// @throws io::InputError for an empty name or a root joint of another type
BeamParts AppendBeam(const BeamDescription& beam, MechanismDescription& mechanism,
                     std::vector<ForceDescription>& forces);

/// A body by its inertia.
BodyDescription MakeBody(const std::string& name, const bodies::RigidInertia& inertia,
                         const Source& source = {});

}  // namespace kingpin::joints
