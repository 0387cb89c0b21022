// Bodies on their way from soup to surfaces: what is welded, what belongs together.
#pragma once

#include <string>
#include <vector>

#include "cad_import/model/cad_model.h"
#include "cad_import/model/raw_scene.h"
#include "cad_import/normalisation/healing.h"

namespace elbowroom::cad_import {

// A body on its way: whose pieces it is made of, and how far it may be from what it stands for.
struct Body {
  OwnedMesh owned;
  std::vector<std::string> piece_names;
  double deviation = 0.0;
  std::string name;
};

// Welded; of one piece, its own.
[[nodiscard]] Body BodyOf(RawShape shape);

struct BodyScene {
  std::vector<Body> bodies;
  std::vector<CadInstance> instances;
};

// Joins open bodies of one place each that share vertices and are one closed surface together, as exporters
// cut one up by material or group; their instances become the first's. Returns how many were joined.
int JoinOpenBodies(BodyScene& scene);

// Sorts the triangles by connected piece, each of which is then a piece by that name.
void SplitIntoPieces(Body& body);

}  // namespace elbowroom::cad_import
