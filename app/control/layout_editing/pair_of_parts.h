// What to propose when somebody has chosen two parts and wants a spacing or a rule between them.
#pragma once

#include <span>
#include <string>

#include "core/layout.h"
#include "core/rigid_transform.h"

namespace elbowroom::control {

// A spacing with a name of its own that leaves both parts where they are: along the axis, and with the one of
// them moving, that gives the widest gap between their extents (where all overlap: the least overlap), of
// those that the layout can have beside its other spacings. Of equals z goes before x and y, and the second
// part moves. The limits: from 0, or the overlap rounded away from it by tens, to 100 mm and more beyond the
// gap, by fifties. Where the layout can have none of them, the widest is proposed all the same, and adding it
// says why it can't be. Throws: PreconditionError unless both are parts of the layout, and not the same.
[[nodiscard]] core::Spacing ProposeSpacing(const core::Layout& layout,
                                           std::span<const core::RigidTransform> world_from_parts,
                                           const std::string& first, const std::string& second);

// The rule that the layout has for the two, or a new one that asks for 5 mm.
[[nodiscard]] core::PairRule ProposePairRule(const core::Layout& layout, const std::string& first,
                                             const std::string& second);

}  // namespace elbowroom::control
