// The smooth piece of a surface around one of its triangles.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "core/triangle_mesh.h"

namespace elbowroom::control {

// The triangles that hang together with `triangle` by edges across which the surface turns by no more than
// `turn_deg`, in ascending order: the face that was clicked on, of a plane or of a hole. Vertices at the same
// place are one. Triangles without area are left out, unless it is the one that was asked for.
// Looks at all triangles: a second or two for a million. Throws: PreconditionError for a triangle that the
// mesh doesn't have; Error{kCancelled}.
[[nodiscard]] std::vector<std::uint32_t> SmoothPatch(const core::TriangleMesh& mesh, std::uint32_t triangle,
                                                     double turn_deg, const std::stop_token& stop = {});

}  // namespace elbowroom::control
