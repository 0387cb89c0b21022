#include "cad_import/formats/tessellation.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <array>
#include <cmath>

namespace elbowroom::cad_import {
namespace {

constexpr int kMostMeshings = 4;
// Small holes get corners enough to look round.
constexpr double kAngleRad = 0.5;

// How far a face is from its triangles.
class FaceDeviation {
 public:
  // `tolerance`: below it an upper bound of the distance is enough.
  FaceDeviation(const TopoDS_Face& face, const Poly_Triangulation& triangles, double tolerance)
      : surface_(face, false),
        geometry_(BRep_Tool::Surface(face)),
        triangles_(triangles),
        tolerance_(tolerance) {}

  [[nodiscard]] double Find() {
    if (surface_.GetType() == GeomAbs_Plane) return 0.0;
    double worst = 0.0;
    for (int i = 1; i <= triangles_.NbTriangles(); ++i) {
      int a = 0, b = 0, c = 0;
      triangles_.Triangle(i).Get(a, b, c);
      worst = std::max({worst, At({a, b, c}), At({a, b}), At({b, c}), At({c, a})});
    }
    return worst;
  }

 private:
  // The distance of the middle of some nodes from the face. The face's point at the middle of their
  // parameters gives an upper bound. Where that exceeds the tolerance, the nearest point is looked for,
  // because parameters mean little at poles and seams.
  double At(std::initializer_list<int> nodes) {
    gp_XYZ middle(0.0, 0.0, 0.0);
    gp_XY parameters(0.0, 0.0);
    for (const int node : nodes) {
      middle += triangles_.Node(node).XYZ();
      parameters += triangles_.UVNode(node).XY();
    }
    const auto count = static_cast<double>(nodes.size());
    middle /= count;
    parameters /= count;
    const double bound = (surface_.Value(parameters.X(), parameters.Y()).XYZ() - middle).Modulus();
    if (bound <= tolerance_) return bound;
    (void)geometry_.ValueOfUV(middle, Precision::Confusion());
    return std::min(bound, geometry_.Gap());
  }

  BRepAdaptor_Surface surface_;
  ShapeAnalysis_Surface geometry_;
  const Poly_Triangulation& triangles_;
  double tolerance_;
};

double DeviationOf(const TopoDS_Face& face, double tolerance) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
  if (triangles.IsNull() || !triangles->HasUVNodes()) return 0.0;
  // In the frame that the nodes are in.
  return FaceDeviation(TopoDS::Face(face.Located(TopLoc_Location())), *triangles, tolerance).Find();
}

double DeviationOf(const TopoDS_Shape& shape, double tolerance) {
  double worst = 0.0;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
    worst = std::max(worst, DeviationOf(TopoDS::Face(at.Current()), tolerance));
  return worst;
}

void Append(const TopoDS_Face& face, Tessellation& result) {
  ++result.faces;
  TopLoc_Location location;
  const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, location);
  if (triangles.IsNull() || triangles->NbTriangles() == 0) {
    ++result.faces_without_triangles;
    return;
  }
  const gp_Trsf& shape_from_face = location.Transformation();
  const auto offset = static_cast<std::int32_t>(result.mesh.vertices_mm.size()) - 1;  // nodes count from 1
  for (int i = 1; i <= triangles->NbNodes(); ++i) {
    const gp_Pnt node = triangles->Node(i).Transformed(shape_from_face);
    result.mesh.vertices_mm.emplace_back(node.X(), node.Y(), node.Z());
  }
  const bool is_reversed = (face.Orientation() == TopAbs_REVERSED) != shape_from_face.IsNegative();
  for (int i = 1; i <= triangles->NbTriangles(); ++i) {
    std::array<int, 3> corner{};
    triangles->Triangle(i).Get(corner[0], corner[1], corner[2]);
    if (is_reversed) std::swap(corner[1], corner[2]);
    result.mesh.triangles.push_back({corner[0] + offset, corner[1] + offset, corner[2] + offset});
  }
}

}  // namespace

Tessellation Tessellate(const TopoDS_Shape& shape, double tolerance) {
  IMeshTools_Parameters aims;
  aims.Deflection = tolerance;
  aims.Angle = kAngleRad;
  aims.InParallel = true;
  aims.AllowQualityDecrease = true;  // of the triangles that the file itself may hold
  Tessellation result;
  for (int i = 0; i < kMostMeshings; ++i, aims.Deflection *= 0.5) {
    if (i > 0) BRepTools::Clean(shape);
    const BRepMesh_IncrementalMesh mesh(shape, aims);
    result.deviation = DeviationOf(shape, tolerance);
    if (result.deviation <= tolerance) break;
  }
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
    Append(TopoDS::Face(at.Current()), result);
  return result;
}

double DiagonalOf(const TopoDS_Shape& shape) {
  Bnd_Box box;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
    BRepBndLib::Add(at.Current(), box, false);
  return box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
}

}  // namespace elbowroom::cad_import
