#include "cad_import/formats/three_mf_reader.h"

#include <Common/NMR_ErrorConst.h>
#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace elbowroom::cad_import {
namespace {

using core::Error;
using core::ErrorKind;

constexpr int kDeepestNesting = 64;

// Handles of the library, released at the end of their lives.
struct Release {
  void operator()(NMR::PLib3MFBase* handle) const { NMR::lib3mf_release(handle); }
};
using Owned = std::unique_ptr<NMR::PLib3MFBase, Release>;  // every kind of handle is the same type

class Reading {
 public:
  explicit Reading(const std::filesystem::path& file) : where_(file.string()) {}

  RawScene Read() {
    const auto model = Make([](auto** made) { return NMR::lib3mf_createmodel(made); });
    const auto reader =
        Make([&](auto** made) { return NMR::lib3mf_model_queryreader(model.get(), "3mf", made); });
    if (NMR::lib3mf_reader_readfromfileutf8(reader.get(), where_.c_str()) != LIB3MF_OK)
      Fail(ReasonOf(reader.get()));
    result_.unit = UnitOfModel(*model);
    TakeWarnings(*reader);
    const auto items = Make([&](auto** made) { return NMR::lib3mf_model_getbuilditems(model.get(), made); });
    for (BOOL has_next = 0;
         Check(NMR::lib3mf_builditemiterator_movenext(items.get(), &has_next)), has_next != 0;) {
      const auto item =
          Make([&](auto** made) { return NMR::lib3mf_builditemiterator_getcurrent(items.get(), made); });
      const auto object =
          Make([&](auto** made) { return NMR::lib3mf_builditem_getobjectresource(item.get(), made); });
      DWORD id = 0;
      Check(NMR::lib3mf_builditem_getobjectresourceid(item.get(), &id));
      Eigen::Affine3d model_from_object = Eigen::Affine3d::Identity();
      if (BOOL is_moved = 0;
          Check(NMR::lib3mf_builditem_hasobjecttransform(item.get(), &is_moved)), is_moved != 0) {
        NMR::MODELTRANSFORM transform{};
        Check(NMR::lib3mf_builditem_getobjecttransform(item.get(), &transform));
        model_from_object = ToEigen(transform);
      }
      Visit(*object, id, model_from_object, "", 0);
    }
    return std::move(result_);
  }

 private:
  [[noreturn]] void Fail(const std::string& why) const {
    throw Error(ErrorKind::kFormat,
                fmt::format("{}: can't be read as 3MF ({}); export it again", where_, why));
  }
  void Check(LIB3MFRESULT result) const {
    if (result != LIB3MF_OK) Fail(fmt::format("error {:#x}", static_cast<unsigned>(result)));
  }
  Owned Make(auto function) const {
    NMR::PLib3MFBase* made = nullptr;
    Check(function(&made));
    return Owned(made);
  }

  static std::string ReasonOf(NMR::PLib3MFBase* handle) {
    DWORD code = 0;
    LPCSTR text = nullptr;
    if (NMR::lib3mf_getlasterror(handle, &code, &text) != LIB3MF_OK || text == nullptr)
      return "no reason given";
    return fmt::format("error {:#x}: {}", code, text);
  }

  // What the library passed over.
  void TakeWarnings(NMR::PLib3MFModelReader& reader) {
    constexpr DWORD kMostWarnings = 5;
    DWORD count = 0;
    Check(NMR::lib3mf_reader_getwarningcount(&reader, &count));
    for (DWORD i = 0; i < count; ++i) {
      DWORD code = 0;
      ULONG size = 0;
      Check(NMR::lib3mf_reader_getwarningutf8(&reader, i, &code, nullptr, 0, &size));
      std::string text(size + 1, '\0');
      Check(NMR::lib3mf_reader_getwarningutf8(&reader, i, &code, text.data(), size + 1, &size));
      text.resize(std::min<std::size_t>(text.find('\0'), text.size()));
      if (code == NMR_ERROR_INVALIDMODELUNIT) {
        result_.unit.reset();
        result_.warnings.emplace_back("its unit isn't one of 3MF's and was passed over");
      } else if (result_.warnings.size() < kMostWarnings) {
        result_.warnings.push_back(fmt::format("lib3mf: {}", text));
      }
    }
  }

  FileUnit UnitOfModel(NMR::PLib3MFModel& model) const {
    DWORD unit = NMR::MODELUNIT_MILLIMETER;
    Check(NMR::lib3mf_model_getunit(&model, &unit));
    switch (unit) {
      case NMR::MODELUNIT_MICROMETER:
        return UnitOf(0.001);
      case NMR::MODELUNIT_CENTIMETER:
        return UnitOf(10.0);
      case NMR::MODELUNIT_INCH:
        return UnitOf(25.4);
      case NMR::MODELUNIT_FOOT:
        return UnitOf(304.8);
      case NMR::MODELUNIT_METER:
        return UnitOf(1000.0);
      default:
        return UnitOf(1.0);
    }
  }

  static Eigen::Affine3d ToEigen(const NMR::MODELTRANSFORM& transform) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column)
        result(row, column) = double{transform.m_fFields[row][column]};
    return result;
  }

  std::string NameOf(NMR::PLib3MFModelObjectResource& object) const {
    ULONG size = 0;
    if (NMR::lib3mf_object_getnameutf8(&object, nullptr, 0, &size) != LIB3MF_OK || size == 0) return "";
    std::string name(size + 1, '\0');
    if (NMR::lib3mf_object_getnameutf8(&object, name.data(), size + 1, &size) != LIB3MF_OK) return "";
    name.resize(std::min<std::size_t>(name.find('\0'), name.size()));
    return name;
  }

  // `id`: of the object; a shape is read once, however many objects of its name there are.
  void Visit(NMR::PLib3MFModelObjectResource& object, DWORD id, const Eigen::Affine3d& model_from_object,
             const std::string& parent, int depth) {
    if (depth > kDeepestNesting || result_.instances.size() >= kMostInstances) {
      throw Error(ErrorKind::kGeometry,
                  fmt::format("{}: its components are nested deeper than {} or make more than {} "
                              "parts; export a simpler model",
                              where_, kDeepestNesting, kMostInstances));
    }
    const std::string name = NameOf(object);
    const std::string path = parent.empty() || name.empty() ? parent + name : parent + '/' + name;
    BOOL is_mesh = 0;
    Check(NMR::lib3mf_object_ismeshobject(&object, &is_mesh));
    if (is_mesh != 0) {
      const std::size_t shape = ShapeOf(object, id, name);
      if (result_.shapes[shape].mesh.triangles.empty()) {
        ++result_.left_out;
      } else {
        result_.instances.push_back({path, shape, model_from_object, std::nullopt});
      }
      return;
    }
    DWORD count = 0;
    Check(NMR::lib3mf_componentsobject_getcomponentcount(&object, &count));
    for (DWORD i = 0; i < count; ++i) {
      const auto component =
          Make([&](auto** made) { return NMR::lib3mf_componentsobject_getcomponent(&object, i, made); });
      const auto part =
          Make([&](auto** made) { return NMR::lib3mf_component_getobjectresource(component.get(), made); });
      DWORD part_id = 0;
      Check(NMR::lib3mf_component_getobjectresourceid(component.get(), &part_id));
      NMR::MODELTRANSFORM transform{};
      Check(NMR::lib3mf_component_gettransform(component.get(), &transform));
      Visit(*part, part_id, model_from_object * ToEigen(transform), path, depth + 1);
    }
  }

  std::size_t ShapeOf(NMR::PLib3MFModelObjectResource& object, DWORD id, const std::string& name) {
    const auto [found, is_new] = shape_of_id_.try_emplace(id, result_.shapes.size());
    if (!is_new) return found->second;
    RawShape shape{name, {}};
    DWORD vertices = 0, triangles = 0;
    Check(NMR::lib3mf_meshobject_getvertexcount(&object, &vertices));
    Check(NMR::lib3mf_meshobject_gettrianglecount(&object, &triangles));
    std::vector<NMR::MODELMESHVERTEX> points(vertices);
    std::vector<NMR::MODELMESHTRIANGLE> faces(triangles);
    if (vertices > 0) Check(NMR::lib3mf_meshobject_getvertices(&object, points.data(), vertices, nullptr));
    if (triangles > 0)
      Check(NMR::lib3mf_meshobject_gettriangleindices(&object, faces.data(), triangles, nullptr));
    for (const NMR::MODELMESHVERTEX& point : points)
      shape.mesh.vertices_mm.emplace_back(double{point.m_fPosition[0]}, double{point.m_fPosition[1]},
                                          double{point.m_fPosition[2]});
    for (const NMR::MODELMESHTRIANGLE& face : faces)
      shape.mesh.triangles.push_back({static_cast<std::int32_t>(face.m_nIndices[0]),
                                      static_cast<std::int32_t>(face.m_nIndices[1]),
                                      static_cast<std::int32_t>(face.m_nIndices[2])});
    result_.shapes.push_back(std::move(shape));
    return found->second;
  }

  std::string where_;
  std::map<DWORD, std::size_t> shape_of_id_;
  RawScene result_;
};

}  // namespace

RawScene ReadThreeMf(const std::filesystem::path& file) { return Reading(file).Read(); }

}  // namespace elbowroom::cad_import
