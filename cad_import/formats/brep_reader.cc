#include "cad_import/formats/brep_reader.h"

#include <fmt/format.h>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Message_ProgressIndicator.hxx>
#include <Message_ProgressScope.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "cad_import/formats/referenced_files.h"
#include "cad_import/formats/tessellation.h"
#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

namespace fs = std::filesystem;

using core::Error;
using core::ErrorKind;

constexpr double kShareOfDiagonal = 1e-3;
constexpr double kLeastTolerance = 1e-6;  // OpenCASCADE takes none below 1e-7

// OpenCASCADE's progress as ours, in per cent.
class Indicator : public Message_ProgressIndicator {
 public:
  Indicator(const core::Progress& progress, std::string what) : progress_(progress), what_(std::move(what)) {}

 protected:
  void Show(const Message_ProgressScope& /*scope*/, const Standard_Boolean /*force*/) override {
    const auto percent = static_cast<std::int64_t>(100.0 * GetPosition());
    if (percent == last_) return;
    last_ = percent;
    progress_.Report(percent, 100, what_);
  }

 private:
  const core::Progress& progress_;
  std::string what_;
  std::int64_t last_ = -1;
};

struct Document {
  Handle(TDocStd_Document) document;
  std::optional<FileUnit> unit;
  std::vector<std::string> warnings;
  std::vector<fs::path> referred;
};

Handle(TDocStd_Document) NewDocument() {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  return document;
}

Error NotRead(const fs::path& file, FileFormat format) {
  return {ErrorKind::kFormat,
          fmt::format("{}: can't be read as {}; export it again", file.string(), ToString(format))};
}

// What the reader has read into the document.
void Translate(auto& reader, Handle(TDocStd_Document) & document, const core::Progress& progress,
               const Error& otherwise) {
  const Handle(Indicator) indicator = new Indicator(progress, "translating, per cent");
  if (!reader.Transfer(document, indicator->Start())) throw Error(otherwise);
}

// The unit context of an entity; null if it has none. Each combination of contexts is a type of its own, none
// derived from this one.
Handle(StepRepr_GlobalUnitAssignedContext) UnitContextOf(const Handle(Standard_Transient) & entity) {
  if (auto units = Handle(StepRepr_GlobalUnitAssignedContext)::DownCast(entity); !units.IsNull())
    return units;
  if (const auto both =
          Handle(StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)::DownCast(entity);
      !both.IsNull()) {
    return both->GlobalUnitAssignedContext();
  }
  if (const auto three =
          Handle(StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)::DownCast(entity);
      !three.IsNull()) {
    return three->GlobalUnitAssignedContext();
  }
  return {};
}

// Millimetres per unit of length of each context that declares one.
std::set<double> UnitsOf(const Interface_InterfaceModel& model) {
  std::set<double> units;
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const Handle(StepRepr_GlobalUnitAssignedContext) context = UnitContextOf(model.Value(i));
    if (context.IsNull()) continue;
    STEPConstruct_UnitContext factors;
    if (factors.ComputeFactors(context) == 0 && factors.LengthDone()) units.insert(factors.LengthFactor());
  }
  return units;
}

// The files that it refers to, which must lie in its own folder or below.
std::vector<fs::path> ReferredFiles(STEPCAFControl_Reader& reader, const fs::path& file) {
  STEPConstruct_ExternRefs references(reader.Reader().WS());
  std::vector<fs::path> files;
  if (!references.LoadExternRefs()) return files;
  const ReferencedFiles folder(file);
  for (int i = 1; i <= references.NbExternRefs(); ++i) {
    const char* name = references.FileName(i);
    if (name == nullptr || *name == '\0') continue;
    const fs::path other = folder.path() / name;
    if (!folder.Holds(other)) throw RefersElsewhere(file, name);
    std::error_code error;
    if (fs::exists(other, error)) files.push_back(fs::weakly_canonical(other));
  }
  return files;
}

Document ReadStep(const fs::path& file, const core::Progress& progress) {
  Document result{NewDocument(), std::nullopt, {}, {}};
  STEPCAFControl_Reader reader;
  progress.Report(0, 0, "reading");
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw NotRead(file, FileFormat::kStep);
  result.referred = ReferredFiles(reader, file);
  const std::set<double> units = UnitsOf(*reader.Reader().WS()->Model());
  if (!units.empty()) result.unit = UnitOf(*units.begin());
  if (units.size() > 1) {
    result.warnings.push_back(
        fmt::format("it declares {} units of length, from {} to {}; each part was read in its own",
                    units.size(), UnitOf(*units.begin()).name, UnitOf(*units.rbegin()).name));
  }
  Translate(reader, result.document, progress, NotRead(file, FileFormat::kStep));
  return result;
}

Document ReadIges(const fs::path& file, const core::Progress& progress) {
  Document result{NewDocument(), std::nullopt, {}, {}};
  IGESCAFControl_Reader reader;
  progress.Report(0, 0, "reading");
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) throw NotRead(file, FileFormat::kIges);
  const auto model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  const double mm = model.IsNull() ? 0.0 : model->GlobalSection().UnitValue();
  if (mm > 0.0) result.unit = UnitOf(mm);
  Translate(reader, result.document, progress, NotRead(file, FileFormat::kIges));
  return result;
}

Document ReadBrepFile(const fs::path& file, const core::Progress& progress) {
  Document result{NewDocument(), std::nullopt, {}, {}};
  TopoDS_Shape shape;
  progress.Report(0, 0, "reading");
  if (!BRepTools::Read(shape, file.c_str(), BRep_Builder()) || shape.IsNull())
    throw NotRead(file, FileFormat::kBrep);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(result.document->Main());
  TDataStd_Name::Set(shapes->AddShape(shape, false), file.stem().c_str());
  return result;
}

std::string NameOf(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
  std::string text = TCollection_AsciiString(name->Get()).ToCString();
  return text.starts_with("=>[") ? "" : text;  // OpenCASCADE's name for what has none
}

// An occurrence's name, unless it is only a number: "NAUO12".
std::string NameOf(const TDF_Label& occurrence, const TDF_Label& product) {
  const std::string name = NameOf(occurrence);
  const bool is_number =
      name.starts_with("NAUO") && name.find_first_not_of("0123456789", 4) == std::string::npos;
  return name.empty() || is_number ? NameOf(product) : name;
}

Eigen::Affine3d ToEigen(const gp_Trsf& b_from_a) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) result(row, column) = b_from_a.Value(row + 1, column + 1);
  return result;
}

// Walks the document's tree of products.
class DocumentWalk {
 public:
  // `tolerance_mm`: as ImportOptions has it.
  DocumentWalk(const Document& document, std::optional<double> tolerance_mm, double mm_per_document_mm,
               const core::Progress& progress)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document.document->Main())),
        colors_(XCAFDoc_DocumentTool::ColorTool(document.document->Main())),
        usual_tolerance_(kUsualToleranceMm / mm_per_document_mm),
        progress_(progress) {
    if (tolerance_mm) tolerance_ = *tolerance_mm / mm_per_document_mm;
  }

  RawScene Walk(const std::string& where) {
    result_.are_bodies = true;
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (const TDF_Label& root : roots) Visit(root, "", Eigen::Affine3d::Identity(), std::nullopt);
    if (result_.instances.empty() && faces_without_triangles_ > 0) {
      throw Error(ErrorKind::kCad,
                  fmt::format("{}: none of its {} faces could be meshed, perhaps for want of "
                              "memory; run `elbowroom import` on it with a larger --tolerance "
                              "or --memory-gib, or repair it",
                              where, faces_));
    }
    if (faces_without_triangles_ > 0) {
      result_.warnings.push_back(fmt::format("{} of its {} faces could not be meshed and are missing",
                                             faces_without_triangles_, faces_));
    }
    if (worst_excess_ > 1.0) {
      result_.warnings.push_back(fmt::format(
          "its triangles are up to {:.3g} times the tolerance away from its faces", worst_excess_));
    }
    return std::move(result_);
  }

 private:
  void Visit(const TDF_Label& occurrence, const std::string& parent, const Eigen::Affine3d& model_from_parent,
             std::optional<ColorRgb> color) {
    TDF_Label product = occurrence;
    if (shapes_->IsReference(occurrence)) shapes_->GetReferredShape(occurrence, product);
    const std::string name = NameOf(occurrence, product);
    const std::string path = parent.empty() || name.empty() ? parent + name : parent + '/' + name;
    const Eigen::Affine3d model_from_product =
        model_from_parent * ToEigen(shapes_->GetLocation(occurrence).Transformation());
    // The outermost colour holds.
    if (!color) color = ColorOf(occurrence);
    if (!color) color = ColorOf(product);
    if (shapes_->IsAssembly(product)) {
      TDF_LabelSequence components;
      shapes_->GetComponents(product, components);
      for (const TDF_Label& component : components) Visit(component, path, model_from_product, color);
      return;
    }
    VisitBodies(product, path, model_from_product, color);
  }

  // Adds each solid of a product as a body of its own: if solids that touch were welded together, they would
  // have no inside. Then adds the faces that belong to no solid, as one body.
  void VisitBodies(const TDF_Label& product, const std::string& path,
                   const Eigen::Affine3d& model_from_product, std::optional<ColorRgb> color) {
    // Without the place that it stands at, which its instances give.
    const TopoDS_Shape whole = shapes_->GetShape(product).Located(TopLoc_Location());
    std::vector<TopoDS_Shape> bodies;
    for (TopExp_Explorer solid(whole, TopAbs_SOLID); solid.More(); solid.Next())
      bodies.push_back(solid.Current());
    const bool has_solids = !bodies.empty();
    TopoDS_Compound loose;
    BRep_Builder builder;
    builder.MakeCompound(loose);
    TopExp_Explorer face(whole, TopAbs_FACE, TopAbs_SOLID);
    if (!has_solids || face.More()) {
      for (; face.More(); face.Next()) builder.Add(loose, face.Current());
      bodies.emplace_back(loose);
      result_.are_bodies = false;
    }
    TCollection_AsciiString entry;
    TDF_Tool::Entry(product, entry);
    const std::string own_name = NameOf(product);
    const std::string name = own_name.empty() ? path : own_name;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::string number = bodies.size() > 1 ? ' ' + std::to_string(i + 1) : "";
      const std::optional<std::size_t> shape =
          ShapeOf(entry.ToCString() + number, bodies[i].Located(TopLoc_Location()), name + number);
      if (!shape) {
        ++result_.left_out;
        continue;
      }
      const Eigen::Affine3d product_from_body = ToEigen(bodies[i].Location().Transformation());
      result_.instances.push_back({path + number, *shape, model_from_product * product_from_body, color});
    }
  }

  // `key`: of the body. Nothing: it has no faces.
  std::optional<std::size_t> ShapeOf(const std::string& key, const TopoDS_Shape& shape,
                                     const std::string& name) {
    const auto [found, is_new] = shape_of_key_.try_emplace(key, std::nullopt);
    if (!is_new) return found->second;
    progress_.Report(static_cast<std::int64_t>(result_.shapes.size()), 0, "meshing part");
    const double diagonal = DiagonalOf(shape);
    if (!(diagonal > 0.0)) return std::nullopt;
    const double tolerance = std::max(
        tolerance_.value_or(std::min(usual_tolerance_, kShareOfDiagonal * diagonal)), kLeastTolerance);
    Tessellation made = Tessellate(shape, tolerance);
    faces_ += made.faces;
    faces_without_triangles_ += made.faces_without_triangles;
    worst_excess_ = std::max(worst_excess_, made.deviation / tolerance);
    if (made.mesh.triangles.empty()) return std::nullopt;
    found->second = result_.shapes.size();
    result_.shapes.push_back({name, std::move(made.mesh), std::max(tolerance, made.deviation)});
    return found->second;
  }

  std::optional<ColorRgb> ColorOf(const TDF_Label& label) const {
    Quantity_Color color;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
      if (!colors_->GetColor(label, type, color)) continue;
      std::array<double, 3> srgb{};
      color.Values(srgb[0], srgb[1], srgb[2], Quantity_TOC_sRGB);
      ColorRgb result{};
      std::ranges::transform(srgb, result.begin(), [](double channel) {
        return static_cast<float>(std::clamp(channel, 0.0, 1.0));
      });
      return result;
    }
    return std::nullopt;
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  std::optional<double> tolerance_;  // in the document's unit, as the next
  double usual_tolerance_;
  const core::Progress& progress_;
  std::map<std::string, std::optional<std::size_t>> shape_of_key_;
  int faces_ = 0;
  int faces_without_triangles_ = 0;
  double worst_excess_ = 0.0;
  RawScene result_;
};

Document ReadDocument(const fs::path& file, FileFormat format, const core::Progress& progress) {
  switch (format) {
    case FileFormat::kStep:
      return ReadStep(file, progress);
    case FileFormat::kIges:
      return ReadIges(file, progress);
    default:
      return ReadBrepFile(file, progress);
  }
}

}  // namespace

RawScene ReadBrep(const fs::path& file, FileFormat format, const ImportOptions& options,
                  const core::Progress& progress) {
  try {
    Document document = ReadDocument(file, format, progress);
    // What a millimetre of the document is in the result, in mm.
    const double mm_per_unit = document.unit ? document.unit->mm_per_unit : 1.0;
    const auto asked = options.unit    ? options.unit
                       : document.unit ? std::nullopt
                                       : options.unit_if_file_has_none;
    const double mm_per_document_mm = asked ? core::MillimetresPer(*asked) / mm_per_unit : 1.0;
    RawScene scene =
        DocumentWalk(document, options.tolerance_mm, mm_per_document_mm, progress).Walk(file.string());
    scene.are_mm = document.unit.has_value();
    scene.unit = document.unit;
    scene.referred = std::move(document.referred);
    scene.warnings.insert(scene.warnings.begin(), document.warnings.begin(), document.warnings.end());
    return scene;
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: can't be read as {} ({}: {}); export it again", file.string(),
                            ToString(format), failure.DynamicType()->Name(), failure.GetMessageString()));
  }
}

}  // namespace elbowroom::cad_import
