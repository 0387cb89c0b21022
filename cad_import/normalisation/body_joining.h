// Bodies between triangle soup and healed surfaces: how they are welded, joined and cut into pieces.
#pragma once

#include <string>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "cad_import/model/raw_scene.h"
#include "cad_import/normalisation/healing.h"

namespace elbowroom::cad_import {

// A body that isn't healed yet. `owned` numbers `piece_names`; `deviation` is how far the triangles may be
// from the surface that they stand for.
struct Body {
  OwnedMesh owned;
  std::vector<std::string> piece_names;
  double deviation = 0.0;
  std::string name;
};

// The shape, welded, as a body of one piece.
[[nodiscard]] Body BodyOf(RawShape shape);

struct BodyScene {
  std::vector<Body> bodies;
  std::vector<CadInstance> instances;
};

// Joins open bodies that stand in one place each, share vertices and together have no open edge: exporters
// cut one surface up by material or group. The first body's instance remains for all of them. Returns how
// many were joined.
int JoinOpenBodies(BodyScene& scene);

// Sorts the triangles by connected piece. Each becomes a piece with the name of the body's first one.
void SplitIntoPieces(Body& body);

}  // namespace elbowroom::cad_import
