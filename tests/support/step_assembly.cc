#include "tests/support/step_assembly.h"

#include <fmt/format.h>

#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Trsf.hxx>

#include "core/error.h"

namespace elbowroom::test_support {
namespace {

TopLoc_Location LocationOf(const core::RigidTransform& b_from_a) {
  const Eigen::Matrix3d& r = b_from_a.rotation;
  const Eigen::Vector3d& t = b_from_a.translation_mm;
  gp_Trsf moved;
  moved.SetValues(r(0, 0), r(0, 1), r(0, 2), t.x(), r(1, 0), r(1, 1), r(1, 2), t.y(), r(2, 0), r(2, 1),
                  r(2, 2), t.z());
  return TopLoc_Location(moved);
}

}  // namespace

void WriteStepAssembly(const std::filesystem::path& path, const std::string& name,
                       const std::vector<StepBody>& bodies, const std::vector<StepInstance>& instances) {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label assembly = shapes->NewShape();
  TDataStd_Name::Set(assembly, name.c_str());
  std::vector<TDF_Label> labels;
  for (const StepBody& body : bodies) {
    labels.push_back(shapes->AddShape(body.shape, false));
    TDataStd_Name::Set(labels.back(), body.name.c_str());
  }
  for (const StepInstance& instance : instances) {
    const TDF_Label component =
        shapes->AddComponent(assembly, labels.at(instance.body), LocationOf(instance.assembly_from_body));
    TDataStd_Name::Set(component, instance.name.c_str());
  }
  shapes->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  if (!writer.Transfer(document) || writer.Write(path.c_str()) != IFSelect_RetDone)
    throw core::Error(core::ErrorKind::kFile, fmt::format("{} can't be written", path.string()));
}

}  // namespace elbowroom::test_support
